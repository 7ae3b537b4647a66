//! Spray of rain: the layer of droplets that impacts throw up over everything that rain hits.
//!
//! Laws:
//! - thrown share: `0.75 (1 - exp(-0.003 (K - K_c)))` of the water of a drop whose splash parameter `K` is above `K_c`, on a film of water of
//!   depth `h` with `K_c = 63.5 + 226 (h / d)^0.72` (O. Ahamed et al. 2022, at 1 bar and 20 C; their share is that of a dry surface);
//! - profile: droplets leave the surface with vertical speeds `w` of which `w^2 / 2 g` is spread exponentially, with the mean `H`, and fly
//!   without drag. At any time as much water is in the air as `q T`, `T = sqrt(2 pi H / g)`, for a rate `q` of thrown water, and its density is
//!   `(q T / H) exp(-z / H)` at the height `z`: the atmosphere of one temperature. Such an exponential decrease is measured and simulated over
//!   water in rain (X. Liu, X. Zhang, Q. Zheng, J. H. Duncan, J. Fluid Mech. 2024);
//! - extinction: `3 / (2 D)` of the volume of water per volume of air for droplets of the Sauter mean diameter `D`, as a camera loses light.
//!
//! `H` ([`HEIGHT_M`]) and `D` ([`DROPLET_M`]) are of the order that pictures of rain on streets show, and are not fitted to measurements. (With
//! numbers as the radius to the power of -5/2, which simulations of raindrops on a pool give, `D` is a third of the diameter of the largest droplets.)
//!
//! Units: m, s, m/s.

use std::f64::consts::PI;

use downpour_math::in_range;
use downpour_math::ops::f64 as ops;

use crate::DropError;
use crate::air::STANDARD_GRAVITY as GRAVITY;
use crate::distribution::DropSizeDistribution;
use crate::splash::SplashLaw;

/// Height over which spray thins out by a factor of e, m.
pub const HEIGHT_M: f64 = 0.05;

/// Sauter mean diameter of the droplets, m.
pub const DROPLET_M: f64 = 0.3e-3;

/// Largest share of a drop's water that is thrown up.
const MAX_SHARE: f64 = 0.75;

/// Growth of the share with the splash parameter.
const PER_K: f64 = 0.003;

/// Splash parameter above which a drop throws up water: that of a dry surface, and what a film as deep as the drop adds.
const DRY_K: f64 = 63.5;
const FILM_K: f64 = 226.0;

/// Power of the depth of the film over the drop's diameter.
const FILM_POWER: f64 = 0.72;

/// Spray over a level surface that rain hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spray {
    /// Extinction at the surface, 1/m.
    pub extinction: f64,
    /// Height over which it decreases by a factor of e, m.
    pub height_m: f64,
}

impl Spray {
    /// The spray of a rain that splashes by a law, with droplets of a Sauter mean diameter and a height of its decrease, both m.
    ///
    /// ```
    /// use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
    /// use downpour_drop::splash::{FILM_M, SplashLaw};
    /// use downpour_drop::spray::{DROPLET_M, HEIGHT_M, Spray};
    /// let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 50.0)?;
    /// let spray = Spray::of_rain(&rain, &SplashLaw::new(FILM_M, 20.0)?, DROPLET_M, HEIGHT_M)?;
    /// // Over 10 m just above the ground more than half of the light is lost.
    /// assert!((0.07..0.11).contains(&spray.extinction));
    /// # Ok::<(), downpour_drop::DropError>(())
    /// ```
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] for droplets that are not 0.05 to 1 mm large, or a height that is not 5 mm to 1 m.
    pub fn of_rain(
        rain: &DropSizeDistribution,
        law: &SplashLaw,
        droplet_m: f64,
        height_m: f64,
    ) -> Result<Self, DropError> {
        in_range("droplets of spray", droplet_m, "mm", &(0.05e-3..=1.0e-3), 1.0e3, "0.05 to 1")?;
        in_range("height of spray", height_m, "m", &(0.005..=1.0), 1.0, "0.005 to 1")?;
        let thrown = rain.rate_of_share(|diameter, speed| thrown_share(law, diameter, speed));
        // Volume of water per volume of air at the surface.
        let water = thrown * air_time(height_m) / height_m;
        Ok(Self { extinction: 1.5 * water / droplet_m, height_m })
    }
}

