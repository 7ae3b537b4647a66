//! Parameters of a street, and their TOML form.

use serde::Deserialize;

use crate::error::StreetError;

/// Smallest length, meters.
pub const MIN_LENGTH_M: f32 = 20.0;
/// Greatest length, meters.
pub const MAX_LENGTH_M: f32 = 500.0;
/// Smallest width of the carriageway between the curbs, meters.
pub const MIN_CARRIAGEWAY_M: f32 = 4.0;
/// Greatest width of the carriageway between the curbs, meters.
pub const MAX_CARRIAGEWAY_M: f32 = 12.0;
/// Smallest width of a pavement, meters.
pub const MIN_PAVEMENT_M: f32 = 1.8;
/// Greatest width of a pavement, meters.
pub const MAX_PAVEMENT_M: f32 = 5.0;

/// Surface of the carriageway.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Paving {
    /// Granite setts in rows.
    #[default]
    Cobbles,
    /// Asphalt with repairs, between gutters of setts.
    Asphalt,
}

/// Sort of the street lamps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LampEra {
    /// Lanterns with warm light on cast posts and on walls.
    #[default]
    Lantern,
    /// Curved posts of the middle of the 20th century with sodium light.
    Sodium,
    /// Slim posts with neutral LED light.
    Led,
}

/// Parameters of a street. All numbers are checked by [`Street::generate`](crate::Street::generate).
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StreetSettings {
    /// Same seed, same street.
    pub seed: u64,
    /// Length of the rows of houses, meters: 20 to 500.
    pub length_m: f32,
    /// Width of the carriageway between the curbs, meters: 4 to 12.
    pub carriageway_m: f32,
    /// Width of each pavement, meters: 1.8 to 5.
    pub pavement_m: f32,
    /// Surface of the carriageway.
    pub paving: Paving,
    /// Wear and dirt: 0 newly done to 1 neglected.
    pub age: f32,
    /// Sort of the street lamps.
    pub lamps: LampEra,
    /// Distance from a lamp to the next one, on the other side, meters: 6 to 60.
    pub lamp_spacing_m: f32,
    /// Density of tables, bins, bollards, bicycles and trees: 0 none to 1 crowded.
    pub furniture: f32,
    /// Fraction of the curb where cars are parked: 0 to 1.
    pub cars: f32,
    /// Fraction of houses with a shop: 0 to 1.
    pub shops: f32,
    /// Fraction of windows that are lit at night: 0 to 1.
    pub lit_windows: f32,
}

impl Default for StreetSettings {
    /// The street of `assets/scenes/street`: 80 m of cobbles.
    fn default() -> Self {
        Self {
            seed: 7,
            length_m: 80.0,
            carriageway_m: 6.2,
            pavement_m: 2.8,
            paving: Paving::Cobbles,
            age: 0.5,
            lamps: LampEra::Lantern,
            lamp_spacing_m: 11.0,
            furniture: 0.75,
            cars: 0.45,
            shops: 0.5,
            lit_windows: 0.42,
        }
    }
}

impl StreetSettings {
    /// Reads settings from TOML; keys that are left out have their defaults. `file` is named in errors.
    ///
    /// ```
    /// use downpour_street::{Paving, StreetSettings};
    /// let settings = StreetSettings::from_toml("seed = 3\npaving = \"asphalt\"", "street.toml")?;
    /// assert_eq!((settings.seed, settings.paving), (3, Paving::Asphalt));
    /// let error = StreetSettings::from_toml("lenght_m = 3", "street.toml").unwrap_err();
    /// assert!(error.to_string().starts_with("street.toml: line 1: unknown field `lenght_m`"));
    /// # Ok::<(), downpour_street::StreetError>(())
    /// ```
    ///
    /// # Errors
    /// [`StreetError::Setting`] for a text that is not TOML, a key that is not known, a value of another type or out of its range.
    pub fn from_toml(text: &str, file: &str) -> Result<Self, StreetError> {
        let settings: Self = toml::from_str(text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start.min(text.len()));
            let line = text.as_bytes()[..at].iter().filter(|&&byte| byte == b'\n').count() + 1;
            let message = error.message().lines().collect::<Vec<_>>().join(", ");
            let (found, allowed) =
                message.split_once(", expected ").unwrap_or((&message, "TOML with the keys of a street"));
            StreetError::Setting {
                file: file.to_owned(),
                key: format!("line {line}"),
                found: found.to_owned(),
                allowed: allowed.to_owned(),
            }
        })?;
        settings.check(file)?;
        Ok(settings)
    }

    /// Checks all numbers; `file` is named in errors.
    ///
    /// # Errors
    /// [`StreetError::Setting`] for the first number out of its range.
    pub fn check(&self, file: &str) -> Result<(), StreetError> {
        let ranges = [
            ("length_m", self.length_m, MIN_LENGTH_M, MAX_LENGTH_M),
            ("carriageway_m", self.carriageway_m, MIN_CARRIAGEWAY_M, MAX_CARRIAGEWAY_M),
            ("pavement_m", self.pavement_m, MIN_PAVEMENT_M, MAX_PAVEMENT_M),
            ("age", self.age, 0.0, 1.0),
            ("lamp_spacing_m", self.lamp_spacing_m, 6.0, 60.0),
            ("furniture", self.furniture, 0.0, 1.0),
            ("cars", self.cars, 0.0, 1.0),
            ("shops", self.shops, 0.0, 1.0),
            ("lit_windows", self.lit_windows, 0.0, 1.0),
        ];
        for (key, found, low, high) in ranges {
            if !(low..=high).contains(&found) {
                return Err(StreetError::Setting {
                    file: file.to_owned(),
                    key: key.to_owned(),
                    found: found.to_string(),
                    allowed: format!("{low} to {high}"),
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        StreetSettings::from_toml(text, "s.toml").unwrap_err().to_string()
    }

    #[test]
    fn defaults_are_allowed() {
        assert_eq!(StreetSettings::from_toml("", "s.toml"), Ok(StreetSettings::default()));
    }

    #[test]
    fn errors_name_file_key_and_range() {
        assert_eq!(refused("length_m = 10"), "s.toml: length_m: 10; allowed: 20 to 500");
        assert_eq!(refused("length_m = 2000"), "s.toml: length_m: 2000; allowed: 20 to 500");
        assert_eq!(refused("age = nan"), "s.toml: age: NaN; allowed: 0 to 1");
        let unknown = refused("\nwidth = 3");
        assert!(
            unknown.starts_with("s.toml: line 2: unknown field `width`; allowed: one of `seed`"),
            "{unknown}"
        );
        let word = refused("paving = \"gravel\"");
        assert!(word.contains("unknown variant `gravel`; allowed: `cobbles` or `asphalt`"), "{word}");
        let broken = refused("seed = = 3");
        assert!(broken.starts_with("s.toml: line 1: ") && broken.contains("allowed: "), "{broken}");
        assert!(refused("seed = -1").contains("allowed: "));
    }
}
