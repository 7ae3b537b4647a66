//! One mask as OpenEXR.
//!
//! Channels: `R`, `G`, `B` direction through the drop, `A` coverage; `reflected.R`, `.G`, `.B` direction of the
//! reflection outside; `transmittance.Y`; `internal.R`, `.G`, `.B` direction of light that was reflected inside once without
//! being totally reflected; `internalTransmittance.Y`; `reflections.Y` total reflections inside. Directions are in the frame
//! of the view (x right, y up, z toward the viewer). The attribute `downpourMask` holds the diameter, the half
//! extent of the picture in equivalent radii, the view's elevation and the refractive index.
//!
//! The reader accepts files of this module's writer. The header is checked first: compression schemes whose decoders are
//! not safe on hostile files (DWAA, DWAB, B44, B44A, HTJ2K) are rejected, as are sizes above the limit, before
//! any memory is allocated for pixels.

use std::io::Cursor;

use ::exr::prelude::*;
use half::f16;

use crate::file::{Description, shorten};
use crate::{Mask, MaskError, MaskTexel, SIZES};

/// The precision of the numbers in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// 32 bits: the mask as it was traced.
    #[default]
    Float,
    /// 16 bits: directions to 1 in 2000, half of the size.
    Half,
}

/// Name of the attribute with the description.
const ATTRIBUTE: &str = "downpourMask";

type Field = (&'static str, fn(&MaskTexel) -> f32, fn(&mut MaskTexel, f32));

/// Channels and the numbers of a texel that they hold.
const FIELDS: [Field; 13] = [
    ("R", |t| t.direction[0], |t, v| t.direction[0] = v),
    ("G", |t| t.direction[1], |t, v| t.direction[1] = v),
    ("B", |t| t.direction[2], |t, v| t.direction[2] = v),
    ("A", |t| t.coverage, |t, v| t.coverage = v),
    ("reflected.R", |t| t.reflected[0], |t, v| t.reflected[0] = v),
    ("reflected.G", |t| t.reflected[1], |t, v| t.reflected[1] = v),
    ("reflected.B", |t| t.reflected[2], |t, v| t.reflected[2] = v),
    ("transmittance.Y", |t| t.transmittance, |t, v| t.transmittance = v),
    ("internal.R", |t| t.internal[0], |t, v| t.internal[0] = v),
    ("internal.G", |t| t.internal[1], |t, v| t.internal[1] = v),
    ("internal.B", |t| t.internal[2], |t, v| t.internal[2] = v),
    ("internalTransmittance.Y", |t| t.internal_transmittance, |t, v| t.internal_transmittance = v),
    ("reflections.Y", |t| t.reflections as f32, |t, v| t.reflections = v as u32),
];

/// Encodes the mask as an OpenEXR file, ZIP compressed.
///
/// # Errors
/// [`MaskError::Encode`] if the encoder fails.
pub fn write_exr(mask: &Mask, precision: Precision) -> core::result::Result<Vec<u8>, MaskError> {
    let channels = FIELDS.iter().map(|(name, get, _)| {
        let values = mask.texels.iter().map(get);
        let samples = match precision {
            Precision::Float => FlatSamples::F32(values.collect()),
            Precision::Half => FlatSamples::F16(values.map(f16::from_f32).collect()),
        };
        AnyChannel::new(*name, samples)
    });
    let description = Description {
        diameters: vec![mask.diameter],
        half_extents: vec![mask.half_extent],
        view: mask.view,
        refractive_index: mask.refractive_index,
    };
    let mut attributes = LayerAttributes::default();
    // One attribute only: the encoder stores them in a map whose order changes from run to run.
    attributes
        .other
        .insert(Text::from(ATTRIBUTE), AttributeValue::Text(Text::from(description.write().as_str())));
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let size = mask.size as usize;
    let layer = Layer::new((size, size), attributes, encoding, AnyChannels::sort(channels.collect()));
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .map_err(|error| MaskError::Encode { format: "OpenEXR", reason: error.to_string() })?;
    Ok(bytes.into_inner())
}

/// Reads a mask that [`write_exr`] has written.
///
/// # Errors
/// [`MaskError::File`] or [`MaskError::Size`], with what was found.
pub fn read_exr(bytes: &[u8]) -> core::result::Result<Mask, MaskError> {
    let (size, description) = check_header(bytes)?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| file("pixels", shorten(&error.to_string()), "a complete OpenEXR file"))?;
    let mut texels = vec![MaskTexel::default(); size as usize * size as usize];
    for (name, _, set) in FIELDS {
        let channel = image.layer_data.channel_data.list.iter().find(|c| c.name == *name);
        let channel = channel
            .ok_or_else(|| file("channels", format!("no channel {name}"), "the channels of a mask"))?;
        for (texel, value) in texels.iter_mut().zip(channel.sample_data.values_as_f32()) {
            if !value.is_finite() {
                return Err(file("pixels", format!("{value} in channel {name}"), "finite numbers"));
            }
            set(texel, value);
        }
    }
    Ok(Mask {
        size,
        diameter: description.diameters[0],
        view: description.view,
        refractive_index: description.refractive_index,
        half_extent: description.half_extents[0],
        texels,
    })
}

fn file(location: &'static str, found: String, allowed: &'static str) -> MaskError {
    MaskError::File { location, found, allowed }
}

/// Size and description, from the header alone.
fn check_header(bytes: &[u8]) -> core::result::Result<(u32, Description), MaskError> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false)
        .map_err(|error| file("header", shorten(&error.to_string()), "an OpenEXR file"))?;
    let [header] = meta.headers.as_slice() else {
        return Err(file("header", format!("{} parts", meta.headers.len()), "one part"));
    };
    let safe = matches!(
        header.compression,
        Compression::Uncompressed
            | Compression::RLE
            | Compression::ZIP1
            | Compression::ZIP16
            | Compression::PIZ
            | Compression::PXR24
    );
    if !safe {
        return Err(file(
            "compression",
            header.compression.to_string(),
            "none, RLE, ZIPS, ZIP, PIZ or PXR24 (convert the file)",
        ));
    }
    if header.deep || header.blocks.has_tiles() {
        return Err(file("header", "deep data or tiles".to_owned(), "scan lines"));
    }
    let (width, height) = (header.layer_size.0, header.layer_size.1);
    let size = u32::try_from(width).unwrap_or(u32::MAX);
    if !SIZES.contains(&size) {
        return Err(MaskError::Size { found: size, min: *SIZES.start(), max: *SIZES.end() });
    }
    if width != height {
        return Err(file("data window", format!("{width} x {height}"), "a square"));
    }
    if header.channels.list.len() > 2 * FIELDS.len() {
        return Err(file("channels", format!("{} channels", header.channels.list.len()), "the 13 of a mask"));
    }
    let Some(AttributeValue::Text(text)) = header.own_attributes.other.get(&Text::from(ATTRIBUTE)) else {
        return Err(file("attributes", "no downpourMask".to_owned(), "a mask written by Downpour"));
    };
    let description = Description::read("attribute downpourMask", &text.to_string())?;
    if description.diameters.len() != 1 {
        return Err(file("attribute downpourMask", shorten(&text.to_string()), "one diameter"));
    }
    Ok((size, description))
}
