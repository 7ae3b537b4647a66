//! A tornado takes air in at its base, lifts and rotates it, and lets it out at its top, without loss.

mod common;

use std::f64::consts::{PI, TAU};

use common::{circulation, close, flux_sphere, frame, tornado, wind};
use downpour_wind::primitive::wind_primitive_updraft;
use downpour_wind::{WindCore, WindForm, WindPrimitive, WindSingularity, WindTornado};
use glam::DVec3;

const Q: f64 = 500.0;
const GAMMA: f64 = 60.0;

#[test]
fn air_goes_in_at_the_base_up_the_core_and_out_at_the_top() {
    let tornado = tornado();
    let field = wind(&[WindPrimitive::Tornado(tornado)]);
    let [u, v, up] = frame(tornado.axis);
    let (base, height) = (tornado.base.as_dvec3(), f64::from(tornado.height));
    for side in [u, -u, v, -v] {
        let around = up.cross(side);
        let low = field(base + side * 4.0);
        let high = field(base + up * height + side * 4.0);
        // 4 m beside a point sink or source of 500 m^3/s; the other end is three times as far.
        assert!(low.dot(side) < -1.5 && low.dot(side) > -2.5, "inflow {}", low.dot(side));
        assert!(high.dot(side) > 1.5 && high.dot(side) < 2.5, "outflow {}", high.dot(side));
        for at in [low, high] {
            close(at.dot(around), GAMMA / (TAU * 4.0), GAMMA / (TAU * 4.0), 0.15, "swirl");
        }
    }
    for fraction in [0.1, 0.3, 0.5, 0.7, 0.9] {
        let speed = field(base + up * (fraction * height));
        assert!(speed.dot(up) > 20.0, "updraft {} at {fraction}", speed.dot(up));
        close((speed - up * speed.dot(up)).length(), 0.0, 20.0, 1.0e-4, "no side wind on the axis");
    }
    close(circulation(&field, base + up * 5.0, tornado.axis, 40.0), GAMMA, GAMMA, 2.0e-3, "circulation");
}

/// The paper's three parts with its printed formulas: sink and source cancel, hence the point forms here.
#[test]
fn line_forms_cancel_and_ours_do_not() {
    let tornado = tornado();
    let at = tornado.base.as_dvec3() + frame(tornado.axis)[0] * 4.0;
    let line = |center| WindSingularity {
        form: WindForm::Line,
        strength: tornado.discharge,
        center,
        axis: tornado.axis,
        core_radius: tornado.core_radius,
        core: WindCore::Rosenhead,
    };
    let top = tornado.base + tornado.axis.normalize() * tornado.height;
    let printed = wind(&[WindPrimitive::Sink(line(tornado.base)), WindPrimitive::Source(line(top))]);
    assert!(printed(at).length() < 1.0e-4);
    let still = WindTornado { circulation: 0.0, ..tornado };
    assert!(wind(&[WindPrimitive::Tornado(still)])(at).length() > 1.5);
}

#[test]
fn no_air_is_lost_anywhere() {
    let tornado = tornado();
    let field = wind(&[WindPrimitive::Tornado(tornado)]);
    let [u, _, up] = frame(tornado.axis);
    let base = tornado.base.as_dvec3();
    let height = f64::from(tornado.height);
    for (center, radius) in [
        (base, 1.0),
        (base, 6.0),
        (base + up * height, 3.0),
        (base + up * 6.0, 2.0),
        (base + up * 3.0 + u * 2.0, 5.0),
        (base + up * 6.0, 30.0),
    ] {
        close(flux_sphere(&field, center, radius), 0.0, Q, 1.0e-3, &format!("{radius} m around {center}"));
    }
}

/// Through a wide disk between base and top: the flow up the core, minus the flow that the ends draw down outside it.
#[test]
fn the_core_carries_the_discharge() {
    let tornado = WindTornado { height: 200.0, ..tornado() };
    let field = wind(&[WindPrimitive::Tornado(tornado)]);
    let [u, _, up] = frame(tornado.axis);
    let middle = tornado.base.as_dvec3() + up * 100.0;
    let (radius, rings) = (15.0, 3000);
    let flow: f64 = (0..rings)
        .map(|k| {
            let r = radius * (f64::from(k) + 0.5) / f64::from(rings);
            TAU * r * field(middle + u * r).dot(up) * radius / f64::from(rings)
        })
        .sum();
    // A fraction R^2 / (R^2 + e^2) is within R; each end draws down its fraction of the solid angle, half of it at 45
    // degrees.
    let e = f64::from(tornado.core_radius);
    let within = radius * radius / (radius * radius + e * e);
    let ends = 1.0 - 100.0 / (100.0_f64 * 100.0 + radius * radius).sqrt();
    close(flow, Q * (within - ends), Q, 1.0e-3, "flow through the disk");
    // Speed on the axis of a long updraft.
    let fastest = Q / (PI * e * e);
    close(field(middle).dot(up), fastest, fastest, 1.0e-3, "speed on the axis");
}

#[test]
fn it_turns_the_other_way_if_asked() {
    let tornado = tornado();
    let turned = WindTornado { circulation: -tornado.circulation, ..tornado };
    let found = circulation(
        &wind(&[WindPrimitive::Tornado(turned)]),
        tornado.base.as_dvec3() + DVec3::Y,
        tornado.axis,
        40.0,
    );
    close(found, -GAMMA, GAMMA, 5.0e-3, "circulation");
}

/// The closed form of the updraft is the integral of the core's density along its line (here by Simpson's rule).
#[test]
fn the_updraft_is_an_integral_along_its_line() {
    let (height, core) = (12.0_f32, 1.5_f32);
    let (h, e) = (f64::from(height), f64::from(core));
    let steps = 2000;
    for (r, z) in [(0.0, 6.0), (0.0, 0.0), (1.0, -1.0), (2.5, 3.0), (1.5, 12.0), (0.4, 20.0), (7.0, 5.0)] {
        let density = |k: i32| {
            let u = z - h * f64::from(k) / f64::from(steps);
            let s = r * r + e * e + u * u;
            3.0 * e * e * Q / (4.0 * PI * s * s * s.sqrt())
        };
        let weight = |k: i32| match k {
            0 => 1.0,
            _ if k == steps => 1.0,
            _ => 2.0 + 2.0 * f64::from(k % 2),
        };
        let sum: f64 = (0..=steps).map(|k| weight(k) * density(k)).sum();
        let wanted = sum * h / f64::from(steps) / 3.0;
        let found = wind_primitive_updraft(Q as f32, (r * r) as f32, z as f32, height, core);
        // On the axis of a long one: scale of the rounding errors of its two ends.
        let scale = Q / (PI * e * e);
        close(found.into(), wanted, scale, 1.0e-6, &format!("{r} m from the line, {z} m up"));
    }
}
