//! Wipers: blades that rotate about a pivot and push the water ahead of them.

use downpour_math::in_range;
use std::f64::consts::PI;

use downpour_math::ops::f64 as ops;

use super::blade::{GlassBlade, glass_blade_side};
use super::error::GlassError;
use super::lattice::UNIT_M3;
use super::options::GlassOptions;

/// Angle of a blade at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlassWiperKey {
    /// Time, s.
    pub time_s: f64,
    /// Angle, rad, as in [`GlassWiperMotion::Sweep`].
    pub angle_rad: f64,
}

/// Motion of a blade. Angles are radians from +x (right) toward the top of the pane, -7 to 7.
#[derive(Clone, Debug, PartialEq)]
pub enum GlassWiperMotion {
    /// Back and forth in a period, as driven by a crank: `(1 - cos(2 pi t / period)) / 2` of the range.
    Sweep {
        /// Angle at the start.
        from_rad: f64,
        /// Angle after half of the period.
        to_rad: f64,
        /// Period, s.
        period_s: f64,
    },
    /// Angles at increasing times, linear between them, constant before the first and after the last.
    Keys(Vec<GlassWiperKey>),
}

/// A part of a blade that leaves water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlassWornBand {
    /// Start, m from the pivot.
    pub from_m: f64,
    /// End, m from the pivot.
    pub to_m: f64,
    /// Fraction of the water that stays behind, 0 to 1.
    pub leaves: f64,
}

/// A wiper. Its blade rotates by at most 20 rad/s.
#[derive(Clone, Debug, PartialEq)]
pub struct GlassWiper {
    /// Pivot, m right of and below the upper left corner of the pane; at most as far outside as the pane is wide.
    pub pivot_m: [f64; 2],
    /// Start of the blade, m from the pivot.
    pub inner_m: f64,
    /// End of the blade, m from the pivot.
    pub outer_m: f64,
    /// Motion of the blade.
    pub motion: GlassWiperMotion,
    /// Thickness of the film that the blade leaves, m: 0 to 20e-6.
    pub film_m: f64,
    /// Worn bands, in order from the pivot, without overlap.
    pub worn: Vec<GlassWornBand>,
}

const MAX_SPEED_RAD_S: f64 = 20.0;

impl GlassWiper {
    /// Half of the width of a blade's lip, m: the ridge that it pushes begins in front of it.
    pub const LIP_M: f64 = 3.0e-3;

    pub(super) fn check(&self, index: usize, options: &GlassOptions) -> Result<(), GlassError> {
        let [width, height] = options.size.map(|n| f64::from(n) * options.cell_m);
        let [x, y] = self.pivot_m;
        let outside = GlassError::WiperOutside { index, x, y };
        if !(-width..=2.0 * width).contains(&x) || !(-height..=2.0 * height).contains(&y) {
            return Err(outside);
        }
        let reach = 2.0 * (width + height);
        in_range("end of a blade", self.outer_m, "m", &(1.0e-3..=reach), 1.0, "0.001 to twice the pane")?;
        in_range("start of a blade", self.inner_m, "m", &(0.0..=self.outer_m), 1.0, "0 to the blade's end")?;
        let away = |at: f64, size: f64| (-at).max(at - size).max(0.0);
        let far = |at: f64, size: f64| at.abs().max((at - size).abs());
        if ops::hypot(away(x, width), away(y, height)) > self.outer_m
            || ops::hypot(far(x, width), far(y, height)) < self.inner_m
        {
            return Err(outside);
        }
        in_range("film behind a blade", self.film_m, "um", &(0.0..=20.0e-6), 1.0e6, "0 to 20")?;
        let mut from = self.inner_m;
        for band in &self.worn {
            in_range(
                "start of a worn band",
                band.from_m,
                "m",
                &(from..=self.outer_m),
                1.0,
                "on the blade, in order",
            )?;
            in_range(
                "end of a worn band",
                band.to_m,
                "m",
                &(band.from_m..=self.outer_m),
                1.0,
                "on the blade",
            )?;
            in_range("fraction that a worn band leaves", band.leaves, "", &(0.0..=1.0), 1.0, "0 to 1")?;
            from = band.to_m;
        }
        self.check_motion()
    }

