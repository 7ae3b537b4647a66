//! Rain in the frames of a host application, against the same passes on the CPU.

#![cfg(feature = "wgpu")]

mod device;
mod host;

use downpour::gpu::{Gpu, LimitSet, wgpu};
use downpour::rain::{
    AlphaHoles, DepthRange, HostSky, ObstacleMesh, PlateTextures, Rain, RainError, RainSettings, RainView,
};
use downpour::render::camera::{EyeMotion, Viewpoint};
use downpour::render::light::LightSource;
use downpour::trace::data::SceneData;
use downpour::weather::{Look, Spray};
use glam::Vec3;
use host::{Host, NEAR_M, SKY, WALL, ground, mean, settings, view};

const SIZE: [u32; 2] = [160, 90];

/// A device with WebGPU's default limits; `None` if tests on a GPU were declined.
fn device() -> Option<Gpu> {
    device::gpu(LimitSet::WebGpuDefault)
}

/// The same passes on the CPU, from colors, depths and obstacles that the test knows.
fn expected(rain: &Rain, view: &RainView, wall_m: f32, obstacles: &[[[f32; 3]; 3]]) -> Vec<[f32; 4]> {
    use downpour::trace::builder::{MeshPart, SceneBuilder};
    use downpour::trace::sky_light::SkyLight;

    let mut builder = SceneBuilder::new();
    let corners: Vec<[f32; 3]> = obstacles.iter().flatten().copied().collect();
    let indices: Vec<u32> = (0..corners.len() as u32).collect();
    builder.add_mesh(&MeshPart::plain(&corners, &indices, 0), &glam::Affine3A::IDENTITY);
    expected_among(rain, view, wall_m, &builder.build(&SkyLight::uniform([0.0; 3])), None)
}

/// A sky map: columns and rows, texels, and radiance of the color 1.
type Sky<'a> = ([u32; 2], &'a [[f32; 4]], f32);

/// The same among the obstacles of a scene, under a sky map.
fn expected_among(
    rain: &Rain,
    view: &RainView,
    wall_m: f32,
    scene: &SceneData,
    sky: Option<Sky<'_>>,
) -> Vec<[f32; 4]> {
    use downpour::drop::oscillation::{Amplitudes, Fluids};
    use downpour::drop::splash::SplashLaw;
    use downpour::drop::spray::Spray;
    use downpour::render::host::{HostEnvironment, HostEnvironmentFrame, HostPlateFrame, host_plate};
    use downpour::render::picture::compose_pixel;
    use downpour::render::rain::{
        DropMasks, EnvironmentMap, Exposure, MediumGrain, MediumOptions, Rain as PictureRain,
    };
    use downpour::render::rain::{RainMedium, RainOptions};
    use downpour::render::{Plate, rain_layer};
    use downpour::trace::{data::RenderFrame, scene::SceneView};

    let settings = rain.settings();
    let index = downpour::drop::optics::water_index_in_air(589.3e-9, &settings.air).expect("it is possible");
    let masks = DropMasks::trace(index).and_then(|masks| masks.with_splashes(index)).expect("it is possible");
    let sizes = downpour::drop::distribution::DropSizeDistribution::new(settings.sizes, settings.rate_mm_h)
        .expect("it is possible");
    let visible = rain.drops(view, SIZE).expect("it is possible");
    let speed = downpour::drop::fall_speed::TerminalSpeed::new(sizes.options().fall_speed, &settings.air);
    let fall = speed.at(sizes.effective_diameter()).expect("it is possible");
    let medium = MediumOptions {
        velocity: Vec3::new(0.0, -fall as f32, 0.0),
        grain: MediumGrain::Streaks,
        ..MediumOptions::default()
    };
    let options = RainOptions {
        medium: RainMedium::new(&sizes, &visible.resolved, &masks, &medium).expect("it is possible"),
        exposure: Exposure {
            shutter_s: view.shutter_s,
            time_s: view.time_s,
            oscillation: Amplitudes::GARG_NAYAR_EVEN,
            fluids: Fluids::in_air(&settings.air),
            seed: settings.seed,
            ..Exposure::default()
        },
        spray: settings.spray.is_enabled.then(|| {
            let law = SplashLaw::new(settings.splashes.film_m, settings.air.temperature_c())
                .expect("it is possible");
            let (droplet, height) = (settings.spray.droplet_m, settings.spray.height_m);
            let mut spray = Spray::of_rain(&sizes, &law, droplet, height).expect("it is possible");
            spray.extinction *= settings.look.spray;
            spray
        }),
        ..RainOptions::default()
    };
    let camera = view.camera.camera(SIZE, 0).expect("it is possible");
    let range = DepthRange::reversed(NEAR_M);
    let frame = HostPlateFrame { camera, inverse: range.inverse(), clear: range.clear(), scale: 1.0 };
    let is_wall = |i: u32| wall_m.is_finite() && i / SIZE[0] >= SIZE[1] / 2;
    let color: Vec<[f32; 4]> =
        (0..SIZE[0] * SIZE[1]).map(|i| [if is_wall(i) { WALL } else { SKY } as f32; 4]).collect();
    let depth: Vec<f32> =
        (0..SIZE[0] * SIZE[1]).map(|i| if is_wall(i) { NEAR_M / wall_m } else { 0.0 }).collect();
    let pixels = host_plate(&frame, &color, &depth);
    let picture = PictureRain::new(&camera, view.camera.eye.as_dvec3(), &visible.drops, &masks, &options);
    let map = HostEnvironmentFrame::new(&camera, picture.environment.size, sky.map(|(.., scale)| scale));
    let sky = sky.map_or(([1, 1], &[[0.0; 4]][..]), |(size, texels, _)| (size, texels));
    let finest = HostEnvironment { frame: &map, plate: &pixels, sky }.map();
    let environment = EnvironmentMap::new(&picture.environment, finest);
    let of_scene = RenderFrame::new(scene, &view.camera, SIZE, 1, 0, 0).expect("it is possible");
    let lighting = SceneView { data: scene, frame: &of_scene };
    let clean = &pixels[..(SIZE[0] * SIZE[1]) as usize];
    let plate = Plate { camera: &camera, pixels: clean, environment: &environment, lighting: &lighting };
    let layer = rain_layer(&plate, &picture, &masks, &mut Vec::new()).expect("it is possible");
    clean.iter().zip(&layer).map(|(&plate, &rain)| compose_pixel(plate, rain)).collect()
}

