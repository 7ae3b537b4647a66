//! `shaders/wgsl/render/host_*.wgsl` against `downpour_render::host`.

use downpour_gpu::{ComputeKernel, Gpu, GpuError, wgpu};
use downpour_math::pyramid::{PyramidRounding, pyramid};
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_render::camera::{Camera, Viewpoint};
use downpour_render::host::{
    DepthRange, HostEnvironment, HostEnvironmentFrame, HostPlateFrame, host_blend_color, host_blend_corner,
    host_environment_position, host_plate, host_plate_distance, host_radiance_checked,
};
use downpour_shaders::render::host::{
    HOST_BLEND, HOST_ENVIRONMENT, HOST_ENVIRONMENT_KERNEL, HOST_PLATE, HOST_PLATE_KERNEL, HOST_RADIANCE,
};
use glam::Vec3;
use half::f16;

use crate::Domain::{Below, Made, OneOf, Uniform, Unit3};
use crate::compare::POISON;
use crate::function::Run;
use crate::words::IntoWords as _;
use crate::{FunctionCase, KernelCase, Tol};

const SIZE: [u32; 2] = [37, 23];
const MAP: u32 = 32;
const SKY: [u32; 2] = [48, 24];

/// A camera that looks somewhere, as words.
fn camera_words(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, d] = random.map(rng_unit);
    let forward = Vec3::new(2.0 * a - 1.0, b - 0.5, -0.3 - c);
    bytemuck::cast::<Camera, [u32; 16]>(camera(forward, 0.3 + d)).to_vec()
}

