//! Clips do not loop: drops enter at new positions.

use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_sim::simulation::{SimVolume, Simulation, SimulationOptions, StepInput};
use downpour_sim::view::View;
use downpour_wind::{Turbulence, Wind, WindField, WindGrid, WindMask};
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;

fn rain(rate_mm_h: f64) -> DropSizeDistribution {
    DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, rate_mm_h).expect("in range")
}

fn view() -> View {
    View { eye: DVec3::new(0.0, 1.7, 0.0), pixel_angle: 2.0 * 0.4663 / 270.0, ..View::default() }
}

/// Turbulence of 0.5 m/s.
fn turbulent() -> WindField {
    let wind = Wind::new(Vec::new(), None, Some(Turbulence { speed: 0.5, ..Turbulence::default() }));
    let grid = WindGrid::new(Vec3::splat(-25.0), Vec3::splat(25.0), [32; 3]).expect("in range");
    wind.expect("in range").field(0.0, &grid, &WindMask::open(&grid)).expect("in range")
}

/// Coverage by drops of a picture of 48 x 27 parts.
fn coverage(simulation: &Simulation, view: &View) -> Vec<f64> {
    let mut picture = vec![0.0; 48 * 27];
    for drop in simulation.visible(view).drops {
        let offset = drop.position - view.eye;
        let depth = offset.dot(view.forward);
        let x = 0.5 + 0.5 * offset.dot(view.right) / (depth * view.half_width);
        let y = 0.5 + 0.5 * offset.dot(view.up) / (depth * view.half_height);
        if (0.0..1.0).contains(&x) && (0.0..1.0).contains(&y) {
            let angle = f64::from(drop.diameter) / offset.length();
            picture[(y * 27.0) as usize * 48 + (x * 48.0) as usize] += angle * angle;
        }
    }
    picture
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len() as f64;
    let (mean_a, mean_b) = (a.iter().sum::<f64>() / n, b.iter().sum::<f64>() / n);
    let sums = a.iter().zip(b).fold([0.0; 3], |[ab, aa, bb], (x, y)| {
        let (x, y) = (x - mean_a, y - mean_b);
        [ab + x * y, aa + x * x, bb + y * y]
    });
    sums[0] / (sums[1] * sums[2]).sqrt()
}

#[test]
fn frames_of_rain_in_turbulence_are_not_alike() {
    let (view, field) = (view(), turbulent());
    let now = StepInput { field: Some(&field), ..StepInput::new(&view, DVec3::ZERO, Vec3::ZERO) };
    let mut simulation =
        Simulation::new(&rain(100.0), &SimulationOptions::default(), &now).expect("in range");
    let mut frames = Vec::new();
    for _ in 0..36 {
        for _ in 0..2 {
            simulation.advance(1.0 / 48.0, &now).expect("in range");
        }
        frames.push(coverage(&simulation, &view));
    }
    for lag in 1..=8 {
        let pairs = frames.iter().zip(frames.iter().skip(lag));
        let (sum, count) = pairs.fold((0.0, 0.0), |(sum, n), (a, b)| (sum + correlation(a, b), n + 1.0));
        println!("{lag} frames apart: {:.3}", sum / count);
        assert!(sum / count < 0.05, "{lag} frames apart: {}", sum / count);
    }
}

