//! `shaders/wgsl/mask` against `downpour-mask`.

use downpour_drop::DropShape;
use downpour_gpu::{Gpu, GpuError};
use downpour_mask::gpu::{GpuMaskError, GpuTracer};
use downpour_mask::silhouette::{
    mask_silhouette_area, mask_silhouette_cut, mask_silhouette_distance, mask_silhouette_estimate,
};
use downpour_mask::trace::{
    Exit, TracedDrop, mask_trace_curvature, mask_trace_exit, mask_trace_meet, mask_trace_normal,
    mask_trace_plane_turn, mask_trace_reflectance, mask_trace_spheroid, mask_trace_step, mask_trace_surface,
    mask_trace_through,
};
use downpour_mask::{ClosedMesh, Mask, MaskOptions, MaskTexel, View, trace_drop_scalar, trace_model};
use downpour_math::rng::rng_unit;
use downpour_shaders::mask;

use crate::Domain::{Below, Made, OneOf, Uniform, Unit3};
use crate::compare::{Cpu, Gpu as FromGpu};
use crate::function::Run;
use crate::signature::WordKind;
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, KernelCase, Tol};

/// Texels along an edge of the masks that are compared.
const SIZE: u32 = 96;

/// The words of a `MaskTracedDrop`: a drop of 0.1 to 9 mm seen from any elevation.
fn traced_words(random: [u32; 4]) -> Vec<u32> {
    let diameter = 1.0e-4 + 8.9e-3 * f64::from(rng_unit(random[0]));
    let elevation = std::f64::consts::PI * (f64::from(rng_unit(random[1])) - 0.5);
    let shape = DropShape::new(diameter).expect("a diameter of the table");
    let up = View::from_elevation(elevation).expect("an elevation").up();
    let radius = shape.equivalent_radius();
    let wide = shape.max_half_width() / radius;
    let tall = 0.5 * (shape.extent_up() + shape.extent_down()) / radius;
    let bits = |c: f64| (c as f32).to_bits();
    let mut words = vec![SIZE];
    words.extend([0.02, 1.0 / (wide * wide), 1.0 / (tall * tall)].map(bits));
    words.extend(shape.coefficients().map(bits));
    words.push(0);
    words.extend(up.map(bits));
    words.push(bits(1.333));
    words
}

/// The same for pixels of 0.3.
fn coarse_words(random: [u32; 4]) -> Vec<u32> {
    let mut words = traced_words(random);
    words[1] = 0.3f32.to_bits();
    words
}

/// The same from the side.
fn level_words(random: [u32; 4]) -> Vec<u32> {
    let mut words = traced_words(random);
    let up = words.len() - 4;
    words[up..up + 3].copy_from_slice(&[0.0f32, 1.0, 0.0].map(f32::to_bits));
    words
}

/// The same of a drop that refracts more than anything that is clear.
fn dense_words(random: [u32; 4]) -> Vec<u32> {
    let mut words = traced_words(random);
    let index = words.len() - 1;
    words[index] = 6.0f32.to_bits();
    words
}

/// The same words as the twin takes them, and the width of a pixel.
fn traced(args: &mut Args<'_>) -> (TracedDrop, f32) {
    let _size = args.u32();
    let [pixel, inverse_wide, inverse_tall] = args.f32s();
    let coefficients = args.f32s::<12>();
    let up = args.f32s::<3>().map(f64::from);
    let index = args.f32();
    let drop = TracedDrop {
        coefficients: std::array::from_fn(|n| f64::from(coefficients[n])),
        up,
        index: index.into(),
        inverse_wide: inverse_wide.into(),
        inverse_tall: inverse_tall.into(),
        steps: downpour_shaders::mask::MASK_TRACE_STEPS,
    };
    (drop, pixel)
}

/// As `MaskTraceExit`.
fn exit_words(exit: &Exit<f32>) -> Vec<u32> {
    let at = ((exit.point, exit.reflections), (exit.normal, exit.lost));
    (at, (exit.inside, exit.outside)).words()
}

fn through(a: &mut Args<'_>) -> Vec<u32> {
    let (drop, _) = traced(a);
    let t = mask_trace_through(&drop, a.f32(), a.f32());
    let outer = ((t.direction, t.transmittance), (t.reflected, t.reflectance));
    ((outer, (t.internal, t.internal_transmittance)), t.reflections).words()
}

