//! The 3x3 matrix of the paper, encoded and decoded; values out of range are errors.

mod common;

use common::{CENTER, CORE, STRENGTH, singularity, tornado};
use downpour_math::OutOfRange;
use downpour_wind::{
    WindCore, WindError, WindForm, WindGrid, WindMatrix, WindPrimitive, WindSingularity, WindTornado,
    WindUniform,
};
use glam::Vec3;

fn all() -> Vec<WindPrimitive> {
    let unit = |form| WindSingularity { axis: Vec3::new(0.6, 0.0, -0.8), ..singularity(form) };
    vec![
        WindPrimitive::Uniform(WindUniform { speed: 5.0, direction: Vec3::new(0.0, 0.6, 0.8) }),
        WindPrimitive::Source(unit(WindForm::Line)),
        WindPrimitive::Sink(unit(WindForm::Line)),
        WindPrimitive::Vortex(WindSingularity { strength: -3.0, ..unit(WindForm::Line) }),
        WindPrimitive::Tornado(WindTornado { axis: Vec3::Y, ..tornado() }),
        WindPrimitive::Source(unit(WindForm::Point)),
        WindPrimitive::Sink(unit(WindForm::Point)),
        WindPrimitive::Vortex(unit(WindForm::Point)),
        WindPrimitive::Vortex(WindSingularity { core: WindCore::LambOseen, ..unit(WindForm::Line) }),
        WindPrimitive::Source(WindSingularity { core: WindCore::Rankine, ..unit(WindForm::Line) }),
        WindPrimitive::Sink(WindSingularity { core: WindCore::LambOseen, ..unit(WindForm::Line) }),
    ]
}

/// Rows of the paper: type, strength; center; up. A sink has a negative strength.
#[test]
fn the_matrix_is_that_of_the_paper() {
    let matrices = WindMatrix::encode(&[WindPrimitive::Sink(singularity(WindForm::Line))]).expect("in range");
    let [first, center, up] = matrices[0].rows;
    assert_eq!(first, [2.0, -STRENGTH, CORE]);
    assert_eq!(center, CENTER.to_array());
    let wanted = Vec3::new(1.0, 2.0, -0.5) / 5.25_f32.sqrt();
    assert!((Vec3::from(up) - wanted).length() < 1.0e-6, "{up:?}");
    assert_eq!(matrices[0].padded()[1], [CENTER.x, CENTER.y, CENTER.z, 0.0]);
}

#[test]
fn every_primitive_comes_back() {
    let matrices = WindMatrix::encode(&all()).expect("in range");
    // Four for the tornado, one for each of the others.
    assert_eq!(matrices.len(), all().len() + 3);
    let back = WindMatrix::decode(&matrices).expect("what was encoded");
    assert_eq!(back, all());
    assert_eq!(WindMatrix::encode(&back).expect("in range"), matrices);
    assert_eq!(WindMatrix::decode(&[]), Ok(vec![]));
}

#[test]
fn a_slanted_tornado_comes_back_to_rounding() {
    let matrices = WindMatrix::encode(&[WindPrimitive::Tornado(tornado())]).expect("in range");
    let back = WindMatrix::decode(&matrices).expect("what was encoded");
    let [WindPrimitive::Tornado(found)] = back[..] else { panic!("{back:?}") };
    assert!((found.height - tornado().height).abs() < 1.0e-5);
    assert!((found.axis - tornado().axis.normalize()).length() < 1.0e-6);
    assert_eq!((found.circulation, found.discharge, found.base), (60.0, 500.0, CENTER));
    // The smallest height is still in range after rounding.
    for k in 0..50 {
        let core_radius = 0.37 + 0.11 * k as f32;
        let least = WindTornado { core_radius, height: 2.0 * core_radius, ..tornado() };
        let matrices = WindMatrix::encode(&[WindPrimitive::Tornado(least)]).expect("in range");
        assert!(WindMatrix::decode(&matrices).is_ok(), "{core_radius}");
    }
}

#[test]
fn foreign_matrices_are_checked() {
    let good = WindMatrix::encode(&all()).expect("in range");
    for kind in [-1.0, 0.5, 8.0, 12.0, 15.0, 16.0, 20.0, 24.0, 25.0, 1.0e20, f32::NAN, f32::INFINITY] {
        let mut matrices = good.clone();
        matrices[2].rows[0][0] = kind;
        let error = WindMatrix::decode(&matrices).expect_err("no such type");
        assert!(matches!(error, WindError::UnknownType { index: 2, .. }), "{error}");
    }
    // A source with negative strength, a sink with positive.
    for index in [1, 2] {
        let mut matrices = good.clone();
        matrices[index].rows[0][1] *= -1.0;
        let error = WindMatrix::decode(&matrices).expect_err("the wrong sign");
        assert!(matches!(error, WindError::OutOfRange(OutOfRange { quantity: "strength", .. })), "{error}");
    }
    // A tornado without a part, or with parts of two tornadoes.
    let updraft = 4;
    assert_eq!(WindMatrix::decode(&good[..=updraft]), Err(WindError::LoneUpdraft { index: updraft }));
    for (part, row) in [(5, 0), (5, 1), (6, 1), (7, 1), (6, 2)] {
        let mut matrices = good.clone();
        matrices[part].rows[row][1] += 0.5;
        let found = WindMatrix::decode(&matrices);
        assert_eq!(found, Err(WindError::LoneUpdraft { index: updraft }), "part {part}, row {row}");
    }
    // Any number in any entry gives a result or an error, never a panic, and an accepted matrix can be encoded.
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -0.0, 0.0, 1.0e-40, 3.0] {
        for at in 0..good.len() * 9 {
            let mut matrices = good.clone();
            matrices[at / 9].rows[at % 9 / 3][at % 3] = bad;
            if let Ok(found) = WindMatrix::decode(&matrices) {
                assert!(WindMatrix::encode(&found).is_ok(), "{bad} at {at}");
            }
        }
    }
}

