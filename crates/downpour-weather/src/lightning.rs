//! Lightning: flashes by hand and from a seed, as light over the time of an exposure.
//!
//! A flash has return strokes, 3 to 5 on the mean, 40 to 60 ms apart, from one position (Rakov & Uman, *Lightning*, 2003, table 1.1).
//! The light of each rises in less than a millisecond and decays in some 10 ms ([`StrokePulse`]); it comes from far away, as
//! parallel light. The clouds that it lights shine too.
//!
//! All is a function of time, in closed form: an exposure has the same light whichever was asked for before.

mod exposure;
mod limit;
mod storm;
mod stroke;
mod tables;

pub use exposure::{FlashExposure, FlashLight};
pub use storm::Storm;
pub use stroke::StrokePulse;
pub(super) use tables::{FlashTable, LightningTable};

/// Maximum number of entries `[[flash]]`.
pub const MAX_FLASHES: usize = 1024;

/// Maximum number of strokes of a flash.
pub const MAX_STROKES: usize = 32;

/// Maximum number of strokes by hand in any one second: each is a lamp of its own.
pub const MAX_STROKES_PER_SECOND: usize = 64;

/// A flash of lightning.
#[derive(Clone, Debug, PartialEq)]
pub struct Flash {
    /// Time of the first stroke, s.
    pub time_s: f64,
    /// Unit direction toward the flash.
    pub towards: [f64; 3],
    /// Tint, linear.
    pub color: [f64; 3],
    /// Time constant of the rise of each stroke, s.
    pub rise_s: f64,
    /// Illuminance of level ground by the clouds that the flash lights, over that of a surface that faces the flash.
    pub clouds: f64,
    /// Strokes, in order of time.
    pub strokes: Vec<Stroke>,
}

/// A return stroke of a flash.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// Time after the first stroke, s.
    pub after_s: f64,
    /// Maximum illuminance of a surface that faces the flash, lux.
    pub illuminance_lux: f64,
    /// Time constant of the decay of its light, s.
    pub decay_s: f64,
}

/// A stroke with what it has of its flash.
#[derive(Clone, Copy, Debug, PartialEq)]
struct StrokeOf {
    pulse: StrokePulse,
    towards: [f64; 3],
    color: [f64; 3],
    clouds: f64,
}

impl Flash {
    /// Its strokes.
    fn strokes_of(&self) -> impl Iterator<Item = StrokeOf> + '_ {
        self.strokes.iter().map(|stroke| StrokeOf {
            pulse: StrokePulse {
                begin_s: self.time_s + stroke.after_s,
                peak_lux: stroke.illuminance_lux,
                rise_s: self.rise_s,
                decay_s: stroke.decay_s,
            },
            towards: self.towards,
            color: self.color,
            clouds: self.clouds,
        })
    }
}

/// Lightning of a weather.
#[derive(Clone, Debug, PartialEq)]
pub struct Lightning {
    /// Flashes by hand, in order of time.
    flashes: Vec<Flash>,
    /// Flashes from a seed.
    storm: Option<Storm>,
    /// True if no second has more than three strokes.
    is_limited: bool,
    /// Strokes by hand that are kept, in order of time.
    strokes: Vec<StrokeOf>,
}

impl Default for Lightning {
    /// None.
    fn default() -> Self {
        Self::new(Vec::new(), None, true)
    }
}

impl Lightning {
    /// Flashes by hand and from a seed. `is_limited`: no second has more than three strokes, for viewers who are sensitive to flashes
    /// (WCAG 2.2, 2.3.1); those that would be too many are left out.
    #[must_use]
    pub fn new(flashes: Vec<Flash>, storm: Option<Storm>, is_limited: bool) -> Self {
        let mut strokes: Vec<StrokeOf> = flashes.iter().flat_map(Flash::strokes_of).collect();
        strokes.sort_by(|a, b| a.pulse.begin_s.total_cmp(&b.pulse.begin_s));
        if is_limited {
            strokes = limit::limited(strokes);
        }
        Self { flashes, storm, is_limited, strokes }
    }

    /// Sets the brightness of the flashes from a seed.
    pub(super) fn set_brightness(&mut self, brightness: f64) {
        if let Some(storm) = &mut self.storm {
            storm.brightness = brightness;
        }
    }

    /// Flashes by hand, in order of time.
    #[must_use]
    pub fn flashes(&self) -> &[Flash] {
        &self.flashes
    }

    /// Flashes from a seed.
    #[must_use]
    pub fn storm(&self) -> Option<&Storm> {
        self.storm.as_ref()
    }

    /// True if no second has more than three strokes.
    #[must_use]
    pub fn is_limited(&self) -> bool {
        self.is_limited
    }

    /// True if there is none at any time.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.strokes.is_empty() && self.storm.is_none()
    }

    /// Strokes by hand that the limit has left out.
    #[must_use]
    pub fn left_out(&self) -> usize {
        let all: usize = self.flashes.iter().map(|flash| flash.strokes.len()).sum();
        all.saturating_sub(self.strokes.len())
    }

    /// Light of the strokes that shine between two times in s, in order of time.
    #[must_use]
    pub fn pulses(&self, from_s: f64, to_s: f64) -> Vec<StrokePulse> {
        self.strokes(from_s, to_s).into_iter().map(|of| of.pulse).collect()
    }

    /// The strokes that shine between two times in s, in order of time.
    fn strokes(&self, from_s: f64, to_s: f64) -> Vec<StrokeOf> {
        let shines = |of: &StrokeOf| of.pulse.begin_s <= to_s && of.pulse.end_s() > from_s;
        let mut found: Vec<StrokeOf> = self.strokes.iter().copied().filter(shines).collect();
        if let Some(storm) = &self.storm {
            let first_s = from_s - storm::MAX_LIT_S;
            let drawn = if self.is_limited {
                limit::limited_storm(storm, &self.strokes, first_s, to_s)
            } else {
                storm.between(first_s, to_s).iter().flat_map(Flash::strokes_of).collect()
            };
            found.extend(drawn.into_iter().filter(shines));
        }
        found.sort_by(|a, b| a.pulse.begin_s.total_cmp(&b.pulse.begin_s));
        found
    }
}
