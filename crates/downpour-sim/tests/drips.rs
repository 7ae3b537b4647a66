//! Drips: where they leave, how much water they carry, how they fall.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use downpour_bvh::Bvh;
use downpour_drop::air::Air;
use downpour_drop::drip::{self, Drip};
use downpour_drop::fall_speed::{FallSpeedModel, TerminalSpeed, terminal_speed};
use downpour_drop::splash::{FILM_M, SplashLaw};
use downpour_math::ops::f64 as ops;
use downpour_sim::drips::{DripOptions, DripPoint, DripPoints, DripRain, DripRegion, Drips, SetDrip};
use downpour_sim::field::{DropKind, FallingDrop};
use downpour_sim::impacts::SplashOptions;
use downpour_sim::shelter::Obstacles;
use downpour_sim::view::View;
use downpour_wind::{Gusts, UniformWind, Wind, WindPart};
use glam::{DVec3, Vec3};

/// 25 mm/h since long.
const RAIN: DripRain =
    DripRain { rate_m_s: 25.0e-3 / 3600.0, begin_s: -3600.0, end_s: f64::INFINITY, storage_m: 0.3e-3 };

type Triangle = [[f32; 3]; 3];

fn quad([a, b, c, d]: [[f32; 3]; 4]) -> [Triangle; 2] {
    [[a, b, c], [a, c, d]]
}

fn floor() -> Vec<Triangle> {
    quad([[-9.0, 0.0, -9.0], [-9.0, 0.0, 9.0], [9.0, 0.0, 9.0], [9.0, 0.0, -9.0]]).to_vec()
}

/// A plate from (x, z) = (-w, 0) to (w, l), tilted down towards +z by a slope, and turned about Y; its ridge is at a height.
fn plate(half_width: f32, length: f32, slope: f32, turn: f32, height: f32) -> Vec<Triangle> {
    let (sin, cos) = (f64::from(turn), f64::from(turn));
    let (sin, cos) = (ops::sin(sin) as f32, ops::cos(cos) as f32);
    let at = |x: f32, z: f32| [cos * x + sin * z, height - slope * z, -sin * x + cos * z];
    let (w, l) = (half_width, length);
    quad([at(-w, 0.0), at(-w, l), at(w, l), at(w, 0.0)]).to_vec()
}

/// A box between two corners.
fn block(low: [f32; 3], high: [f32; 3]) -> Vec<Triangle> {
    let ([a, b, c], [x, y, z]) = (low, high);
    [
        [[a, y, c], [a, y, z], [x, y, z], [x, y, c]],
        [[a, b, c], [x, b, c], [x, b, z], [a, b, z]],
        [[a, b, z], [x, b, z], [x, y, z], [a, y, z]],
        [[x, b, c], [a, b, c], [a, y, c], [x, y, c]],
        [[x, b, z], [x, b, c], [x, y, c], [x, y, z]],
        [[a, b, c], [a, b, z], [a, y, z], [a, y, c]],
    ]
    .into_iter()
    .flat_map(quad)
    .collect()
}

/// A sphere of a radius around a height.
fn sphere(radius: f64, height: f64) -> Vec<Triangle> {
    let (rings, sectors) = (48, 96);
    let at = |i: u32, j: u32| {
        let polar = std::f64::consts::PI * f64::from(i) / f64::from(rings);
        let around = std::f64::consts::TAU * f64::from(j % sectors) / f64::from(sectors);
        let [x, y, z] =
            [ops::sin(polar) * ops::cos(around), ops::cos(polar), -ops::sin(polar) * ops::sin(around)];
        [(radius * x) as f32, (height + radius * y) as f32, (radius * z) as f32]
    };
    let cell = |i: u32, j: u32| quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
    (0..rings).flat_map(|i| (0..sectors).flat_map(move |j| cell(i, j))).collect()
}

fn obstacles(bvh: &Bvh) -> Obstacles<'_> {
    Obstacles { nodes: &bvh.nodes, triangles: &bvh.triangles, holes: None, origin: DVec3::ZERO }
}

