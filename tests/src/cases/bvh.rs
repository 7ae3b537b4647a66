//! `shaders/wgsl/bvh` against `downpour-bvh`.

use downpour_bvh::{
    BvhNode, BvhTriangle, bvh_enter, bvh_inverse, bvh_is_before, bvh_leaf, bvh_order, bvh_triangle,
};
use downpour_math::rng::rng_unit;
use downpour_shaders::bvh::{BVH, BVH_EDGE_SLACK, BVH_LEAF, BVH_NO_CHILD};

use crate::Domain::{Below, Fixed, Made, OneOf, Or, Uniform, Unit3};
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, Tol};

fn met(a: &mut Args<'_>) -> Vec<u32> {
    let corner = a.f32s();
    let index = a.f32() as u32;
    let (edge_1, lets_through) = (a.f32s(), a.u32());
    let triangle = BvhTriangle { corner, index, edge_1, lets_through, edge_2: a.f32s(), padding: 0 };
    bvh_triangle(&triangle, a.f32s(), a.f32s()).words()
}

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    let [none, one] = [0.0, 1.0].map(Fixed);
    vec![
        FunctionCase::new(
            "bvh_inverse",
            &BVH,
            // A sign is lost where a component counts as 0.
            &[Or(&Uniform(-1.0, 1.0), &[0.0, -1.0e-20, -1.01e-20, -1.02e-20]); 3],
            Tol::ulp(3, "a division (2.5 ulp)"),
            |a| bvh_inverse(a.f32s()).words(),
        ),
        FunctionCase::new(
            "bvh_enter",
            &BVH,
            &[
                Made(|r| {
                    let unit = r.map(rng_unit);
                    // Boxes beside each other, around the middle; every other node has three of them.
                    let low =
                        |axis: usize| std::array::from_fn(|k| unit[(axis + k) % 4] - 0.5 + 0.1 * k as f32);
                    let high = |low: [f32; 4]| low.map(|c| c + 0.05 + 0.5 * unit[3]);
                    let lows: [[f32; 4]; 3] = std::array::from_fn(low);
                    let all = [lows, lows.map(high)].concat();
                    let last = if r[0] % 2 == 0 { 9 } else { BVH_NO_CHILD };
                    [all.as_flattened().iter().map(|c| c.to_bits()).collect(), vec![1, 2 << 28 | 5, 3, last]]
                        .concat()
                }),
                Unit3,
                Made(|r| {
                    // Rays toward the middle, so that some hit and some do not.
                    let d: [f32; 3] = std::array::from_fn(|k| rng_unit(r[k]) - 0.5);
                    bvh_inverse(d).map(f32::to_bits).to_vec()
                }),
                OneOf(&[0.0, 0.0, 1.0e-4, 0.3]),
                OneOf(&[0.5, 2.0, 3.0e38]),
            ],
            Tol::relative(
                1.0e-5,
                1.0e-5,
                "products and differences; a ray that grazes a box may fall on either side",
            )
            .with_outliers(1.0e-3),
            |a| {
                let [low_x, low_y, low_z, high_x, high_y, high_z] = std::array::from_fn(|_| a.f32s());
                let child = std::array::from_fn(|_| a.u32());
                let node = BvhNode { low_x, low_y, low_z, high_x, high_y, high_z, child };
                bvh_enter(&node, a.f32s(), a.f32s(), a.f32(), a.f32()).words()
            },
        ),
        FunctionCase::new(
            "bvh_order",
            &BVH,
            // Some of them are equal.
            &[[OneOf(&[0.0, 0.25, 0.5, 1.0, 3.0e38]); 4], [Below(9); 4]].concat(),
            Tol::exact("a network of comparisons"),
            |a| {
                let enters = a.f32s();
                let order = bvh_order(enters, std::array::from_fn(|_| a.u32()));
                [order.enters.words(), order.child.words()].concat()
            },
        ),
        FunctionCase::new(
            "bvh_leaf",
            &BVH,
            &[Made(|r| {
                let ends = [0, 7, BVH_LEAF - 20];
                vec![
                    (1 + r[0] % 14) * BVH_LEAF
                        + ends.get(r[1] as usize % 4).copied().unwrap_or(r[2] % (BVH_LEAF - 20)),
                ]
            })],
            Tol::exact("shifts of integers"),
            |a| {
                let triangles = bvh_leaf(a.u32());
                vec![triangles.start as u32, triangles.end as u32]
            },
        ),
        FunctionCase::new(
            "bvh_is_before",
            &BVH,
            &[
                OneOf(&[0.0, 0.99e-7, 1.0e-7, 1.01e-7, 0.5, 1.000_000_5, 1.000_003, 1.01, 999.9, 1000.002]),
                OneOf(&[0.0, 0.5, 1.0, 1000.0]),
            ],
            Tol::exact("a comparison of numbers that no rounding swaps"),
            |a| u32::from(bvh_is_before(a.f32(), a.f32())).words(),
        ),
        FunctionCase::new(
            "bvh_triangle",
            &BVH,
            &[
                Uniform(-0.6, -0.4),
                Uniform(-0.6, -0.4),
                Uniform(-0.1, 0.1),
                OneOf(&[0.0]),
                Uniform(0.8, 1.2),
                Uniform(-0.1, 0.1),
                Uniform(-0.2, 0.2),
                Below(2),
                Uniform(-0.1, 0.1),
                Uniform(0.8, 1.2),
                Uniform(-0.2, 0.2),
                Uniform(-0.4, 0.4),
                Uniform(-0.4, 0.4),
                Uniform(1.0, 2.0),
                Uniform(-0.2, 0.2),
                Uniform(-0.2, 0.2),
                Uniform(-1.0, -0.5),
            ],
            Tol::absolute(
                2.0e-5,
                "cross products and a division (2.5 ulp); rays on an edge may fall on either side",
            ),
            met,
        ),
        // Rays onto the very edges of a triangle, on both sides of the slack, and rays within its plane. All is exact.
        FunctionCase::new(
            "bvh_triangle",
            &BVH,
            &[
                [none; 4].as_slice(),
                &[one, none, none, Below(2)],
                &[none, one, none],
                &[
                    OneOf(&[
                        -2.0e-6,
                        -BVH_EDGE_SLACK,
                        0.0,
                        0.5,
                        1.0,
                        1.0 + 0.5 * BVH_EDGE_SLACK,
                        1.0 + BVH_EDGE_SLACK,
                    ]),
                    OneOf(&[-2.0e-6, -BVH_EDGE_SLACK, 0.0, 0.0, 0.0, 0.5]),
                    one,
                ],
                &[none, none, OneOf(&[-1.0, -1.0, -1.0, 0.0])],
            ]
            .concat(),
            Tol::exact("products with 0 and 1"),
            met,
        ),
    ]
}