/// Share of the water of a drop of a diameter in m that is thrown up where it meets a surface with a speed toward it in m/s, 0 to 0.75.
#[must_use]
pub fn thrown_share(law: &SplashLaw, diameter_m: f64, speed_m_s: f64) -> f64 {
    let least = DRY_K + FILM_K * ops::pow(law.film_m() / diameter_m, FILM_POWER);
    let above = law.parameter(diameter_m, speed_m_s) - least;
    MAX_SHARE * (1.0 - ops::exp(-PER_K * above.max(0.0)))
}

/// Mean time in s that thrown water is in the air, for a height of its decrease in m.
#[must_use]
pub fn air_time(height_m: f64) -> f64 {
    (2.0 * PI * height_m / GRAVITY).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distribution::DropSizeLaw;
    use crate::splash::FILM_M;
    use downpour_math::rng::{rng_draw, rng_unit};

    fn law() -> SplashLaw {
        SplashLaw::new(FILM_M, 20.0).expect("a law")
    }

    #[test]
    fn the_share_is_that_of_the_formula() {
        // By hand: d = 2 mm at 6.49 m/s has K = 363 (a published table); (0.5 / 2)^0.72 = 0.3686, so K_c = 146.8;
        // 0.75 (1 - exp(-0.003 * 216.2)) = 0.358.
        let share = thrown_share(&law(), 2.0e-3, 6.49);
        assert!((share - 0.358).abs() < 0.006, "{share}");
        // A small drop on a deep film throws nothing, and none throws more than three quarters.
        assert_eq!(thrown_share(&law(), 0.7e-3, 2.87), 0.0);
        assert!((0.6..0.75).contains(&thrown_share(&law(), 6.0e-3, 9.2)));
    }

    /// Droplets that are thrown one by one, and fly as stones do: their time in the air and where they are on the mean.
    #[test]
    fn droplets_that_fly_are_an_atmosphere() {
        let height = 0.05;
        let (mut seconds, mut bins) = (0.0, [0.0f64; 4]);
        let count = 20_000;
        for k in 0..count {
            let [word, ..] = rng_draw([5, 6], k, 0, 0);
            let top = -height * ops::ln(1.0 - f64::from(rng_unit(word)));
            let speed = (2.0 * GRAVITY * top).sqrt();
            seconds += 2.0 * speed / GRAVITY;
            for (n, bin) in bins.iter_mut().enumerate() {
                // Time between two heights, up and down.
                let left = |z: f64| (2.0 * (top - z).max(0.0) / GRAVITY).sqrt();
                *bin += 2.0 * (left(n as f64 * 0.03) - left((n + 1) as f64 * 0.03));
            }
        }
        let mean = seconds / f64::from(count);
        assert!((mean / air_time(height) - 1.0).abs() < 0.01, "{mean}");
        for (n, bin) in bins.iter().enumerate() {
            let (low, high) = (n as f64 * 0.03, (n + 1) as f64 * 0.03);
            let expected = (ops::exp(-low / height) - ops::exp(-high / height)) * air_time(height);
            let found = bin / f64::from(count);
            assert!((found / expected - 1.0).abs() < 0.05, "{n}: {found} and {expected}");
        }
    }

    #[test]
    fn more_rain_throws_up_more() {
        let of = |rate| {
            let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, rate).expect("a rain");
            Spray::of_rain(&rain, &law(), DROPLET_M, HEIGHT_M).expect("spray").extinction
        };
        assert_eq!(of(0.0), 0.0);
        // Larger drops throw a larger share.
        assert!(of(20.0) > 2.0 * of(10.0) && of(20.0) < 3.0 * of(10.0));
        // The same water twice as high and as coarse: T / H / D.
        let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 20.0).expect("a rain");
        let other = Spray::of_rain(&rain, &law(), 2.0 * DROPLET_M, 2.0 * HEIGHT_M).expect("spray");
        assert!((other.extinction * 2.0 * 2.0f64.sqrt() / of(20.0) - 1.0).abs() < 1.0e-9);
    }

    #[test]
    fn spray_has_limits() {
        let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 20.0).expect("a rain");
        for (droplet, height) in [(0.0, 0.05), (2.0e-3, 0.05), (f64::NAN, 0.05), (3.0e-4, 0.0), (3.0e-4, 2.0)]
        {
            assert!(Spray::of_rain(&rain, &law(), droplet, height).is_err(), "{droplet} {height}");
        }
    }
}
