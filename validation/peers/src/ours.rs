//! Downpour's steps, and its rain over a plate.

use bevy::math::{DVec3, Vec3};
use downpour::drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour::gpu::{Gpu, wgpu};
use downpour::rain::{PlateTextures, Rain, RainError, RainSettings, RainView};
use downpour::render::camera::{EyeMotion, Viewpoint};
use downpour::render::light::LightSource;
use downpour::sim::gpu::{GpuSimulation, GpuStepInput};
use downpour::sim::simulation::{SimVolume, SimulationOptions, StepInput};
use downpour::sim::view::View;
use half::f16;

use crate::contender::{Contender, Entry};
use crate::device::Device;
use crate::{BOX_M, EYE_M, FOV_Y, SIZE, STEP_S, picture};

/// Rain rate of the steps, mm/h.
const RATE_MM_H: f64 = 25.0;

/// Largest rain rate, mm/h.
const MAX_MM_H: f64 = 500.0;

/// Most drops that `Rain` may draw one by one; it draws those of which a pixel can show more than a haze, which are fewer.
const MAX_DRAWN: u32 = 2_000_000;

/// Halvings of the rain rates among which that of a number of drops is.
const HALVINGS: u32 = 10;

/// Distance of the plate's wall, m: drops up to there are drawn one by one.
const WALL_M: f32 = 50.0;

/// Distance of the near plane of the plate's depth, m.
const NEAR_M: f32 = 0.1;

/// Steps of a box of drops, without a picture.
struct Steps {
    simulation: GpuSimulation,
    view: View,
}

/// Returns the steps of about as many drops in a box.
///
/// # Errors
/// What the simulation says.
pub(crate) fn step(device: &Device, drops: u32) -> Result<Entry, String> {
    let gpu = Gpu::on_device(device.device.clone(), device.queue.clone());
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, RATE_MM_H)
        .map_err(|error| error.to_string())?;
    let view = View { eye: DVec3::new(0.0, f64::from(EYE_M), 0.0), ..View::default() };
    let options = SimulationOptions {
        volume: SimVolume::Box { size_m: [BOX_M; 3] },
        max_drops: drops,
        ..SimulationOptions::default()
    };
    let simulation =
        GpuSimulation::new(&gpu, &rain, &options, &StepInput::new(&view, DVec3::ZERO, Vec3::ZERO))
            .map_err(|error| format!("steps of {drops} drops: {error}"))?;
    Ok(Entry {
        name: "Downpour, steps in a box, not drawn".to_owned(),
        drops: simulation.count(),
        empty: None,
        contender: Box::new(Steps { simulation, view }),
    })
}

impl Contender for Steps {
    fn frame(&mut self) -> Result<(), String> {
        let input = GpuStepInput::new(&self.view, DVec3::ZERO, Vec3::ZERO);
        self.simulation.advance(STEP_S, &input).map_err(|error| error.to_string())
    }
}

/// Frame of a host application: a colored wall, and rain over it if there is any.
struct Host {
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// What the color texture is at the begin of a frame.
    plate: wgpu::Texture,
    color: wgpu::TextureView,
    depth: wgpu::TextureView,
    rain: Option<Rain>,
    lights: Vec<LightSource>,
    frame: u32,
}

/// Returns frames of the plate alone, and with about as many drops in view, without a lamp and with one.
///
/// # Errors
/// What the rain says.
pub(crate) fn pictures(device: &Device, drops: u32) -> Result<Vec<Entry>, String> {
    let lamp = LightSource::Point {
        radius: 0.0,
        position: Vec3::new(0.0, 6.0, -8.0),
        intensity: Vec3::splat(400.0),
        range: 0.0,
    };
    let (dark, rate, count) = rain(device, drops)?;
    let lit = Rain::new(&device.device, &device.queue, dark.settings().clone());
    let lit = lit.map_err(|error| failed(&error))?;
    let entry = |name, drops, empty, host| Entry { name, drops, empty, contender: Box::new(host) };
    let named = |what: &str| format!("Downpour, `Rain` of {rate:.0} mm/h{what}");
    Ok(vec![
        entry("Downpour, the plate alone".to_owned(), 0, None, Host::new(device, None, Vec::new())),
        entry(named(""), count, Some(0), Host::new(device, Some(dark), Vec::new())),
        entry(named(" with a lamp"), count, Some(0), Host::new(device, Some(lit), vec![lamp])),
    ])
}

