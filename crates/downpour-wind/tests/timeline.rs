//! Keys: linear between them, constant outside; values out of range at any time are errors of the constructor.

mod common;

use common::{singularity, tornado};
use downpour_math::OutOfRange;
use downpour_wind::{
    Gusts, Keyed, KeyedSingularity, KeyedTornado, Turbulence, WIND_KEYS, WIND_PARTS, Wind, WindCore,
    WindError, WindForm, WindPart, WindPrimitive, WindUniform,
};
use glam::{DVec3, Vec3};

fn keyed(keys: &[(f64, f64)]) -> Keyed<f64> {
    Keyed::new(keys.to_vec()).expect("good keys")
}

fn whirl() -> KeyedSingularity {
    KeyedSingularity {
        form: WindForm::Line,
        core: WindCore::Rankine,
        strength: keyed(&[(0.0, -10.0), (4.0, 30.0)]),
        center: Keyed::new(vec![(0.0, DVec3::ZERO), (10.0, DVec3::new(20.0, 0.0, -10.0))])
            .expect("good keys"),
        axis: Keyed::new(vec![(1.0, DVec3::Y * 5.0), (3.0, DVec3::X * 0.1)]).expect("good keys"),
        core_radius: keyed(&[(-2.0, 1.0), (2.0, 3.0)]),
    }
}

#[test]
fn keys_are_linear_between_and_constant_outside() {
    let value = keyed(&[(-1.0, 2.0), (1.0, 6.0), (1.5, 6.0), (3.0, 0.0)]);
    for (time, wanted) in [
        (f64::NEG_INFINITY, 2.0),
        (-1.0, 2.0),
        (0.0, 4.0),
        (0.5, 5.0),
        (1.0, 6.0),
        (1.2, 6.0),
        (2.25, 3.0),
        (3.0, 0.0),
        (1.0e300, 0.0),
        (f64::INFINITY, 0.0),
        (f64::NAN, 2.0),
    ] {
        assert!((value.at(time) - wanted).abs() < 1.0e-12, "{time}: {}", value.at(time));
    }
    let sum = value.with(&keyed(&[(0.0, 0.0), (2.0, 8.0)]), |a, b| a + b);
    assert_eq!(sum.keys().iter().map(|&(time, _)| time).collect::<Vec<_>>(), [-1.0, 0.0, 1.0, 1.5, 2.0, 3.0]);
    assert!((sum.at(1.5) - 12.0).abs() < 1.0e-12);
    assert_eq!(Keyed::from(2.0).with(&Keyed::from(3.0), |a, b| a * b).at(7.0), 6.0);
}

#[test]
fn keys_that_are_none_are_refused() {
    let error = |keys: &[(f64, f64)]| Keyed::new(keys.to_vec()).expect_err("bad keys");
    assert_eq!(error(&[]), WindError::KeyCount { found: 0, allowed: WIND_KEYS });
    let many: Vec<(f64, f64)> = (0..=WIND_KEYS).map(|k| (k as f64, 1.0)).collect();
    assert_eq!(error(&many), WindError::KeyCount { found: WIND_KEYS + 1, allowed: WIND_KEYS });
    assert!(matches!(error(&many), WindError::KeyCount { found: 1.., .. }));
    assert!(Keyed::new(many[1..].to_vec()).is_ok());
    assert_eq!(error(&[(2.0, 0.0), (1.0, 0.0)]), WindError::KeyTime { index: 1, found: 1.0, before: 2.0 });
    for gap in [0.0, 1.0e-7, -1.0e-3] {
        assert!(
            matches!(error(&[(5.0, 0.0), (5.0 + gap, 1.0)]), WindError::KeyTime { index: 1, .. }),
            "{gap}"
        );
    }
    assert!(Keyed::new(vec![(5.0, 0.0), (5.000_001, 1.0)]).is_ok());
    for bad in [f64::NAN, f64::INFINITY, -1.1e6] {
        assert!(matches!(
            error(&[(bad, 0.0)]),
            WindError::OutOfRange(OutOfRange { quantity: "time of a key", .. })
        ));
    }
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(matches!(
            error(&[(0.0, bad)]),
            WindError::OutOfRange(OutOfRange { quantity: "value of a key", .. })
        ));
    }
    assert!(Keyed::new(vec![(0.0, DVec3::new(0.0, f64::NAN, 0.0))]).is_err());
}

