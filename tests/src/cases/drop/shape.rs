//! `drop/shape.wgsl` against `downpour_drop::shape`.

use downpour_drop::shape::{
    DropShape, DropShapeCoefficients, drop_shape_normal, drop_shape_radius, drop_shape_radius_slope,
    drop_shape_slope,
};
use downpour_shaders::drop::shape::SHAPE;

use crate::Domain::{Made, Uniform, Unit3};
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, Tol};

/// The coefficients of a drop of 0.2 to 9 mm.
fn coefficients(random: [u32; 4]) -> Vec<u32> {
    let diameter = 0.2e-3 + 8.8e-3 * f64::from(random[0]) / f64::from(u32::MAX);
    let c = DropShape::new(diameter).expect("a diameter of the table").gpu_coefficients();
    [c.c0, c.c1, c.c2].concat().into_iter().map(f32::to_bits).collect()
}

fn shape(args: &mut Args<'_>) -> [f64; 11] {
    DropShapeCoefficients { c0: args.f32s(), c1: args.f32s(), c2: args.f32s() }.into()
}

const SUM: Tol = Tol::absolute(1.0e-6, "Clenshaw's sum of 11 terms up to 1; a GPU may fuse its products");
const SLOPE: Tol = Tol::absolute(5.0e-6, "the same with terms multiplied by up to 10");

pub(super) fn functions() -> Vec<FunctionCase> {
    let (c, x) = (Made(coefficients), Uniform(-1.0, 1.0));
    vec![
        FunctionCase::new("drop_shape_radius", &SHAPE, &[c, x], SUM, |a| {
            drop_shape_radius(&shape(a), a.f32()).words()
        }),
        FunctionCase::new("drop_shape_slope", &SHAPE, &[c, x], SLOPE, |a| {
            drop_shape_slope(&shape(a), a.f32()).words()
        }),
        FunctionCase::new("drop_shape_radius_slope", &SHAPE, &[c, x], SLOPE, |a| {
            drop_shape_radius_slope(&shape(a), a.f32()).words()
        }),
        FunctionCase::new(
            "drop_shape_normal",
            &SHAPE,
            &[c, Unit3, Unit3],
            Tol::absolute(4.0e-6, "the slope above, a division (2.5 ulp) and a normalization"),
            |a| drop_shape_normal(&shape(a), a.f32s(), a.f32s()).words(),
        ),
    ]
}