#[test]
fn a_frame_is_that_of_the_cpu() {
    let Some(gpu) = device() else { return };
    let mut rain = Rain::new(gpu.device(), gpu.queue(), settings()).unwrap();
    let host = Host::new(&gpu, SIZE, wgpu::TextureFormat::Rgba16Float);
    let (view, wall_m) = (view(), 6.0);
    let made = host.rain(&mut rain, &view, wall_m, &[]).unwrap();
    let expected = expected(&rain, &view, wall_m, &[]);
    let plate = |i: usize| if i as u32 / SIZE[0] >= SIZE[1] / 2 { WALL } else { SKY } as f32;
    let (mut off, mut rainy) = (0, 0);
    for (i, (made, expected)) in made.iter().zip(&expected).enumerate() {
        rainy += usize::from((expected[0] - plate(i)).abs() > 0.02);
        // Half precision has 11 bits; a sample of a streak's outline may fall on either side.
        off += usize::from((0..3).any(|k| (made[k] - expected[k]).abs() > 4.0e-3));
    }
    let pixels = made.len();
    assert!(rainy > pixels / 50, "{rainy} of {pixels} pixels show drops");
    assert!(off < pixels / 200, "{off} of {pixels} pixels differ");
    assert!((mean(&made) / mean(&expected) - 1.0).abs() < 1.0e-3, "{} {}", mean(&made), mean(&expected));
    // The control: other drops are another picture.
    let other = host.rain(&mut rain, &RainView { time_s: 3.5, ..view }, wall_m, &[]).unwrap();
    let differ = other.iter().zip(&expected).filter(|(a, b)| (a[0] - b[0]).abs() > 4.0e-3).count();
    assert!(differ > pixels / 50, "{differ} of {pixels} pixels differ at another time");
}

/// Drops show the host's sky map where they refract or reflect what is beyond the picture, as on the CPU.
#[test]
fn drops_show_the_sky_map() {
    use downpour::trace::{builder::SceneBuilder, sky_light::SkyLight};

    let Some(gpu) = device() else { return };
    let mut rain = Rain::new(gpu.device(), gpu.queue(), settings()).unwrap();
    let host = Host::new(&gpu, SIZE, wgpu::TextureFormat::Rgba16Float);
    // Bright and red to the right of the camera, blue to its left, dark below. Odd numbers keep the edges of texels off the axes, where
    // either side is right.
    let ([columns, rows], scale) = ([7u32, 5u32], 4.0);
    let bytes: Vec<[u8; 4]> = (0..columns * rows)
        .map(|i| match (i % columns, i / columns) {
            (_, 4) => [10, 10, 10, 255],
            (2..=4, _) => [240, 60, 30, 255],
            _ => [20, 40, 250, 255],
        })
        .collect();
    let extent = wgpu::Extent3d { width: columns, height: rows, depth_or_array_layers: 1 };
    let map = gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: extent,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    gpu.queue().write_texture(
        map.as_image_copy(),
        bytes.as_flattened(),
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * columns), rows_per_image: None },
        extent,
    );
    let map = map.create_view(&wgpu::TextureViewDescriptor::default());
    let sky = HostSky { view: &map, radiance_scale: scale };
    let made = host.rain_under(&mut rain, &view(), 6.0, &[], Some(sky)).unwrap();
    let texels: Vec<[f32; 4]> = bytes.iter().map(|texel| texel.map(|byte| f32::from(byte) / 255.0)).collect();
    let scene = SceneBuilder::new().build(&SkyLight::uniform([0.0; 3]));
    let expected = expected_among(&rain, &view(), 6.0, &scene, Some(([columns, rows], &texels, scale)));
    let differ = |a: &[[f32; 4]], b: &[[f32; 4]]| {
        a.iter().zip(b).filter(|(a, b)| (0..3).any(|k| (a[k] - b[k]).abs() > 8.0e-3)).count()
    };
    let off = differ(&made, &expected);
    assert!(off < made.len() / 100, "{off} of {} pixels differ", made.len());
    assert!((mean(&made) / mean(&expected) - 1.0).abs() < 2.0e-3, "{} {}", mean(&made), mean(&expected));
    // The control: without the map drops show the borders of the picture.
    let without = host.rain(&mut rain, &view(), 6.0, &[]).unwrap();
    assert!(differ(&without, &expected) > 5 * off.max(20), "{}", differ(&without, &expected));
}