fn region(half: f64) -> DripRegion {
    DripRegion::new(DVec3::new(-half, 0.0, -half), DVec3::new(half, 9.0, half)).unwrap()
}

fn points(triangles: &[Triangle]) -> (Bvh, DripPoints) {
    let bvh = Bvh::new(triangles);
    let found = DripPoints::find(&obstacles(&bvh), region(4.0)).unwrap();
    (bvh, found)
}

fn area(found: &[DripPoint]) -> f64 {
    found.iter().map(|point| point.catchment_m2).sum()
}

fn options(wind: UniformWind) -> DripOptions {
    let speed = TerminalSpeed::new(FallSpeedModel::Beard1976, &Air::standard());
    DripOptions { seed: 7, temperature_c: 20.0, wind, speed }
}

fn still() -> UniformWind {
    Wind::default().air().clone()
}

fn uniform(speed: f64, gusts: Option<Gusts>) -> UniformWind {
    let part = WindPart::uniform(&speed.into(), &DVec3::X.into()).unwrap();
    Wind::new(vec![part], gusts, None).unwrap().air().clone()
}

fn view() -> View {
    View { eye: DVec3::new(0.0, 2.0, 6.0), shutter_s: 0.01, least_pixels: 0.2, ..View::default() }
}

/// Roofs that are turned against the lattice: all of their water drips, off the eaves, all along them and nowhere else.
#[test]
fn a_roof_drips_all_along_its_eaves_and_loses_nothing() {
    for (slope, turn) in [(0.3f32, 0.0f32), (0.1, 0.4), (0.7, -0.9), (1.5, 0.2), (0.02, 0.0)] {
        let (half_width, length) = (1.5f32, 2.0f32);
        let (_, found) = points(&[plate(half_width, length, slope, turn, 4.0), floor()].concat());
        let expected = 2.0 * f64::from(half_width) * f64::from(length);
        let collected = area(&found.points);
        assert!((collected / expected - 1.0).abs() < 0.01, "{slope} {turn}: {collected} of {expected} m^2");
        let (sin, cos) = (ops::sin(turn.into()), ops::cos(turn.into()));
        let mut along: Vec<f64> = Vec::new();
        let mut beside = 0.0;
        for point in &found.points {
            let p = point.position;
            let (x, z) = (cos * p.x - sin * p.z, sin * p.x + cos * p.z);
            assert!(x.abs() < f64::from(half_width) + 1.0e-3 && z < f64::from(length) + 1.0e-3, "{p}");
            // Within 2 mm of the edge, and on it.
            assert!((p.y - (4.0 - f64::from(slope) * z)).abs() < 1.0e-3, "{p}");
            if (z - f64::from(length)).abs() < 2.0e-3 { along.push(x) } else { beside += point.catchment_m2 }
        }
        assert!(beside < 0.04 * expected, "{slope} {turn}: {beside} m^2 beside the eaves");
        along.sort_by(f64::total_cmp);
        let ends = [along[0] + f64::from(half_width), f64::from(half_width) - along[along.len() - 1]];
        let gaps = along.windows(2).map(|pair| pair[1] - pair[0]).chain(ends);
        let widest = gaps.fold(0.0, f64::max);
        assert!(widest < 0.08, "{slope} {turn}: a gap of {widest} m");
        // About as far apart as the waves that drops grow from.
        let mean = 2.0 * f64::from(half_width) / along.len() as f64;
        assert!((0.018..0.04).contains(&mean), "{slope} {turn}: {mean} m apart");
    }
}

/// Water runs around a sphere to its lowest point.
#[test]
fn a_sphere_drips_at_its_bottom() {
    let (_, found) = points(&[sphere(0.25, 3.0), floor()].concat());
    assert!(!found.points.is_empty());
    for point in &found.points {
        assert!(point.position.y < 2.76, "{}", point.position);
    }
    let expected = std::f64::consts::PI * 0.0625;
    assert!((area(&found.points) / expected - 1.0).abs() < 0.02, "{}", area(&found.points));
}