fn found(primitive: WindPrimitive) -> (&'static str, f64) {
    match WindMatrix::encode(&[primitive]) {
        Err(WindError::OutOfRange(OutOfRange { quantity, found, .. })) => (quantity, found),
        Err(WindError::ZeroAxis { quantity, .. }) => (quantity, 0.0),
        other => panic!("{other:?} of {primitive:?}"),
    }
}

#[test]
fn numbers_out_of_range_are_named() {
    let at = singularity(WindForm::Line);
    let uniform = WindUniform { speed: 1.0, direction: Vec3::X };
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3.0e38] {
        let source = WindPrimitive::Source;
        assert_eq!(found(source(WindSingularity { strength: bad, ..at })).0, "strength");
        assert_eq!(found(source(WindSingularity { core_radius: bad, ..at })).0, "core radius");
        assert_eq!(found(source(WindSingularity { center: Vec3::new(0.0, bad, 0.0), ..at })).0, "center");
        assert_eq!(found(source(WindSingularity { axis: Vec3::new(0.0, 1.0, bad), ..at })).0, "axis");
        let wind = WindPrimitive::Uniform;
        assert_eq!(found(wind(WindUniform { speed: bad, ..uniform })).0, "wind speed");
        let direction = Vec3::new(bad, 1.0, 0.0);
        assert_eq!(found(wind(WindUniform { direction, ..uniform })).0, "direction of the wind");
        let whirl = WindPrimitive::Tornado;
        assert_eq!(found(whirl(WindTornado { circulation: bad, ..tornado() })).0, "circulation");
        assert_eq!(found(whirl(WindTornado { discharge: bad, ..tornado() })).0, "discharge");
        assert_eq!(found(whirl(WindTornado { height: bad, ..tornado() })).0, "height");
        assert_eq!(found(whirl(WindTornado { base: Vec3::splat(bad), ..tornado() })).0, "base");
        assert_eq!(found(whirl(WindTornado { core_radius: bad, ..tornado() })).0, "core radius");
        assert_eq!(found(whirl(WindTornado { axis: Vec3::splat(bad), ..tornado() })).0, "axis");
    }
    let zero = WindSingularity { core_radius: 0.0, ..at };
    assert_eq!(found(WindPrimitive::Vortex(zero)), ("core radius", 0.0));
    let still = WindSingularity { axis: Vec3::ZERO, ..at };
    assert_eq!(
        WindMatrix::encode(&[WindPrimitive::Vortex(still)]),
        Err(WindError::ZeroAxis { quantity: "axis", found: [0.0; 3] })
    );
    assert_eq!(found(WindPrimitive::Sink(WindSingularity { strength: -1.0, ..at })), ("strength", -1.0));
    assert!(WindMatrix::encode(&[WindPrimitive::Vortex(WindSingularity { strength: -1.0, ..at })]).is_ok());
    let odd = WindSingularity { core: WindCore::Rankine, ..singularity(WindForm::Point) };
    assert_eq!(
        WindMatrix::encode(&[WindPrimitive::Source(odd)]),
        Err(WindError::CoreOfPoint { found: "rankine" })
    );
    let flat = WindTornado { height: 2.9, ..tornado() };
    assert_eq!(found(WindPrimitive::Tornado(flat)).0, "height");
    let text = WindMatrix::encode(&[WindPrimitive::Vortex(zero)]).expect_err("no core").to_string();
    assert_eq!(text, "core radius is 0 m; allowed: 0.01 to 1e4");
}

#[test]
fn boxes_out_of_range_are_refused() {
    let new = |low, high, size| WindGrid::new(low, high, size);
    let (low, high) = (Vec3::ZERO, Vec3::splat(10.0));
    assert!(new(low, high, [203, 203, 203]).is_ok());
    let error = new(low, high, [204, 204, 204]).expect_err("too many");
    assert_eq!(error, WindError::TooManyCells { found: 204 * 204 * 204, allowed: 1 << 23 });
    assert!(matches!(error, WindError::TooManyCells { .. }));
    assert!(!matches!(new(low, low, [1; 3]).expect_err("empty"), WindError::TooManyCells { .. }));
    for size in [[0, 1, 1], [1, 4097, 1], [1, 1, u32::MAX]] {
        assert!(matches!(new(low, high, size), Err(WindError::OutOfRange(OutOfRange { .. }))), "{size:?}");
    }
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3.0e38] {
        assert!(new(Vec3::new(0.0, bad, 0.0), high, [4; 3]).is_err(), "{bad}");
        assert!(new(low, Vec3::new(1.0, 1.0, bad), [4; 3]).is_err(), "{bad}");
    }
    assert!(new(high, low, [4; 3]).is_err(), "upside down");
}
