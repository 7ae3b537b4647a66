//! Crowns of splashes: their number, their positions, and that any time can be asked for.

use std::collections::BTreeMap;

use downpour_bvh::Bvh;
use downpour_drop::air::Air;
use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_drop::fall_speed::{FallSpeedModel, terminal_speed};
use downpour_drop::splash::{FILM_M, SplashLaw};
use downpour_sim::collision::{CollisionMap, CollisionOptions};
use downpour_sim::field::{DropKind, FallingDrop, RainField};
use downpour_sim::impacts::SplashOptions;
use downpour_sim::shelter::Obstacles;
use downpour_sim::simulation::{SimVolume, Simulation, SimulationOptions, StepInput};
use downpour_sim::view::View;
use glam::{DVec3, Vec3};

fn law() -> DropSizeDistribution {
    DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 50.0).expect("in range")
}

fn quad([a, b, c, d]: [[f32; 3]; 4]) -> [[[f32; 3]; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

fn at(height: f32, low: [f32; 2], high: [f32; 2]) -> [[[f32; 3]; 3]; 2] {
    quad([
        [low[0], height, low[1]],
        [low[0], height, high[1]],
        [high[0], height, high[1]],
        [high[0], height, low[1]],
    ])
}

/// Level ground, with a roof of 1 x 1 m over one corner of what the view shows.
fn yard() -> Bvh {
    Bvh::new(&[at(0.0, [-9.0, -9.0], [9.0, 9.0]), at(0.5, [0.0, 0.0], [1.0, 1.0])].concat())
}

/// From 3 m above the ground straight down on 2 x 2 m of it, by pixels of 0.5 mm.
fn view() -> View {
    View {
        eye: DVec3::new(0.0, 3.0, 0.0),
        right: DVec3::X,
        up: DVec3::NEG_Z,
        forward: DVec3::NEG_Y,
        half_width: 1.0 / 3.0,
        half_height: 1.0 / 3.0,
        pixel_angle: 0.5e-3 / 3.0,
        ..View::default()
    }
}

fn options() -> SplashOptions {
    SplashOptions { law: SplashLaw::new(FILM_M, 20.0).expect("a law"), size: 1.0 }
}

fn splashes(bvh: &Bvh, time_s: f64) -> Vec<FallingDrop> {
    let obstacles =
        Obstacles { nodes: &bvh.nodes, triangles: &bvh.triangles, holes: None, origin: DVec3::ZERO };
    let options = options();
    let rain = RainField::new(&law(), 5).expect("in range");
    rain.splashes(&obstacles, &view(), time_s, &options).expect("in range")
}

/// Expected number of crowns on a square meter: the flux of the drops that splash, times how long each of them lasts.
fn expected_per_m2() -> f64 {
    let speed = |d: f64| terminal_speed(FallSpeedModel::Beard1976, d, &Air::standard()).expect("a drop");
    // The Weber number is 400 at the least of them; twelve diameters over the speed are an eighth of the time, for the part of the energy that is
    // beyond the least one's. Some of the smallest are narrower than the least width on the picture, 0.75 mm: hardly any here.
    let weber = |d: f64| 998.2 * speed(d) * speed(d) * d / 0.0728;
    let least =
        (0..2000).map(|k| 1.0e-3 + 0.5e-6 * f64::from(k)).find(|&d| weber(d) > 400.0).expect("one splashes");
    let steps = 4000;
    (0..steps)
        .map(|k| {
            let d = least + (8.0e-3 - least) * (f64::from(k) + 0.5) / f64::from(steps);
            let lasts = 8.0 * 12.0 * (1.0 - 400.0 / weber(d)) * d / speed(d);
            law().concentration(d) * speed(d) * lasts * (8.0e-3 - least) / f64::from(steps)
        })
        .sum()
}

/// True on the ground, and neither near the roof nor at the edge of the picture: 1.9 x 1.9 m but for 1.0 x 1.0 m.
fn is_counted(p: DVec3) -> bool {
    p.x.abs() < 0.95 && p.z.abs() < 0.95 && (p.x < -0.05 || p.z < -0.05)
}

fn assert_as_many(found: usize, times: u32) {
    let expected = expected_per_m2() * f64::from(times) * (1.9 * 1.9 - 1.0);
    let apart = (found as f64 - expected) / expected.sqrt();
    println!("{found} crowns, expected {expected}");
    assert!(expected > 1000.0 && apart.abs() < 4.0, "{found} crowns, not {expected}");
}

#[test]
fn there_are_as_many_as_drops_that_hit() {
    let bvh = yard();
    let times = 40;
    let counted = |k: u32| {
        let crowns = splashes(&bvh, 1.0 + 0.5 * f64::from(k));
        crowns.iter().filter(|crown| is_counted(crown.position)).count()
    };
    assert_as_many((0..times).map(counted).sum(), times);
}

/// Rain step by step over the same yard, after some steps; the map is that of the yard.
fn stepped(volume: SimVolume, step_s: f64, map: &CollisionMap, steps: u32) -> Simulation {
    let view = View { least_pixels: 1.0, ..view() };
    let options =
        SimulationOptions { volume, wait_s: step_s, max_drops: 1 << 22, ..SimulationOptions::default() };
    let input = StepInput { map: Some(map), ..StepInput::new(&view, DVec3::ZERO, Vec3::ZERO) };
    let mut simulation = Simulation::new(&law(), &options, &input).expect("in range");
    for _ in 0..steps {
        simulation.advance(step_s, &input).expect("in range");
    }
    simulation
}

/// The crowns that a picture of stepped rain shows.
fn crowns(simulation: &Simulation, after_s: f64, map: &CollisionMap) -> Vec<FallingDrop> {
    let visible = simulation.visible_after(after_s, &view(), Some(map), Some(&options()));
    visible.drops.into_iter().filter(|drop| drop.kind == DropKind::Splash).collect()
}

fn map_of_yard() -> CollisionMap {
    let options = CollisionOptions { size: [18.0; 2], texels: [360; 2], ..CollisionOptions::default() };
    CollisionMap::new(&options, &yard()).expect("a map")
}

/// Drops that are simulated splash as often, in a view and in a box, whatever the step and wherever between steps the picture is.
#[test]
fn there_are_as_many_of_stepped_rain() {
    let map = map_of_yard();
    let size_m = [6.5; 3];
    for (volume, step_s, after_s) in [
        (SimVolume::View, 1.0 / 60.0, 0.0),
        (SimVolume::View, 1.0 / 60.0, 0.015),
        (SimVolume::View, 1.0 / 200.0, 0.002),
        (SimVolume::Box { size_m }, 1.0 / 30.0, 0.02),
    ] {
        let mut simulation = stepped(volume, step_s, &map, 20);
        let (view, times) = (View { least_pixels: 1.0, ..view() }, 12);
        let input = StepInput { map: Some(&map), ..StepInput::new(&view, DVec3::ZERO, Vec3::ZERO) };
        let mut counted = || {
            for _ in 0..(0.06 / step_s) as u32 {
                simulation.advance(step_s, &input).expect("in range");
            }
            crowns(&simulation, after_s, &map).iter().filter(|crown| is_counted(crown.position)).count()
        };
        assert_as_many((0..times).map(|_| counted()).sum(), times);
    }
}

/// A crown of stepped rain stays where it is and ages from picture to picture, whether a step has passed or not.
#[test]
fn a_crown_of_stepped_rain_is_the_same_from_picture_to_picture() {
    let (map, step_s) = (map_of_yard(), 1.0 / 60.0);
    let before = stepped(SimVolume::View, step_s, &map, 80);
    let after = stepped(SimVolume::View, step_s, &map, 81);
    let early: BTreeMap<u64, FallingDrop> = crowns(&before, 0.010, &map).iter().map(|c| (c.id, *c)).collect();
    // Within the step, exactly when it ends, and from its record; the drop's speed differs by the drag of a step.
    for (simulation, after_s, within) in
        [(&before, 0.014, 2.0e-6), (&before, step_s, 2.0e-6), (&after, 0.0, 1.0e-4), (&after, 0.012, 1.0e-4)]
    {
        let later_s = after_s - 0.010 + if std::ptr::eq(simulation, &after) { step_s } else { 0.0 };
        let (mut both, late) = (0, crowns(simulation, after_s, &map));
        for crown in &late {
            let Some(was) = early.get(&crown.id) else {
                assert!(f64::from(-crown.present_s[0]) < later_s + within, "{crown:?}");
                continue;
            };
            both += 1;
            let aged = f64::from(was.present_s[0] - crown.present_s[0]);
            assert!((aged - later_s).abs() < within, "{crown:?} {was:?}");
            assert!(crown.position.with_y(0.0).distance(was.position.with_y(0.0)) < 10.0 * within);
            assert_eq!(crown.diameter, was.diameter);
        }
        assert!(both > 20, "{both} of {}", late.len());
    }
}

/// Without splashes none is listed, nor are there any of drops that are not kept.
#[test]
fn stepped_rain_has_no_splashes_unless_they_are_kept() {
    let map = map_of_yard();
    let simulation = stepped(SimVolume::View, 1.0 / 60.0, &map, 60);
    let without = simulation.visible_after(0.01, &view(), Some(&map), None);
    assert!(without.drops.iter().all(|drop| drop.kind != DropKind::Splash));
    assert!(crowns(&simulation, 0.01, &map).iter().all(|crown| crown.position.y < 0.6));
}

#[test]
fn none_is_under_a_roof_and_all_are_on_a_surface() {
    let bvh = yard();
    let mut on_roof = 0;
    for k in 0..20 {
        for crown in splashes(&bvh, 3.0 + 0.7 * f64::from(k)) {
            let p = crown.position;
            assert_eq!(crown.kind, DropKind::Splash);
            let radius = f64::from(0.5 * crown.diameter);
            let is_above = p.x > 0.0 && p.x < 1.0 && p.z > 0.0 && p.z < 1.0;
            let foot = if is_above { 0.5 } else { 0.0 };
            on_roof += u32::from(is_above);
            assert!((0.0..0.5 * radius).contains(&(p.y - foot)), "{crown:?}");
            assert!((0.3e-3..0.05).contains(&radius), "{crown:?}");
        }
    }
    assert!(on_roof > 20, "{on_roof}");
}

/// A crown is the same whenever it is asked for: it stands in its place, and grows and ends as its age says.
#[test]
fn a_crown_is_the_same_at_all_times() {
    let bvh = yard();
    let (first, later_s) = (7.2, 4.0e-3);
    let before: BTreeMap<u64, FallingDrop> = splashes(&bvh, first).iter().map(|c| (c.id, *c)).collect();
    let after = splashes(&bvh, first + later_s);
    let mut both = 0;
    for crown in &after {
        let Some(was) = before.get(&crown.id) else {
            assert!(f64::from(-crown.present_s[0]) < later_s + 1.0e-6, "{crown:?}");
            continue;
        };
        both += 1;
        assert_eq!(crown.diameter, was.diameter);
        assert!(crown.position.with_y(0.0).distance(was.position.with_y(0.0)) < 1.0e-5);
        for (now, then) in crown.present_s.iter().zip(was.present_s) {
            assert!((f64::from(now - then) + later_s).abs() < 1.0e-6, "{crown:?} {was:?}");
        }
    }
    assert!(both > 20, "{both} of {}", after.len());
}

/// Crowns on a slope stand along its normal, as high above it as they do above level ground; drops that fall past a wall leave none.
#[test]
fn they_stand_along_the_normal() {
    let slope = quad([[-9.0, 9.0, -9.0], [-9.0, -9.0, 9.0], [9.0, -9.0, 9.0], [9.0, 9.0, -9.0]]);
    let crowns = splashes(&Bvh::new(&slope), 2.0);
    assert!(crowns.len() > 20, "{}", crowns.len());
    let half = 0.5f64.sqrt();
    for crown in &crowns {
        let normal = Vec3::from(crown.normal);
        assert!(normal.distance(Vec3::new(0.0, half as f32, half as f32)) < 1.0e-5, "{normal}");
        let above = (crown.position.y + crown.position.z) * half;
        let stage = f64::from(-crown.present_s[0] / (crown.present_s[1] - crown.present_s[0]));
        let middle = downpour_drop::splash::crown::middle(stage) * f64::from(crown.diameter) / 2.0;
        assert!((above - middle).abs() < 1.0e-5, "{above} m, {middle} m");
    }
    let wall = quad([[-9.0, 9.0, -3.0], [-9.0, -9.0, -3.0], [9.0, -9.0, -3.0], [9.0, 9.0, -3.0]]);
    assert!(splashes(&Bvh::new(&wall), 2.0).is_empty());
    assert!(splashes(&Bvh::new(&[]), 2.0).is_empty());
}
