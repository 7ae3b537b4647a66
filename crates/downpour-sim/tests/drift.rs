//! Rain in closed form in a wind, and behind obstacles.

use downpour_bvh::{Bvh, Hit};
use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_sim::field::{FallingDrop, RainField};
use downpour_sim::shelter::{Holes, Obstacles};
use downpour_sim::view::View;
use downpour_wind::{Gusts, Keyed, UniformWind, Wind, WindPart};
use glam::DVec3;

fn rain(rate_mm_h: f64) -> RainField {
    let law = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, rate_mm_h).expect("in range");
    RainField::new(&law, 3).expect("in range")
}

fn steady(velocity: DVec3) -> UniformWind {
    if velocity == DVec3::ZERO {
        return Wind::default().air().clone();
    }
    let part = WindPart::uniform(&Keyed::from(velocity.length()), &velocity.into()).expect("in range");
    Wind::new(vec![part], None, None).expect("in range").uniform().expect("in range")
}

fn gusty() -> UniformWind {
    let speed = Keyed::new(vec![(0.0, 3.0), (4.0, 9.0), (20.0, 6.0)]).expect("in range");
    let part = WindPart::uniform(&speed, &DVec3::new(1.0, 0.0, 0.4).into()).expect("in range");
    Wind::new(vec![part], Some(Gusts::default()), None).expect("in range").uniform().expect("in range")
}

fn by_id(mut drops: Vec<FallingDrop>) -> Vec<FallingDrop> {
    drops.sort_by_key(|drop| drop.id);
    drops
}

/// The velocity of each drop is the rate of change of its position.
#[test]
fn drops_move_at_their_velocity() {
    let rain = rain(20.0).with_wind(gusty());
    let (low, high) = (DVec3::new(-3.0, 0.0, -3.0), DVec3::new(3.0, 4.0, 3.0));
    for time in [2.0, 9.0, 5000.0] {
        let now = by_id(rain.in_box(low, high, time).expect("in range"));
        let then = by_id(rain.in_box(low - 0.1, high + 0.1, time + 1.0e-3).expect("in range"));
        assert!(now.len() > 5000);
        let mut slanted = 0;
        for drop in &now {
            let later = &then[then.binary_search_by_key(&drop.id, |d| d.id).expect("the same drop")];
            let moved = (later.position - drop.position) / 1.0e-3;
            let velocity = glam::Vec3::from(drop.velocity).as_dvec3();
            assert!((moved - velocity).length() < 0.02, "{moved}, {velocity}");
            slanted += u32::from(velocity.x > 1.0);
        }
        assert_eq!(slanted as usize, now.len());
    }
}

/// Wind displaces the rain and changes nothing else: as many drops, as much water, at any displacement.
#[test]
fn wind_keeps_the_rain() {
    let rain = rain(20.0).with_wind(steady(DVec3::new(8.0, 0.0, -3.0)));
    let size = DVec3::new(8.0, 5.0, 8.0);
    for (low, time) in [(DVec3::ZERO, 0.0), (DVec3::new(70.0, 3.0, -9.0), 40.0), (DVec3::ZERO, 1.0e5)] {
        let drops = rain.in_box(low, low + size, time).expect("in range");
        let expected = rain.number_density() * size.element_product();
        assert!(
            (drops.len() as f64 - expected).abs() < 5.0 * expected.sqrt(),
            "{} of {expected}",
            drops.len()
        );
        let mut counts = [0.0; 64];
        for drop in &drops {
            let [x, y, z] = ((drop.position - low) / size * 4.0).floor().to_array();
            counts[x as usize * 16 + y as usize * 4 + z as usize] += 1.0;
        }
        let mean = drops.len() as f64 / 64.0;
        let chi: f64 = counts.iter().map(|n| (n - mean) * (n - mean) / mean).sum();
        // 63 degrees of freedom; 5 standard deviations.
        assert!(chi < 63.0 + 5.0 * (126.0f64).sqrt(), "{chi}");
        let rate = rain.measured_rate_mm_h(low, time).expect("in range");
        assert!((rate - 20.0).abs() < 1.0, "{rate}");
    }
}

/// A camera sees the drops of the box, in wind as well.
#[test]
fn a_camera_sees_the_drops_of_the_box() {
    let rain = rain(20.0).with_wind(gusty());
    let view = View { eye: DVec3::new(3.0, 2.0, 1.0), least_pixels: 0.5, far: 3.0, ..View::default() };
    let seen = by_id(rain.visible(&view, 12.3).expect("in range").drops);
    let all = rain.in_box(view.eye - 3.1, view.eye + 3.1, 12.3).expect("in range");
    let expected = by_id(
        all.into_iter()
            .filter(|drop| {
                let offset = drop.position - view.eye;
                let depth = offset.dot(view.forward);
                let d = f64::from(drop.diameter);
                let within = |along: f64, half: f64| {
                    (along.abs() - depth * half) / (1.0 + half * half).sqrt() <= 0.6 * d && depth > -0.6 * d
                };
                let range = (d / (view.pixel_angle * 0.5)).min(3.0);
                (view.near..=range).contains(&offset.length())
                    && within(offset.dot(view.right), view.half_width)
                    && within(offset.dot(view.up), view.half_height)
            })
            .collect(),
    );
    assert!(expected.len() > 300, "{}", expected.len());
    assert_eq!(seen, expected);
}