/// A drop of a box re-enters in another column; boxes of all cameras agree.
#[test]
fn no_drop_of_a_box_keeps_its_column() {
    let size = 6.0;
    let options = SimulationOptions {
        volume: SimVolume::Box { size_m: [size; 3] },
        max_drops: 4000,
        ..SimulationOptions::default()
    };
    let views = [
        view(),
        View { eye: DVec3::new(2.5, 2.9, -1.0), forward: DVec3::X, right: DVec3::Z, ..view() },
        View { eye: DVec3::new(-1.0, 0.4, 14.0), pixel_angle: 1.0e-3, ..view() },
    ];
    let mut columns: BTreeMap<usize, Vec<Vec3>> = BTreeMap::new();
    let mut states = Vec::new();
    for (k, view) in views.iter().enumerate() {
        let now = StepInput::new(view, DVec3::ZERO, Vec3::new(1.0, 0.0, 0.5));
        let mut simulation = Simulation::new(&rain(20.0), &options, &now).expect("in range");
        for step in 0..240 {
            simulation.advance(1.0 / 60.0, &now).expect("in range");
            if k == 0 && step % 60 == 59 {
                for (number, drop) in simulation.drops().iter().enumerate() {
                    columns.entry(number).or_default().push(Vec3::from(drop.position));
                }
            }
        }
        states.push(simulation);
    }
    // Between the last two samples a drop falls through a box, and the wind carries it by 1 m and 0.5 m a second.
    let (mut same, mut fallen) = (0, 0);
    for positions in columns.values() {
        let (first, last) = (positions[0], positions[3]);
        let carried = first + Vec3::new(3.0, 0.0, 1.5);
        let away = (last - carried) / size as f32;
        let away = away - away.round();
        same += u32::from(away.x.abs() < 0.05 && away.z.abs() < 0.05);
        fallen += 1;
    }
    // By chance one in a hundred.
    assert!(f64::from(same) < 0.03 * f64::from(fallen), "{same} of {fallen} keep their column");
    // Drops in the common part of two boxes are in both.
    let within = |at: Vec3, view: &View| {
        let center = view.eye + view.forward * size / 3.0;
        ((at.as_dvec3() - center).abs().max_element()) < 0.5 * size - 0.05
    };
    for k in 1..3 {
        let held: Vec<Vec3> = states[k].drops().iter().map(|drop| Vec3::from(drop.position)).collect();
        let mut shared = 0;
        for (drop, other) in states[0].drops().iter().zip(&held) {
            let at = Vec3::from(drop.position);
            if within(at, &views[0]) && within(at, &views[k]) {
                assert!((at - *other).length() < 2.0e-3, "{at}, {other}");
                shared += 1;
            }
        }
        println!("{shared} drops are in the boxes 0 and {k}");
        assert!(k == 2 || shared > 100, "{shared}");
    }
}

/// A drop keeps its id from picture to picture, and no two drops share one.
#[test]
fn a_drop_keeps_its_number() {
    let (view, field) = (view(), turbulent());
    for volume in [SimVolume::View, SimVolume::Box { size_m: [4.0; 3] }] {
        let options = SimulationOptions { volume, max_drops: 50_000, ..SimulationOptions::default() };
        let now = StepInput { field: Some(&field), ..StepInput::new(&view, DVec3::ZERO, Vec3::ZERO) };
        let mut simulation = Simulation::new(&rain(50.0), &options, &now).expect("in range");
        let mut before: BTreeMap<u64, DVec3> = BTreeMap::new();
        let (mut kept, mut all): (_, BTreeMap<u64, (i32, DVec3)>) = (0, BTreeMap::new());
        for step in 0..90 {
            simulation.advance(1.0 / 60.0, &now).expect("in range");
            let seen = simulation.visible(&view).drops;
            let count = seen.len();
            let numbered: BTreeMap<u64, DVec3> = seen.iter().map(|drop| (drop.id, drop.position)).collect();
            assert_eq!(numbered.len(), count, "no two drops have one number");
            for drop in &seen {
                if let Some(&earlier) = before.get(&drop.id) {
                    // It has moved by its velocity, and has not re-entered.
                    let moved = drop.position - earlier - Vec3::from(drop.velocity).as_dvec3() / 60.0;
                    assert!(moved.length() < 0.02, "{moved}");
                    kept += 1;
                } else if let Some((last, position)) = all.get(&drop.id) {
                    // A gust has turned it back into the view.
                    let steps = f64::from(step - last);
                    let moved =
                        drop.position - *position - Vec3::from(drop.velocity).as_dvec3() * steps / 60.0;
                    assert!(moved.length() < 0.02 * steps * steps, "{moved} in {steps} steps");
                }
                all.insert(drop.id, (step, drop.position));
            }
            before = numbered;
        }
        assert!(kept > 500, "{kept}");
    }
}