/// Every parameter of a part follows its keys.
#[test]
fn parts_move() {
    let wind = Wind::new(vec![WindPart::Vortex(whirl())], None, None).expect("a wind");
    let at = |time| {
        let [WindPrimitive::Vortex(found)] = wind.at(time)[..] else { panic!("one vortex") };
        found
    };
    let first = at(-9.0);
    assert_eq!(
        (first.strength, first.center, first.axis, first.core_radius),
        (-10.0, Vec3::ZERO, Vec3::Y, 1.0)
    );
    let mid = at(2.0);
    assert_eq!((mid.strength, mid.center, mid.core_radius), (10.0, Vec3::new(4.0, 0.0, -2.0), 3.0));
    assert!((mid.axis - Vec3::new(1.0, 1.0, 0.0).normalize()).length() < 1.0e-6, "{}", mid.axis);
    assert_eq!((mid.core, mid.form), (WindCore::Rankine, WindForm::Line));
    assert_eq!(at(99.0).axis, Vec3::X);
    let KeyedSingularity { strength, .. } = whirl();
    let twister = KeyedTornado {
        circulation: strength,
        discharge: keyed(&[(0.0, 0.0), (2.0, 100.0)]),
        base: Keyed::new(vec![(0.0, DVec3::ZERO), (8.0, DVec3::X * 8.0)]).expect("good keys"),
        axis: DVec3::new(0.0, 2.0, 0.0).into(),
        height: keyed(&[(0.0, 10.0), (4.0, 30.0)]),
        core_radius: keyed(&[(0.0, 1.0), (4.0, 3.0)]),
    };
    let wind = Wind::new(vec![WindPart::Tornado(twister)], None, None).expect("a wind");
    let [WindPrimitive::Tornado(found)] = wind.at(1.0)[..] else { panic!("one tornado") };
    assert_eq!((found.circulation, found.discharge, found.base), (0.0, 50.0, Vec3::X));
    assert_eq!((found.height, found.core_radius, found.axis), (15.0, 1.5, Vec3::Y));
}

/// A part without keys is the primitive that it was made from.
#[test]
fn a_primitive_without_keys_stays() {
    for primitive in [
        WindPrimitive::Uniform(WindUniform { speed: 5.0, direction: Vec3::Z }),
        WindPrimitive::Sink(singularity(WindForm::Point)),
        WindPrimitive::Tornado(tornado()),
    ] {
        let wind = Wind::new(vec![primitive.into()], None, None).expect("a wind");
        for time in [-1.0e9, 0.0, 7.5, f64::NAN, f64::INFINITY] {
            let [found] = wind.at(time)[..] else { panic!("one primitive") };
            match (found, primitive) {
                (WindPrimitive::Uniform(a), WindPrimitive::Uniform(b)) => assert_eq!(a, b),
                (WindPrimitive::Sink(a), WindPrimitive::Sink(b)) => {
                    assert_eq!((a.strength, a.center, a.core_radius), (b.strength, b.center, b.core_radius));
                    assert!((a.axis - b.axis.normalize()).length() < 1.0e-6);
                }
                (WindPrimitive::Tornado(a), WindPrimitive::Tornado(b)) => {
                    assert_eq!((a.circulation, a.height, a.base), (b.circulation, b.height, b.base));
                }
                other => panic!("{other:?}"),
            }
        }
    }
    assert!(Wind::default().is_still() && Wind::default().at(3.0).is_empty());
}

/// The tip of the velocity moves on a straight line: a wind that reverses passes through calm.
#[test]
fn a_uniform_wind_is_a_velocity() {
    let turn = |to: DVec3| {
        let directions = Keyed::new(vec![(0.0, DVec3::X), (2.0, to)]).expect("good keys");
        let part = WindPart::uniform(&keyed(&[(0.0, 4.0), (2.0, 4.0)]), &directions).expect("a wind");
        Wind::new(vec![part], None, None).expect("a wind")
    };
    let wind = turn(DVec3::Z * 3.0);
    let [WindPrimitive::Uniform(found)] = wind.at(1.0)[..] else { panic!("a uniform wind") };
    assert!((found.speed - 8.0_f32.sqrt()).abs() < 1.0e-6);
    assert!((found.direction - Vec3::new(1.0, 0.0, 1.0).normalize()).length() < 1.0e-6);
    let wind = turn(DVec3::NEG_X);
    let [WindPrimitive::Uniform(found)] = wind.at(1.0)[..] else { panic!("a uniform wind") };
    assert!(found.speed < 1.0e-6 && WindPrimitive::Uniform(found).check().is_ok());
}

fn refused(part: WindPart) -> WindError {
    Wind::new(vec![part], None, None).expect_err("out of range")
}

