//! Multipliers and media of effects that change over time.

use super::fog::FogKeys;
use super::wind::keys::moving;
use super::{Splashes, Weather};
use crate::{Fog, Glow};
use downpour_wind::Keyed;

/// Multipliers and media over time, of those that a file gives.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct EffectKeys {
    /// Size of the crowns of splashes.
    pub(super) splash_size: Option<Keyed<f64>>,
    /// Fraction of the light that a lens scatters.
    pub(super) glare: Option<Keyed<f64>>,
    /// Factor of its angles.
    pub(super) glow_width: Option<Keyed<f64>>,
    /// Fog.
    pub(super) fog: Option<FogKeys>,
    /// Brightness of flashes from a seed.
    pub(super) brightness: Option<Keyed<f64>>,
    /// Index of each puddle, and the influence of its ripples.
    pub(super) influences: Vec<(usize, Keyed<f64>)>,
}

impl EffectKeys {
    /// The same without constant values.
    pub(super) fn moving(self) -> Self {
        let influences = self.influences.into_iter();
        Self {
            splash_size: moving(self.splash_size),
            glare: moving(self.glare),
            glow_width: moving(self.glow_width),
            fog: self.fog.and_then(FogKeys::moving),
            brightness: moving(self.brightness),
            influences: influences.filter_map(|(i, keyed)| Some((i, moving(Some(keyed))?))).collect(),
        }
    }
}

impl Weather {
    /// Fog at a time in seconds.
    #[must_use]
    pub fn fog_at(&self, time_s: f64) -> Option<Fog> {
        let fog = self.fog?;
        let keys = self.keys.effects.fog.as_ref();
        Some(keys.map_or(fog, |keys| Fog { extinction_per_m: keys.extinction_per_m(time_s), ..fog }))
    }

    /// Light beside its image at a time in seconds.
    #[must_use]
    pub fn glow_at(&self, time_s: f64) -> Glow {
        let EffectKeys { glare, glow_width, .. } = &self.keys.effects;
        let at = |keyed: &Option<Keyed<f64>>, value| keyed.as_ref().map_or(value, |keyed| keyed.at(time_s));
        Glow { glare: at(glare, self.glow.glare), width: at(glow_width, self.glow.width), ..self.glow }
    }

    /// Splashes at a time in seconds.
    #[must_use]
    pub fn splashes_at(&self, time_s: f64) -> Splashes {
        let keys = self.keys.effects.splash_size.as_ref();
        keys.map_or(self.splashes, |size| Splashes { size: size.at(time_s), ..self.splashes })
    }

    /// Influence of the ripples of a puddle at a time in seconds, if it changes.
    #[must_use]
    pub fn ripple_influence_at(&self, puddle: usize, time_s: f64) -> Option<f64> {
        let mut influences = self.keys.effects.influences.iter();
        influences.find(|(index, _)| *index == puddle).map(|(_, keyed)| keyed.at(time_s))
    }

    /// Sets all of these to a time in seconds.
    pub(super) fn set_effects(&mut self, keys: &EffectKeys, time_s: f64) {
        (self.fog, self.glow, self.splashes) =
            (self.fog_at(time_s), self.glow_at(time_s), self.splashes_at(time_s));
        if let Some(brightness) = &keys.brightness {
            self.lightning.set_brightness(brightness.at(time_s));
        }
        for (index, influence) in &keys.influences {
            if let Some(puddle) = self.puddles.get_mut(*index) {
                puddle.ripple_influence = influence.at(time_s);
            }
        }
    }
}
