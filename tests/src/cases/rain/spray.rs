//! `shaders/wgsl/render/spray*.wgsl` against `downpour_render::rain::spray`.

use downpour_drop::spray::Spray;
use downpour_gpu::{Gpu, GpuError};
use downpour_math::packing::packing_unpack_half;
use downpour_math::rng::rng_unit;
use downpour_render::gpu::RainPipeline;
use downpour_render::plate::Lighting as _;
use downpour_render::rain::spray::{SprayMap, SprayView, spray_between, spray_border, spray_places};
use downpour_render::rain::{DropMasks, RainOptions};
use downpour_shaders::Kernel;
use downpour_shaders::render::spray::{
    SPRAY, SPRAY_BLEND_KERNEL, SPRAY_KERNEL, SPRAY_LIGHT_KERNEL, SPRAY_MAP_KERNEL,
};
use downpour_trace::gpu::ScenePipeline;
use downpour_trace::scene::SceneView;

use glam::Vec4;

use super::{ABOVE, BESIDE, INSIDE, LEVEL, Placement, Prepared, SEEN, SIZE, block_means};
use crate::Domain::{Made, Uniform};
use crate::function::Run;
use crate::kept::kept;
use crate::words::IntoWords as _;
use crate::{FunctionCase, KernelCase, Tol};

/// Part of the spray that is compared.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    Map,
    Found,
    Light,
    Seen,
    Blend,
}

/// Spray that is thick over some decimeters.
fn spray_case(gpu: &Gpu, placement: Placement, part: Part) -> Result<Run, GpuError> {
    let masks = DropMasks::trace(1.333).expect("masks");
    let spray = Some(Spray { extinction: 0.8, height_m: 0.1 });
    let options = RainOptions { spray, ..RainOptions::default() };
    let prepared = kept(&format!("spray {placement:?}"), || Prepared::new(placement, options, &masks));
    let Prepared { scene, frame, rain, capture, clean } = &*prepared;
    let view = SceneView { data: scene, frame };
    let both =
        [rain.lights(&view, &masks).expect("lamps"), rain.streak_lights(&view, &masks).expect("lamps")];
    let (scenes, rains) = (ScenePipeline::new(gpu)?, RainPipeline::new(gpu)?);
    let uploaded = scenes.upload(scene)?;
    let clean_buffer = gpu.storage_buffer("clean", clean)?;
    let plate = scenes.plate(gpu, &uploaded, frame, &rains, rain)?;
    let pass = rains.prepare(gpu, &plate.of(&clean_buffer), &rains.upload(&masks)?, rain, &both)?;
    gpu.submit(&plate.dispatches(&pass))?;
    gpu.submit(&[pass.open_air()])?;
    gpu.submit(&pass.binning().concat())?;
    gpu.submit(&[pass.lamps(), pass.streaks(), pass.medium(), pass.drops()].concat())?;
    let mut layer = pass.layer()?;
    gpu.submit(&pass.spray())?;
    let (words, found) = pass.spray_found()?;
    let spray = rain.spray.expect("spray").with_rays(view.ray_spacing());
    // What is worked out from the device's own map and findings differs by nothing else.
    let map = SprayMap { words };
    let numbers =
        |rows: &[[f32; 4]], first: usize| rows.iter().skip(first).step_by(2).copied().collect::<Vec<_>>();
    match part {
        Part::Map => {
            let own = SprayMap::new(&spray, &view);
            let some =
                |words: &[f32]| words.as_chunks::<4>().0.iter().step_by(13).copied().collect::<Vec<_>>();
            Ok(Run::of_pixels(128, &some(&own.words), &some(&map.words)))
        }
        Part::Found => {
            let own = SprayView { frame: &spray, map: &map }.found(&frame.camera, &rain.medium, clean);
            // Optical depth; light that each place takes out, and the distances.
            let of = |rows: &[[f32; 4]]| {
                let (pixels, _) = rows.as_chunks::<2>();
                let pixel = |pixel: &[[f32; 4]; 2]| {
                    let [[depth, share], [near, far]] =
                        pixel.map(|row| packing_unpack_half(row[3].to_bits()));
                    [
                        depth,
                        share * near + (1.0 - share) * far,
                        share * near * near + (1.0 - share) * far * far,
                        0.0,
                    ]
                };
                pixels.iter().map(pixel).collect::<Vec<_>>()
            };
            Ok(Run::of_pixels(SIZE[0], &of(&own), &of(&found)))
        }
        Part::Light => {
            let mut own: Vec<[f32; 4]> = found.iter().map(|row| [0.0, 0.0, 0.0, row[3]]).collect();
            rain.medium_light(&both[0]).light_spray(&mut own);
            Ok(Run::of_pixels(SIZE[0], &numbers(&own, 0), &numbers(&found, 0)))
        }
        Part::Seen => {
            let mut own: Vec<[f32; 4]> = found.iter().map(|row| [0.0, 0.0, 0.0, row[3]]).collect();
            rain.medium_light(&both[0]).light_spray(&mut own);
            // Which lamp a number draws may differ, what comes of it may not. The fourth numbers are halves.
            let lit = |rows: &[[f32; 4]]| {
                numbers(rows, 1).into_iter().map(|[r, g, b, _]| [r, g, b, 0.0]).collect::<Vec<_>>()
            };
            let blocks = |rows: &[[f32; 4]]| block_means(lit(rows).iter());
            Ok(Run::of_pixels(SIZE[0] / 16, &blocks(&own), &blocks(&found)))
        }
        Part::Blend => {
            let table = rain.streak_table(&masks, capture, &both[1].light(&rain.streak_rows()));
            rain.blend_spray(&spray, &found, (capture, &table), &mut layer);
            Ok(Run::of_pixels(SIZE[0], &layer, &pass.layer()?))
        }
    }
}