fn camera(forward: Vec3, fov_y: f32) -> Camera {
    let viewpoint = Viewpoint { eye: Vec3::new(1.0, 2.0, 3.0), forward, up: Vec3::Y, fov_y };
    viewpoint.camera(SIZE, 0).expect("a camera")
}

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    vec![
        FunctionCase::new(
            "host_radiance_checked",
            &HOST_RADIANCE,
            &[
                Uniform(-1.0, 70_000.0),
                OneOf(&[-2.0, -0.0, 0.0, 1.0e-3, 65_504.0, 65_505.0, f32::INFINITY, f32::NEG_INFINITY]),
                Uniform(0.0, 1.0),
                Uniform(0.5, 2.0),
            ],
            Tol::relative(1.0e-7, 0.0, "a product, rounded once"),
            |a| host_radiance_checked(Vec3::from(a.f32s()), a.f32()).to_array().words(),
        ),
        FunctionCase::new(
            "host_plate_distance",
            &HOST_PLATE,
            &[
                OneOf(&[0.0, 1.0e-6, 1.0e-3, 0.02, 0.3, 0.999, 1.0]),
                OneOf(&[0.0, 0.01, 10.0]),
                OneOf(&[10.0, -9.0, 9.99, -5.0]),
                OneOf(&[0.0, 1.0]),
                Uniform(1.0, 1.5),
            ],
            Tol::relative(
                4.0e-6,
                0.0,
                "a division (2.5 ulp) by a sum that may be fused, a ninth of its larger term or more",
            ),
            |a| host_plate_distance(a.f32(), a.f32s(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "host_environment_position",
            &HOST_ENVIRONMENT,
            &[Made(camera_words), Unit3],
            Tol::relative(1.0e-4, 1.0e-3, "quotients (2.5 ulp) of sums of products, times pixels")
                .with_outliers(2.0e-3),
            |a| {
                let camera = bytemuck::cast::<[f32; 16], Camera>(a.f32s());
                host_environment_position(&camera, Vec3::from(a.f32s())).to_array().words()
            },
        ),
        FunctionCase::new("host_blend_corner", &HOST_BLEND, &[Below(3)], Tol::exact("small integers"), |a| {
            host_blend_corner(a.u32()).words()
        }),
        FunctionCase::new(
            "host_blend_color",
            &HOST_BLEND,
            &[Uniform(0.0, 4.0), Uniform(0.0, 4.0), Uniform(0.0, 4.0), Uniform(0.0, 1.0), Uniform(0.1, 10.0)],
            Tol::relative(1.0e-7, 0.0, "a product, rounded once"),
            |a| host_blend_color(a.f32s(), a.f32()).words(),
        ),
    ]
}

/// A texture with these bytes, `bytes` for each texel.
fn texture(
    gpu: &Gpu,
    size: [u32; 2],
    format: wgpu::TextureFormat,
    bytes: u32,
    data: &[u8],
) -> wgpu::TextureView {
    let texture = gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(size[0] * bytes),
        rows_per_image: Some(size[1]),
    };
    gpu.queue().write_texture(texture.as_image_copy(), data, layout, texture.size());
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// A texture of colors that half precision holds.
fn colors(gpu: &Gpu, size: [u32; 2], seed: u32) -> (wgpu::TextureView, Vec<[f32; 4]>) {
    let texel = |i| rng_draw([seed, 11], i, 0, 0).map(|word| f16::from_f32(8.0 * rng_unit(word) - 0.5));
    let texels: Vec<[f16; 4]> = (0..size[0] * size[1]).map(texel).collect();
    let view = texture(gpu, size, wgpu::TextureFormat::Rgba16Float, 8, bytemuck::cast_slice(&texels));
    (view, texels.iter().map(|texel| texel.map(f16::to_f32)).collect())
}

fn plate_case(gpu: &Gpu) -> Result<Run, GpuError> {
    let (color, colors) = colors(gpu, SIZE, 1);
    let words: Vec<u16> = (0..SIZE[0] * SIZE[1])
        .map(|i| if i % 7 == 0 { 0 } else { rng_draw([5, 11], i, 0, 0)[0] as u16 })
        .collect();
    let depth = texture(gpu, SIZE, wgpu::TextureFormat::Depth16Unorm, 2, bytemuck::cast_slice(&words));
    let depths: Vec<f32> = words.iter().map(|&word| f32::from(word) / 65535.0).collect();
    let range = DepthRange { near_m: 0.1, far_m: 500.0, is_reversed: true };
    let frame = HostPlateFrame {
        camera: camera(Vec3::new(0.2, -0.1, -1.0), 0.9),
        inverse: range.inverse(),
        clear: range.clear(),
        scale: 1.5,
    };
    let expected = host_plate(&frame, &colors, &depths);
    let expected = &expected[..colors.len()];
    let uniform = gpu.uniform_buffer("frame", &frame)?;
    let pixels = gpu.storage_buffer("pixels", &vec![[f32::from_bits(POISON); 4]; expected.len()])?;
    let kernel = ComputeKernel::new(gpu, &HOST_PLATE_KERNEL, &[])?;
    let bindings = kernel.bind_resources(
        gpu,
        [
            (0, uniform.as_entire_binding()),
            (1, wgpu::BindingResource::TextureView(&color)),
            (2, wgpu::BindingResource::TextureView(&depth)),
            (3, pixels.as_entire_binding()),
        ],
    )?;
    gpu.submit(&[kernel.dispatch(&bindings, [SIZE[0].div_ceil(8), SIZE[1].div_ceil(8), 1])])?;
    Ok(Run::of_pixels(SIZE[0], expected, &gpu.read(&pixels)?))
}

fn environment_case(gpu: &Gpu, with_sky: bool) -> Result<Run, GpuError> {
    let (sky, texels) = colors(gpu, SKY, 2);
    // So wide that the band in which a sky map takes over has many texels.
    let camera = camera(Vec3::new(0.3, 0.2, -1.0), 2.3);
    let frame = HostEnvironmentFrame::new(&camera, MAP, with_sky.then_some(0.5));
    let mut plate: Vec<[f32; 4]> =
        (0..SIZE[0] * SIZE[1]).map(|i| rng_draw([3, 11], i, 0, 0).map(rng_unit)).collect();
    pyramid(&mut plate, SIZE, PyramidRounding::Up);
    let expected = HostEnvironment { frame: &frame, plate: &plate, sky: (SKY, &texels) }.map();
    let uniform = gpu.uniform_buffer("frame", &frame)?;
    let pixels = gpu.storage_buffer("plate", &plate)?;
    let map = gpu.storage_buffer("map", &vec![[f32::from_bits(POISON); 4]; expected.len()])?;
    let kernel = ComputeKernel::new(gpu, &HOST_ENVIRONMENT_KERNEL, &[])?;
    let bindings = kernel.bind_resources(
        gpu,
        [
            (0, uniform.as_entire_binding()),
            (1, pixels.as_entire_binding()),
            (2, wgpu::BindingResource::TextureView(&sky)),
            (3, map.as_entire_binding()),
        ],
    )?;
    gpu.submit(&[kernel.dispatch(&bindings, [MAP.div_ceil(8), MAP.div_ceil(8), 1])])?;
    Ok(Run::of_pixels(MAP, &expected, &gpu.read(&map)?))
}

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let case =
        |name, kernel, tol, run| KernelCase { name, kernel, with: &[], overrides: &[], text: None, tol, run };
    let blended = Tol::relative(
        1.0e-3,
        1.0e-3,
        "a logarithm and quotients for a position between texels that differ by 1; a texel of the sky map may be its neighbor",
    )
    .with_outliers(5.0e-3);
    vec![
        case(
            "main_host_plate: reversed depth",
            &HOST_PLATE_KERNEL,
            Tol::relative(4.0e-6, 0.0, "a root and a division (2.5 ulp each)"),
            plate_case,
        ),
        case("main_host_environment: the picture alone", &HOST_ENVIRONMENT_KERNEL, blended, |gpu| {
            environment_case(gpu, false)
        }),
        case("main_host_environment: with a sky map", &HOST_ENVIRONMENT_KERNEL, blended, |gpu| {
            environment_case(gpu, true)
        }),
    ]
}