#[test]
fn frames_repeat_to_the_bit_and_make_no_buffers() {
    let Some(gpu) = device() else { return };
    let mut rain = Rain::new(gpu.device(), gpu.queue(), settings()).unwrap();
    let host = Host::new(&gpu, SIZE, wgpu::TextureFormat::Rgba16Float);
    let lamp = LightSource::Point {
        radius: 0.0,
        position: Vec3::new(1.0, 3.0, -8.0),
        intensity: Vec3::splat(60.0),
        range: 0.0,
    };
    let first = host.rain(&mut rain, &view(), 6.0, &[lamp]).unwrap();
    let made = |rain: &mut Rain, time_s| {
        let mut encoder = gpu.device().create_command_encoder(&Default::default());
        host.draw(&mut encoder, 6.0);
        let (color, depth) =
            (host.color.create_view(&Default::default()), host.depth.create_view(&Default::default()));
        let lights = [lamp];
        let textures = PlateTextures { lights: &lights, ..PlateTextures::new(&color, &depth, NEAR_M) };
        let stats = rain.render(&mut encoder, &RainView { time_s, ..view() }, &textures).unwrap();
        gpu.queue().submit([encoder.finish()]);
        stats
    };
    let begun = made(&mut rain, 3.0).buffers_made;
    for k in 0..6 {
        let stats = made(&mut rain, 3.0 + f64::from(k) / 60.0);
        assert!(stats.room > 100 && stats.columns > 100, "{stats:?}");
        assert_eq!(stats.buffers_made, begun, "frame {k}");
        assert!(stats.bytes_uploaded < 64 << 10, "{} bytes", stats.bytes_uploaded);
    }
    for _ in 0..3 {
        assert!(host.rain(&mut rain, &view(), 6.0, &[lamp]).unwrap() == first, "a frame differs from itself");
    }
    // With splashes and droplets as well: from second to second a slice of time more or less is searched.
    rain.set_obstacles(&ground()).unwrap();
    let begun = [3.0, 3.03].map(|time_s| made(&mut rain, time_s).buffers_made)[1];
    for k in 0..6 {
        let stats = made(&mut rain, 3.0 + f64::from(k) / 60.0);
        assert!(stats.has_splashes && stats.has_droplets && stats.buffers_made == begun, "{stats:?}");
        assert!(stats.bytes_uploaded < 64 << 10, "{} bytes", stats.bytes_uploaded);
    }
    rain.set_obstacles(&[]).unwrap();
    // Two rains on one device, and another size.
    let mut other = Rain::new(gpu.device(), gpu.queue(), settings()).unwrap();
    let small = Host::new(&gpu, [96, 64], wgpu::TextureFormat::Rgba16Float);
    let alone = small.rain(&mut other, &view(), 6.0, &[lamp]).unwrap();
    assert!(small.rain(&mut rain, &view(), 6.0, &[lamp]).unwrap() == alone);
    assert!(host.rain(&mut rain, &view(), 6.0, &[lamp]).unwrap() == first);
    // A lamp lights the rain.
    let dark = host.rain(&mut rain, &view(), 6.0, &[]).unwrap();
    assert!(mean(&first) > 1.01 * mean(&dark), "{} {}", mean(&first), mean(&dark));
}

