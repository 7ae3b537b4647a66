//! What all drops share in each step, made from what the camera does: the one source of frames for the CPU and the GPU.

use downpour_drop::distribution::DropSizeDistribution;
use downpour_math::rng::seed_words;
use downpour_shaders::sim::step::{
    STEP_VOLUME_AREA, STEP_VOLUME_BOX, STEP_VOLUME_CYLINDER, STEP_VOLUME_TARIQ, STEP_VOLUME_VIEW,
};
use glam::{DVec3, Vec3};

use crate::SimError;
use crate::population::{Population, box_centre};
use crate::resolved::{Region, Resolved};
use crate::simulation::{Drag, SimVolume, SimulationOptions, WIDER};
use crate::step::StepFrame;
use crate::view::View;
use crate::volume::{VolumeEye, volume_backs};

/// The longest step, s: longer times are cut.
const LONGEST_STEP_S: f64 = 1.0 / 30.0;

/// The times that can be asked for at once, s.
const TIMES_S: std::ops::RangeInclusive<f64> = 1.0e-5..=1.0;

/// Makes the frames of a simulation.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) options: SimulationOptions,
    pub(crate) least_pixels: f64,
    pub(crate) least_diameter: f64,
    view: View,
    origin: DVec3,
    step: u32,
}

impl Plan {
    /// The plan and the drops that it begins with.
    pub(crate) fn new(
        rain: &DropSizeDistribution,
        options: &SimulationOptions,
        view: &View,
        origin: DVec3,
    ) -> Result<(Self, Population), SimError> {
        options.check()?;
        view.check()?;
        let wide = widened(view);
        let drops = Population::new(rain, &options.volume, &wide, options.most_drops, options.seed)?;
        let Population { least_pixels, least_diameter, .. } = drops;
        let options = options.clone();
        Ok((Self { options, least_pixels, least_diameter, view: wide, origin, step: 0 }, drops))
    }

    /// The view of now, as wide as drops are simulated.
    pub(crate) fn view(&self) -> &View {
        &self.view
    }

    pub(crate) fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Limits of the list of drops that a picture can show.
    pub(crate) fn resolved(&self, view: &View) -> Resolved {
        let region = match self.options.volume {
            SimVolume::View => Region::Everywhere,
            SimVolume::Box { size_m } => {
                let size = DVec3::from(size_m);
                Region::Box { center: box_centre(&self.view, size), size }
            }
            SimVolume::ImSung => {
                let radius = 0.5 * self.view.far;
                Region::Sphere { center: self.view.eye + self.view.forward * radius, radius }
            }
            SimVolume::Tariq { size_m } => Region::Box { center: self.view.eye, size: size_m.into() },
            SimVolume::Cylinder { base_m, radius_m, height_m } => {
                Region::Cylinder { base: base_m.into(), radius: radius_m, height: height_m }
            }
        };
        Resolved { least_diameter: self.least_diameter, region, ..Resolved::of(view, self.least_pixels) }
    }

    /// The frames of a time in which the camera comes to `view`: one, or as many as the time is too long for.
    pub(crate) fn frames(
        &mut self,
        time_s: f64,
        view: &View,
        origin: DVec3,
        wind: Vec3,
    ) -> Result<Vec<StepFrame>, SimError> {
        if !TIMES_S.contains(&time_s) {
            let (quantity, unit, allowed) = ("time of a step", "s", "1e-5 to 1");
            return Err(SimError::OutOfRange { quantity, found: time_s, unit, allowed });
        }
        view.check()?;
        if !(origin.is_finite() && (view.eye - origin).abs().max_element() <= 1.0e5) {
            let found = (view.eye - origin).abs().max_element();
            let (quantity, unit, allowed) = ("distance of the eye from the origin", "m", "up to 1e5");
            return Err(SimError::OutOfRange { quantity, found, unit, allowed });
        }
        let steps = (time_s / LONGEST_STEP_S).ceil().max(1.0);
        let frames = (0..steps as u32).map(|_| self.frame(time_s / steps, &widened(view), origin, wind));
        Ok(frames.collect())
    }

    fn frame(&mut self, time_s: f64, view: &View, origin: DVec3, wind: Vec3) -> StepFrame {
        let options = &self.options;
        let before = std::mem::replace(&mut self.view, *view);
        let moved_origin = origin - std::mem::replace(&mut self.origin, origin);
        let mut shift = moved_origin;
        let (mut size, mut centre) = (DVec3::ONE, view.eye);
        let mut elsewhere = false;
        let volume = match options.volume {
            SimVolume::Box { size_m } => {
                size = DVec3::from(size_m);
                centre = box_centre(view, size);
                shift -= size * (shift / size).round();
                elsewhere = (view.eye - before.eye).abs().cmpgt(0.5 * size).any();
                STEP_VOLUME_BOX
            }
            SimVolume::View => {
                elsewhere = view.eye.distance(before.eye) > view.far;
                STEP_VOLUME_VIEW
            }
            SimVolume::ImSung => STEP_VOLUME_AREA,
            SimVolume::Tariq { size_m } => {
                size = DVec3::from(size_m);
                STEP_VOLUME_TARIQ
            }
            SimVolume::Cylinder { base_m, radius_m, height_m } => {
                size = DVec3::new(radius_m, height_m, 1.0);
                centre = DVec3::from(base_m) + DVec3::Y * (0.5 * height_m);
                STEP_VOLUME_CYLINDER
            }
        };
        let gauge = options.gauge.unwrap_or_default();
        let old_origin = origin - moved_origin;
        let step = self.step;
        self.step = step.wrapping_add(1);
        StepFrame {
            before: VolumeEye::new(&before, old_origin),
            now: VolumeEye::new(view, origin),
            shift: shift.as_vec3().to_array(),
            count: 0,
            size: size.as_vec3().to_array(),
            first: 0,
            centre: (centre - origin).as_vec3().to_array(),
            volume,
            wind: wind.to_array(),
            time: time_s as f32,
            seed: seed_words(options.seed),
            step,
            elsewhere: elsewhere.into(),
            range: (1.0 / (view.pixel_angle * self.least_pixels).max(1.0e-12)) as f32,
            farthest: view.far as f32,
            average: (options.drag == Drag::Rousseau2008).into(),
            events: options.most_events,
            bounce: options.bounce.share,
            restitution: options.bounce.restitution,
            grip: options.bounce.grip,
            bounced_size: options.bounce.size,
            bounced_time: options.bounce.longest_s,
            gauge_height: (gauge.height_m - origin.y) as f32,
            gauge: options.gauge.is_some().into(),
            unused: 0,
            gauge_area: {
                let ([x0, z0], [x1, z1]) = (gauge.low_m, gauge.high_m);
                [x0 - origin.x, z0 - origin.z, x1 - origin.x, z1 - origin.z].map(|x| x as f32)
            },
            back: volume_backs(
                [before.right, before.up, before.forward],
                [view.right, view.up, view.forward],
            ),
        }
    }
}

/// A view a little wider than the picture: drops whose middle is outside still show their edge.
fn widened(view: &View) -> View {
    View { half_width: view.half_width * WIDER, half_height: view.half_height * WIDER, ..*view }
}
