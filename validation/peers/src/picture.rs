//! Textures of pictures, and their way back to the CPU.

use std::path::Path;

use downpour::gpu::wgpu;
use downpour::render::tone::tone_srgb;
use half::f16;

use crate::SIZE;
use crate::contender::Entry;
use crate::device::Device;

/// Pixels as 8-bit sRGB.
#[derive(PartialEq)]
pub(crate) struct Picture(image::RgbaImage);

/// Creates a texture of the size of a picture.
pub(crate) fn texture(
    device: &Device,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// Reads a picture of linear 16-bit floats or of 8-bit sRGB.
///
/// # Errors
/// A device that does not give it.
pub(crate) fn read(device: &Device, texture: &wgpu::Texture) -> Result<Picture, String> {
    let failed = |what: &str, error: &dyn std::fmt::Display| format!("{what} of a picture failed: {error}");
    let is_float = texture.format() == wgpu::TextureFormat::Rgba16Float;
    let pixel = if is_float { 8 } else { 4 };
    let row = (texture.width() * pixel).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row) * u64::from(texture.height()),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.device.create_command_encoder(&Default::default());
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(row),
        rows_per_image: Some(texture.height()),
    };
    let copied = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), copied, texture.size());
    device.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |_| ());
    device.wait()?;
    let bytes = buffer.get_mapped_range(..).map_err(|error| failed("reading", &error))?;
    Ok(Picture(image::RgbaImage::from_fn(texture.width(), texture.height(), |x, y| {
        let at = (y * row + x * pixel) as usize;
        image::Rgba(match is_float {
            true => std::array::from_fn(|k| {
                let linear = f16::from_le_bytes([bytes[at + 2 * k], bytes[at + 2 * k + 1]]).to_f32();
                if k == 3 { 255 } else { tone_srgb(linear) }
            }),
            false => std::array::from_fn(|k| if k == 3 { 255 } else { bytes[at + k] }),
        })
    })))
}

/// Saves the last picture of each entry as `DROPS-NUMBER.png`.
///
/// # Errors
/// A folder that cannot be written.
pub(crate) fn save(device: &Device, folder: &Path, drops: u32, entries: &[Entry]) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for (number, entry) in entries.iter().enumerate() {
        if let Some(texture) = entry.contender.picture() {
            let path = folder.join(format!("{drops}-{number}.png"));
            let saved = read(device, texture)?.0.save(&path);
            saved.map_err(|error| format!("{}: {error}", path.display()))?;
            eprintln!("{}: {}", path.display(), entry.name);
        }
    }
    Ok(())
}