/// A slab that lies flat drips from its lower rim on all sides; what stands under a roof gets nothing.
#[test]
fn a_slab_drips_from_its_lower_rim_and_shelters_what_is_below() {
    let slab = block([-1.0, 3.0, -1.0], [1.0, 3.1, 1.0]);
    let below = block([-0.5, 1.0, -0.5], [0.5, 1.05, 0.5]);
    let (bvh, found) = points(&[slab, below, floor()].concat());
    assert!((area(&found.points) / 4.0 - 1.0).abs() < 0.01, "{}", area(&found.points));
    for point in &found.points {
        let p = point.position;
        assert!((p.y - 3.0).abs() < 1.0e-3, "{p}");
        assert!((p.x.abs().max(p.z.abs()) - 1.0).abs() < 3.0e-3, "{p}");
    }
    for side in [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z] {
        let on_side: Vec<_> =
            found.points.iter().filter(|point| point.position.dot(side) > 0.99).copied().collect();
        assert!((area(&on_side) - 1.0).abs() < 0.1, "{side}: {}", area(&on_side));
    }
    // Its drops fall to the floor, not on the block.
    let drips = Drips::new(&obstacles(&bvh), &found.points, Some(&RAIN), &[], &options(still())).unwrap();
    let (low, high) = (DVec3::new(-4.0, -1.0, -4.0), DVec3::new(4.0, 4.0, 4.0));
    let impacts = drips.impacts(&obstacles(&bvh), low, high, [10.0, 12.0], 0.0).unwrap();
    assert!(impacts.len() > 500, "{}", impacts.len());
    for impact in &impacts {
        assert!(impact.position.y.abs() < 1.0e-3 && impact.normal == Vec3::Y, "{impact:?}");
    }
}

/// Houses, kerbs and thick walls: the water runs down on them.
#[test]
fn walls_and_kerbs_do_not_drip() {
    let house = block([-2.0, 0.0, -2.0], [0.0, 5.0, 0.0]);
    let kerb = block([1.0, -0.5, -3.0], [3.0, 0.12, 3.0]);
    let (_, found) = points(&[house, kerb, floor()].concat());
    assert!(found.points.is_empty(), "{:?}", found.points[0]);
    assert!(found.ran_down_m2 > 10.0, "{}", found.ran_down_m2);
    // A balcony at the wall drips, and not into the house.
    let house = block([-2.0, 0.0, -2.0], [0.0, 5.0, 0.0]);
    let balcony = block([0.0, 2.5, -1.5], [0.8, 2.62, -0.5]);
    let (_, found) = points(&[house, balcony, floor()].concat());
    assert!(!found.points.is_empty());
    assert!(
        found.points.iter().all(|point| point.position.x > -0.01 && (point.position.y - 2.5).abs() < 1e-3)
    );
    // The roof of the house runs down its walls, and on this side over the balcony.
    assert!(area(&found.points) > 0.78, "{}", area(&found.points));
}

/// What drips in a minute is the rain on the roof.
#[test]
fn as_much_water_drips_as_rain_falls() {
    let triangles = [plate(1.0, 2.0, 0.2, 0.3, 3.5), floor()].concat();
    let (bvh, found) = points(&triangles);
    // 10 mm/h: nowhere a jet.
    let rain = DripRain { rate_m_s: 10.0e-3 / 3600.0, ..RAIN };
    for wind in [still(), uniform(3.0, None), uniform(3.0, Some(Gusts::default()))] {
        let drips = Drips::new(&obstacles(&bvh), &found.points, Some(&rain), &[], &options(wind)).unwrap();
        let expected = rain.rate_m_s * 4.0;
        assert!((drips.flow() / expected - 1.0).abs() < 0.01, "{} {expected}", drips.flow());
        let (low, high) = (DVec3::splat(-20.0), DVec3::splat(20.0));
        let impacts = drips.impacts(&obstacles(&bvh), low, high, [5.0, 65.0], 0.0).unwrap();
        let volume: f64 = impacts.iter().map(|impact| drip::sphere_volume(impact.diameter.into())).sum();
        assert!((volume / (60.0 * expected) - 1.0).abs() < 0.01, "{volume}");
        let range = Drip::new(1.5e-3, 20.0).unwrap().diameter_m..Drip::new(3.3e-3, 20.0).unwrap().diameter_m;
        for impact in &impacts {
            assert!(range.contains(&f64::from(impact.diameter)), "{}", impact.diameter);
            assert!(impact.time_s > 5.0 && impact.time_s <= 65.0 && impact.position.y.abs() < 2.0e-3);
        }
    }
}