#[test]
fn depth_hides_rain_and_a_roof_stops_it() {
    let Some(gpu) = device() else { return };
    let mut rain = Rain::new(gpu.device(), gpu.queue(), settings()).unwrap();
    let host = Host::new(&gpu, SIZE, wgpu::TextureFormat::Rgba16Float);
    let below = |pixels: &[[f32; 4]]| pixels[pixels.len() / 2..].to_vec();
    let changed =
        |pixels: &[[f32; 4]]| below(pixels).iter().filter(|p| (p[0] - WALL as f32).abs() > 4.0e-3).count();
    let far = host.rain(&mut rain, &view(), 20.0, &[]).unwrap();
    let near = host.rain(&mut rain, &view(), 0.12, &[]).unwrap();
    assert!(changed(&far) > 500, "{}", changed(&far));
    assert!(changed(&near) < changed(&far) / 20, "{} of {}", changed(&near), changed(&far));
    let [a, b, c, d] = [[-60.0, 3.0, -60.0], [60.0, 3.0, -60.0], [60.0, 3.0, 60.0], [-60.0, 3.0, 60.0]];
    rain.set_obstacles(&[[a, b, c], [a, c, d]]).unwrap();
    assert_eq!(
        rain.drops(&view(), SIZE).unwrap().drops.iter().filter(|drop| drop.position.y < 2.99).count(),
        0
    );
    rain.set_obstacles(&[]).unwrap();
    assert!(host.rain(&mut rain, &view(), 20.0, &[]).unwrap() == far);
    rain.set_settings(RainSettings { rate_mm_h: 0.0, ..settings() }).unwrap();
    let dry = host.rain(&mut rain, &view(), 20.0, &[]).unwrap();
    assert_eq!(changed(&dry), 0);
}

/// Drops and light go through the holes of a canopy, drops splash on what is between, and the device agrees with the CPU.
#[test]
fn drops_fall_through_the_holes_of_obstacles() {
    use downpour::shaders::render::scene::SCENE_MASKED;
    use downpour::sim::field::DropKind;
    use downpour::trace::builder::{MeshPart, SceneBuilder};
    use downpour::trace::material::{MaterialLook, TextureUse};
    use downpour::trace::sky_light::SkyLight;

    let Some(gpu) = device() else { return };
    let mut rain = Rain::new(gpu.device(), gpu.queue(), settings()).unwrap();
    let host = Host::new(&gpu, SIZE, wgpu::TextureFormat::Rgba16Float);
    // Stripes along z of half a meter each, of which every other is a hole; below them the ground.
    let corners = [[-40.0, 0.6, -40.0], [-40.0, 0.6, 40.0], [40.0, 0.6, 40.0], [40.0, 0.6, -40.0]];
    let coordinates = [[0.0, 0.0], [0.0, 1.0], [80.0, 1.0], [80.0, 0.0]];
    fn two<T: Copy>([a, b, c, d]: [T; 4]) -> [[T; 3]; 2] {
        [[a, b, c], [a, c, d]]
    }
    let (canopy, uvs, alpha) = (two(corners), two(coordinates), [255, 255, 255, 255, 0, 0, 0, 0]);
    let holes = AlphaHoles { uvs: &uvs, size: [8, 1], alpha: &alpha, cutoff: 0.5 };
    let ground = ground();
    let meshes = [ObstacleMesh::solid(&ground), ObstacleMesh { triangles: &canopy, holes: Some(holes) }];
    rain.set_obstacle_meshes(&meshes).unwrap();
    let eye = Vec3::new(0.5, 0.25, -2.0);
    let view = RainView { camera: Viewpoint { eye, ..view().camera }, ..view() };
    let drops = rain.drops(&view, SIZE).unwrap().drops;
    // No wind: what is below the canopy has fallen straight through. Midway between texels it is either.
    let is_below_hole = |x: f64| (0.5 - 1.0e-3..1.0 + 1.0e-3).contains(&((x + 40.0).rem_euclid(1.0)));
    let below: Vec<_> = drops
        .iter()
        .filter(|drop| drop.position.y < 0.55 && matches!(drop.kind, DropKind::Falling | DropKind::Splash))
        .collect();
    assert!(below.len() > 50 && below.iter().all(|drop| is_below_hole(drop.position.x)), "{}", below.len());
    let (made, wall_m) = (host.rain(&mut rain, &view, 6.0, &[]).unwrap(), 6.0);
    let mut builder = SceneBuilder::new();
    let texels: Vec<[u8; 4]> = alpha.iter().map(|&alpha| [255, 255, 255, alpha]).collect();
    let slot = builder.texture(8, 1, &texels, TextureUse::Data);
    let slot = builder.add_slot(slot);
    let whole = builder.add_material(MaterialLook::default());
    let maps = [Some(slot), None, None, None, None, None, None, None];
    let cut = builder.add_material(MaterialLook { flags: SCENE_MASKED, maps, ..MaterialLook::default() });
    let order = [0, 1, 2, 0, 2, 3];
    let [a, b, c, d] = [ground[0][0], ground[0][1], ground[0][2], ground[1][2]];
    builder.add_mesh(&MeshPart::plain(&[a, b, c, d], &order, whole), &glam::Affine3A::IDENTITY);
    let part = MeshPart { uvs: [Some(&coordinates), None], ..MeshPart::plain(&corners, &order, cut) };
    builder.add_mesh(&part, &glam::Affine3A::IDENTITY);
    let expected = expected_among(&rain, &view, wall_m, &builder.build(&SkyLight::uniform([0.0; 3])), None);
    let differ = |a: &[[f32; 4]], b: &[[f32; 4]]| {
        a.iter().zip(b).filter(|(a, b)| (0..3).any(|k| (a[k] - b[k]).abs() > 4.0e-3)).count()
    };
    let off = differ(&made, &expected);
    assert!(off < made.len() / 200, "{off} of {} pixels differ", made.len());
    // The controls: no holes, and no canopy.
    for other in [&[ObstacleMesh::solid(&ground), ObstacleMesh::solid(&canopy)][..], &meshes[..1]] {
        rain.set_obstacle_meshes(other).unwrap();
        let without = host.rain(&mut rain, &view, wall_m, &[]).unwrap();
        assert!(differ(&without, &expected) > 5 * off.max(20), "{}", differ(&without, &expected));
    }
    for (holes, text) in [
        (AlphaHoles { size: [8, 0], ..holes }, "has 8 x 0 texels; allowed: 1 to 8192 each"),
        (AlphaHoles { size: [4, 1], ..holes }, "has 8 values; allowed: 4, for 4 x 1 texels"),
        (
            AlphaHoles { uvs: &uvs[..1], ..holes },
            "has coordinates of 1 triangles; allowed: those of the 2 triangles",
        ),
        (AlphaHoles { cutoff: f32::NAN, ..holes }, "alpha cutoff of obstacles is NaN; allowed: 0 to 1"),
    ] {
        let mesh = ObstacleMesh { triangles: &canopy, holes: Some(holes) };
        let error = rain.set_obstacle_meshes(&[mesh]).unwrap_err().to_string();
        assert!(error.contains(text), "{error}");
    }
}

