//! Sources, sinks and vortices against theory: flow, circulation, speeds, cores.

mod common;

use std::f64::consts::{PI, TAU};

use common::{
    CENTER, CORE, STRENGTH, circulation, close, flux_cylinder, flux_sphere, frame, singularity, wind,
};
use downpour_math::ops::f64::hypot;
use downpour_wind::{WindForm, WindPrimitive, WindSingularity, WindUniform};
use glam::{DVec3, Vec3};

const M: f64 = STRENGTH as f64;
const E: f64 = CORE as f64;

fn axis() -> Vec3 {
    singularity(WindForm::Line).axis
}

/// The core holds back a fraction of the flow outside a radius; far away the flow is complete.
#[test]
fn a_source_lets_out_its_strength() {
    let point = wind(&[WindPrimitive::Source(singularity(WindForm::Point))]);
    let line = wind(&[WindPrimitive::Source(singularity(WindForm::Line))]);
    for radius in [0.25, 0.5, 1.0, 3.0, 10.0, 50.0] {
        let outside = 1.0 + E * E / (radius * radius);
        let flux = flux_sphere(&point, CENTER.as_dvec3(), radius);
        close(flux, M / (outside * outside.sqrt()), M, 1.0e-5, "point source");
        assert!(
            flux <= M * 1.00001 && flux >= M * (1.0 - 1.5 * E * E / (radius * radius)) - 1.0e-4,
            "{flux}"
        );
        let flux = flux_cylinder(&line, CENTER.as_dvec3(), axis(), radius);
        close(flux, M / outside, M, 1.0e-5, "line source");
    }
    // The surface need not be centered.
    let flux = flux_sphere(&point, DVec3::new(4.0, 0.0, 1.0), 30.0);
    close(flux, M, M, 1.0e-3, "a sphere around an off-center source");
}

#[test]
fn a_sink_takes_in_its_strength() {
    for form in [WindForm::Line, WindForm::Point] {
        let source = wind(&[WindPrimitive::Source(singularity(form))]);
        let sink = wind(&[WindPrimitive::Sink(singularity(form))]);
        for at in [DVec3::new(2.0, 2.0, 2.0), DVec3::new(-7.0, 0.1, 3.0)] {
            assert_eq!(sink(at), -source(at), "{form:?}");
            assert!(sink(at).length() > 0.01);
        }
    }
}

/// There is no divergence away from the source, except for the known tail of the core.
#[test]
fn elsewhere_there_is_no_divergence() {
    let elsewhere = CENTER.as_dvec3() + frame(axis())[0] * 30.0;
    const R4: f64 = 30.0 * 30.0 * 30.0 * 30.0;
    let volume = 4.0 / 3.0 * PI * 8.0;
    let cases = [
        // Density of divergence 30 m away from the point or line, times the volume of a sphere of 2 m.
        (WindPrimitive::Source(singularity(WindForm::Point)), M * 3.0 * E * E / (4.0 * PI * R4 * 30.0)),
        (WindPrimitive::Source(singularity(WindForm::Line)), M * E * E / (PI * R4)),
        (WindPrimitive::Vortex(singularity(WindForm::Line)), 0.0),
        (WindPrimitive::Vortex(singularity(WindForm::Point)), 0.0),
    ];
    for (primitive, density) in cases {
        let field = wind(&[primitive]);
        let flux = flux_sphere(&field, elsewhere, 2.0);
        let passing = field(elsewhere).length() * PI * 4.0;
        assert!(passing > 0.03);
        close(flux, density * volume, passing, 2.0e-5, &format!("{primitive:?}"));
    }
    // A vortex has none in its core either.
    for form in [WindForm::Line, WindForm::Point] {
        let field = wind(&[WindPrimitive::Vortex(singularity(form))]);
        close(flux_sphere(&field, CENTER.as_dvec3() + 0.2, 0.6), 0.0, M, 1.0e-5, "vortex");
    }
}

#[test]
fn a_vortex_has_its_circulation() {
    let line = wind(&[WindPrimitive::Vortex(singularity(WindForm::Line))]);
    let point = wind(&[WindPrimitive::Vortex(singularity(WindForm::Point))]);
    for radius in [0.25, 0.5, 1.0, 3.0, 10.0, 50.0] {
        let outside = 1.0 + E * E / (radius * radius);
        close(circulation(&line, CENTER.as_dvec3(), axis(), radius), M / outside, M, 1.0e-5, "line vortex");
        // About its own plane: strength / (2 r).
        let wanted = M / (2.0 * radius * outside * outside.sqrt());
        close(circulation(&point, CENTER.as_dvec3(), axis(), radius), wanted, wanted, 1.0e-5, "point vortex");
    }
    // The same at any height, and 0 along a ring that does not enclose the axis.
    let high = CENTER.as_dvec3() + frame(axis())[2] * 17.0;
    close(circulation(&line, high, axis(), 20.0), M, M, 1.0e-3, "line vortex, high");
    let beside = CENTER.as_dvec3() + frame(axis())[0] * 30.0;
    close(circulation(&line, beside, axis(), 5.0), 0.0, M, 1.0e-4, "beside the vortex");
    // Sources have none.
    let source = wind(&[WindPrimitive::Source(singularity(WindForm::Line))]);
    close(circulation(&source, CENTER.as_dvec3() + 0.1, axis(), 1.0), 0.0, M, 1.0e-5, "source");
}