/// Thin edges make smaller drops: Tate's law with Harkins and Brown's fraction, 0.72 for an edge of 1 mm.
#[test]
fn drops_off_a_thin_edge_are_small() {
    let sheet = block([-1.0, 3.0, -1.0], [1.0, 3.002, 1.0]);
    let (bvh, found) = points(&[sheet, floor()].concat());
    let drips = Drips::new(&obstacles(&bvh), &found.points, Some(&RAIN), &[], &options(still())).unwrap();
    let all = drips.visible(&obstacles(&bvh), &view(), 0.0, 3.0).unwrap();
    let falls: Vec<&FallingDrop> = all.iter().filter(|drop| drop.velocity[1] < -1.0).collect();
    assert!(falls.len() > 5, "{}", falls.len());
    let weight = std::f64::consts::TAU * 1.0e-3 * 0.072_736 * 0.72 / 9.806_65;
    let tate = drip::sphere_diameter(weight / 998.2);
    for drop in falls {
        assert!((f64::from(drop.diameter) / tate - 1.0).abs() < 0.03, "{} {tate}", drop.diameter);
    }
}

/// Time in which a drop falls from rest through a height, by small steps of the drag law.
fn integrated_fall(diameter: f64, height: f64) -> f64 {
    let terminal = terminal_speed(FallSpeedModel::Beard1976, diameter, &Air::standard()).unwrap();
    let (mut y, mut v, mut t, step) = (0.0, 0.0, 0.0, 1.0e-5);
    while y < height {
        let slope = |v: f64| 9.806_65 * (1.0 - v * v / (terminal * terminal));
        let middle = v + 0.5 * step * slope(v);
        v += step * slope(middle);
        y += step * middle;
        t += step;
    }
    t
}

#[test]
fn a_fall_from_three_meters_takes_its_time() {
    let bvh = Bvh::new(&floor());
    let set = SetDrip { position: DVec3::new(0.0, 3.0, 0.0), per_s: 2.0, diameter_m: 4.0e-3 };
    let drips = Drips::new(&obstacles(&bvh), &[], None, &[set], &options(still())).unwrap();
    let mut seen = 0;
    let expected = integrated_fall(4.0e-3, 3.0);
    for k in 0..40 {
        let time_s = 0.1 * f64::from(k);
        let drops = drips.visible(&obstacles(&bvh), &View { shutter_s: 0.0, ..view() }, 0.0, time_s).unwrap();
        for drop in drops.iter().filter(|drop| drop.velocity[1] < 0.0) {
            let [begin, end] = drop.present_s.map(f64::from);
            // From where it hung, 2 mm below the point.
            assert!((end - begin - expected).abs() < 3.0e-3, "{} {expected}", end - begin);
            assert_eq!(drop.kind, DropKind::Dripped);
            seen += 1;
        }
        // One hangs.
        assert_eq!(drops.iter().filter(|drop| drop.velocity == [0.0; 3]).count(), 1);
    }
    assert!(seen > 20, "{seen}");
}