/// An optical depth, the first and the last of some distances, and moments of what is at three of them: as far apart as they are, near one
/// another, at one place, or nowhere.
fn places(random: [u32; 4]) -> Vec<u32> {
    let [first, at, apart, weight] = random.map(rng_unit);
    let (first, last) = (0.5 + 20.0 * first, 1.0 + 30.0 * apart);
    let scale = [1.0, 1.0, 1.0, 2.0e-4][random[0] as usize % 4];
    let weights = match random[1] % 16 {
        0 => [0.0; 3],
        1 => [0.0, 1.0, 0.0],
        _ => [0.2 + weight, 1.2 - weight, 0.3],
    };
    let parts = [0.0, last * scale, last * scale * (0.2 + 0.6 * at)].into_iter().zip(weights);
    let moments =
        parts.fold(Vec4::ZERO, |sum, (x, weight)| sum + weight * Vec4::new(1.0, x, x * x, x * x * x));
    let words = [weight, first, first + last].into_iter().chain(moments.to_array());
    words.map(f32::to_bits).collect()
}

/// The cases.
pub(in crate::cases) fn functions() -> Vec<FunctionCase> {
    vec![
        FunctionCase::new(
            "spray_between",
            &SPRAY,
            &[Uniform(-3.0, 9.0), Uniform(-3.0, 9.0)],
            Tol::relative(1.0e-4, 1.0e-7, "exponentials, and their difference from 1 from 0.02 on (5e-5)"),
            |a| spray_between(a.f32(), a.f32()).words(),
        ),
        // Neighboring gaps, where the series serves.
        FunctionCase::new(
            "spray_between",
            &SPRAY,
            &[Made(|r| {
                let [a, apart, ..] = r.map(rng_unit);
                vec![(3.0 * a).to_bits(), (3.0 * a + 0.02 * apart).to_bits()]
            })],
            Tol::relative(3.0e-6, 1.0e-9, "an exponential, and sums of products of what is near 1"),
            |a| spray_between(a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "spray_places",
            &SPRAY,
            &[Made(places)],
            Tol::relative(2.0e-3, 2.0e-3, "roots of differences of moments (1e-6 of them)")
                .with_outliers(5.0e-3),
            |a| {
                let [depth, first, last] = a.f32s();
                let found = spray_places(depth, first, last, Vec4::from_array(a.f32s()));
                [found.depth, found.near, found.far, found.share].words()
            },
        ),
        FunctionCase::new(
            "spray_border",
            &SPRAY,
            &[Uniform(0.0, 512.0), Uniform(-40.0, 40.0)],
            Tol::relative(1.0e-4, 1.0e-4, "a difference of numbers up to 512, over a rate")
                .with_outliers(2.0e-3),
            |a| spray_border(a.f32(), a.f32()).words(),
        ),
    ]
}

const MAPPED: Tol =
    Tol::relative(1.0e-5, 3.0e-4, "the end of a ray of 1 km; a ray at an edge may fall on either side")
        .with_outliers(2.0e-3);

const FOLLOWED: Tol = Tol::relative(
    2.0e-3,
    2.0e-4,
    "sums over hundreds of parts of exponentials, as halves; a ray in a border may be in either of two cells",
)
.with_outliers(2.0e-3);

const LIT: Tol = Tol::relative(
    3.0e-3,
    1.0e-4,
    "differences of a table between angles (atan2, 4096 ulp), and places as halves",
)
.with_outliers(2.0e-3);

const BLENDED: Tol =
    Tol::relative(2.0e-3, 1.0e-4, "means of the capture in a table, and a mean of 49 pixels")
        .with_outliers(2.0e-3);

/// The cases.
pub(in crate::cases) fn kernels() -> Vec<KernelCase> {
    let case = |name, kernel: &'static Kernel, tol, run| KernelCase {
        name,
        kernel,
        with: &[],
        overrides: &[],
        text: None,
        tol,
        run,
    };
    vec![
        case("main_spray_map: what rain hits", &SPRAY_MAP_KERNEL, MAPPED, |gpu| {
            spray_case(gpu, LEVEL, Part::Map)
        }),
        case("main_spray: level, behind a pane", &SPRAY_KERNEL, FOLLOWED, |gpu| {
            spray_case(gpu, LEVEL, Part::Found)
        }),
        case("main_spray: from above", &SPRAY_KERNEL, FOLLOWED, |gpu| spray_case(gpu, ABOVE, Part::Found)),
        case("main_spray: among drops", &SPRAY_KERNEL, FOLLOWED, |gpu| spray_case(gpu, INSIDE, Part::Found)),
        case("main_spray_light: lamps and sun", &SPRAY_LIGHT_KERNEL, LIT, |gpu| {
            spray_case(gpu, LEVEL, Part::Light)
        }),
        case("main_spray_light: many lamps", &SPRAY_LIGHT_KERNEL, LIT, |gpu| {
            spray_case(gpu, BESIDE, Part::Light)
        }),
        case("main_spray_light: shadows", &SPRAY_LIGHT_KERNEL, SEEN, |gpu| {
            spray_case(gpu, LEVEL, Part::Seen)
        }),
        case("main_spray_light: one pixel in 9 looks", &SPRAY_LIGHT_KERNEL, SEEN, |gpu| {
            spray_case(gpu, Placement { spacing: 3, ..LEVEL }, Part::Seen)
        }),
        case("main_spray_blend: one pixel in 16 looks", &SPRAY_BLEND_KERNEL, BLENDED, |gpu| {
            spray_case(gpu, Placement { spacing: 4, ..LEVEL }, Part::Blend)
        }),
        case("main_spray_blend: many lamps", &SPRAY_BLEND_KERNEL, BLENDED, |gpu| {
            spray_case(gpu, BESIDE, Part::Blend)
        }),
    ]
}