const SURFACE: Tol = Tol::relative(
    1.0e-5,
    1.0e-5,
    "Clenshaw's sum of 11 terms, two square roots and two divisions (2.5 ulp) of numbers of order 1",
);

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    let drop = Made(traced_words);
    let near = Uniform(-1.3, 1.3);
    let inside = Uniform(-0.55, 0.55);
    vec![
        FunctionCase::new("mask_trace_surface", &mask::TRACE, &[drop, near, near, near], SURFACE, |a| {
            let (drop, _) = traced(a);
            let surface = mask_trace_surface(&drop, a.f32s());
            (surface.half_gradient, surface.excess).words()
        }),
        FunctionCase::new(
            "mask_trace_spheroid",
            &mask::TRACE,
            &[drop, near, near, near, near, near, near],
            Tol::relative(1.0e-5, 4.0e-6, "sums of products of numbers up to 4; a GPU may fuse them"),
            |a| {
                let (drop, _) = traced(a);
                mask_trace_spheroid(&drop, a.f32s(), a.f32s()).words()
            },
        ),
        FunctionCase::new(
            "mask_trace_curvature",
            &mask::TRACE,
            &[drop, Unit3],
            Tol::relative(1.0e-5, 4.0e-6, "sums of products of numbers up to 4; a GPU may fuse them"),
            |a| {
                let (drop, _) = traced(a);
                mask_trace_curvature(&drop, a.f32s()).words()
            },
        ),
        FunctionCase::new(
            "mask_trace_step",
            &mask::TRACE,
            &[Uniform(-0.9, 0.4), Uniform(0.7, 1.6), Uniform(0.6, 1.1), OneOf(&[-1.0, 1.0])],
            Tol::relative(1.0e-5, 1.0e-5, "a square root of a discriminant and a division (2.5 ulp)"),
            |a| mask_trace_step(a.f32(), a.f32(), a.f32(), a.f32()).words(),
        ),
        // Lines that graze: the two roots are close together, or there is none.
        FunctionCase::new(
            "mask_trace_step",
            &mask::TRACE,
            &[Uniform(0.3, 1.2), Uniform(-0.9, 0.9), Uniform(0.6, 1.1), OneOf(&[-1.0, 1.0])],
            Tol::absolute(2.0e-3, "a square root of a difference that is known to 4e-7"),
            |a| mask_trace_step(a.f32(), a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "mask_trace_meet",
            &mask::TRACE,
            &[drop, inside, inside, inside, Unit3, OneOf(&[-1.0, 1.0])],
            Tol::relative(
                2.0e-5,
                2.0e-5,
                "Newton's steps converge to the surface, which both sides know to 1e-6",
            ),
            |a| {
                let (drop, _) = traced(a);
                mask_trace_meet(&drop, a.f32s(), a.f32s(), a.f32()).words()
            },
        ),
        FunctionCase::new("mask_trace_normal", &mask::TRACE, &[drop, Unit3], SURFACE, |a| {
            let (drop, _) = traced(a);
            mask_trace_normal(&drop, a.f32s()).words()
        }),
        FunctionCase::new(
            "mask_trace_plane_turn",
            &mask::TRACE,
            &[Unit3, Unit3, Unit3],
            Tol::absolute(
                1.0e-3,
                "a quotient of squared cross products, which cancel for nearly parallel vectors",
            ),
            |a| mask_trace_plane_turn(a.f32s(), a.f32s(), a.f32s()).words(),
        ),
        FunctionCase::new(
            "mask_trace_exit",
            &mask::TRACE,
            &[drop, inside, inside, inside, Unit3],
            Tol::absolute(2.0e-3, "a refraction; errors grow close to total reflection and with each one")
                .with_outliers(2.0e-3),
            |a| {
                let (drop, _) = traced(a);
                exit_words(&mask_trace_exit(&drop, a.f32s(), a.f32s()))
            },
        ),
        FunctionCase::new(
            "mask_trace_reflectance",
            &mask::TRACE,
            &[Unit3, Below(9), Unit3, Below(2), Unit3, Unit3, Uniform(1.2, 1.4)],
            Tol::relative(1.0e-5, 1.0e-5, "Fresnel's equations: square roots and quotients (2.5 ulp)")
                .with_outliers(1.0e-3),
            |a| {
                let (point, _) = (a.f32s(), a.u32());
                let (normal, _) = (a.f32s(), a.u32());
                let (inside, outside) = (a.f32s(), a.f32s());
                let exit = Exit { point, normal, inside, outside, reflections: 0.0, lost: 0.0 };
                mask_trace_reflectance(&exit, a.f32()).words()
            },
        ),
        FunctionCase::new(
            "mask_trace_through",
            &mask::TRACE,
            &[drop, inside, inside],
            Tol::relative(
                1.0e-4,
                1.0e-4,
                "two refractions and a reflection; errors grow close to total reflection and with each one",
            )
            .with_outliers(1.0e-4),
            through,
        ),
        // Wider rays, of which a part is polarized, in a drop seen from the side.
        FunctionCase::new(
            "mask_trace_through",
            &mask::TRACE,
            &[Made(level_words), Uniform(-0.8, 0.8), Uniform(-0.3, 0.3)],
            Tol::absolute(1.0e-5, "two refractions and a reflection far from total reflection")
                .with_outliers(1.0e-2),
            through,
        ),
        // So strong a refraction that some light does not find out.
        FunctionCase::new(
            "mask_trace_through",
            &mask::TRACE,
            &[Made(dense_words), inside, inside],
            Tol::absolute(2.0e-3, "errors grow close to total reflection and with each one")
                .with_outliers(5.0e-3),
            through,
        ),
        FunctionCase::new(
            "mask_silhouette_estimate",
            &mask::SILHOUETTE,
            &[drop, near, near],
            Tol::relative(1.0e-5, 1.0e-5, "sums of products and a division (2.5 ulp)"),
            |a| {
                let (drop, _) = traced(a);
                mask_silhouette_estimate(&drop, a.f32(), a.f32()).words()
            },
        ),
        FunctionCase::new(
            "mask_silhouette_distance",
            &mask::SILHOUETTE,
            &[drop, Uniform(0.5, 1.3), Uniform(0.3, 1.3)],
            Tol::relative(
                2.0e-5,
                2.0e-5,
                "Newton's steps to the nearest approach, then a quotient (2.5 ulp)",
            ),
            |a| {
                let (drop, _) = traced(a);
                mask_silhouette_distance(&drop, a.f32(), a.f32()).words()
            },
        ),
        FunctionCase::new(
            "mask_silhouette_area",
            &mask::SILHOUETTE,
            &[
                Uniform(-0.8, 0.8),
                Made(|r| {
                    let phi = std::f32::consts::TAU * rng_unit(r[0]);
                    vec![downpour_math::ops::cos(phi).to_bits(), downpour_math::ops::sin(phi).to_bits()]
                }),
            ],
            Tol::absolute(4.0e-6, "quotients (2.5 ulp) of numbers up to 1"),
            |a| mask_silhouette_area(a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "mask_silhouette_cut",
            &mask::SILHOUETTE,
            &[drop, near, near],
            Tol::absolute(2.0e-3, "the distance to the outline (1e-5) in units of a pixel of 0.02"),
            |a| {
                let (drop, pixel) = traced(a);
                let (x, y) = (a.f32(), a.f32());
                let cut = mask_silhouette_cut(&drop, pixel, x, y);
                ((cut.sample, cut.coverage), cut.traced).words()
            },
        ),
        // Pixels of a third of a drop, where the margins of the thresholds and the sample's place in a pixel count.
        FunctionCase::new(
            "mask_silhouette_cut",
            &mask::SILHOUETTE,
            &[Made(coarse_words), near, near],
            Tol::absolute(2.0e-4, "the distance to the outline (1e-5) in units of a pixel of 0.3"),
            |a| {
                let (drop, pixel) = traced(a);
                let (x, y) = (a.f32(), a.f32());
                let cut = mask_silhouette_cut(&drop, pixel, x, y);
                ((cut.sample, cut.coverage), cut.traced).words()
            },
        ),
    ]
}

/// Direction, coverage, reflection and transmittance are numbers, the count of reflections is an integer; the
/// padding is not compared.
fn run(cpu: &Mask, gpu: &Mask) -> Run {
    let words = |mask: &Mask| -> Vec<u32> {
        let texel = |t: &MaskTexel| {
            let outer = ((t.direction, t.coverage), (t.reflected, t.transmittance));
            ((outer, (t.internal, t.internal_transmittance)), t.reflections).words()
        };
        mask.texels.iter().flat_map(texel).collect()
    };
    let texel =
        |i: u32| vec![(i % cpu.size) as f32, (i / cpu.size) as f32].into_iter().map(f32::to_bits).collect();
    let mut kinds = vec![WordKind::Float; 12];
    kinds.push(WordKind::Integer);
    Run {
        arguments: (0..cpu.size * cpu.size).map(texel).collect(),
        cpu: Cpu(words(cpu)),
        gpu: FromGpu(words(gpu)),
        kinds,
    }
}

fn told(error: GpuMaskError) -> GpuError {
    match error {
        GpuMaskError::Gpu(error) => error,
        other => GpuError::Refused { what: "a mask".to_owned(), reason: other.to_string() },
    }
}

fn drop_case(gpu: &Gpu, diameter: f64, degrees: f64) -> Result<Run, GpuError> {
    let shape = DropShape::new(diameter).expect("a diameter of the table");
    let view = View::from_elevation(f64::to_radians(degrees)).expect("an elevation");
    let options = MaskOptions { size: SIZE, view, ..MaskOptions::default() };
    let cpu = trace_drop_scalar(&shape, &options).expect("a mask");
    Ok(run(&cpu, &GpuTracer::new(gpu)?.trace_drop(&shape, &options).map_err(told)?))
}

fn model_case(gpu: &Gpu, degrees: f64) -> Result<Run, GpuError> {
    let shape = DropShape::new(4.0e-3).expect("a diameter of the table");
    let mesh = downpour_drop::mesh::DropMesh::latitude_longitude(&shape, 24, 48).expect("a mesh");
    let mesh =
        ClosedMesh::new(mesh.positions(), Some(mesh.normals()), mesh.triangles()).expect("a closed mesh");
    let view = View::from_elevation(f64::to_radians(degrees)).expect("an elevation");
    let options = MaskOptions { size: SIZE, view, ..MaskOptions::default() };
    let cpu = trace_model(&mesh, &options, None).expect("a mask");
    Ok(run(&cpu, &GpuTracer::new(gpu)?.trace_model(&mesh, &options, None).map_err(told)?))
}

const DROP: Tol =
    Tol::absolute(1.0e-4, "two refractions of f32; the derivative of Snell's law grows at the rim");
const TILTED: Tol = Tol::absolute(
    1.0e-3,
    "total reflections multiply the errors before them, and close to the critical angle the count may differ",
)
.with_outliers(1.0e-3);
const MODEL: Tol =
    Tol::absolute(1.0e-3, "a ray on an edge may meet either of two facets, whose normals agree there")
        .with_outliers(1.0e-3);

/// The cases.
#[must_use]
pub(super) fn kernels() -> Vec<KernelCase> {
    let drop = |name, tol, run| KernelCase {
        name,
        kernel: &mask::DROP_KERNEL,
        with: &[],
        overrides: &[],
        text: None,
        tol,
        run,
    };
    let model = |name, run| KernelCase {
        name,
        kernel: &mask::MODEL_KERNEL,
        with: &[],
        overrides: &[],
        text: None,
        tol: MODEL,
        run,
    };
    vec![
        drop("main_mask_drop: 1 mm from the side", DROP, |gpu| drop_case(gpu, 1.0e-3, 0.0)),
        drop("main_mask_drop: 2 mm from the side", DROP, |gpu| drop_case(gpu, 2.0e-3, 0.0)),
        drop("main_mask_drop: 6 mm from the side", DROP, |gpu| drop_case(gpu, 6.0e-3, 0.0)),
        drop("main_mask_drop: 5 mm from 20 degrees above", TILTED, |gpu| drop_case(gpu, 5.0e-3, 20.0)),
        drop("main_mask_drop: 6 mm from below", TILTED, |gpu| drop_case(gpu, 6.0e-3, -90.0)),
        model("main_mask_model: a mesh of 4 mm from the side", |gpu| model_case(gpu, 0.0)),
        model("main_mask_model: a mesh of 4 mm from 35 degrees below", |gpu| model_case(gpu, -35.0)),
    ]
}