/// A drop that lands makes the crown of its speed, in its place and time; one that falls too slowly makes none.
#[test]
fn a_drop_that_lands_splashes() {
    let bvh = Bvh::new(&floor());
    let high = SetDrip { position: DVec3::new(0.0, 3.0, 0.0), per_s: 2.0, diameter_m: 4.0e-3 };
    let low = SetDrip { position: DVec3::new(0.3, 0.3, 0.0), per_s: 9.0, diameter_m: 2.0e-3 };
    let drips = Drips::new(&obstacles(&bvh), &[], None, &[high, low], &options(still())).unwrap();
    let splashes = SplashOptions { law: SplashLaw::new(FILM_M, 20.0).unwrap(), size: 1.0 };
    let terminal = terminal_speed(FallSpeedModel::Beard1976, 4.0e-3, &Air::standard()).unwrap();
    let square = terminal * terminal;
    let speed = (square * (1.0 - ops::exp(-2.0 * 9.806_65 * 3.0 / square))).sqrt();
    let expected = splashes.law.splash(4.0e-3, speed).unwrap();
    let (step, steps) = (0.01, 1000);
    let (mut begins, mut shown) = (std::collections::BTreeMap::new(), 0);
    for k in 0..steps {
        let time_s = step * f64::from(k);
        for crown in drips.splashes(&obstacles(&bvh), &view(), time_s, &splashes).unwrap() {
            assert_eq!(crown.kind, DropKind::Splash);
            let [begin, end] = crown.present_s.map(f64::from);
            assert!(begin <= 0.0 && end > 0.0, "{begin} {end}");
            assert!(((end - begin) / expected.duration_s - 1.0).abs() < 0.01, "{} s", end - begin);
            let size = f64::from(crown.diameter) / (2.0 * expected.radius_m);
            assert!((0.74..1.26).contains(&size), "{size} of the law's size");
            assert!(crown.position.distance(DVec3::ZERO) < 0.02, "{}", crown.position);
            begins.insert(crown.id, time_s + begin);
            shown += 1;
        }
    }
    let (corner, opposite) = (DVec3::splat(-5.0), DVec3::splat(5.0));
    let span_s = [0.0, step * f64::from(steps - 1)];
    let impacts = drips.impacts(&obstacles(&bvh), corner, opposite, span_s, 3.0e-3).unwrap();
    assert!((18..=22).contains(&impacts.len()), "{}", impacts.len());
    for impact in &impacts {
        let is_its = |begin: &&f64| (**begin - impact.time_s).abs() < 1.0e-5;
        assert_eq!(begins.values().filter(is_its).count(), 1, "at {} s", impact.time_s);
    }
    // Each is seen for its duration.
    let mean = f64::from(shown) * step / impacts.len() as f64;
    assert!((mean / expected.duration_s - 1.0).abs() < 0.1, "{mean} s of {}", expected.duration_s);
}

/// A drop hangs until it falls, from the same place, and grows meanwhile.
#[test]
fn a_drop_hangs_and_grows_and_falls() {
    let bvh = Bvh::new(&floor());
    let set = SetDrip { position: DVec3::new(0.0, 2.0, 0.0), per_s: 1.0, diameter_m: 5.0e-3 };
    let drips = Drips::new(&obstacles(&bvh), &[], None, &[set], &options(still())).unwrap();
    let at = |time_s: f64| drips.visible(&obstacles(&bvh), &view(), 0.0, time_s).unwrap();
    let hanging =
        |drops: &[FallingDrop]| drops.iter().find(|drop| drop.velocity == [0.0; 3]).copied().unwrap();
    let first = hanging(&at(10.0));
    let [since, leaves] = first.present_s.map(|time| 10.0 + f64::from(time));
    assert!(since < 10.0 && leaves > 10.0 && (0.6..1.4).contains(&(leaves - since)), "{since} {leaves}");
    let mut last = 0.0;
    for k in 1..20 {
        let drop = hanging(&at(since + (leaves - since) * (f64::from(k) / 20.0)));
        assert!(drop.id == first.id && drop.diameter > last);
        last = drop.diameter;
    }
    let after = at(leaves + 0.02);
    let falling = after.iter().find(|drop| drop.id == first.id).unwrap();
    assert!((falling.position.y - first.position.y).abs() < 0.01, "{}", falling.position.y);
    assert!((f64::from(falling.velocity[1]) + 0.02 * 9.806_65).abs() < 0.01, "{:?}", falling.velocity);
    assert_ne!(hanging(&after).id, first.id);
}

