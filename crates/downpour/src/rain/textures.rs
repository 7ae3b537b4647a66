//! Textures of a host application.

use downpour_gpu::wgpu::{self, TextureFormat, TextureUsages};
use downpour_math::in_range;
use downpour_render::camera::check_size;
use downpour_render::gpu::HostTextures;
use downpour_render::host::DepthRange;
use downpour_render::light::LightSource;

use super::RainError;

/// Formats of color textures: what can be read as linear light and blended into without any feature.
const COLOR_FORMATS: [TextureFormat; 3] =
    [TextureFormat::Rgba16Float, TextureFormat::Rgba8UnormSrgb, TextureFormat::Bgra8UnormSrgb];

/// Formats of depth textures.
const DEPTH_FORMATS: [TextureFormat; 3] =
    [TextureFormat::Depth32Float, TextureFormat::Depth24Plus, TextureFormat::Depth16Unorm];

/// A frame of a host application without rain.
#[derive(Clone, Copy, Debug)]
pub struct PlateTextures<'a> {
    /// Color, into which the rain is blended: `Rgba16Float`, or an 8-bit sRGB format; with the usages `TEXTURE_BINDING` and
    /// `RENDER_ATTACHMENT`; multisampling resolved. The view has the texture's format, and shows one layer of its first level.
    pub color: &'a wgpu::TextureView,
    /// Depth of the same size: `Depth32Float`, `Depth24Plus` or `Depth16Unorm`, with the usage `TEXTURE_BINDING`, and with
    /// `RENDER_ATTACHMENT` if it has several levels; multisampling resolved. The view shows one layer of its first level.
    pub depth: &'a wgpu::TextureView,
    /// Meaning of its values.
    pub depth_range: DepthRange,
    /// Sky map that drops show beyond the borders of the picture; without one they show the picture's borders, blurred.
    pub sky: Option<HostSky<'a>>,
    /// Lamps and the sun, with intensities in the unit of the color.
    pub lights: &'a [LightSource],
    /// Radiance of the color 1, in the unit of the lights: 1 unless the host exposes its colors before the rain.
    pub radiance_scale: f32,
}

/// A sky map of a host application.
#[derive(Clone, Copy, Debug)]
pub struct HostSky<'a> {
    /// Equirectangular, +Y up: u = 0.5 + atan2(z, x) / 2 pi, v = 0 at the zenith. Any format that is read as floats.
    pub view: &'a wgpu::TextureView,
    /// Radiance of the color 1.
    pub radiance_scale: f32,
}

impl<'a> PlateTextures<'a> {
    /// Color and depth with infinite reversed depth, without lights or a sky map.
    #[must_use]
    pub fn new(color: &'a wgpu::TextureView, depth: &'a wgpu::TextureView, near_m: f32) -> Self {
        let depth_range = DepthRange::reversed(near_m);
        Self { color, depth, depth_range, sky: None, lights: &[], radiance_scale: 1.0 }
    }

    pub(super) fn on_gpu(&self) -> HostTextures<'a> {
        HostTextures { color: self.color, depth: self.depth, sky: self.sky.map(|sky| sky.view) }
    }

    /// Checks the textures, and returns their columns and rows.
    pub(super) fn check(&self) -> Result<[u32; 2], RainError> {
        let [color, depth] = [self.color, self.depth].map(wgpu::TextureView::texture);
        let both = TextureUsages::TEXTURE_BINDING | TextureUsages::RENDER_ATTACHMENT;
        check_texture("color texture", color, &COLOR_FORMATS, both)?;
        // As an attachment a view tells which level it shows.
        let of_depth = if depth.mip_level_count() > 1 { both } else { TextureUsages::TEXTURE_BINDING };
        check_texture("depth texture", depth, &DEPTH_FORMATS, of_depth)?;
        if let Some(sky) = self.sky {
            let texture = sky.view.texture();
            check_texture("sky map", texture, &[texture.format()], TextureUsages::TEXTURE_BINDING)?;
            in_range("radiance of the sky map", sky.radiance_scale, "", &(0.0..=1.0e6), 1.0, "0 to 1e6")?;
        }
        let size = [color.width(), color.height()];
        check_size(size)?;
        let found = [depth.width(), depth.height()];
        if found != size {
            return Err(RainError::Texture {
                what: "depth texture",
                found: format!("{} x {} pixels", found[0], found[1]),
                allowed: format!("the size of the color texture, {} x {}", size[0], size[1]),
            });
        }
        let DepthRange { near_m, far_m, .. } = self.depth_range;
        in_range("near plane", near_m, "m", &(1.0e-4..=1.0e4), 1.0, "0.0001 to 10000")?;
        let beyond = near_m * 1.000_001..=f32::INFINITY;
        in_range("far plane", far_m, "m", &beyond, 1.0, "beyond the near plane")?;
        in_range("radiance of the color 1", self.radiance_scale, "", &(1.0e-6..=1.0e6), 1.0, "1e-6 to 1e6")?;
        Ok(size)
    }
}

fn check_texture(
    what: &'static str,
    texture: &wgpu::Texture,
    formats: &[TextureFormat],
    usage: TextureUsages,
) -> Result<(), RainError> {
    let wrong = |found: String, allowed: String| Err(RainError::Texture { what, found, allowed });
    if !formats.contains(&texture.format()) {
        return wrong(format!("format {:?}", texture.format()), format!("{formats:?}"));
    }
    if texture.dimension() != wgpu::TextureDimension::D2 {
        return wrong(format!("dimension {:?}", texture.dimension()), "D2".to_owned());
    }
    if texture.sample_count() != 1 {
        return wrong(format!("{} samples per pixel", texture.sample_count()), "1, resolved".to_owned());
    }
    if !texture.usage().contains(usage) {
        return wrong(format!("usage {:?}", texture.usage()), format!("at least {usage:?}"));
    }
    Ok(())
}
