//! Presets: weather files of the project, from which a file takes what it does not give.

use super::fault::Positions;
use super::words::nearest;
use downpour_scene::error::{SceneError, quoted};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Presets of `preset`: name and text.
pub const PRESETS: [(&str, &str); 5] = [
    ("drizzle", include_str!("../../../assets/weather/drizzle.toml")),
    ("steady", include_str!("../../../assets/weather/steady.toml")),
    ("heavy", include_str!("../../../assets/weather/heavy.toml")),
    ("storm", include_str!("../../../assets/weather/storm.toml")),
    ("night-city", include_str!("../../../assets/weather/night-city.toml")),
];

/// Keys of the same table that exclude each other: where a file gives the first, those of the preset are left out.
const INSTEAD: [(&str, &str, &[&str]); 10] = [
    ("sky", "file", &["color", "zenith_color"]),
    ("sky", "color", &["file", "zenith_color"]),
    ("sky", "zenith_color", &["file", "color"]),
    ("rain", "drops", &["rate_mm_h", "distribution"]),
    ("wetness", "wetness", &["rained_mm", "rained_s", "dried_s", "storage_mm", "drying_s"]),
    (
        "wetness",
        "enabled",
        &["rained_mm", "rained_s", "dried_s", "storage_mm", "drying_s", "reflections", "reflection_edge"],
    ),
    ("wetness", "reflections", &["reflection_edge"]),
    ("wetness", "rained_s", &["rained_mm"]),
    ("wetness", "rained_mm", &["rained_s"]),
    ("", "wind", &["gusts"]),
];

/// Text of the preset of a name.
///
/// # Errors
/// An unknown name, with the nearest one.
pub(super) fn text(name: &str, positions: &Positions<'_>) -> Result<&'static str, SceneError> {
    let names = PRESETS.map(|(name, _)| name);
    PRESETS.iter().find(|(known, _)| *known == name).map(|&(_, text)| text).ok_or_else(|| {
        let hint = nearest(name, &names).map_or_else(String::new, |word| format!(", perhaps {word}"));
        positions.bad("preset", format!("unknown preset {}{hint}", quoted(name)), names.join(", "))
    })
}

/// Adds to the entries of a file those of a preset that it does not give: tables key by key, lists as a whole.
pub(super) fn merge<'a>(file: &mut DeTable<'a>, preset: DeTable<'a>) {
    merge_table("", file, preset);
}

fn merge_table<'a>(path: &str, file: &mut DeTable<'a>, preset: DeTable<'a>) {
    let instead = INSTEAD.iter().filter(|(table, given, _)| *table == path && has(file, given));
    let left_out: Vec<&str> = instead.flat_map(|(.., others)| others.iter().copied()).collect();
    for (key, value) in preset {
        if left_out.contains(&&**key.get_ref()) {
            continue;
        }
        let known = file.iter_mut().find(|(name, _)| name.get_ref() == key.get_ref()).map(|(_, known)| known);
        match (known.map(Spanned::get_mut), value.into_inner()) {
            (Some(DeValue::Table(inner)), DeValue::Table(of_preset)) => {
                merge_table(key.get_ref(), inner, of_preset);
            }
            // The file's own value stays.
            (Some(_), _) => {}
            (None, value) => {
                let spot = key.span();
                file.insert(key, Spanned::new(spot, value));
            }
        }
    }
}

fn has(table: &DeTable<'_>, wanted: &str) -> bool {
    table.keys().any(|key| key.get_ref() == wanted)
}
