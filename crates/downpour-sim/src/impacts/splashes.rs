//! Crowns of the splashes of impacts.

use downpour_drop::splash::{Splash, SplashLaw, crown};
use downpour_math::in_range;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::sim::splash::{
    SPLASH_HIGH, SPLASH_LEVEL, SPLASH_LOW, SPLASH_MAX_S, SPLASH_MAX_SIZE, SPLASH_MIN_SIZE, SPLASH_SIZE,
};

use super::places::Places;
use super::{Candidate, Impact, OfClass};
use crate::SimError;
use crate::facets::Facets;
use crate::falling::{DropKind, FallingDrop};
use crate::field::{Class, RainField, check_time};
use crate::shelter::Obstacles;
use crate::view::{Bounds, View, within};
use glam::DVec3;

/// Difference between the id of a drop and that of its splash.
const SPLASH: u64 = (SPLASH_HIGH as u64) << 32 | SPLASH_LOW as u64;

/// Range of the random size of a splash, relative to the law.
const SIZES: [f64; 2] = [SPLASH_MIN_SIZE as f64, SPLASH_MAX_SIZE as f64];

/// Crowns are drawn from this width on the picture on, in pixels: below, they are no more than the texture of the ground.
pub(crate) const MIN_PIXELS: f64 = 3.0;

/// Least vertical component of the normal of a surface on which crowns stand: none hang from what looks down.
const LEVEL: f32 = SPLASH_LEVEL;

/// Longest duration of a crown, s: that of a drop of 5 mm at terminal speed.
pub(crate) const MAX_CROWN_S: f64 = SPLASH_MAX_S as f64;

/// Largest number of crowns of a picture.
const MAX_COUNT: usize = 65_536;

/// Splashes of a rain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplashOptions {
    /// Size, duration and threshold.
    pub law: SplashLaw,
    /// Factor of the size of crowns: 1 is that of the law.
    pub size: f64,
}

impl RainField {
    /// Crowns of splashes that a picture shows at a time in seconds: of drops that have hit a surface that does not look down, from 3
    /// pixels wide on. They stand along its normal where the drop hit until they have fallen back; what moves under them meanwhile leaves them. Of more
    /// than 65 536 those of the smallest drops are left out.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for an invalid view or size (0.1 to 10), or a time beyond
    /// [`MAX_TIME_S`](crate::field::MAX_TIME_S).
    pub fn splashes(
        &self,
        obstacles: &Obstacles<'_>,
        view: &View,
        time_s: f64,
        options: &SplashOptions,
    ) -> Result<Vec<FallingDrop>, SimError> {
        options.check(view, time_s)?;
        let sides = view.sides();
        // The wind adds to the speed of a drop toward a slope.
        let wind = self.wind.velocity(time_s).length();
        let reach = |diameter: f64, speed: f64| options.largest_crown(view, diameter, speed + wind);
        let of_class = |class: &Class| {
            let (radius, range) = reach(class.largest, class.speeds[1])?;
            let in_part = move |place: &Bounds| is_shown(view, &sides, place.ball(), (radius, range));
            let wanted = move |drop: &Candidate| {
                let found = reach(drop.diameter.into(), drop.speed);
                found.is_some_and(|crown| is_shown(view, &sides, drop.ball(), crown))
            };
            (range >= view.near).then(|| OfClass { bounds: view.bounds(range, radius), in_part, wanted })
        };
        let span_s = [time_s - MAX_CROWN_S, time_s];
        let crown = |impact: &Impact| options.crown(impact, view, time_s);
        let mut places = Places::new(obstacles, LEVEL);
        let crowns = self.impacts_of(&Facets::new(obstacles), &mut places, span_s, of_class, crown)?;
        Ok(largest(crowns))
    }
}

/// The largest crowns, as many as a picture may have.
pub(crate) fn largest(mut crowns: Vec<FallingDrop>) -> Vec<FallingDrop> {
    if crowns.len() > MAX_COUNT {
        crowns.sort_by(|a, b| b.diameter.total_cmp(&a.diameter).then(a.id.cmp(&b.id)));
        crowns.truncate(MAX_COUNT);
    }
    crowns
}

/// True if a picture may show a crown that stands in a ball, of a radius and up to a distance as [`SplashOptions::largest_crown`] has them.
pub(crate) fn is_shown(
    view: &View,
    sides: &[DVec3; 5],
    (middle, half): (DVec3, f64),
    (radius, range): (f64, f64),
) -> bool {
    let offset = middle - view.eye;
    offset.length() - half - radius <= range && within(sides, offset, half + 1.5 * radius)
}

impl SplashOptions {
    /// Checks the picture, and that the size is 0.1 to 10.
    pub(crate) fn check(&self, view: &View, time_s: f64) -> Result<(), SimError> {
        view.check()?;
        check_time(time_s)?;
        in_range("size of splashes", self.size, "", &(0.1..=10.0), 1.0, "0.1 to 10")?;
        Ok(())
    }

    /// Radius of the largest crown of a drop of a diameter in m that meets a surface at a speed in m/s, and the distance up to which a
    /// picture shows it, m; `None` if it does not splash.
    pub(crate) fn largest_crown(&self, view: &View, diameter: f64, speed: f64) -> Option<(f64, f64)> {
        let radius = self.law.splash(diameter, speed)?.radius_m * self.size * SIZES[1];
        Some((radius, view.range(2.0 * radius, MIN_PIXELS)))
    }

    /// Crown of an impact at a time in s, if there is one and the picture shows it.
    pub(crate) fn crown(&self, impact: &Impact, view: &View, time_s: f64) -> Option<FallingDrop> {
        let age_s = time_s - impact.time_s;
        let toward = -f64::from(impact.velocity.dot(impact.normal));
        let Splash { radius_m, duration_s } = self.law.splash(impact.diameter.into(), toward)?;
        let duration_s = duration_s.min(MAX_CROWN_S);
        if impact.normal.y < LEVEL || !(0.0..duration_s).contains(&age_s) {
            return None;
        }
        let [chance, ..] =
            rng_draw([impact.id as u32, (impact.id >> 32) as u32], 0, 0, SPLASH_SIZE).map(rng_unit);
        let random = SIZES[0] + (SIZES[1] - SIZES[0]) * f64::from(chance);
        let radius = radius_m * self.size * random;
        let position =
            impact.position + impact.normal.as_dvec3() * (radius * crown::middle(age_s / duration_s));
        let range = view.range(2.0 * radius, MIN_PIXELS);
        let offset = position - view.eye;
        // The mask reaches beyond the largest radius, to the droplets of the rim.
        let shown = offset.length() < range && within(&view.sides(), offset, 1.5 * radius);
        shown.then(|| FallingDrop {
            position,
            velocity: [0.0; 3],
            diameter: (2.0 * radius) as f32,
            id: impact.id ^ SPLASH,
            kind: DropKind::Splash,
            present_s: [-age_s, duration_s - age_s].map(|time| time as f32),
            normal: impact.normal.into(),
        })
    }
}
