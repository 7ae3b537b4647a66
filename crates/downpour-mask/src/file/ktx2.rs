//! Masks over diameters as a KTX2 texture array.
//!
//! Format `R16G16B16A16_SFLOAT`, one level, ZLIB supercompression, three layers per mask, rows from the top:
//! - layer 3 k: direction through the drop (x, y, z), coverage;
//! - layer 3 k + 1: direction of the reflection outside (x, y, z), transmittance;
//! - layer 3 k + 2: direction of light that was reflected inside once without being totally reflected (x, y, z), its
//!   transmittance.
//!
//! The key `DownpourMask` holds diameters, half extents (in equivalent radii), the view's elevation and the
//! refractive index. The number of total reflections is not stored (OpenEXR has it).
//!
//! The reader accepts files of this module's writer, and checks every size before it allocates memory.

use half::f16;
use ktx2::{Format, Header, LevelIndex, SupercompressionScheme};

use crate::file::texture_array::{TextureArray, find_text, part, write_array};
use crate::file::{Description, shorten};
use crate::{Mask, MaskError, MaskTexel, SIZES};

/// Maximum number of masks of an array: a texture array has 256 layers on every WebGPU device.
const MAX_MASKS: usize = 256 / LAYERS;
/// Layers per mask.
const LAYERS: usize = 3;
/// Texel format of a layer.
const FORMAT: Format = Format::R16G16B16A16_SFLOAT;
/// Bytes of a texel of a layer.
const TEXEL_BYTES: usize = 8;

/// Encodes masks of one size, view and refractive index as a KTX2 file.
///
/// # Errors
/// [`MaskError::File`] if the masks differ in these, or if there are none or too many.
pub fn write_ktx2(masks: &[Mask]) -> Result<Vec<u8>, MaskError> {
    let Some(first) = masks.first().filter(|_| masks.len() <= MAX_MASKS) else {
        return Err(file("masks", format!("{} masks", masks.len()), "1 to 85"));
    };
    let same = |m: &&Mask| {
        (m.size, m.view) == (first.size, first.view)
            && m.refractive_index.to_bits() == first.refractive_index.to_bits()
    };
    if !masks.iter().all(|m| same(&m)) {
        return Err(file(
            "masks",
            "different sizes or views".to_owned(),
            "one size, view and refractive index",
        ));
    }
    let mut texels = Vec::with_capacity(masks.len() * first.texels.len() * LAYERS * TEXEL_BYTES);
    for mask in masks {
        for layer in 0..LAYERS {
            for t in &mask.texels {
                let ([x, y, z], w) = match layer {
                    0 => (t.direction, t.coverage),
                    1 => (t.reflected, t.transmittance),
                    _ => (t.internal, t.internal_transmittance),
                };
                texels.extend([x, y, z, w].iter().flat_map(|&v| f16::from_f32(v).to_le_bytes()));
            }
        }
    }
    let description = Description {
        diameters: masks.iter().map(|m| m.diameter).collect(),
        half_extents: masks.iter().map(|m| m.half_extent).collect(),
        view: first.view,
        refractive_index: first.refractive_index,
    };
    write_array(&TextureArray {
        format: FORMAT,
        type_size: 2,
        size: [first.size; 2],
        layers: (LAYERS * masks.len()) as u32,
        keys: &[("DownpourMask", description.write().as_bytes())],
        texels: &texels,
    })
}

/// Reads masks that [`write_ktx2`] has written. The numbers of total reflections are 0.
///
/// # Errors
/// [`MaskError::File`] or [`MaskError::Size`], with what was found.
pub fn read_ktx2(bytes: &[u8]) -> Result<Vec<Mask>, MaskError> {
    let truncated = |part| file(part, format!("a file of {} bytes", bytes.len()), "a complete KTX2 file");
    let header: &[u8; Header::LENGTH] = bytes.first_chunk().ok_or_else(|| truncated("header"))?;
    let header = Header::from_bytes(header)
        .map_err(|error| file("header", shorten(&error.to_string()), "a KTX2 texture array of masks"))?;
    let (size, layers) = check_header(&header)?;
    let level: &[u8; LevelIndex::LENGTH] =
        bytes[Header::LENGTH..].first_chunk().ok_or_else(|| truncated("level index"))?;
    let level = LevelIndex::from_bytes(level);
    let expected = size as usize * size as usize * layers * TEXEL_BYTES;
    if level.uncompressed_byte_length != expected as u64 {
        let found = format!("{} bytes", level.uncompressed_byte_length);
        return Err(file("level 0, uncompressed length", found, "the length of all texels"));
    }
    let packed = part(bytes, level.byte_offset, level.byte_length).ok_or_else(|| truncated("level 0"))?;
    let keys = part(bytes, header.index.kvd_byte_offset.into(), header.index.kvd_byte_length.into())
        .ok_or_else(|| truncated("keys"))?;
    let text = find_text(keys, "DownpourMask")
        .ok_or_else(|| file("keys", "no DownpourMask".to_owned(), "masks written by Downpour"))?;
    let description = Description::read("key DownpourMask", &text)?;
    if description.diameters.len() * LAYERS != layers {
        return Err(file("layers", format!("{layers}"), "three per diameter"));
    }
    let texels = match header.supercompression_scheme {
        Some(_) => miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(packed, expected)
            .map_err(|error| file("level 0", shorten(&error.to_string()), "a ZLIB stream of all texels"))?,
        None => packed.to_vec(),
    };
    if texels.len() != expected {
        return Err(file("level 0", format!("{} bytes", texels.len()), "the length of all texels"));
    }
    unpack(&texels, size, &description)
}