#[test]
fn what_is_out_of_range_at_any_time_is_refused() {
    let quantity = |error| match error {
        WindError::OutOfRange(OutOfRange { quantity, .. }) | WindError::ZeroAxis { quantity, .. } => quantity,
        other => panic!("{other:?}"),
    };
    let bad = |change: fn(&mut KeyedSingularity)| {
        let mut part = whirl();
        change(&mut part);
        quantity(refused(WindPart::Source(part)))
    };
    // A source may not be negative, as this vortex is at first.
    assert_eq!(bad(|_| ()), "strength");
    assert_eq!(bad(|p| p.strength = f64::NAN.into()), "strength");
    let fine = |p: &mut KeyedSingularity| p.strength = 1.0.into();
    let fixed = move |change: fn(&mut KeyedSingularity)| {
        let mut part = whirl();
        fine(&mut part);
        change(&mut part);
        quantity(refused(WindPart::Source(part)))
    };
    assert_eq!(fixed(|p| p.core_radius = 0.0.into()), "core radius");
    assert_eq!(fixed(|p| p.core_radius = keyed(&[(0.0, 5.0), (1.0, 0.0), (2.0, 5.0)])), "core radius");
    assert_eq!(fixed(|p| p.axis = DVec3::ZERO.into()), "axis");
    assert_eq!(fixed(|p| p.axis = DVec3::NAN.into()), "axis");
    assert_eq!(fixed(|p| p.center = DVec3::splat(2.0e6).into()), "center");
    let mut turned = whirl();
    turned.axis = Keyed::new(vec![(0.0, DVec3::Y), (5.0, DVec3::new(1.0e-3, -2.0, 0.0))]).expect("keys");
    assert_eq!(refused(WindPart::Vortex(turned)), WindError::AxisReverses { quantity: "axis", time: 5.0 });
    // 2 core radii of height, between keys of different times as well.
    let mut low = KeyedTornado {
        circulation: 1.0.into(),
        discharge: 1.0.into(),
        base: DVec3::ZERO.into(),
        axis: DVec3::Y.into(),
        height: keyed(&[(0.0, 10.0), (10.0, 40.0)]),
        core_radius: keyed(&[(0.0, 1.0), (2.0, 8.5), (10.0, 1.0)]),
    };
    assert_eq!(quantity(refused(WindPart::Tornado(low.clone()))), "height");
    low.core_radius = keyed(&[(0.0, 1.0), (2.0, 7.9), (10.0, 1.0)]);
    let wind = Wind::new(vec![WindPart::Tornado(low)], None, None).expect("in range");
    for k in -10..210 {
        assert!(wind.at(f64::from(k) * 0.1).iter().all(|p| p.check().is_ok()), "{k}");
    }
    let speed = |value: f64| WindPart::Uniform(Keyed::from(DVec3::new(0.0, 0.0, value)));
    assert_eq!(quantity(refused(speed(201.0))), "wind speed");
    assert_eq!(quantity(refused(speed(f64::NAN))), "wind speed");
    assert!(Wind::new(vec![speed(-200.0)], None, None).is_ok());
    let still = WindPrimitive::Uniform(WindUniform { speed: 3.0, direction: Vec3::ZERO });
    assert_eq!(quantity(refused(still.into())), "wind speed");
    assert!(matches!(
        WindPart::uniform(&1.0.into(), &DVec3::ZERO.into()),
        Err(WindError::ZeroAxis { quantity: "direction of the wind", .. })
    ));
    let error = Wind::new(vec![speed(1.0); WIND_PARTS + 1], None, None).expect_err("too many");
    assert_eq!(error, WindError::TooManyParts { found: 1025, allowed: 1024 });
    assert!(matches!(error, WindError::TooManyParts { .. }), "{error}");
}

/// Many parts with keys at different times would be too expensive together.
#[test]
fn the_keys_of_all_uniform_parts_are_counted() {
    let part = |shift: f64| {
        let keys = (0..3000).map(|k| (f64::from(k) + shift, DVec3::X)).collect();
        WindPart::Uniform(Keyed::new(keys).expect("good keys"))
    };
    assert!(Wind::new(vec![part(0.0), part(0.0)], None, None).is_ok());
    let error = Wind::new(vec![part(0.0), part(0.5)], None, None).expect_err("too many");
    assert_eq!(error, WindError::KeyCount { found: 6000, allowed: WIND_KEYS });
}

#[test]
fn gusts_and_turbulence_are_checked() {
    let gusts = |intensity, length| Wind::new(vec![], Some(Gusts { intensity, length, seed: 0 }), None);
    let eddies = |speed, length| Wind::new(vec![], None, Some(Turbulence { speed, length, seed: 0 }));
    assert!(gusts(1.0, 1.0e4).is_ok() && eddies(50.0, 0.1).is_ok());
    for bad in [f64::NAN, -0.1, 1.1] {
        assert!(gusts(bad, 10.0).is_err(), "{bad}");
    }
    for bad in [f64::NAN, 0.0, f64::INFINITY, 1.1e4] {
        assert!(gusts(0.5, bad).is_err() && eddies(1.0, bad).is_err(), "{bad}");
    }
    for bad in [f64::NAN, -1.0, 50.1] {
        assert!(eddies(bad, 10.0).is_err(), "{bad}");
    }
}