/// Spray stands over obstacles, as on the CPU, and makes no buffer after the first frame.
#[test]
fn spray_stands_over_obstacles() {
    let Some(gpu) = device() else { return };
    let spray = Spray { is_enabled: true, height_m: 0.3, ..Spray::default() };
    let wet = RainSettings { spray, look: Look { spray: 4.0, ..Look::PHYSICAL }, ..settings() };
    let mut rain = Rain::new(gpu.device(), gpu.queue(), wet).unwrap();
    let host = Host::new(&gpu, SIZE, wgpu::TextureFormat::Rgba16Float);
    let lamp = [LightSource::Point {
        radius: 0.0,
        position: Vec3::new(1.0, 3.0, -8.0),
        intensity: Vec3::splat(60.0),
        range: 0.0,
    }];
    rain.set_obstacles(&ground()).unwrap();
    let made = host.rain(&mut rain, &view(), 6.0, &[]).unwrap();
    let expected = expected(&rain, &view(), 6.0, &ground());
    assert!((mean(&made) / mean(&expected) - 1.0).abs() < 2.0e-3, "{} {}", mean(&made), mean(&expected));
    let lit = host.rain(&mut rain, &view(), 6.0, &lamp).unwrap();
    rain.set_settings(settings()).unwrap();
    let without = host.rain(&mut rain, &view(), 6.0, &[]).unwrap();
    let lit_without = host.rain(&mut rain, &view(), 6.0, &lamp).unwrap();
    // The ground's mist hides the wall, and is seen in the lamp's light.
    let changed = made.iter().zip(&without).filter(|(a, b)| (a[0] - b[0]).abs() > 4.0e-3).count();
    assert!(changed > made.len() / 20, "{changed} pixels differ");
    let more = (mean(&lit) - mean(&made)) / (mean(&lit_without) - mean(&without));
    assert!(more > 1.05, "{more}");
    // Without obstacles there is none.
    rain.set_obstacles(&[]).unwrap();
    let dry = host.rain(&mut rain, &view(), 6.0, &[]).unwrap();
    rain.set_settings(RainSettings { spray, ..settings() }).unwrap();
    assert!(host.rain(&mut rain, &view(), 6.0, &[]).unwrap() == dry);
}

