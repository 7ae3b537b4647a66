//! Amounts of light of lookups in the project's atlas: against rays traced at the exact direction of the light, and in small
//! steps as a drop moves or grows; and the difference between the light of an oscillating drop and that of a sphere.
//!
//! `cargo test -p downpour-atlas --test amount -- --nocapture` prints the figures.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;
use std::sync::LazyLock;

use downpour_atlas::lookup::AtlasSlot;
use downpour_atlas::{StreakAtlas, StreakOptions, StreakOscillation, StreakParticle, StreakTracer};
use downpour_drop::optics::{SphereScattering, WATER_INDEX};
use downpour_math::ops::f64 as ops;
use downpour_math::rng::{rng_draw, rng_unit};
use rayon::prelude::*;

static ATLAS: LazyLock<StreakAtlas> = LazyLock::new(|| {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/streaks");
    StreakAtlas::load(&folder).unwrap()
});

const VIEW: [f32; 3] = [0.0, 0.0, 1.0];
const OSCILLATIONS: usize = StreakOscillation::COMMITTED.len();

/// Lights every 5 degrees from straight behind the drop: to the right of it, above it and aslant. The angle in degrees, and the
/// direction in the frame of the streak.
fn lights() -> Vec<(f64, [f64; 3])> {
    let of_rise = |up: f64| {
        (1..36).map(move |k| {
            let angle = 5.0 * f64::from(k);
            let (away, along) = (ops::sin(angle.to_radians()), ops::cos(angle.to_radians()));
            (angle, [away * (1.0 - up * up).sqrt(), away * up, -along])
        })
    };
    [0.0, 1.0, 0.6].into_iter().flat_map(of_rise).collect()
}

/// Axis of the drop in the frame of a viewer `degrees` above the drop.
fn axis(degrees: f64) -> [f32; 3] {
    let angle = degrees.to_radians();
    [0.0, ops::cos(angle) as f32, ops::sin(angle) as f32]
}

/// Index of the oscillation of an atlas position.
fn oscillation(slot: &AtlasSlot) -> usize {
    let [_, oscillations, elevations, directions] = ATLAS.data().frame.counts;
    (slot.layers[0] / (elevations * directions) % oscillations) as usize
}

/// The first drop of each oscillation.
static IDS: LazyLock<Vec<u32>> = LazyLock::new(|| {
    let of = |id| {
        let drop = StreakParticle { diameter: 1.0e-3, axis: axis(0.0), id };
        oscillation(&ATLAS.slot(&drop, VIEW, VIEW))
    };
    (0..OSCILLATIONS).map(|k| (0..).find(|&id| of(id) == k).unwrap()).collect()
});

/// Streak of a drop of one of the oscillations, seen from `degrees` above.
fn slot(millimeters: f64, oscillation: usize, degrees: f64, light: [f64; 3]) -> AtlasSlot {
    let drop =
        StreakParticle { diameter: (millimeters * 1.0e-3) as f32, axis: axis(degrees), id: IDS[oscillation] };
    ATLAS.slot(&drop, light.map(|c| c as f32), VIEW)
}

/// Mean over three layers of their amounts: the amount that is interpolated between 41 directions.
fn of_triangle(slot: &AtlasSlot) -> f64 {
    let amounts = ATLAS.data().amounts;
    let means = &amounts[amounts.len() - ATLAS.layers()..];
    (0..3).map(|k| f64::from(slot.weights[k] * means[slot.layers[k] as usize])).sum()
}

/// Amounts of the lights by rays, with other numbers of rows and of rays than the atlas has.
fn traced(millimeters: f64, oscillation: &StreakOscillation, degrees: f64) -> Vec<f64> {
    let options = StreakOptions { rows: 16, rays: 4, ..StreakOptions::default() };
    let tracer = StreakTracer::new(millimeters * 1.0e-3, oscillation, &options).unwrap();
    let lights: Vec<[f64; 3]> = lights().into_iter().map(|(_, light)| light).collect();
    tracer.amounts(degrees.to_radians(), &lights).unwrap()
}

/// Ratios of amounts.
#[derive(Debug)]
struct Ratios {
    least: f64,
    most: f64,
    /// Root of the mean square of the ratio less 1.
    rms: f64,
    /// Fraction of the ratios within 10 % of 1.
    close: f64,
}

fn ratios(all: &[f64]) -> Ratios {
    let count = all.len() as f64;
    Ratios {
        least: all.iter().copied().fold(f64::MAX, f64::min),
        most: all.iter().copied().fold(0.0, f64::max),
        rms: (all.iter().map(|r| (r - 1.0) * (r - 1.0)).sum::<f64>() / count).sqrt(),
        close: all.iter().filter(|r| (1.0 / 1.1..=1.1).contains(*r)).count() as f64 / count,
    }
}