fn file(location: &'static str, found: String, allowed: &'static str) -> MaskError {
    MaskError::File { location, found, allowed }
}

/// Size and number of layers, if the header is that of masks.
fn check_header(header: &Header) -> Result<(u32, usize), MaskError> {
    if header.format != Some(FORMAT) {
        return Err(file("vkFormat", format!("{:?}", header.format), "97 (R16G16B16A16_SFLOAT)"));
    }
    if !matches!(header.supercompression_scheme, None | Some(SupercompressionScheme::ZLIB)) {
        let found = format!("{:?}", header.supercompression_scheme);
        return Err(file("supercompressionScheme", found, "0 (none) or 3 (ZLIB)"));
    }
    if !SIZES.contains(&header.pixel_width) {
        return Err(MaskError::Size { found: header.pixel_width, min: *SIZES.start(), max: *SIZES.end() });
    }
    let flat = header.pixel_height == header.pixel_width
        && header.pixel_depth == 0
        && header.face_count == 1
        && header.level_count == 1;
    if !flat {
        let found = format!(
            "{} x {} x {}, {} faces, {} levels",
            header.pixel_width,
            header.pixel_height,
            header.pixel_depth,
            header.face_count,
            header.level_count
        );
        return Err(file("dimensions", found, "a square, one face, one level"));
    }
    let layers = header.layer_count as usize;
    if layers == 0 || !layers.is_multiple_of(LAYERS) || layers > LAYERS * MAX_MASKS {
        return Err(file("layerCount", layers.to_string(), "a multiple of 3 from 3 to 255"));
    }
    Ok((header.pixel_width, layers))
}

fn unpack(texels: &[u8], size: u32, description: &Description) -> Result<Vec<Mask>, MaskError> {
    let layer = size as usize * size as usize;
    let four = |at: usize| -> [f32; 4] {
        std::array::from_fn(|k| {
            let i = at * TEXEL_BYTES + 2 * k;
            f16::from_le_bytes([texels[i], texels[i + 1]]).to_f32()
        })
    };
    let mut masks = Vec::with_capacity(description.diameters.len());
    for (k, (&diameter, &half_extent)) in
        description.diameters.iter().zip(&description.half_extents).enumerate()
    {
        let texels: Vec<MaskTexel> = (0..layer)
            .map(|i| {
                let [x, y, z, coverage] = four(LAYERS * k * layer + i);
                let [rx, ry, rz, transmittance] = four((LAYERS * k + 1) * layer + i);
                let [ix, iy, iz, internal_transmittance] = four((LAYERS * k + 2) * layer + i);
                MaskTexel {
                    direction: [x, y, z],
                    coverage,
                    reflected: [rx, ry, rz],
                    transmittance,
                    internal: [ix, iy, iz],
                    internal_transmittance,
                    ..MaskTexel::default()
                }
            })
            .collect();
        let finite = |t: &MaskTexel| {
            t.direction
                .iter()
                .chain(&t.reflected)
                .chain(&t.internal)
                .chain([&t.coverage, &t.transmittance, &t.internal_transmittance])
                .all(|v| v.is_finite())
        };
        if let Some(i) = texels.iter().position(|t| !finite(t)) {
            return Err(file("level 0", format!("mask {k}, texel {i} is not finite"), "finite numbers"));
        }
        masks.push(Mask {
            size,
            diameter,
            view: description.view,
            refractive_index: description.refractive_index,
            half_extent,
            texels,
        });
    }
    Ok(masks)
}