#[test]
fn drops_splash_on_obstacles_and_droplets_rebound() {
    use downpour::sim::field::DropKind;
    use downpour::sim::simulation::Bounce;
    use downpour::weather::Splashes;

    let Some(gpu) = device() else { return };
    let bounce = Bounce { fraction: 1.0, size: 1.0, ..Bounce::default() };
    let wet = RainSettings { bounce, ..settings() };
    let mut rain = Rain::new(gpu.device(), gpu.queue(), wet.clone()).unwrap();
    let host = Host::new(&gpu, SIZE, wgpu::TextureFormat::Rgba16Float);
    // Close above the ground.
    let eye = Vec3::new(0.5, 0.25, -2.0);
    let view = RainView { camera: Viewpoint { eye, ..view().camera }, ..view() };
    rain.set_obstacles(&ground()).unwrap();
    let wall_m = 6.0;
    let made = host.rain(&mut rain, &view, wall_m, &[]).unwrap();
    let drops = rain.drops(&view, SIZE).unwrap().drops;
    let count = |kind| drops.iter().filter(|drop| drop.kind == kind).count();
    let (crowns, droplets) = (count(DropKind::Splash), count(DropKind::Bounced));
    assert!(crowns > 5 && droplets > 5, "{crowns} crowns, {droplets} droplets");
    let expected = expected(&rain, &view, wall_m, &ground());
    let differ = |a: &[[f32; 4]], b: &[[f32; 4]]| {
        a.iter().zip(b).filter(|(a, b)| (0..3).any(|k| (a[k] - b[k]).abs() > 4.0e-3)).count()
    };
    let off = differ(&made, &expected);
    assert!(off < made.len() / 200, "{off} of {} pixels differ", made.len());
    assert!((mean(&made) / mean(&expected) - 1.0).abs() < 1.0e-3, "{} {}", mean(&made), mean(&expected));
    // The control: without either it is another picture.
    let splashes = Splashes { is_enabled: false, ..Splashes::default() };
    let dull = RainSettings { splashes, bounce: Bounce { fraction: 0.0, ..bounce }, ..wet.clone() };
    rain.set_settings(dull.clone()).unwrap();
    let without = host.rain(&mut rain, &view, wall_m, &[]).unwrap();
    assert!(differ(&without, &expected) > 5 * off.max(20), "{}", differ(&without, &expected));
    // Splashes that come later look as those that were there at first.
    let mut later = Rain::new(gpu.device(), gpu.queue(), dull).unwrap();
    later.set_obstacles(&ground()).unwrap();
    assert!(host.rain(&mut later, &view, wall_m, &[]).unwrap() == without);
    later.set_settings(wet).unwrap();
    assert!(host.rain(&mut later, &view, wall_m, &[]).unwrap() == made);
    for (bad, text) in [
        (Splashes { size: 20.0, ..splashes }, "size of splashes is 20; allowed: 0.1 to 10"),
        (Splashes { film_m: 0.1, is_enabled: true, ..splashes }, "film of water is 100 mm"),
    ] {
        let error = rain.set_settings(RainSettings { splashes: bad, ..settings() }).unwrap_err().to_string();
        assert!(error.contains(text), "{error}");
    }
    let bad = RainSettings { bounce: Bounce { max_time_s: f32::NAN, ..bounce }, ..settings() };
    assert!(rain.set_settings(bad).unwrap_err().to_string().contains("time of droplets that rebound is NaN"));
}

#[test]
fn few_pixels_find_the_light_of_lamps_for_all() {
    let Some(gpu) = device() else { return };
    let host = Host::new(&gpu, SIZE, wgpu::TextureFormat::Rgba16Float);
    let lamp = |x: f32, y: f32, z: f32| LightSource::Point {
        radius: 0.0,
        position: Vec3::new(x, y, z),
        intensity: Vec3::splat(2.0e4),
        range: 0.0,
    };
    let lamps = [lamp(1.0, 3.0, -8.0), lamp(-6.0, 5.0, -30.0)];
    let mut rain = Rain::new(gpu.device(), gpu.queue(), settings()).unwrap();
    let dark = mean(&host.rain(&mut rain, &view(), f32::INFINITY, &[]).unwrap());
    let mut drawn = |ray_spacing| {
        rain.set_settings(RainSettings { ray_spacing, ..settings() }).unwrap();
        host.rain(&mut rain, &view(), f32::INFINITY, &lamps).unwrap()
    };
    let all = drawn(1);
    assert!(mean(&all) > 1.05 * dark, "{} {dark}", mean(&all));
    for spacing in [2, 4] {
        let few = drawn(spacing);
        assert!(few != all, "{spacing}");
        let part = (mean(&few) - dark) / (mean(&all) - dark);
        assert!((part - 1.0).abs() < 0.01, "{spacing}: {part}");
    }
}

/// Rain that is twice as visible before a lamp adds twice the light, longer streaks add as much, and rain of visibility 0 adds none.
#[test]
fn a_host_makes_rain_more_visible() {
    let Some(gpu) = device() else { return };
    let host = Host::new(&gpu, SIZE, wgpu::TextureFormat::Rgba16Float);
    let lamp = LightSource::Point {
        radius: 0.0,
        position: Vec3::new(1.0, 3.0, -8.0),
        intensity: Vec3::splat(2.0e4),
        range: 0.0,
    };
    let some = || RainSettings { rate_mm_h: 20.0, ..settings() };
    let mut rain = Rain::new(gpu.device(), gpu.queue(), RainSettings { rate_mm_h: 0.0, ..some() }).unwrap();
    let dry = host.rain(&mut rain, &view(), f32::INFINITY, &[lamp]).unwrap();
    let mut drawn = |visibility, streak_length| {
        rain.set_settings(RainSettings {
            look: Look { visibility, streak_length, ..Look::PHYSICAL },
            ..some()
        })
        .unwrap();
        host.rain(&mut rain, &view(), f32::INFINITY, &[lamp]).unwrap()
    };
    assert!(drawn(0.0, 1.0) == dry);
    let [one, two, long] = [(1.0, 1.0), (2.0, 1.0), (1.0, 3.0)]
        .map(|(visibility, length)| mean(&drawn(visibility, length)) - mean(&dry));
    println!("{one}, {two}, {long}");
    assert!(one > 0.0 && (two / one - 2.0).abs() < 0.1, "{one}, {two}");
    assert!((long / one - 1.0).abs() < 0.1, "{one}, {long}");
}

