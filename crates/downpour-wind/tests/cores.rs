//! Cores of line forms: radius and value of the maximum speed, and the speed inside.

mod common;

use std::f64::consts::TAU;

use common::{CENTER, CORE, STRENGTH, circulation, close, frame, singularity, wind};
use downpour_math::ops::f64::exp;
use downpour_wind::{WindCore, WindForm, WindPrimitive, WindSingularity};
use glam::DVec3;

const M: f64 = STRENGTH as f64;
const E: f64 = CORE as f64;

fn vortex(core: WindCore) -> WindPrimitive {
    WindPrimitive::Vortex(WindSingularity { core, ..singularity(WindForm::Line) })
}

/// Speed at a distance from the axis.
fn speed(primitive: WindPrimitive) -> impl Fn(f64) -> f64 {
    let side = frame(singularity(WindForm::Line).axis)[0];
    let field = wind(&[primitive]);
    move |r| field(CENTER.as_dvec3() + side * r).length()
}

/// Position and height of a peak, by ternary search.
fn peak(speed: impl Fn(f64) -> f64) -> (f64, f64) {
    let (mut low, mut high) = (0.2 * E, 4.0 * E);
    for _ in 0..60 {
        let third = (high - low) / 3.0;
        if speed(low + third) < speed(high - third) { low += third } else { high -= third }
    }
    (low, speed(low))
}

#[test]
fn peaks_are_where_the_laws_have_them() {
    let unit = M / (TAU * E);
    for (core, position, height) in [
        (WindCore::Rosenhead, 1.0, 0.5),
        (WindCore::Rankine, 1.0, 1.0),
        (WindCore::LambOseen, 1.12091, 0.63817),
    ] {
        for primitive in [
            vortex(core),
            WindPrimitive::Source(WindSingularity { core, ..singularity(WindForm::Line) }),
            WindPrimitive::Sink(WindSingularity { core, ..singularity(WindForm::Line) }),
        ] {
            let (at, found) = peak(speed(primitive));
            // f32 is flat over some thousandths about a smooth peak.
            close(at / E, position, 1.0, 4.0e-3, &format!("{core:?}: position"));
            close(found / unit, height, height, 1.0e-5, &format!("{core:?}: height"));
        }
    }
}

#[test]
fn inside_they_are_what_they_are_named_for() {
    let rankine = speed(vortex(WindCore::Rankine));
    let spread = speed(vortex(WindCore::LambOseen));
    for k in 1..200 {
        let r = f64::from(k) * 0.02 * E;
        // Solid rotation inside, unchanged outside.
        let solid = M / TAU * if r < E { r / (E * E) } else { 1.0 / r };
        close(rankine(r), solid, M / (TAU * E), 4.0e-6, &format!("Rankine at {r}"));
        let lamb = M / (TAU * r) * (1.0 - exp(-(r * r) / (E * E)));
        close(spread(r), lamb, M / (TAU * E), 4.0e-6, &format!("Lamb and Oseen at {r}"));
    }
    assert_eq!((rankine(0.0), spread(0.0)), (0.0, 0.0));
}

/// Outside the core all have the full circulation; Lamb and Oseen's ring at r holds 1 - exp(-r^2 / e^2) of it.
#[test]
fn the_circulation_is_whole_outside() {
    let axis = singularity(WindForm::Line).axis;
    for (core, r, fraction) in [
        (WindCore::Rankine, 0.5 * E, 0.25),
        (WindCore::Rankine, 2.0 * E, 1.0),
        (WindCore::LambOseen, E, 1.0 - exp(-1.0)),
        (WindCore::LambOseen, 5.0 * E, 1.0),
        (WindCore::Rosenhead, 5.0 * E, 25.0 / 26.0),
    ] {
        let field = wind(&[vortex(core)]);
        let found = circulation(&field, CENTER.as_dvec3(), axis, r);
        close(found, M * fraction, M, 1.0e-5, &format!("{core:?} at {r}"));
    }
    // Far away all cores agree.
    let far = CENTER.as_dvec3() + frame(axis)[0] * 400.0;
    let fields = WindCore::ALL.map(|core| wind(&[vortex(core)])(far));
    assert!(fields.iter().all(|v: &DVec3| v.distance(fields[0]) < 1.0e-5 * fields[0].length()), "{fields:?}");
}

#[test]
fn cores_have_names() {
    for core in WindCore::ALL {
        assert_eq!(WindCore::from_name(core.name()), Some(core));
    }
    assert_eq!(WindCore::from_name("Rankine"), None);
    assert_eq!(WindCore::default(), WindCore::Rosenhead);
}
