//! Motion of a drop during an exposure, for the tracer.

use downpour_drop::DropShape;
use downpour_drop::air::Air;
use downpour_drop::fall_speed::{FallSpeedModel, terminal_speed};
use downpour_drop::oscillation::{
    Amplitudes, Fluids, FrequencyLaw, OscillatingDrop, Oscillation, drop_oscillation_legendre_20,
    drop_oscillation_legendre_31,
};
use downpour_drop::shape::drop_shape_radius;
use downpour_math::ops::f64 as ops;

use super::SpecimenError;
use super::options::SpecimenOptions;

/// Parts of the half circle of directions, and of each amplitude, among which the farthest point is looked for.
const DIRECTIONS: u32 = 360;
const DISPLACEMENTS: i32 = 4;

/// Ratio of the bounding spheroid to the sampled points.
const MARGIN: f64 = 1.002;

/// A drop that falls at its terminal speed (Beard 1976, at 20 C and 1013.25 hPa) and oscillates, at the origin at time 0. The
/// radius at rest is multiplied by the factor of `downpour_drop::oscillation`, and the volume is conserved; phi = 0, the
/// direction of the lobe of the mode (3,1), is toward +X.
#[derive(Clone, Copy, Debug)]
pub struct SpecimenMotion {
    /// The drop and its oscillation.
    pub drop: OscillatingDrop,
    /// Terminal speed, in volume-equivalent radii per second.
    pub speed: f64,
    /// Fall in half of the exposure, in radii.
    pub farthest: f64,
    /// Instants per sample of the picture.
    pub instants: u32,
    /// 1 / A^2 across and 1 / B^2 along the axis of a spheroid that holds the drop at any time, in radii.
    pub inverse_wide: f64,
    /// As `inverse_wide`.
    pub inverse_tall: f64,
}

impl SpecimenMotion {
    /// Motion for the options; `None` for a drop at rest.
    pub(crate) fn of(shape: &DropShape, options: &SpecimenOptions) -> Result<Option<Self>, SpecimenError> {
        if !options.is_streak() {
            return Ok(None);
        }
        let still = options.oscillation == Amplitudes::NONE;
        let diameter = 2.0 * shape.equivalent_radius();
        // A drop that does not oscillate may be smaller than those that can.
        let tuned = if still { diameter.max(1.0e-3) } else { diameter };
        let oscillation =
            Oscillation::new(tuned, options.oscillation, &Fluids::AT_20_C, FrequencyLaw::default())?
                .with_phases(options.phase);
        let [wide, tall] = spheroid(&OscillatingDrop::new(*shape, oscillation));
        let speed = fall_speed(shape)? / shape.equivalent_radius();
        Ok(Some(Self {
            drop: OscillatingDrop::new(*shape, oscillation),
            speed,
            farthest: 0.5 * speed * options.exposure_s,
            instants: options.instants,
            inverse_wide: 1.0 / (wide * wide),
            inverse_tall: 1.0 / (tall * tall),
        }))
    }

    /// The largest distance of the surface from the drop's origin, in meters.
    pub(crate) fn bounding_radius(&self) -> f64 {
        self.drop.shape().equivalent_radius() / self.inverse_wide.min(self.inverse_tall).sqrt()
    }
}

/// Terminal speed in m/s.
pub(crate) fn fall_speed(shape: &DropShape) -> Result<f64, SpecimenError> {
    Ok(terminal_speed(FallSpeedModel::Beard1976, 2.0 * shape.equivalent_radius(), &Air::standard())?)
}

/// Half axes, across and along, of a spheroid that encloses the drop at all phases.
fn spheroid(drop: &OscillatingDrop) -> [f64; 2] {
    let coefficients = drop.shape().coefficients();
    let amplitudes = drop.oscillation().amplitudes().pair();
    let parts = f64::from(DISPLACEMENTS);
    // Largest radius by direction: the lobe of the mode (3,1) is on either side.
    let mut reach = Vec::with_capacity(DIRECTIONS as usize + 1);
    for i in 0..=DIRECTIONS {
        let theta = std::f64::consts::PI * f64::from(i) / f64::from(DIRECTIONS);
        let (across, x) = (ops::sin(theta), ops::cos(theta));
        let (p20, p31) = (drop_oscillation_legendre_20(x), drop_oscillation_legendre_31(x).abs());
        let mut most = 0.0f64;
        for n in -DISPLACEMENTS..=DISPLACEMENTS {
            for m in 0..=DISPLACEMENTS {
                let displacement =
                    [amplitudes[0] * f64::from(n) / parts, amplitudes[1] * f64::from(m) / parts];
                let factor = 1.0 + displacement[0] * p20 + displacement[1] * p31;
                most = most.max(factor * drop.scale(displacement));
            }
        }
        let radius = most * drop_shape_radius(&coefficients, x);
        reach.push([radius * across, radius * x]);
    }
    let largest = |axis: usize| reach.iter().map(|p| p[axis].abs()).fold(0.0, f64::max);
    let (wide, tall) = (largest(0), largest(1));
    let gauge = |p: &[f64; 2]| ops::hypot(p[0] / wide, p[1] / tall);
    let grow = reach.iter().map(gauge).fold(1.0, f64::max) * MARGIN;
    [wide * grow, tall * grow]
}
