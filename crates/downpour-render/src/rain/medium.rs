//! Unresolved rain: drops that a picture does not draw one by one, as a medium along a ray. Twin of
//! `shaders/wgsl/render/medium.wgsl`.
//!
//! Drops that are too small on the picture, too far, or outside the region in which drops are simulated take out light and
//! scatter it as drawn drops do, so that the mean of a picture does not depend on which drops it draws:
//!
//! - a drop takes out what its outline covers ([`ExtinctionEfficiency`]), seen from where the ray comes;
//! - in place of what it takes out it shows the mean radiance of a drop ([`StreakTable`](super::StreakTable));
//! - lamps and the sun are scattered by the phase function of a drop of water ([`MediumLight`]), with a ray that asks what
//!   is hidden;
//! - where something keeps the rain off there is no medium (module `open`).
//!
//! A sky map is taken to be the sky as it is seen through the rain beyond 50 m.

pub(super) mod filter;
pub mod fog;
mod frame;
mod light;
mod open;
pub(super) mod phase;
mod smooth;
pub mod spread;
pub mod streaks;

use downpour_drop::DropError;
use downpour_drop::distribution::{DropSizeDistribution, ExtinctionEfficiency};
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_math::ops::f64 as ops;
use downpour_shaders::render::medium::{MEDIUM_NEAR, MEDIUM_QUARTERS, MEDIUM_SKY_REACH, MEDIUM_SLICES};
use downpour_shaders::render::rain::PROJECT_NO_CLASS;
use downpour_sim::resolved::{Region, Resolved};
use downpour_weather::Fog;
use glam::{DVec3, Vec3};

use super::DropMasks;
use super::project::project_class;
pub use frame::{MediumFrame, MediumShell};
pub use light::MediumLight;
pub(super) use light::lamps_of;
use streaks::{Shell, shell_of};

/// Entries of the table.
const ENTRIES: usize = 4 * MEDIUM_QUARTERS as usize;

/// Bins of diameter per factor of two.
const BINS_PER_OCTAVE: f64 = 16.0;

/// Plane of a pane of glass in front of an eye: there is no rain on the eye's side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PanePlane {
    /// Unit normal, away from the eye.
    pub outward: Vec3,
    /// Distance of the plane from the eye, m, above 0.
    pub distance: f32,
}

/// Look of unresolved rain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MediumGrain {
    /// The mean of its drops everywhere.
    #[default]
    Even,
    /// Streaks, with the mean and the variance of its drops ([`streaks`]).
    Streaks,
}

/// Options of unresolved rain besides its drop sizes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MediumOptions {
    /// Extinction cross section of a drop over the area of its outline.
    pub efficiency: ExtinctionEfficiency,
    /// Mean velocity of the drops, m/s.
    pub velocity: Vec3,
    /// Origin to which the scene's buffers are relative, m.
    pub origin: DVec3,
    /// A pane before the eye.
    pub pane: Option<PanePlane>,
    /// Look of the drops.
    pub grain: MediumGrain,
    /// Multiple of the light that a drop takes out and gives: 1 is what physics gives.
    pub visibility: f64,
}

impl Default for MediumOptions {
    /// A camera's efficiency, drops that fall straight down, the world's origin, even.
    fn default() -> Self {
        Self {
            efficiency: ExtinctionEfficiency::Camera,
            velocity: Vec3::new(0.0, -5.0, 0.0),
            origin: DVec3::ZERO,
            pane: None,
            grain: MediumGrain::Even,
            visibility: 1.0,
        }
    }
}

/// Unresolved rain in front of an eye, as a participating medium. The default is no rain.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RainMedium {
    /// Optical depth of level rays, at 0.25 m, then a factor of 2^(1/3) farther each.
    depths: [f32; ENTRIES],
    /// Extinction of all drops for level rays, 1/m.
    all: f32,
    /// Relative excess of the area of a drop's outline from straight above over that from the side.
    flatness: f32,
    /// Unit vector against the mean fall.
    rise: Vec3,
    /// Region in which drops are simulated, relative to the scene's origin.
    region: Region,
    /// Mean row of the masks' diameters, weighted by outline.
    row: f32,
    /// Mean diameter of all drops, weighted by outline, m.
    mean_diameter_m: f64,
    /// Rate of the sizes that are nowhere drawn, mm/h.
    rate_mm_h: f64,
    pane: Option<PanePlane>,
    /// Fog, its base relative to the scene's origin.
    fog: Option<Fog>,
    grain: MediumGrain,
    /// Mean velocity of the drops, and the fall speed in it, m/s.
    velocity: Vec3,
    fall_speed: f32,
    /// Unresolved drops by distance.
    shells: [Shell; MEDIUM_SLICES as usize],
}