/// Wind carries drops, no faster than itself; a wall stops them.
#[test]
fn drops_drift_and_end_at_walls() {
    let wall = block([0.5, 0.0, -2.0], [0.7, 5.0, 2.0]);
    let bvh = Bvh::new(&[wall, floor()].concat());
    let set = SetDrip { position: DVec3::new(0.0, 3.0, 0.0), per_s: 3.0, diameter_m: 4.0e-3 };
    let all = (DVec3::splat(-20.0), DVec3::splat(20.0));
    let ends = |wind: UniformWind| {
        let drips = Drips::new(&obstacles(&bvh), &[], None, &[set], &options(wind)).unwrap();
        drips.impacts(&obstacles(&bvh), all.0, all.1, [0.0, 10.0], 0.0).unwrap()
    };
    for gusts in [None, Some(Gusts::default())] {
        let slow = ends(uniform(1.0, gusts));
        assert!((28..=32).contains(&slow.len()), "{}", slow.len());
        for impact in &slow {
            let x = impact.position.x;
            assert!(impact.position.y.abs() < 2.0e-3 && (0.1..0.5).contains(&x), "{}", impact.position);
        }
        for impact in ends(uniform(12.0, gusts)) {
            assert!((impact.position.x - 0.5).abs() < 0.01 && impact.position.y > 0.5, "{}", impact.position);
            assert_eq!(impact.normal, Vec3::NEG_X);
        }
    }
    // Integration of both components in still and moving air by the law of each: a drop lags the wind by v / g.
    let x = ends(uniform(1.0, None))[0].position.x;
    let time = integrated_fall(4.0e-3, 3.0);
    let relaxes = terminal_speed(FallSpeedModel::Beard1976, 4.0e-3, &Air::standard()).unwrap() / 9.806_65;
    let expected = time - relaxes * (1.0 - ops::exp(-time / relaxes));
    assert!((x - expected).abs() < 5.0e-3, "{x} {expected}");
}

/// Regions, cameras, threads and the order of times have no say.
#[test]
fn drips_are_the_same_for_any_camera_and_thread_count() {
    let triangles = [plate(1.0, 1.5, 0.3, 0.5, 3.0), floor()].concat();
    let (bvh, found) = points(&triangles);
    let wide = DripRegion::new(DVec3::new(-7.3, 0.0, -5.1), DVec3::new(6.0, 9.0, 8.0)).unwrap();
    assert_eq!(DripPoints::find(&obstacles(&bvh), wide).unwrap().points, found.points);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let found = DripPoints::find(&obstacles(&bvh), region(4.0)).unwrap();
            let wind = uniform(2.0, Some(Gusts::default()));
            let drips =
                Drips::new(&obstacles(&bvh), &found.points, Some(&RAIN), &[], &options(wind)).unwrap();
            let at = |time_s: f64| drips.visible(&obstacles(&bvh), &view(), 0.1, time_s).unwrap();
            let clip: Vec<_> = (0..4).map(|k| at(2.0 + 0.25 * f64::from(k))).collect();
            // A time alone is that of the clip.
            assert_eq!(at(2.5), clip[2]);
            clip
        })
    };
    let clip = run(1);
    assert_eq!(clip, run(3));
    assert!(clip[0].len() > 50, "{}", clip[0].len());
    // Another camera sees the same drops.
    let drips = Drips::new(&obstacles(&bvh), &found.points, Some(&RAIN), &[], &options(still())).unwrap();
    let other = View { eye: DVec3::new(0.5, 2.2, 5.0), ..view() };
    let [a, b] = [view(), other].map(|view| drips.visible(&obstacles(&bvh), &view, 0.1, 7.0).unwrap());
    let shared = a.iter().filter(|drop| b.contains(drop)).count();
    assert!(shared > a.len() / 2, "{shared} of {}", a.len());
    for drop in &a {
        // A drop that leaves during the exposure is listed as it hangs and as it falls.
        let same = |other: &&FallingDrop| (other.id, other.present_s) == (drop.id, drop.present_s);
        assert!(b.iter().find(same).is_none_or(|other| other == drop), "{drop:?}");
    }
}