    fn check_motion(&self) -> Result<(), GlassError> {
        let angle = |a: f64| in_range("angle of a blade", a, "rad", &(-7.0..=7.0), 1.0, "-7 to 7");
        match &self.motion {
            GlassWiperMotion::Sweep { from_rad, to_rad, period_s } => {
                angle(*from_rad)?;
                angle(*to_rad)?;
                in_range("period of a wiper", *period_s, "s", &(0.1..=1.0e6), 1.0, "0.1 to 1e6")?;
            }
            GlassWiperMotion::Keys(keys) => {
                in_range("number of a wiper's keys", keys.len() as f64, "", &(1.0..=1.0e6), 1.0, "1 to 1e6")?;
                let mut before = f64::NEG_INFINITY;
                for key in keys {
                    angle(key.angle_rad)?;
                    let apart = before + 1.0e-3;
                    in_range(
                        "time of a wiper's key",
                        key.time_s,
                        "s",
                        &(apart.max(-1.0e9)..=1.0e9),
                        1.0,
                        "rising by 1 ms at least",
                    )?;
                    before = key.time_s;
                }
            }
        }
        in_range("speed of a blade", self.max_speed(), "rad/s", &(0.0..=MAX_SPEED_RAD_S), 1.0, "0 to 20")?;
        Ok(())
    }

    /// Maximum speed of the blade, rad/s.
    pub(super) fn max_speed(&self) -> f64 {
        match &self.motion {
            GlassWiperMotion::Sweep { from_rad, to_rad, period_s } => {
                (to_rad - from_rad).abs() * PI / period_s
            }
            GlassWiperMotion::Keys(keys) => keys
                .windows(2)
                .map(|w| match w {
                    [a, b] => ((b.angle_rad - a.angle_rad) / (b.time_s - a.time_s)).abs(),
                    _ => 0.0,
                })
                .fold(0.0, f64::max),
        }
    }

    /// Angle of the blade at a time, rad.
    #[must_use]
    pub fn angle(&self, time_s: f64) -> f64 {
        match &self.motion {
            GlassWiperMotion::Sweep { from_rad, to_rad, period_s } => {
                from_rad + (to_rad - from_rad) * 0.5 * (1.0 - ops::cos(2.0 * PI * time_s / period_s))
            }
            GlassWiperMotion::Keys(keys) => {
                let after = keys.partition_point(|key| key.time_s <= time_s);
                match (after.checked_sub(1).and_then(|k| keys.get(k)), keys.get(after)) {
                    (Some(a), Some(b)) => {
                        let fraction = (time_s - a.time_s) / (b.time_s - a.time_s);
                        a.angle_rad + (b.angle_rad - a.angle_rad) * fraction
                    }
                    (Some(key), None) | (None, Some(key)) => key.angle_rad,
                    (None, None) => 0.0,
                }
            }
        }
    }

    /// Number of parts of the blade.
    pub(super) fn parts(&self) -> usize {
        2 * self.worn.len() + 1
    }

    /// Appends the parts of the blade during a tick, as many as [`GlassWiper::parts`].
    pub(super) fn blades(&self, from_s: f64, to_s: f64, cell_m: f64, blades: &mut Vec<GlassBlade>) {
        let half = |m: f64| (2.0 * m / cell_m).round() as i32;
        let points = |time: f64| {
            let angle = self.angle(time);
            [ops::cos(angle), -ops::sin(angle)].map(|c| (16384.0 * c).round() as i32)
        };
        let (before, after) = (points(from_s), points(to_s));
        let turn = glass_blade_side(before.into(), after.into()).signum();
        let film = (self.film_m * cell_m * cell_m / UNIT_M3 * 65536.0).round().min(400_000.0) as u32;
        let mut part = |from: f64, to: f64, leaves: f64| {
            blades.push(GlassBlade {
                before,
                after,
                pivot: self.pivot_m.map(half),
                reach: [half(from), half(to)],
                turn,
                leaves: (256.0 * leaves).round() as u32,
                film,
                unused: 0,
            });
        };
        let mut from = self.inner_m;
        for band in &self.worn {
            part(from, band.from_m, 0.0);
            part(band.from_m, band.to_m, band.leaves);
            from = band.to_m;
        }
        part(from, self.outer_m, 0.0);
    }
}
