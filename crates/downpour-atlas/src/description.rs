//! Description in a streak file: `key=value` pairs, separated by semicolons.

use crate::AtlasError;
use crate::{StreakOptions, StreakOrigin, StreakOscillation, StreakSet};
use downpour_mask::file::shorten;

/// Version of the file. Another one is refused.
const VERSION: &str = "1";
const LOCATION: &str = "key DownpourStreaks";
const PAIRS: &str = "version, origin, diameter_mm, amplitudes, phase, azimuth_deg, elevation_deg, half_extent, \
                     light_radius_deg, refractive_index, rays, directions, digest";

/// FNV-1a hash, 64 bits: detects accidents, not intent.
fn digest(parts: &[&[u8]]) -> u64 {
    parts.iter().flat_map(|part| part.iter()).fold(0xcbf2_9ce4_8422_2325, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// The text for a set with these bytes of texels and of amounts.
pub(crate) fn write(set: &StreakSet, texels: &[u8], amounts: &[u8]) -> String {
    let list = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    let origin = match set.origin {
        StreakOrigin::Traced => "traced",
        StreakOrigin::Columbia => "columbia",
    };
    // A list that is the same at all elevations is written once. Six decimals keep a direction to a millionth.
    let shared = set.directions.windows(2).all(|pair| pair[0] == pair[1]);
    let written = if shared { &set.directions[..set.directions.len().min(1)] } else { &set.directions[..] };
    let directions =
        written.iter().flatten().flatten().map(|c| format!("{c:.6}")).collect::<Vec<_>>().join(",");
    let options = &set.options;
    let degrees: Vec<f64> = set.elevations.iter().map(|e| e.to_degrees()).collect();
    let text = format!(
        "version={VERSION};origin={origin};diameter_mm={};amplitudes={};phase={};azimuth_deg={};elevation_deg={};\
         half_extent={};light_radius_deg={};refractive_index={};rays={};directions={directions}",
        set.diameter * 1.0e3,
        list(&set.oscillation.amplitudes),
        set.oscillation.phase,
        set.oscillation.azimuth.to_degrees(),
        list(&degrees),
        options.half_extent,
        options.light_radius.to_degrees(),
        options.refractive_index,
        options.rays,
    );
    let sum = digest(&[text.as_bytes(), texels, amounts]);
    format!("{text};digest={sum:016x}")
}

/// The set without its texels and amounts, for a texture of this size. The digest is that of the text, `texels` and `amounts`.
pub(crate) fn read(
    text: &str,
    [columns, rows, layers]: [u32; 3],
    texels: &[u8],
    amounts: &[u8],
) -> Result<StreakSet, AtlasError> {
    let wrong =
        |location, found: &str, allowed| AtlasError::File { location, found: shorten(found), allowed };
    let Some((rest, sum)) = text.rsplit_once(";digest=") else {
        return Err(wrong(LOCATION, text, PAIRS));
    };
    let value = |key: &str| {
        rest.split(';')
            .find_map(|pair| pair.split_once('=').filter(|(k, _)| *k == key))
            .map(|(_, v)| v)
            .ok_or_else(|| wrong(LOCATION, key, PAIRS))
    };
    let version = value("version")?;
    if version != VERSION {
        return Err(wrong("version of the streaks", version, "\"1\""));
    }
    let made = format!("{:016x}", digest(&[rest.as_bytes(), texels, amounts]));
    if sum != made {
        return Err(wrong("digest of the streaks", sum, "the digest of the file's contents"));
    }
    let numbers = |key: &str| -> Result<Vec<f64>, AtlasError> {
        value(key)?
            .split(',')
            .map(|n| {
                n.parse::<f64>()
                    .ok()
                    .filter(|v| v.is_finite())
                    .ok_or_else(|| wrong(LOCATION, n, "finite numbers"))
            })
            .collect()
    };
    let one = |key: &str| -> Result<f64, AtlasError> {
        match numbers(key)?[..] {
            [number] => Ok(number),
            _ => Err(wrong(LOCATION, key, "one number")),
        }
    };
    let origin = match value("origin")? {
        "traced" => StreakOrigin::Traced,
        "columbia" => StreakOrigin::Columbia,
        other => return Err(wrong("origin of the streaks", other, "traced or columbia")),
    };
    let [a20, a31] = numbers("amplitudes")?[..] else {
        return Err(wrong(LOCATION, "amplitudes", "two numbers"));
    };
    let elevations: Vec<f64> = numbers("elevation_deg")?.iter().map(|e| e.to_radians()).collect();
    let options = StreakOptions {
        columns,
        rows,
        rays: one("rays")? as u32,
        half_extent: one("half_extent")?,
        light_radius: one("light_radius_deg")?.to_radians(),
        refractive_index: one("refractive_index")?,
    };
    let flat = numbers("directions")?;
    let each = layers as usize / elevations.len();
    let (triples, left) = flat.as_chunks::<3>();
    let once = triples.len() == each;
    let fits = each * elevations.len() == layers as usize && left.is_empty() && each > 0;
    if !fits || !(once || triples.len() == layers as usize) {
        let found = format!("{} numbers for {layers} layers", flat.len());
        return Err(wrong(
            "directions of streaks",
            &found,
            "three for each layer, or for those of one elevation",
        ));
    }
    let directions = (0..elevations.len())
        .map(|k| if once { triples.to_vec() } else { triples[k * each..(k + 1) * each].to_vec() })
        .collect();
    Ok(StreakSet {
        origin,
        diameter: one("diameter_mm")? * 1.0e-3,
        oscillation: StreakOscillation {
            amplitudes: [a20, a31],
            phase: one("phase")?,
            azimuth: one("azimuth_deg")?.to_radians(),
        },
        options,
        elevations,
        directions,
        texels: Vec::new(),
        amounts: Vec::new(),
    })
}