/// After the rain an edge drips more and more seldom.
#[test]
fn dripping_decays_after_rain() {
    let (bvh, found) = points(&[plate(1.0, 1.0, 0.3, 0.0, 3.0), floor()].concat());
    let rain = DripRain { end_s: 0.0, ..RAIN };
    let drips = Drips::new(&obstacles(&bvh), &found.points, Some(&rain), &[], &options(still())).unwrap();
    let (low, high) = (DVec3::splat(-20.0), DVec3::splat(20.0));
    let count = |begin: f64| {
        drips.impacts(&obstacles(&bvh), low, high, [begin, begin + 30.0], 0.0).unwrap().len() as f64
    };
    let before = count(-60.0);
    // 60 s for the film, and 10 s for the way of a meter.
    for minutes in 1..4 {
        let expected = before * ops::exp(-f64::from(minutes) * 60.0 / 70.0) * 70.0 / 30.0 * 0.348_6;
        let found = count(60.0 * f64::from(minutes));
        assert!((found / expected - 1.0).abs() < 0.15, "{minutes}: {found} {expected}");
    }
    assert_eq!(count(3600.0), 0.0);
}

#[test]
fn drips_without_room_are_left_out() {
    let bvh = Bvh::new(&[block([-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]), floor()].concat());
    let at = |y: f64| SetDrip { position: DVec3::new(0.0, y, 0.0), per_s: 1.0, diameter_m: 4.0e-3 };
    // On the roof, and above it.
    let drips = Drips::new(&obstacles(&bvh), &[], None, &[at(2.004), at(2.5)], &options(still())).unwrap();
    assert_eq!((drips.len(), drips.left_out_count()), (1, 1));
    // In the block: it falls to the inside of its bottom.
    let drips = Drips::new(&obstacles(&bvh), &[], None, &[at(1.0)], &options(still())).unwrap();
    let impacts =
        drips.impacts(&obstacles(&bvh), DVec3::splat(-5.0), DVec3::splat(5.0), [0.0, 3.0], 0.0).unwrap();
    assert!(impacts.iter().all(|impact| impact.position.y.abs() < 1.0e-3));
    // Without a scene drops fall for good.
    let nothing = Bvh::new(&[]);
    let drips = Drips::new(&obstacles(&nothing), &[], None, &[at(1.0)], &options(still())).unwrap();
    assert_eq!(drips.len(), 1);
    assert!(
        drips
            .impacts(&obstacles(&nothing), DVec3::splat(-5.0), DVec3::splat(5.0), [0.0, 3.0], 0.0)
            .unwrap()
            .is_empty()
    );
}

#[test]
fn queries_out_of_range_are_refused() {
    let nan = DVec3::new(f64::NAN, 0.0, 0.0);
    assert!(DripRegion::new(nan, DVec3::ONE).is_err());
    let found = DripRegion::new(DVec3::ZERO, DVec3::splat(100.0)).unwrap_err().to_string();
    assert!(found.contains("area of the region of drips is") && found.contains("up to 6400"), "{found}");
    let large =
        DripRegion::around(DVec3::splat(-500.0), DVec3::splat(500.0), DVec3::new(3.0, 1.0, 20.0)).unwrap();
    assert_eq!((large.first, large.cells), ([-640, -320], [1600, 1600]));
    assert_eq!(DripRegion::around(DVec3::ZERO, DVec3::ONE, nan).unwrap().cells, [21, 21]);
    let bvh = Bvh::new(&floor());
    let set = SetDrip { position: DVec3::Y, per_s: 1.0, diameter_m: 8.0e-3 };
    assert!(Drips::new(&obstacles(&bvh), &[], None, &[set], &options(still())).is_err());
    let drips = Drips::new(&obstacles(&bvh), &[], None, &[], &options(still())).unwrap();
    assert!(drips.is_empty());
    assert!(drips.visible(&obstacles(&bvh), &view(), 0.1, f64::NAN).is_err());
    assert!(drips.impacts(&obstacles(&bvh), DVec3::ZERO, DVec3::ONE, [0.0, 61.0], 0.0).is_err());
    let splashes = SplashOptions { law: SplashLaw::new(FILM_M, 20.0).unwrap(), size: 11.0 };
    assert!(drips.splashes(&obstacles(&bvh), &view(), 0.0, &splashes).is_err());
}