#[test]
fn bad_input_is_an_error_and_leaves_the_rain_as_it_was() {
    let Some(gpu) = device() else { return };
    let refused =
        |settings| Rain::new(gpu.device(), gpu.queue(), settings).map(|_| ()).unwrap_err().to_string();
    assert_eq!(
        refused(RainSettings { rate_mm_h: 501.0, ..settings() }),
        "rain rate is 501 mm/h; allowed: 0 to 500"
    );
    assert!(refused(RainSettings { rate_mm_h: f64::NAN, ..settings() }).contains("rain rate is NaN"));
    assert!(refused(RainSettings { max_drops: 0, ..settings() }).contains("most drops is 0"));
    assert_eq!(
        refused(RainSettings { ray_spacing: 5, ..settings() }),
        "spacing of rays is 5; allowed: 1 to 4"
    );
    for look in [
        Look { visibility: 21.0, ..Look::PHYSICAL },
        Look { streak_length: f64::NAN, ..Look::PHYSICAL },
        Look { spray: -1.0, ..Look::PHYSICAL },
    ] {
        assert!(refused(RainSettings { look, ..settings() }).contains("allowed: 0 to 20"));
    }
    let mut rain = Rain::new(gpu.device(), gpu.queue(), settings()).unwrap();
    let host = Host::new(&gpu, SIZE, wgpu::TextureFormat::Rgba16Float);
    let first = host.rain(&mut rain, &view(), 6.0, &[]).unwrap();
    for (bad, text) in [
        (RainView { time_s: f64::NAN, ..view() }, "time is NaN s"),
        (RainView { shutter_s: 2.0, ..view() }, "exposure time is 2 s"),
        (RainView { camera: Viewpoint { fov_y: 0.0, ..view().camera }, ..view() }, "field of view is 0"),
        (
            RainView { camera: Viewpoint { fov_y: f32::NAN, ..view().camera }, ..view() },
            "field of view is NaN",
        ),
        (
            RainView { camera: Viewpoint { eye: Vec3::new(0.0, f32::NAN, 0.0), ..view().camera }, ..view() },
            "camera is NaN",
        ),
        (
            RainView { camera: Viewpoint { up: Vec3::splat(f32::INFINITY), ..view().camera }, ..view() },
            "camera is NaN",
        ),
        (
            RainView { camera: Viewpoint { eye: Vec3::splat(2.0e7), ..view().camera }, ..view() },
            "position of the eye is 20000000 m",
        ),
        (
            RainView {
                motion: EyeMotion { velocity: Vec3::splat(f32::NAN), ..EyeMotion::default() },
                ..view()
            },
            "velocity of the camera is NaN",
        ),
        (RainView { camera: Viewpoint { forward: Vec3::ZERO, ..view().camera }, ..view() }, "view direction"),
    ] {
        let error = host.rain(&mut rain, &bad, 6.0, &[]).unwrap_err().to_string();
        assert!(error.contains(text), "{error}");
    }
    let render = |rain: &mut Rain, textures: &PlateTextures<'_>| {
        let mut encoder = gpu.device().create_command_encoder(&Default::default());
        rain.render(&mut encoder, &view(), textures).map(|_| ()).unwrap_err().to_string()
    };
    let views =
        |host: &Host| [&host.color, &host.depth].map(|texture| texture.create_view(&Default::default()));
    let [color, depth] = views(&host);
    let [_, small] = views(&Host::new(&gpu, [64, 64], wgpu::TextureFormat::Rgba16Float));
    let [float, deep] = views(&Host::new(&gpu, SIZE, wgpu::TextureFormat::R32Float));
    assert_eq!(
        render(&mut rain, &PlateTextures::new(&color, &small, NEAR_M)),
        "the depth texture has 64 x 64 pixels; allowed: the size of the color texture, 160 x 90"
    );
    let error = render(&mut rain, &PlateTextures::new(&float, &deep, NEAR_M));
    assert!(error.contains("format R32Float") && error.contains("Rgba16Float"), "{error}");
    let error = render(&mut rain, &PlateTextures::new(&color, &depth, 0.0));
    assert!(error.contains("near plane is 0 m"), "{error}");
    let range = DepthRange::standard(1.0, 0.5);
    let textures = PlateTextures { depth_range: range, ..PlateTextures::new(&color, &depth, NEAR_M) };
    assert!(render(&mut rain, &textures).contains("far plane is 0.5 m"));
    let textures = PlateTextures { radiance_scale: f32::NAN, ..PlateTextures::new(&color, &depth, NEAR_M) };
    assert!(render(&mut rain, &textures).contains("radiance of the color 1 is NaN"));
    let refused = rain.set_settings(RainSettings { far_m: 0.0, ..settings() }).unwrap_err().to_string();
    assert!(refused.contains("largest distance of drops is 0 m"), "{refused}");
    assert!(host.rain(&mut rain, &view(), 6.0, &[]).unwrap() == first);
}

