//! `[fog]`: droplets in the air that no picture resolves.
//!
//! Meteorological visibility is the distance at which a black object has a given contrast against the horizon (Koschmieder 1924):
//! `exp(-extinction * visibility) = contrast`.

use super::fault::Positions;
use super::quantity::{ExtinctionPerM, FogAsymmetry, FogHeightM, Fraction, In, PositionM, VisibilityM};
use super::wind::keys::{NumberKeys, moving, number_given};
use downpour_scene::error::SceneError;
use downpour_wind::Keyed;
use serde::Deserialize;

/// Default asymmetry of the phase function, for droplets of some 10 um in visible light.
pub const FOG_ASYMMETRY: f64 = 0.85;

/// Contrast at which an object is taken to be just visible.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum VisibilityLaw {
    /// 2 %: Koschmieder 1924.
    #[default]
    Koschmieder,
    /// 5 %: meteorological optical range of the WMO (Guide to Instruments, No. 8, chapter 9).
    Wmo,
}

impl VisibilityLaw {
    /// Optical depth over the distance of visibility: minus the logarithm of the contrast.
    #[must_use]
    pub fn depth(self) -> f64 {
        match self {
            Self::Koschmieder => 3.912,
            Self::Wmo => 2.996,
        }
    }
}

/// Fog: a medium that scatters light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// Extinction at and below the base, 1/m.
    pub extinction_per_m: f64,
    /// Height over which it falls to 1/e above the base, m; `None`: the same everywhere.
    pub height_m: Option<f64>,
    /// Height of the base, m.
    pub base_m: f64,
    /// Asymmetry of the phase function of Henyey & Greenstein, 0 to 0.95.
    pub asymmetry: f64,
    /// Part of the extinction that scatters, 0 to 1.
    pub albedo: f64,
}

/// Extinction of fog over time, as the file gives it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FogKeys {
    /// Visibility, m, or extinction, 1/m.
    amount: Keyed<f64>,
    /// Law of the visibility; `None` if `amount` is extinction.
    law: Option<VisibilityLaw>,
}

impl FogKeys {
    /// The same, if the fog changes.
    pub(super) fn moving(self) -> Option<Self> {
        moving(Some(self.amount)).map(|amount| Self { amount, law: self.law })
    }

    /// Extinction at a time in seconds, 1/m.
    pub(super) fn extinction_per_m(&self, time_s: f64) -> f64 {
        let amount = self.amount.at(time_s);
        self.law.map_or(amount, |law| law.depth() / amount)
    }
}

#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct FogTable {
    visibility_m: Option<NumberKeys<VisibilityM>>,
    extinction_per_m: Option<NumberKeys<ExtinctionPerM>>,
    law: Option<VisibilityLaw>,
    height_m: Option<In<FogHeightM>>,
    base_m: Option<In<PositionM>>,
    asymmetry: Option<In<FogAsymmetry>>,
    albedo: Option<In<Fraction>>,
}

impl FogTable {
    /// The fog of time 0, and over time.
    pub(super) fn checked(&self, positions: &Positions<'_>) -> Result<(Fog, FogKeys), SceneError> {
        if self.extinction_per_m.is_some() && self.law.is_some() {
            return Err(positions.bad("fog.law", "a law without visibility_m", "law with fog.visibility_m"));
        }
        if self.base_m.is_some() && self.height_m.is_none() {
            let allowed = "base_m with fog.height_m";
            return Err(positions.bad("fog.base_m", "a base of fog that is the same everywhere", allowed));
        }
        let visibility = number_given(self.visibility_m.as_ref(), "fog.visibility_m", positions)?;
        let extinction = number_given(self.extinction_per_m.as_ref(), "fog.extinction_per_m", positions)?;
        let keys = match (visibility, extinction) {
            (Some(amount), None) => FogKeys { amount, law: Some(self.law.unwrap_or_default()) },
            (None, Some(amount)) => FogKeys { amount, law: None },
            (found, _) => {
                let found = if found.is_some() { "both" } else { "neither" };
                let found = format!("{found} of visibility_m and extinction_per_m");
                return Err(positions.bad("fog", found, "one of visibility_m and extinction_per_m"));
            }
        };
        let fog = Fog {
            extinction_per_m: keys.extinction_per_m(0.0),
            height_m: self.height_m.map(|height| height.0),
            base_m: self.base_m.map_or(0.0, |base| base.0),
            asymmetry: self.asymmetry.map_or(FOG_ASYMMETRY, |g| g.0),
            albedo: self.albedo.map_or(1.0, |albedo| albedo.0),
        };
        Ok((fog, keys))
    }
}

#[cfg(test)]
mod tests {
    use crate::Weather;

    fn message(text: &str) -> String {
        Weather::parse("f.toml", text).map_or_else(|error| error.to_string(), |_| String::new())
    }

    #[test]
    fn visibility_is_extinction() {
        let sigma =
            |text: &str| Weather::parse("f.toml", text).ok().and_then(|w| w.fog).map(|f| f.extinction_per_m);
        let near =
            |text: &str, to: f64| assert!(sigma(text).is_some_and(|s| (s - to).abs() < 1.0e-5), "{text}");
        // -ln 0.02 / 100 and -ln 0.05 / 100.
        near("[fog]\nvisibility_m = 100", 0.03912);
        near("[fog]\nvisibility_m = 100\nlaw = \"wmo\"", 0.02996);
        near("[fog]\nextinction_per_m = 0.5", 0.5);
        assert_eq!(sigma(""), None);
    }

    #[test]
    fn bad_fog_is_refused() {
        for (text, key) in [
            ("visibility_m = 0", "visibility_m"),
            ("visibility_m = -5", "visibility_m"),
            ("visibility_m = \"far\"", "visibility_m"),
            ("visibility_m = 50\nextinction_per_m = 0.1", "both"),
            ("height_m = 3", "neither"),
            ("visibility_m = 50\nasymmetry = 1", "asymmetry"),
            ("visibility_m = 50\nalbedo = 1.5", "albedo"),
            ("visibility_m = 50\nlaw = \"far\"", "law"),
            ("extinction_per_m = 0.1\nlaw = \"wmo\"", "law"),
            ("visibility_m = 50\nbase_m = 1", "base_m"),
            ("visibility_m = 50\ncolor = 1", "color"),
        ] {
            let found = message(&format!("[fog]\n{text}"));
            assert!(found.contains(key) && found.contains("fog"), "{text}: {found}");
        }
    }
}