impl RainMedium {
    /// Creates the medium of all drops of a rain that a picture's list of drops does not hold.
    ///
    /// # Errors
    /// [`DropError`] if the distribution cannot be cut into bins.
    pub fn new(
        rain: &DropSizeDistribution,
        resolved: &Resolved,
        masks: &DropMasks,
        options: &MediumOptions,
    ) -> Result<Self, DropError> {
        if rain.rate_mm_h() <= 0.0 || options.visibility <= 0.0 {
            return Ok(Self::default());
        }
        let mut depths = [0.0f64; ENTRIES];
        let (mut all, mut above, mut rate_mm_h) = (0.0, 0.0, 0.0);
        let (mut weight, mut row) = (0.0, 0.0);
        let mut diameters = 0.0;
        let speeds = TerminalSpeed::new(rain.options().fall_speed, &rain.options().air);
        // By shell, with their thickness: squares of the outlines' areas per volume, and these times fall speeds.
        let mut squares = [[0.0f64; 2]; MEDIUM_SLICES as usize];
        // A bin on both sides of the least diameter of the list would count as listed as a whole.
        let cut = resolved.min_diameter;
        let bins = rain.diameter_classes(BINS_PER_OCTAVE).into_iter().flat_map(|[lower, upper]| {
            let between = cut.clamp(lower, upper);
            [[lower, between], [between, upper]]
        });
        for [lower, upper] in bins {
            // A sliver would be too thin a bin.
            if upper - lower <= 1.0e-6 {
                continue;
            }
            let part = rain.restricted_to(lower, upper)?;
            let diameter = (lower * upper).sqrt();
            let shown = part.cross_section() * options.visibility;
            let level = shown * masks.outline(diameter as f32, 0.0);
            let extinction = options.efficiency.factor() * level;
            // Diffraction, where it is counted, is everywhere; outlines only where drops are not drawn.
            let (near, far) = (resolved.near, resolved.range(diameter));
            let drawn = |distance: f64| (distance.min(far) - near).max(0.0);
            all += extinction;
            diameters += extinction * diameter;
            above += options.efficiency.factor()
                * shown
                * masks.outline(diameter as f32, std::f32::consts::FRAC_PI_2);
            if far <= 0.0 {
                rate_mm_h += part.integrated_rate_mm_h();
            }
            for (entry, depth) in depths.iter_mut().enumerate() {
                let distance = distance_of(entry);
                *depth += extinction * distance - level * drawn(distance);
            }
            let square = level * level / part.number_density().max(f64::MIN_POSITIVE);
            let speed = speeds.at(diameter).unwrap_or_default();
            for (index, [sum, weighted]) in (0u32..).zip(&mut squares) {
                let [begin, end] = shell_of(index).map(f64::from);
                // What is nearer than any drop that is drawn would be no streak.
                let beyond = |distance: f64| distance.max(near) - drawn(distance);
                let thickness = beyond(end) - beyond(begin);
                *sum += square * thickness;
                *weighted += square * thickness * speed;
            }
            let reach = f64::from(MEDIUM_SKY_REACH);
            let unresolved = level * (reach - drawn(reach));
            weight += unresolved;
            row += unresolved * f64::from(masks.project_lookup(diameter as f32, 0.0).index[0]);
        }
        let made = Self {
            depths: depths.map(|depth| depth as f32),
            all: all as f32,
            flatness: (above / all - 1.0) as f32,
            rise: Vec3::Y,
            region: relative_to(resolved.region, options.origin),
            row: if weight > 0.0 { (row / weight) as f32 } else { 0.0 },
            mean_diameter_m: diameters / all,
            rate_mm_h,
            pane: options.pane,
            fog: None,
            grain: options.grain,
            velocity: options.velocity,
            fall_speed: speeds.at(rain.effective_diameter()).unwrap_or_default() as f32,
            shells: std::array::from_fn(|index| {
                let ([begin, end], [sum, weighted]) = (shell_of(index as u32), squares[index]);
                Shell {
                    squares: (sum / f64::from(end - begin)) as f32,
                    speed: (weighted / sum.max(f64::MIN_POSITIVE)) as f32,
                }
            }),
        };
        Ok(made.with_velocity(options.velocity))
    }

    /// The same medium of drops with another mean velocity, m/s.
    #[must_use]
    pub fn with_velocity(self, velocity: Vec3) -> Self {
        Self { velocity, rise: (-velocity).try_normalize().unwrap_or(Vec3::Y), ..self }
    }

    /// Mean velocity of the drops, m/s.
    #[must_use]
    pub fn velocity(&self) -> Vec3 {
        self.velocity
    }

    /// Unit vector against the mean fall.
    pub(super) fn rise(&self) -> Vec3 {
        self.rise
    }

    /// Extinction of all drops, drawn or not, for level rays, 1/m.
    #[must_use]
    pub fn extinction(&self) -> f64 {
        self.all.into()
    }

    /// Mean diameter of all drops, drawn or not, weighted by the areas of their outlines, m; `None` without rain.
    #[must_use]
    pub fn mean_diameter_m(&self) -> Option<f64> {
        (self.all > 0.0).then_some(self.mean_diameter_m)
    }

    /// Fraction of the extinction of a level ray of 50 m within the simulated region that is not drawn drop by drop, 0 to 1.
    #[must_use]
    pub fn unresolved_fraction(&self) -> f64 {
        let reach = f64::from(MEDIUM_SKY_REACH);
        let frame = MediumFrame::new(self, Vec3::ZERO, [1, 1]);
        if self.all > 0.0 {
            f64::from(frame.medium_within(reach as f32)) / (self.extinction() * reach)
        } else {
            0.0
        }
    }

    /// Rain rate of the drop sizes that are never drawn one by one, mm/h.
    #[must_use]
    pub fn unresolved_rate_mm_h(&self) -> f64 {
        self.rate_mm_h
    }

    /// Class of the masks' diameters whose mean radiance unresolved drops have; `PROJECT_NO_CLASS` without rain.
    #[must_use]
    pub fn class(&self) -> u32 {
        if self.all > 0.0 { project_class(self.row) } else { PROJECT_NO_CLASS }
    }
}

/// Distance of an entry of the table, m.
fn distance_of(entry: usize) -> f64 {
    f64::from(MEDIUM_NEAR) * ops::pow(2.0, entry as f64 / 3.0)
}

fn relative_to(region: Region, origin: DVec3) -> Region {
    match region {
        Region::Box { center, size } => Region::Box { center: center - origin, size },
        Region::Sphere { center, radius } => Region::Sphere { center: center - origin, radius },
        Region::Cylinder { base, radius, height } => Region::Cylinder { base: base - origin, radius, height },
        _ => region,
    }
}