/// Message of rain that there is not.
fn failed(error: &RainError) -> String {
    format!("Downpour's rain: {error}")
}

/// Creates rain that draws about as many drops one by one, at most those of [`MAX_MM_H`], and returns its rate, mm/h, and their
/// number.
fn rain(device: &Device, drops: u32) -> Result<(Rain, f64, u64), String> {
    let settings = |rate_mm_h| RainSettings {
        rate_mm_h,
        max_drops: MAX_DRAWN,
        far_m: f64::from(WALL_M),
        ..RainSettings::default()
    };
    let mut rain =
        Rain::new(&device.device, &device.queue, settings(MAX_MM_H)).map_err(|error| failed(&error))?;
    let mut count = |rate| {
        rain.set_settings(settings(rate))?;
        Ok(rain.drops(&view(0), SIZE)?.drops.len() as u64)
    };
    let mut count = |rate| count(rate).map_err(|error| failed(&error));
    let (mut low, mut high) = (0.0, MAX_MM_H);
    if count(high)? > u64::from(drops) {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if count(middle)? > u64::from(drops) {
                high = middle;
            } else {
                low = middle;
            }
        }
    }
    let counted = count(high)?;
    Ok((rain, high, counted))
}

impl Host {
    fn new(device: &Device, rain: Option<Rain>, lights: Vec<LightSource>) -> Self {
        let format = wgpu::TextureFormat::Rgba16Float;
        let copied = wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::COPY_SRC;
        let drawn = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let plate = picture::texture(device, format, copied);
        device.queue.write_texture(
            plate.as_image_copy(),
            &wall(),
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE[0] * 8), rows_per_image: None },
            plate.size(),
        );
        let color = picture::texture(device, format, copied | drawn).create_view(&Default::default());
        let depth = picture::texture(device, wgpu::TextureFormat::Depth32Float, drawn);
        let depth = depth.create_view(&Default::default());
        Self {
            device: device.device.clone(),
            queue: device.queue.clone(),
            plate,
            color,
            depth,
            rain,
            lights,
            frame: 0,
        }
    }
}

impl Contender for Host {
    fn frame(&mut self) -> Result<(), String> {
        self.frame += 1;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let color = self.color.texture().as_image_copy();
        encoder.copy_texture_to_texture(self.plate.as_image_copy(), color, self.plate.size());
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(NEAR_M / WALL_M),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        if let Some(rain) = &mut self.rain {
            let textures = PlateTextures::new(&self.color, &self.depth, NEAR_M);
            let textures = PlateTextures { lights: &self.lights, ..textures };
            rain.render(&mut encoder, &view(self.frame), &textures).map_err(|error| error.to_string())?;
        }
        self.queue.submit([encoder.finish()]);
        Ok(())
    }

    fn picture(&self) -> Option<&wgpu::Texture> {
        Some(self.color.texture())
    }
}

/// View of a frame.
fn view(frame: u32) -> RainView {
    RainView {
        camera: Viewpoint {
            eye: Vec3::new(0.0, EYE_M, 0.0),
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            fov_y: FOV_Y,
        },
        motion: EyeMotion::default(),
        time_s: 3.0 + f64::from(frame) * STEP_S,
        shutter_s: STEP_S,
    }
}

/// Pixels of the wall: bluish gray, brighter at the top, with dark stripes as of a facade.
fn wall() -> Vec<u8> {
    let [width, height] = SIZE;
    let pixel = |k: u32| {
        let (x, y) = (k % width, k / width);
        let shade = 0.25 - 0.2 * y as f32 / height as f32;
        let shade = if (x / 80) % 2 == 0 && (y / 90) % 2 == 0 { 0.3 * shade } else { shade };
        [0.8 * shade, 0.9 * shade, shade, 1.0].map(f16::from_f32)
    };
    (0..width * height).flat_map(pixel).flat_map(f16::to_le_bytes).collect()
}