#[test]
fn a_color_texture_of_8_bits_is_rained_on_in_linear_light() {
    let Some(gpu) = device() else { return };
    let mut rain = Rain::new(gpu.device(), gpu.queue(), settings()).unwrap();
    let host = Host::new(&gpu, SIZE, wgpu::TextureFormat::Rgba8UnormSrgb);
    let mut encoder = gpu.device().create_command_encoder(&Default::default());
    host.draw(&mut encoder, 6.0);
    let (color, depth) =
        (host.color.create_view(&Default::default()), host.depth.create_view(&Default::default()));
    rain.render(&mut encoder, &view(), &PlateTextures::new(&color, &depth, NEAR_M)).unwrap();
    let row = (SIZE[0] * 4).next_multiple_of(256);
    let buffer = gpu.empty_buffer("picture", u64::from(row * SIZE[1]), wgpu::BufferUsages::empty()).unwrap();
    encoder.copy_texture_to_buffer(
        host.color.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None },
        },
        host.color.size(),
    );
    gpu.queue().submit([encoder.finish()]);
    let bytes: Vec<u8> = gpu.read(&buffer).unwrap();
    let expected = expected(&rain, &view(), 6.0, &[]);
    let encode = |v: f32| {
        let v = v.clamp(0.0, 1.0);
        255.0
            * if v <= 0.003_130_8 {
                12.92 * v
            } else {
                1.055 * downpour::math::ops::pow(v, 1.0 / 2.4) - 0.055
            }
    };
    let off = expected
        .iter()
        .enumerate()
        .filter(|(i, pixel)| {
            let (x, y) = (*i as u32 % SIZE[0], *i as u32 / SIZE[0]);
            let made = bytes[(y * row + 4 * x) as usize];
            (f32::from(made) - encode(pixel[0])).abs() > 2.5
        })
        .count();
    assert!(off < expected.len() / 100, "{off} pixels differ");
}

#[test]
fn a_lost_device_is_an_error() {
    let Some(gpu) = device() else { return };
    let mut rain = Rain::new(gpu.device(), gpu.queue(), settings()).unwrap();
    let host = Host::new(&gpu, SIZE, wgpu::TextureFormat::Rgba16Float);
    let (color, depth) =
        (host.color.create_view(&Default::default()), host.depth.create_view(&Default::default()));
    gpu.device().destroy();
    let mut encoder = gpu.device().create_command_encoder(&Default::default());
    let error = rain.render(&mut encoder, &view(), &PlateTextures::new(&color, &depth, NEAR_M));
    let error = error.map(|_| ()).unwrap_err();
    assert!(matches!(error, RainError::Gpu(_)), "{error}");
}

#[test]
fn what_is_too_much_is_an_error_or_drawn_as_what_is_not_resolved() {
    let Some(gpu) = device() else { return };
    let mut rain = Rain::new(gpu.device(), gpu.queue(), settings()).unwrap();
    let error = rain.set_obstacles(&vec![[[0.0; 3]; 3]; 10_000_000]).map(|_| ()).unwrap_err();
    assert_eq!(error.to_string(), "10000000 triangles; allowed: up to 4194304");
    let lamp = LightSource::Point { radius: 0.0, position: Vec3::ZERO, intensity: Vec3::ONE, range: 0.0 };
    let host = Host::new(&gpu, SIZE, wgpu::TextureFormat::Rgba16Float);
    let error = host.rain(&mut rain, &view(), 6.0, &vec![lamp; 2000]).map(|_| ()).unwrap_err();
    assert_eq!(error.to_string(), "2000 lights; allowed: up to 1024");
    // With fewer drops than the picture resolves, the rest is extinction: the mean stays.
    let all = host.rain(&mut rain, &view(), f32::INFINITY, &[]).unwrap();
    rain.set_settings(RainSettings { max_drops: 20, ..settings() }).unwrap();
    let few = host.rain(&mut rain, &view(), f32::INFINITY, &[]).unwrap();
    assert!((mean(&few) / mean(&all) - 1.0).abs() < 0.02, "{} {}", mean(&few), mean(&all));
    rain.set_settings(RainSettings { max_drops: 1 << 24, ..settings() }).unwrap();
    let most = host.rain(&mut rain, &view(), f32::INFINITY, &[]).unwrap();
    assert!((mean(&most) / mean(&all) - 1.0).abs() < 0.02, "{} {}", mean(&most), mean(&all));
    rain.set_settings(RainSettings { max_drops: (1 << 24) + 1, ..settings() }).unwrap_err();
}