/// A roof of 4 x 4 m, 3 m above the ground.
fn roof() -> Bvh {
    let [a, b, c, d] = [[-2.0, 3.0, -6.0], [2.0, 3.0, -6.0], [2.0, 3.0, -2.0], [-2.0, 3.0, -2.0]];
    Bvh::new(&[[a, b, c], [a, c, d]])
}

fn below_the_roof(wind: UniformWind, time: f64) -> [Vec<FallingDrop>; 2] {
    below(wind, time, None)
}

fn below(wind: UniformWind, time: f64, holes: Option<&dyn Holes>) -> [Vec<FallingDrop>; 2] {
    let rain = rain(50.0).with_wind(wind);
    let bvh = roof();
    let obstacles = Obstacles { nodes: &bvh.nodes, triangles: &bvh.triangles, holes, origin: DVec3::ZERO };
    let view = View { eye: DVec3::new(0.0, 1.5, 3.0), far: 12.0, ..View::default() };
    let all = rain.visible(&view, time).expect("in range").drops;
    let open = rain.visible_among(&obstacles, &view, time).expect("in range").drops;
    [all, open]
}

/// In a steady wind the rain shadow of the roof is slanted by each drop's fall, and exact.
#[test]
fn a_roof_keeps_off_the_rain() {
    for wind in [DVec3::ZERO, DVec3::new(3.0, 0.0, 0.0)] {
        let [all, open] = below_the_roof(steady(wind), 7.0);
        let open_ids: std::collections::BTreeSet<u64> = open.iter().map(|drop| drop.id).collect();
        let mut kept_off = 0;
        for drop in &all {
            let velocity = glam::Vec3::from(drop.velocity).as_dvec3();
            let rise = (3.0 - drop.position.y) / -velocity.y;
            let through = drop.position - velocity * rise;
            let margin = (through.x.abs() - 2.0).max((through.z + 4.0).abs() - 2.0);
            if margin.abs() < 1.0e-4 || rise.abs() < 1.0e-4 {
                continue;
            }
            let expected = rise < 0.0 || margin > 0.0;
            assert_eq!(open_ids.contains(&drop.id), expected, "{drop:?}");
            kept_off += u32::from(!expected);
        }
        assert!(kept_off > 200, "{kept_off} of {}", all.len());
    }
}

/// A roof without its first triangle (x - z > 4 of its square).
#[derive(Debug)]
struct Half;

impl Holes for Half {
    fn is_hole(&self, hit: &Hit) -> bool {
        hit.triangle == 0
    }
}

/// Rain falls through the hole of a roof, and not through the rest of it.
#[test]
fn rain_falls_through_holes() {
    let [all, open] = below(steady(DVec3::ZERO), 7.0, Some(&Half));
    let open_ids: std::collections::BTreeSet<u64> = open.iter().map(|drop| drop.id).collect();
    let (mut through, mut kept_off) = (0, 0);
    for drop in &all {
        let [x, y, z] = drop.position.to_array();
        // The diagonal from (-2, -6) to (2, -2) separates the triangles.
        if y >= 3.0 || x.abs() >= 2.0 || (z + 4.0).abs() >= 2.0 || (x - (z + 4.0)).abs() < 1.0e-4 {
            continue;
        }
        let hole = x > z + 4.0;
        assert_eq!(open_ids.contains(&drop.id), hole, "{drop:?}");
        through += u32::from(hole);
        kept_off += u32::from(!hole);
    }
    assert!(through > 100 && kept_off > 100, "{through}, {kept_off}");
}

/// In gusts a stopped drop stays away, and any other stays: nothing appears or vanishes in mid-air.
#[test]
fn drops_do_not_come_and_go() {
    let ids = |time: f64| -> std::collections::BTreeMap<u64, FallingDrop> {
        let [_, open] = below_the_roof(gusty(), time);
        open.into_iter().map(|drop| (drop.id, drop)).collect()
    };
    let mut before = ids(6.0);
    let (mut born, mut passed) = (0, 0);
    for frame in 1..8 {
        let time = 6.0 + f64::from(frame) / 60.0;
        let [all, _] = below_the_roof(gusty(), time);
        let now = ids(time);
        let seen_before = {
            let [all, _] = below_the_roof(gusty(), time - 1.0 / 60.0);
            all.into_iter().map(|drop| drop.id).collect::<std::collections::BTreeSet<_>>()
        };
        for drop in &all {
            if seen_before.contains(&drop.id) {
                passed += 1;
                // In view in both, existing now and not before.
                born += u32::from(now.contains_key(&drop.id) && !before.contains_key(&drop.id));
            }
        }
        before = now;
    }
    assert!(passed > 5000, "{passed}");
    assert!(born <= passed / 5000, "{born} of {passed} appeared in mid-air");
}