/// The printed formulas, where the core is negligible: to e^2 / r^2 and 1.5 e^2 / r^2, from below.
#[test]
fn far_from_the_core_the_printed_formulas_hold() {
    let [u, v, w] = frame(axis());
    let center = CENTER.as_dvec3();
    let line = wind(&[WindPrimitive::Source(singularity(WindForm::Line))]);
    let point = wind(&[WindPrimitive::Source(singularity(WindForm::Point))]);
    let vortex = wind(&[WindPrimitive::Vortex(singularity(WindForm::Line))]);
    let turning = wind(&[WindPrimitive::Vortex(singularity(WindForm::Point))]);
    for r in [1.0, 2.0, 8.0, 32.0] {
        let at = center + u * r + w * 1.5;
        let bound = E * E / (r * r) + 1.0e-5;
        let (ideal_line, ideal_point) = (M / (TAU * r), M / (4.0 * PI * r * r));
        for (what, found, ideal, bound) in [
            ("line source", line(at).dot(u), ideal_line, bound),
            ("line vortex", vortex(at).dot(v), ideal_line, bound),
            ("point source", point(center + u * r).dot(u), ideal_point, 1.5 * bound),
            ("point source along the axis", point(center - w * r).dot(-w), ideal_point, 1.5 * bound),
            ("point vortex", turning(center + u * r).dot(v), ideal_point, 1.5 * bound),
        ] {
            close(found, ideal, ideal, bound, what);
            assert!(found <= ideal * 1.00001, "{what} at {r}: {found} over {ideal}");
        }
        // Nothing in the other directions.
        close(hypot(line(at).dot(v), line(at).dot(w)), 0.0, ideal_line, 1.0e-5, "line source aside");
        close(hypot(vortex(at).dot(u), vortex(at).dot(w)), 0.0, ideal_line, 1.0e-5, "line vortex aside");
        close(turning(center + w * r).length(), 0.0, ideal_point, 1.0e-5, "point vortex on its axis");
    }
}

/// Finite at the center, with the maximum of the core's formula.
#[test]
fn cores_bound_the_speed() {
    let [u, _, _] = frame(axis());
    let line_peak = M / (4.0 * PI * E);
    let point_peak = M / (4.0 * PI * E * E) * (2.0 / (3.0 * 3.0_f64.sqrt()));
    let vortex = |form| WindPrimitive::Vortex(singularity(form));
    let source = |form| WindPrimitive::Source(singularity(form));
    for (primitive, peak, position) in [
        (source(WindForm::Line), line_peak, E),
        (vortex(WindForm::Line), line_peak, E),
        (source(WindForm::Point), point_peak, E / 2.0_f64.sqrt()),
        (vortex(WindForm::Point), point_peak, E / 2.0_f64.sqrt()),
    ] {
        let field = wind(&[primitive]);
        let speed = |r: f64| field(CENTER.as_dvec3() + u * r).length();
        assert!(speed(0.0) <= 1.0e-6 * peak, "{primitive:?}: {} in the middle", speed(0.0));
        close(speed(position), peak, peak, 1.0e-5, "the peak");
        for k in 1..400 {
            let r = f64::from(k) * 0.01;
            assert!(speed(r) <= peak * 1.00001, "{primitive:?} at {r}");
        }
    }
}

#[test]
fn uniform_wind_is_the_same_everywhere() {
    let direction = Vec3::new(3.0, 0.0, -4.0);
    let field = wind(&[WindPrimitive::Uniform(WindUniform { speed: 7.0, direction })]);
    for at in [DVec3::ZERO, DVec3::new(1.0e5, -3.0, 2.0)] {
        close((field(at) - DVec3::new(4.2, 0.0, -5.6)).length(), 0.0, 7.0, 1.0e-6, "uniform");
    }
}

#[test]
fn winds_add_up() {
    let at = DVec3::new(0.3, 1.7, 2.0);
    let one = WindPrimitive::Vortex(singularity(WindForm::Line));
    let other = WindPrimitive::Sink(WindSingularity { center: Vec3::ONE, ..singularity(WindForm::Point) });
    let many: Vec<_> = (0..50).flat_map(|_| [one, other]).collect();
    let sum = (wind(&[one])(at) + wind(&[other])(at)) * 50.0;
    close((wind(&many)(at) - sum).length(), 0.0, sum.length(), 1.0e-5, "a hundred primitives");
    assert_eq!(wind(&[])(at), DVec3::ZERO);
}
