//! Impacts in closed form: their number, their positions, and the droplets that rebound.

use std::collections::{BTreeMap, BTreeSet};

use downpour_bvh::Bvh;
use downpour_drop::air::Air;
use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_drop::fall_speed::{FallSpeedModel, terminal_speed};
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_sim::field::{DropKind, FallingDrop, RainField};
use downpour_sim::impacts::Impact;
use downpour_sim::shelter::Obstacles;
use downpour_sim::simulation::Bounce;
use downpour_sim::view::View;
use downpour_wind::{Gusts, Keyed, UniformWind, Wind, WindPart};
use glam::{DVec2, DVec3, Vec3};

const RATE: f64 = 15.0;

fn law() -> DropSizeDistribution {
    DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, RATE).expect("in range")
}

fn rain(wind: UniformWind) -> RainField {
    RainField::new(&law(), 5).expect("in range").with_wind(wind)
}

fn uniform(speed: impl Into<Keyed<f64>>, towards: DVec3, gusts: Option<Gusts>) -> UniformWind {
    let part = WindPart::uniform(&speed.into(), &towards.into()).expect("in range");
    Wind::new(vec![part], gusts, None).expect("in range").air().clone()
}

fn still() -> UniformWind {
    Wind::default().air().clone()
}

fn gusty() -> UniformWind {
    let keys = Keyed::new(vec![(0.0, 3.0), (4.0, 9.0), (20.0, 6.0)]).expect("in range");
    uniform(keys, DVec3::new(1.0, 0.0, 0.4), Some(Gusts::default()))
}

