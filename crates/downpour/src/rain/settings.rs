//! Settings of rain in a host application.

use downpour_drop::air::Air;
use downpour_drop::distribution::DropSizeLaw;
use downpour_math::{OutOfRange, in_range};
use downpour_sim::simulation::Bounce;
use downpour_trace::data::MAX_RAY_SPACING;
use downpour_weather::{Look, Splashes, Spray};
use downpour_wind::{UniformWind, Wind};

use super::{RainError, RainView};

/// Settings of rain in a host application. The physics is that of a weather file.
#[derive(Clone, Debug)]
pub struct RainSettings {
    /// Rain rate, 0 to 500 mm/h.
    pub rate_mm_h: f64,
    /// Drop size distribution.
    pub sizes: DropSizeLaw,
    /// Air that the drops fall through.
    pub air: Air,
    /// Wind that carries them: uniform, with gusts.
    pub wind: Wind,
    /// Seed: the same seed, the same drops.
    pub seed: u64,
    /// Most drops that are drawn one by one, at least 1. What is beyond is drawn as extinction and scattered light.
    pub max_drops: u32,
    /// Distance in pixels between those whose rays look for the light of lamps on the drops that are not drawn one by one, which the pixels
    /// between take from them: 1 to 4; 1: all do. It is the same within 0.3 %, and 2 to 4 times as fast before many lamps.
    pub ray_spacing: u32,
    /// Least distance of drops from the eye, m.
    pub near_m: f64,
    /// Largest distance of drops that are drawn one by one, m.
    pub far_m: f64,
    /// Splashes where drops hit obstacles ([`Rain::set_obstacles`](super::Rain::set_obstacles)).
    pub splashes: Splashes,
    /// Mist of droplets over obstacles that drops hit, on a film of water as deep as that of the splashes.
    pub spray: Spray,
    /// Droplets that rebound from obstacles; a fraction of 0: none.
    pub bounce: Bounce,
    /// Artistic multipliers.
    pub look: Look,
}

impl Default for RainSettings {
    /// 10 mm/h of Marshall & Palmer's sizes in still standard air; up to 200 000 drops from 5 cm to 50 m, which splash on half a
    /// millimeter of water.
    fn default() -> Self {
        Self {
            rate_mm_h: 10.0,
            sizes: DropSizeLaw::MarshallPalmer1948,
            air: Air::standard(),
            wind: Wind::default(),
            seed: 0,
            max_drops: 200_000,
            ray_spacing: 1,
            near_m: 0.05,
            far_m: 50.0,
            splashes: Splashes::default(),
            spray: Spray::default(),
            bounce: Bounce::default(),
            look: Look::PHYSICAL,
        }
    }
}

impl RainSettings {
    /// The wind, if it is the same everywhere.
    pub(super) fn uniform_wind(&self) -> Result<UniformWind, RainError> {
        self.wind.uniform().ok_or(RainError::WindNotUniform)
    }

    pub(super) fn check(&self) -> Result<(), OutOfRange> {
        in_range("rain rate", self.rate_mm_h, "mm/h", &(0.0..=500.0), 1.0, "0 to 500")?;
        in_range("most drops", self.max_drops, "", &(1..=1 << 24), 1.0, "1 to 16777216")?;
        in_range("spacing of rays", self.ray_spacing, "", &(1..=MAX_RAY_SPACING), 1.0, "1 to 4")?;
        in_range("least distance of drops", self.near_m, "m", &(0.001..=1.0e3), 1.0, "0.001 to 1000")?;
        in_range(
            "largest distance of drops",
            self.far_m,
            "m",
            &(self.near_m..=1.0e5),
            1.0,
            "the least distance to 1e5",
        )?;
        in_range("size of splashes", self.splashes.size, "", &(0.1..=10.0), 1.0, "0.1 to 10")?;
        in_range("visibility of rain", self.look.visibility, "", &(0.0..=20.0), 1.0, "0 to 20")?;
        in_range("length of streaks", self.look.streak_length, "", &(0.0..=20.0), 1.0, "0 to 20")?;
        in_range("density of spray", self.look.spray, "", &(0.0..=20.0), 1.0, "0 to 20")?;
        let bounce = &self.bounce;
        for (name, value, range, allowed) in [
            ("fraction of impacts that rebound", bounce.fraction, 0.0..=1.0, "0 to 1"),
            ("restitution of rebounds", bounce.restitution, 0.0..=1.0, "0 to 1"),
            ("grip of rebounds", bounce.grip, 0.0..=1.0, "0 to 1"),
            ("size of droplets that rebound", bounce.size, 0.05..=1.0, "0.05 to 1"),
        ] {
            in_range(name, value, "", &range, 1.0, allowed)?;
        }
        in_range("time of droplets that rebound", bounce.max_time_s, "s", &(0.01..=10.0), 1.0, "0.01 to 10")?;
        Ok(())
    }
}

/// # Errors
/// [`OutOfRange`] for an exposure time or a motion outside its range; camera and time are checked where they are used.
pub(super) fn check_view(view: &RainView) -> Result<(), OutOfRange> {
    in_range("exposure time", view.shutter_s, "s", &(0.0..=1.0), 1.0, "0 to 1")?;
    for v in view.motion.velocity.to_array() {
        in_range("velocity of the camera", v, "m/s", &(-1.0e4..=1.0e4), 1.0, "-1e4 to 1e4 each way")?;
    }
    for v in view.motion.turning.to_array() {
        in_range("turning of the camera", v, "rad/s", &(-100.0..=100.0), 1.0, "-100 to 100 about each axis")?;
    }
    Ok(())
}