/// Looked-up amounts over traced ones, 20 to 175 degrees: of the mean over the oscillations, of each oscillation, and of the mean by
/// triangles.
fn compared(millimeters: f64, degrees: f64) -> [Ratios; 3] {
    let all: Vec<Vec<f64>> =
        StreakOscillation::COMMITTED.par_iter().map(|kind| traced(millimeters, kind, degrees)).collect();
    let (mut means, mut each, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for (n, (angle, light)) in lights().iter().enumerate().filter(|(_, (angle, _))| *angle >= 20.0) {
        let slots: Vec<AtlasSlot> =
            (0..OSCILLATIONS).map(|k| slot(millimeters, k, degrees, *light)).collect();
        let whole: f64 = all.iter().map(|of| of[n]).sum();
        assert!(whole > 0.0, "{angle}");
        means.push(slots.iter().map(|slot| f64::from(slot.amount)).sum::<f64>() / whole);
        triangles.push(slots.iter().map(of_triangle).sum::<f64>() / whole);
        each.extend(slots.iter().zip(&all).map(|(slot, of)| f64::from(slot.amount) / of[n]));
    }
    let found = [ratios(&means), ratios(&each), ratios(&triangles)];
    println!(
        "{millimeters} mm, {degrees} degrees: mean {:.2?}, each {:.2?}, by triangles {:.2?}",
        found[0], found[1], found[2]
    );
    found
}

/// At diameters of the atlas, and at elevations between those of its grids. The mean over the oscillations is within 10 % for nine
/// directions of ten; where light falls from a bow into the dark band beside it, linear interpolation is up to 1.8 times too bright.
/// The mean of three layers, as in patterns, is far from this: a negative control.
#[test]
fn looked_up_amounts_are_those_of_rays() {
    for millimeters in [1.0, 4.0] {
        for degrees in [-40.0, -20.0, 0.0, 20.0, 40.0] {
            let [mean, each, triangles] = compared(millimeters, degrees);
            let about = format!("{millimeters} mm, {degrees} degrees: {mean:?} {each:?} {triangles:?}");
            assert!(mean.close > 0.75 && mean.rms < 0.15 && mean.least > 0.7 && mean.most < 1.9, "{about}");
            assert!(each.close > 0.6 && each.rms < 0.6 && each.least > 0.6, "{about}");
            assert!(triangles.close < 0.5 && triangles.rms > 0.5, "{about}");
        }
    }
}

/// Midway between two diameters of the atlas.
#[test]
fn amounts_between_diameters_are_near_those_of_rays() {
    for millimeters in [1.41, 2.37, 3.35] {
        for degrees in [-20.0, 0.0, 20.0] {
            let [mean, each, triangles] = compared(millimeters, degrees);
            let about = format!("{millimeters} mm, {degrees} degrees: {mean:?} {each:?} {triangles:?}");
            assert!(mean.close > 0.7 && mean.rms < 0.25 && mean.least > 0.55 && mean.most < 2.4, "{about}");
            assert!(each.close > 0.6 && each.rms < 0.8, "{about}");
        }
    }
}

/// The amount of a streak is 4 h m / pi of the mean m of its texels, by the law and not by the same sums.
#[test]
fn amounts_are_means_of_streaks() {
    let options = StreakOptions { columns: 12, rows: 6, rays: 2, ..StreakOptions::default() };
    let tracer = StreakTracer::new(2.0e-3, &StreakOscillation::COMMITTED[1], &options).unwrap();
    let lights: Vec<[f64; 3]> = lights().into_iter().map(|(_, light)| light).collect();
    for elevation in [-0.4, 0.0, 1.2] {
        let amounts = tracer.amounts(elevation, &lights).unwrap();
        let streaks = tracer.trace(elevation, &lights).unwrap();
        for (amount, radiance) in amounts.iter().zip(&streaks.radiance) {
            let mean = radiance.iter().map(|&v| f64::from(v)).sum::<f64>() / radiance.len() as f64;
            let wanted = 4.0 * options.half_extent / std::f64::consts::PI * mean;
            assert!((amount - wanted).abs() <= 1.0e-6 * wanted, "{elevation}: {amount} for {wanted}");
        }
    }
    assert!(tracer.amounts(1.5, &lights).unwrap_err().to_string().contains("-80 to 80"));
}

/// For any mixture, the pattern of a streak conserves light: the mean of the looked-up values is the amount.
#[test]
fn a_pattern_leaves_the_amount_as_it_is() {
    let frame = ATLAS.data().frame;
    let [columns, rows] = frame.size;
    for k in 0..200 {
        let units = |which| rng_draw([6, 1], k, which, 0).map(rng_unit);
        let [a, b, c, d] = units(0);
        let axis = [0.0, (1.0 - (a - 0.5) * (a - 0.5)).sqrt(), a - 0.5];
        let drop = StreakParticle { diameter: 0.5e-3 + 5.0e-3 * b, axis, id: k };
        let (z, x) = (2.0 * c - 1.0, 2.0 * d - 1.0);
        let light = [x * (1.0 - z * z).sqrt(), (1.0 - x * x).sqrt() * (1.0 - z * z).sqrt(), z];
        let slot = ATLAS.slot(&drop, light, VIEW);
        let mut sum = 0.0;
        for column in 0..columns {
            let across = ((column as f32 + 0.5) / columns as f32 * 2.0 - 1.0) * frame.half_extent;
            for row in 0..rows {
                sum += ATLAS.radiance(&slot, across, (row as f32 + 0.5) / rows as f32);
            }
        }
        let found = 4.0 * frame.half_extent / std::f32::consts::PI * sum / (columns * rows) as f32;
        assert!((found / slot.amount - 1.0).abs() < 2.0e-3, "{k}: {found} for {}", slot.amount);
    }
}

/// Largest change of an amount, and of a texel over the amount, from one of these positions to the next, each over the larger of the two.
fn largest_step(slots: impl Iterator<Item = AtlasSlot>) -> [f32; 2] {
    let mut before: Option<[f32; 2]> = None;
    let mut largest = [0.0f32; 2];
    for slot in slots {
        let now = [slot.amount, ATLAS.radiance(&slot, 0.2, 0.3) / slot.amount];
        if let Some(before) = before {
            let step = (now[0] - before[0]).abs() / now[0].max(before[0]);
            largest = [largest[0].max(step), largest[1].max((now[1] - before[1]).abs())];
        }
        before = Some(now);
    }
    largest
}

/// A drop that rises past the viewer, or grows, changes its light by small steps: no pop at the next elevation or diameter of the
/// atlas.
#[test]
fn light_changes_by_small_steps() {
    for k in 0..OSCILLATIONS {
        for (angle, light) in lights().into_iter().filter(|(angle, _)| *angle >= 20.0) {
            // Elevations in steps of 0.005 degrees, about the layers', the middles between them, and the highest of all.
            for from in [-41.0, -21.0, -1.0, 19.0, 39.0, 73.0] {
                let rising = (0..400).map(|n| slot(2.0, k, from + 0.005 * f64::from(n), light));
                let [amount, pattern] = largest_step(rising);
                assert!(amount < 0.05 && pattern < 0.05, "{angle}, {from} degrees: {amount} {pattern}");
            }
            // Diameters in steps of 0.1 %, 0.9 to 4.4 mm.
            let growing = (0..1600).map(|n| slot(0.9 * ops::exp(0.001 * f64::from(n)), k, 10.0, light));
            let [amount, pattern] = largest_step(growing);
            assert!(amount < 0.05 && pattern < 0.05, "{angle}: {amount} {pattern}");
        }
    }
}

/// A drop at rest has the light of a sphere, by the table of its orders; one that oscillates sends more of it to its sides, less
/// above, and no bow of the sphere stays in position. Figures of this test are in the documentation of `atlas`.
#[test]
fn oscillation_takes_light_aside() {
    const ENTRIES: usize = 4096;
    // The atlas' light is about as wide as a disk of 4.6 degrees radius.
    let sphere = SphereScattering::new(WATER_INDEX, ENTRIES, 0.16).unwrap();
    let phase = |degrees: f64| -> f64 {
        let entry = (degrees / 180.0 * (ENTRIES as f64 - 1.0)).round() as usize;
        sphere.paths().iter().map(|path| path.phase[entry]).sum()
    };
    let rest = traced(0.3, &StreakOscillation::NONE, 0.0);
    let mean = |millimeters: f64| -> Vec<f64> {
        let all: Vec<Vec<f64>> =
            StreakOscillation::COMMITTED.par_iter().map(|kind| traced(millimeters, kind, 0.0)).collect();
        (0..rest.len()).map(|n| all.iter().map(|of| of[n]).sum::<f64>() / all.len() as f64).collect()
    };
    let drops = [1.0, 2.0, 4.0].map(mean);
    let lights = lights();
    for (first, name) in [(0, "aside"), (35, "above"), (70, "aslant")] {
        for (n, (angle, _)) in lights.iter().enumerate().skip(first).take(35) {
            let [a, b, c] = [0, 1, 2].map(|k| drops[k][n] / phase(*angle));
            let still = rest[n] / phase(*angle);
            println!(
                "{name} {angle} degrees: at rest {still:.2}, oscillating {a:.2} {b:.2} {c:.2} of a sphere's"
            );
            if (20.0..=60.0).contains(angle) {
                assert!((still - 1.0).abs() < 0.1, "{name} {angle}: {still}");
            }
            if name == "aside" && (40.0..=95.0).contains(angle) {
                assert!((1.2..2.6).contains(&a) && (1.2..2.6).contains(&b), "{angle}: {a} {b}");
            }
            if name == "above" && (45.0..=65.0).contains(angle) {
                assert!((0.3..0.9).contains(&a) && (0.3..0.9).contains(&c), "{angle}: {a} {c}");
            }
        }
    }
}