fn quad([a, b, c, d]: [[f32; 3]; 4]) -> [[[f32; 3]; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// Ground at 0, a house with a slanted roof of 4 x 4 m above one corner, which shelters what is below.
fn yard() -> Bvh {
    let ground = quad([[-20.0, 0.0, -20.0], [-20.0, 0.0, 20.0], [20.0, 0.0, 20.0], [20.0, 0.0, -20.0]]);
    let roof = quad([[-4.0, 3.0, -4.0], [-4.0, 3.0, 0.0], [0.0, 4.0, 0.0], [0.0, 4.0, -4.0]]);
    Bvh::new(&[ground, roof].concat())
}

fn obstacles(bvh: &Bvh) -> Obstacles<'_> {
    Obstacles { nodes: &bvh.nodes, triangles: &bvh.triangles, holes: None, origin: DVec3::ZERO }
}

fn speed(diameter: f64) -> f64 {
    terminal_speed(FallSpeedModel::Beard1976, diameter, &Air::standard()).expect("in range")
}

/// Number of drops between two diameters that fall through a horizontal square meter per second.
fn flux(from: f64, to: f64) -> f64 {
    let steps = 4000;
    let of = |k: u32| {
        let d = from + (to - from) * (f64::from(k) + 0.5) / f64::from(steps);
        law().concentration(d) * speed(d)
    };
    (0..steps).map(of).sum::<f64>() * (to - from) / f64::from(steps)
}

#[test]
fn as_many_drops_hit_the_ground_as_fall() {
    let bvh = yard();
    let edges = [0.5e-3, 0.8e-3, 1.3e-3, 2.0e-3, 8.0e-3];
    // Beside the house, on the windward side.
    let (low, high) = (DVec3::new(-14.0, -0.1, 4.0), DVec3::new(-10.0, 0.1, 9.0));
    let span = [3.0, 3.3];
    for wind in [still(), uniform(7.0, DVec3::new(1.0, 0.0, -2.0), None), gusty()] {
        let impacts = rain(wind).impacts(&obstacles(&bvh), low, high, span, edges[0]).expect("in range");
        let ids: BTreeSet<u64> = impacts.iter().map(|impact| impact.id).collect();
        assert_eq!(ids.len(), impacts.len(), "no drop lands twice");
        for pair in edges.windows(2) {
            let within = |impact: &&Impact| (pair[0]..pair[1]).contains(&f64::from(impact.diameter));
            let found = impacts.iter().filter(within).count() as f64;
            let expected = flux(pair[0], pair[1]) * 4.0 * 5.0 * (span[1] - span[0]);
            println!("{pair:?}: {found} of {expected:.1}");
            assert!((found - expected).abs() < 4.0 * expected.sqrt(), "{pair:?}: {found}, not {expected}");
        }
        for impact in &impacts {
            assert!(impact.position.y.abs() < 1.0e-3 && impact.normal.y > 0.999, "{impact:?}");
            assert!(impact.time_s > span[0] && impact.time_s <= span[1], "{impact:?}");
        }
    }
}

#[test]
fn nothing_lands_below_a_roof() {
    let bvh = yard();
    let (low, high) = (DVec3::new(-5.0, -0.5, -5.0), DVec3::new(2.0, 5.0, 1.0));
    for across in [0.0, 4.0] {
        let wind = if across > 0.0 { uniform(across, DVec3::X, None) } else { still() };
        let impacts = rain(wind).impacts(&obstacles(&bvh), low, high, [7.0, 7.15], 0.6e-3).expect("in range");
        let (mut on_roof, mut near) = (0, 0);
        for impact in &impacts {
            let at = impact.position;
            // The plane of the roof, and its extent.
            let plane = at.y - (4.0 + 0.25 * at.x);
            let above_roof = (-4.0..=0.0).contains(&at.x) && (-4.0..=0.0).contains(&at.z);
            if at.y > 0.1 {
                on_roof += 1;
                assert!(plane.abs() < 1.0e-3 && above_roof, "{impact:?}");
                let expected = Vec3::new(-0.25, 1.0, 0.0).normalize();
                assert!(impact.normal.dot(expected) > 0.999, "{impact:?}");
                continue;
            }
            assert!(at.y.abs() < 1.0e-3, "{impact:?}");
            // Backwards along its fall it passes the roof's plane outside the roof.
            let v = impact.velocity.as_dvec3();
            let ago = (4.0 + 0.25 * at.x - at.y) / (-v.y + 0.25 * v.x);
            let through = at - v * ago;
            let beside =
                through.x < -3.999 || through.x > -1.0e-3 || through.z < -3.999 || through.z > -1.0e-3;
            assert!(beside, "{impact:?} came through the roof at {through}");
            near += u32::from(above_roof);
        }
        // The rain on a roof is that through its outline, reduced by the slope away from the wind.
        let expected: f64 = (0..400)
            .map(|k| {
                let d = 0.6e-3 + 7.4e-3 * (f64::from(k) + 0.5) / 400.0;
                law().concentration(d) * (speed(d) + 0.25 * across) * 16.0 * 0.15 * 7.4e-3 / 400.0
            })
            .sum();
        println!("wind {across}: {on_roof} on the roof of {expected:.1}, {near} below it");
        assert!((f64::from(on_roof) - expected).abs() < 4.0 * expected.sqrt(), "{on_roof}, not {expected}");
        assert_eq!(near > 0, across > 0.0, "{near}");
    }
}

#[test]
fn spans_of_time_can_be_cut() {
    let bvh = yard();
    let (low, high) = (DVec3::new(-5.0, -0.5, -5.0), DVec3::new(1.0, 5.0, 1.0));
    for wind in [uniform(7.0, DVec3::X, None), gusty()] {
        let rain = rain(wind);
        let of = |span: [f64; 2]| -> BTreeMap<u64, Impact> {
            let impacts = rain.impacts(&obstacles(&bvh), low, high, span, 0.5e-3).expect("in range");
            impacts.into_iter().map(|impact| (impact.id, impact)).collect()
        };
        let whole = of([4.0, 4.4]);
        let mut parts = of([4.0, 4.21]);
        let rest = of([4.21, 4.4]);
        assert!(whole.len() > 500 && parts.keys().all(|id| !rest.contains_key(id)));
        parts.extend(rest);
        // At the ends of spans rounding may go either way.
        let same = whole.iter().filter(|(id, impact)| {
            parts.get(*id).is_some_and(|other| {
                (other.position - impact.position).length() < 3.0e-3
                    && (other.time_s - impact.time_s).abs() < 1.0e-3
            })
        });
        let same = same.count();
        assert!(same as f64 > 0.996 * whole.len() as f64, "{same} of {}", whole.len());
        assert!((parts.len() as f64 - whole.len() as f64).abs() < 0.004 * whole.len() as f64);
    }
}

/// A drop that a picture shows above the ground lands at the position and time of its impact.
#[test]
fn impacts_are_those_of_the_drops_that_are_seen() {
    let bvh = yard();
    let rain = rain(uniform(5.0, DVec3::X, None));
    let view = View { eye: DVec3::new(5.0, 1.0, 5.0), least_pixels: 0.5, far: 4.0, ..View::default() };
    let seen = rain.visible_among(&obstacles(&bvh), &view, 6.0).expect("in range").drops;
    let (low, high) = (DVec3::new(3.0, -0.1, 1.0), DVec3::new(12.0, 0.1, 7.0));
    let impacts = rain.impacts(&obstacles(&bvh), low, high, [6.0, 7.5], 0.3e-3).expect("in range");
    let impacts: BTreeMap<u64, Impact> = impacts.into_iter().map(|impact| (impact.id, impact)).collect();
    let mut landed = 0;
    for drop in &seen {
        let v = Vec3::from(drop.velocity).as_dvec3();
        let after = drop.position.y / -v.y;
        if after > 0.01 && after < 1.45 && drop.diameter > 0.31e-3 {
            let impact = &impacts[&drop.id];
            assert!((impact.time_s - 6.0 - after).abs() < 1.0e-3, "{impact:?}, {after}");
            assert!((impact.position - drop.position - v * after).length() < 2.0e-3, "{impact:?}");
            landed += 1;
        }
    }
    assert!(landed > 60, "{landed}");
}

/// Droplets around an eye near the ground, of all impacts.
fn droplets(wind: &UniformWind, time_s: f64, bounce: &Bounce) -> Vec<FallingDrop> {
    let bvh = yard();
    let eye = DVec3::new(9.0, 0.25, 9.0);
    let view = View { eye, least_pixels: 0.2, far: 1.0, ..View::default() };
    rain(wind.clone()).bounced(&obstacles(&bvh), &view, 0.2, time_s, bounce).expect("in range")
}

/// Each droplet starts at its impact with the remaining velocity, and then obeys dv/dt = -slip / tau.
#[test]
fn droplets_fly_as_the_law_says() {
    let wind = uniform(3.0, DVec3::X, None);
    let bounce = Bounce { fraction: 1.0, ..Bounce::default() };
    let bvh = yard();
    let time = 5.0;
    let shown = droplets(&wind, time, &bounce);
    assert!(shown.len() > 60, "{}", shown.len());
    let (low, high) = (DVec3::new(5.0, -0.1, 7.0), DVec3::new(11.0, 0.1, 10.0));
    let impacts = rain(wind).impacts(&obstacles(&bvh), low, high, [4.0, 5.0], 0.0).expect("in range");
    // A droplet starts at its impact: found by its initial state.
    let mut by_begin: BTreeMap<i64, Vec<&Impact>> = BTreeMap::new();
    for impact in &impacts {
        by_begin.entry((impact.time_s * 1.0e4).round() as i64).or_default().push(impact);
    }
    let (mut checked, mut highest) = (0, 0.0f64);
    for droplet in &shown {
        assert_eq!(droplet.kind, DropKind::Bounced);
        let age = f64::from(-droplet.present_s[0]);
        let near = ((time - age) * 1.0e4).round() as i64;
        let of =
            (near - 1..=near + 1).flat_map(|k| by_begin.get(&k).into_iter().flatten()).filter(|impact| {
                (f64::from(impact.diameter) * 0.25 - f64::from(droplet.diameter)).abs() < 1.0e-9
            });
        // Drops of one size may land at once: the nearest.
        let away = |impact: &&&Impact| (impact.position - droplet.position).length();
        let Some(impact) = of.min_by(|a, b| away(a).total_cmp(&away(b))) else {
            panic!("no impact for {droplet:?}")
        };
        // Restitution and grip, on a level floor.
        let before = impact.velocity.as_dvec3();
        let mut v = DVec3::new(before.x * 0.3, -before.y * 0.25, before.z * 0.3);
        let mut at = impact.position + DVec3::Y * 1.0e-3;
        let terminal = speed(f64::from(droplet.diameter));
        let (across, along) = (terminal / 9.80665, 0.5 * terminal / 9.80665);
        let steps = 4000;
        let dt = age / f64::from(steps);
        let pull =
            |v: DVec3| DVec3::new((3.0 - v.x) / across, (-terminal - v.y) / along, (0.0 - v.z) / across);
        for _ in 0..steps {
            // Midpoint rule.
            let half = v + pull(v) * (0.5 * dt);
            at += half * dt;
            v += pull(half) * dt;
        }
        assert!((at - droplet.position).length() < 2.0e-3, "{at}, {droplet:?}");
        assert!((v - Vec3::from(droplet.velocity).as_dvec3()).length() < 2.0e-2, "{v}, {droplet:?}");
        assert!(droplet.position.y > 0.0, "{droplet:?}");
        highest = highest.max(droplet.position.y);
        checked += 1;
    }
    println!("{checked} droplets, up to {highest:.3} m");
    // (0.25 x 9 m/s)^2 / 2 g, minus drag.
    assert!((0.02..0.26).contains(&highest), "{highest}");
}

#[test]
fn a_droplet_is_one_drop_from_picture_to_picture_and_not_its_parent() {
    let bounce = Bounce { fraction: 0.3, ..Bounce::default() };
    let wind = gusty();
    let at = |time: f64| -> BTreeMap<u64, FallingDrop> {
        droplets(&wind, time, &bounce).into_iter().map(|drop| (drop.id, drop)).collect()
    };
    let (now, then) = (at(8.0), at(8.01));
    assert_eq!(at(8.0), now, "the same question has the same answer");
    let mut both = 0;
    for (id, drop) in &now {
        if let Some(later) = then.get(id) {
            let mean = 0.5 * (Vec3::from(drop.velocity) + Vec3::from(later.velocity)).as_dvec3();
            let moved = later.position - drop.position - mean * 0.01;
            assert!(moved.length() < 1.5e-3, "{drop:?}, {later:?}");
            both += 1;
        }
    }
    assert!(both * 2 > now.len() && both > 15, "{both} of {}", now.len());
    let every = droplets(&wind, 8.0, &Bounce { fraction: 1.0, ..bounce }).len() as f64;
    let found = now.len() as f64 / every;
    assert!((found - 0.3).abs() < 4.0 * (0.21 / every).sqrt(), "{found} of the impacts");
    assert!(droplets(&wind, 8.0, &Bounce { fraction: 0.0, ..bounce }).is_empty());
}

#[test]
fn what_is_out_of_range_is_refused() {
    let bvh = yard();
    let rain = rain(still());
    let ask = |low: f64, span: [f64; 2]| {
        rain.impacts(&obstacles(&bvh), DVec3::splat(low), DVec3::ONE, span, 0.0).map(|impacts| impacts.len())
    };
    assert!(ask(2.0, [0.0, 1.0]).is_err() && ask(f64::NAN, [0.0, 1.0]).is_err());
    assert!(
        ask(0.0, [1.0, 0.0]).is_err() && ask(0.0, [0.0, 61.0]).is_err() && ask(0.0, [0.0, f64::NAN]).is_err()
    );
    assert_eq!(ask(0.5, [0.0, 1.0]).expect("in range"), 0, "nothing stands there");
    let nothing = Obstacles { nodes: &[], triangles: &[], holes: None, origin: DVec3::ZERO };
    let impacts = rain.impacts(&nothing, DVec3::ZERO, DVec3::ONE, [0.0, 1.0], 0.0);
    assert!(impacts.expect("in range").is_empty());
}

/// Ground, and slanted and upright triangles all about.
fn rubble() -> Bvh {
    let mut corners =
        quad([[-20.0, 0.0, -20.0], [-20.0, 0.0, 20.0], [20.0, 0.0, 20.0], [20.0, 0.0, -20.0]]).to_vec();
    for k in 0..120u32 {
        let [x, y, z, turn] = rng_draw([3, 4], k, 0, 0).map(rng_unit);
        let at = Vec3::new(10.0 * x - 5.0, 6.0 * y, 10.0 * z - 5.0);
        let (a, b) = (Vec3::new(turn - 0.5, 0.8 * x, 0.6 - y), Vec3::new(0.7 * z, 1.2 - y, turn));
        corners.push([at, at + a, at + b].map(Vec3::into));
    }
    Bvh::new(&corners)
}

/// The impacts of a box are those of its halves, its quarters and so on: also where what is hit crosses their sides.
#[test]
fn a_box_has_the_impacts_of_its_parts() {
    let bvh = rubble();
    let field = rain(gusty());
    let (low, high) = (DVec3::new(-4.3, -0.2, -4.7), DVec3::new(4.9, 6.8, 4.1));
    let found = |low, high| {
        let impacts = field.impacts(&obstacles(&bvh), low, high, [3.0, 3.6], 0.4e-3).expect("in range");
        impacts.iter().map(|impact| impact.id).collect::<Vec<u64>>()
    };
    let mut whole = found(low, high);
    let mut parts = Vec::new();
    let [xs, ys, zs] = [0, 1, 2].map(|k| {
        let cut = |share: f64| low[k] + (high[k] - low[k]) * share;
        [[low[k], cut(0.31)], [cut(0.31), cut(0.77)], [cut(0.77), high[k]]]
    });
    for x in xs {
        for y in ys {
            for z in zs {
                parts.extend(found(DVec3::new(x[0], y[0], z[0]), DVec3::new(x[1], y[1], z[1])));
            }
        }
    }
    whole.sort_unstable();
    parts.sort_unstable();
    assert!(whole.len() > 3000, "{}", whole.len());
    assert_eq!(whole, parts);
}

/// What a narrow picture shows of droplets is what a wide one shows there.
#[test]
fn a_narrow_picture_has_the_droplets_of_a_wide_one() {
    let bvh = rubble();
    let field = rain(gusty());
    let bounce = Bounce { fraction: 1.0, size: 0.5, ..Bounce::default() };
    let wide = View {
        eye: DVec3::new(0.4, 1.1, 6.5),
        half_width: 1.5,
        half_height: 1.5,
        far: 4.0,
        shutter_s: 0.02,
        ..View::default()
    };
    let narrow = View { half_width: 0.4, half_height: 0.2, ..wide };
    let of = |view: &View| -> BTreeMap<u64, FallingDrop> {
        let drops = field.bounced(&obstacles(&bvh), view, 0.2, 7.3, &bounce).expect("in range");
        drops.into_iter().map(|drop| (drop.id, drop)).collect()
    };
    let (wide_drops, narrow_drops) = (of(&wide), of(&narrow));
    assert!(narrow_drops.iter().all(|(id, drop)| wide_drops.get(id) == Some(drop)));
    // Those whose middles are inside.
    let inside = |drop: &&FallingDrop| {
        let at = drop.position - wide.eye;
        let (x, y, z) = (at.dot(wide.right), at.dot(wide.up), at.dot(wide.forward));
        z > 0.0 && x.abs() < narrow.half_width * z && y.abs() < narrow.half_height * z
    };
    let expected: Vec<&FallingDrop> = wide_drops.values().filter(inside).collect();
    assert!(
        expected.len() > 100 && expected.len() * 2 < wide_drops.len(),
        "{} of {}",
        expected.len(),
        wide_drops.len()
    );
    assert!(expected.iter().all(|drop| narrow_drops.contains_key(&drop.id)));
}

/// Drops come through a plane where and when they would hit ground that lies in it, as many as fall.
#[test]
fn drops_come_through_a_plane_where_they_hit_ground_in_it() {
    let ground = quad([[-20.0, 0.0, -20.0], [-20.0, 0.0, 20.0], [20.0, 0.0, 20.0], [20.0, 0.0, -20.0]]);
    let bvh = Bvh::new(&ground);
    let [low, high] = [DVec2::new(-14.0, 4.0), DVec2::new(-10.0, 9.0)];
    for (wind, span) in [(still(), [3.1, 3.4]), (gusty(), [3.125, 3.4375])] {
        let rain = rain(wind);
        let crossings = rain.crossings([low, high], 0.0, span, 0.8e-3).expect("in range");
        let expected = flux(0.8e-3, 8.0e-3) * 20.0 * (span[1] - span[0]);
        let found = crossings.len() as f64;
        assert!((found - expected).abs() < 4.0 * expected.sqrt(), "{found}, not {expected}");
        let corners = [low, high].map(|corner| DVec3::new(corner.x, 0.0, corner.y));
        let [low, high] = [corners[0] - DVec3::Y * 0.1, corners[1] + DVec3::Y * 0.1];
        let impacts = rain.impacts(&obstacles(&bvh), low, high, span, 0.8e-3).expect("in range");
        let impacts: BTreeMap<u64, Impact> = impacts.into_iter().map(|impact| (impact.id, impact)).collect();
        let mut missing = 0;
        for crossing in &crossings {
            let Some(impact) = impacts.get(&crossing.id) else {
                missing += 1;
                continue;
            };
            assert!(crossing.position.distance(impact.position) < 1.0e-4, "{crossing:?}, {impact:?}");
            assert!((crossing.time_s - impact.time_s).abs() < 1.0e-5, "{crossing:?}, {impact:?}");
            assert!((crossing.velocity - impact.velocity).length() < 1.0e-3, "{crossing:?}, {impact:?}");
        }
        // Rounding at an end of the span, and at an edge.
        assert!(missing <= 1 && impacts.len() <= crossings.len() + 1, "{missing} of {found}");
    }
    let whole = |span| rain(gusty()).crossings([low, high], 0.0, span, 2.0e-3).expect("in range").len();
    assert_eq!(whole([3.125, 3.4375]), whole([3.125, 3.25]) + whole([3.25, 3.4375]), "spans can be cut");
    let backwards = rain(still()).crossings([high, low], 0.0, [0.0, 1.0], 0.0);
    assert!(backwards.is_err() && rain(still()).crossings([low, high], f64::NAN, [0.0, 1.0], 0.0).is_err());
}
