//! Frames of the steps, from the motion of the camera: the common source for the CPU and the GPU.

use downpour_drop::distribution::DropSizeDistribution;
use downpour_drop::fall_speed::relaxation;
use downpour_math::rng::seed_words;
use downpour_math::{OutOfRange, in_range};
use downpour_shaders::sim::enter::ENTER_SIZES;
use downpour_shaders::sim::step::{
    MOTION_TABLE_LAST, STEP_LAGS, STEP_VOLUME_AREA, STEP_VOLUME_BOX, STEP_VOLUME_CYLINDER, STEP_VOLUME_TARIQ,
    STEP_VOLUME_VIEW,
};
use downpour_wind::UniformWindAt;
use glam::{DVec3, Vec3};

use crate::SimError;
use crate::enter::EnterRegion;
use crate::frustum::{Frustum, PLANES};
use crate::inflow::regions;
use crate::options::{Drag, SimVolume, SimulationOptions};
use crate::population::{Bin, affordable_pixels, bins, box_center, reserve};
use crate::recent::RecentSpans;
use crate::resolved::{Region, Resolved};
use crate::step::{StepFrame, step_pack};
use crate::view::View;
use crate::volume::VolumeEye;

/// Maximum step, s: longer times are divided.
const MAX_STEP_S: f64 = 1.0 / 30.0;

/// Range of times of one call, s.
const TIMES_S: std::ops::RangeInclusive<f64> = 1.0e-5..=1.0;

/// Maximum lag of the drops' velocity in a uniform wind, m/s.
const LAG_M_S: f64 = 0.05;

/// Distance that the velocity of drops lags behind in a wind that varies in space, m.
const BEFORE_M: f64 = 2.0;

/// Lags in a constant wind.
pub(crate) const STILL_LAGS: Lags = [[0.0; 4]; STEP_LAGS as usize];

/// Lag of drops behind a changing wind, m/s, for speeds of 0, 1, 2, ... m/s.
pub(crate) type Lags = [[f32; 4]; STEP_LAGS as usize];

/// Air around the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AirAtEye {
    /// Wind without a field, and at the eye, m/s.
    pub(crate) wind: Vec3,
    /// Bounds on the deviation from it: per m of distance, 1/s, and in total, m/s.
    pub(crate) spread: [f32; 2],
    pub(crate) lags: Lags,
}

/// Lag of drops behind the uniform part of a wind.
pub(crate) fn lags(air: Option<&UniformWindAt<'_>>) -> Lags {
    let Some(air) = air else { return STILL_LAGS };
    std::array::from_fn(|speed| {
        let relaxation = relaxation(speed as f64);
        let across = air.followed(relaxation.horizontal_s).velocity;
        let along = air.followed(relaxation.vertical_s).velocity;
        let lag = DVec3::new(across.x, along.y, across.z) - air.velocity();
        lag.as_vec3().extend(0.0).to_array()
    })
}

/// A step: its frame, and the regions from which drops enter.
#[derive(Clone, Debug)]
pub(crate) struct Turn {
    pub(crate) frame: StepFrame,
    /// Regions, with one that marks their end; empty if nothing enters.
    pub(crate) regions: Vec<EnterRegion>,
    /// True if the step begins its span: nothing is kept in it yet.
    pub(crate) begins_span: bool,
}

/// Source of the frames of a simulation.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) options: SimulationOptions,
    pub(crate) least_pixels: f64,
    pub(crate) min_diameter: f64,
    pub(crate) bins: Vec<Bin>,
    view: View,
    frustum: Frustum,
    origin: DVec3,
    step: u32,
    /// Duration of the last step, s.
    time_s: f64,
    /// Spans of time whose impacts are kept.
    pub(crate) recent: RecentSpans,
}

impl Plan {
    /// Creates the plan of a rain, without its drops.
    pub(crate) fn new(
        rain: &DropSizeDistribution,
        options: &SimulationOptions,
        view: &View,
        origin: DVec3,
        air: AirAtEye,
    ) -> Result<Self, SimError> {
        options.check()?;
        check(view, origin)?;
        let bins = bins(rain)?;
        let times = [options.horizon_s(), options.wait_s];
        let least_pixels = match options.volume {
            SimVolume::View => affordable_pixels(&bins, view, times, options.max_drops),
            _ => view.least_pixels,
        };
        let frustum = frustum(view, least_pixels, air, times);
        let options = options.clone();
        let step = options.first_step;
        Ok(Self {
            options,
            least_pixels,
            min_diameter: 0.0,
            bins,
            view: *view,
            frustum,
            origin,
            step,
            time_s: MAX_STEP_S,
            recent: RecentSpans::default(),
        })
    }

    /// Current view.
    pub(crate) fn view(&self) -> &View {
        &self.view
    }

    pub(crate) fn frustum(&self) -> &Frustum {
        &self.frustum
    }

    pub(crate) fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Maximum distance at which a drop of a view is resolved, m.
    pub(crate) fn farthest(&self, view: &View) -> f64 {
        let largest = self.bins.last().map_or(0.0, |bin| bin.diameters[1]);
        view.range(largest, self.least_pixels)
    }

    /// True if drops enter and leave, so that their number varies.
    pub(crate) fn is_open(&self) -> bool {
        self.options.volume == SimVolume::View
    }

    /// Quantiles of the diameters of each bin.
    pub(crate) fn sizes(&self) -> Vec<[f32; ENTER_SIZES as usize]> {
        self.bins.iter().map(|bin| bin.sizes).collect()
    }

    /// Expected number of drops of a frustum.
    #[cfg(feature = "wgpu")]
    pub(crate) fn expected(&self) -> f64 {
        let of = |bin: &Bin| bin.density * self.frustum.about_volume(bin.diameters[1], bin.speeds[1]);
        self.bins.iter().map(of).sum()
    }

    /// Number of the step after the state, and the duration of the last one, s.
    pub(crate) fn next_step(&self) -> (u32, f64) {
        (self.step.wrapping_add(1), self.time_s)
    }

    /// The volume's `STEP_VOLUME_*`, its size and its center about a view, m.
    pub(crate) fn volume(&self, view: &View) -> (u32, DVec3, DVec3) {
        match self.options.volume {
            SimVolume::Box { size_m } => {
                (STEP_VOLUME_BOX, DVec3::from(size_m), box_center(view, DVec3::from(size_m)))
            }
            SimVolume::View => (STEP_VOLUME_VIEW, DVec3::ONE, view.eye),
            SimVolume::ImSung => (STEP_VOLUME_AREA, DVec3::ONE, view.eye),
            SimVolume::Tariq { size_m } => (STEP_VOLUME_TARIQ, DVec3::from(size_m), view.eye),
            SimVolume::Cylinder { base_m, radius_m, height_m } => {
                let middle = DVec3::from(base_m) + DVec3::Y * (0.5 * height_m);
                (STEP_VOLUME_CYLINDER, DVec3::new(radius_m, height_m, 1.0), middle)
            }
        }
    }

    /// Limits of the list of drops that a picture can show.
    pub(crate) fn resolved(&self, view: &View) -> Resolved {
        let region = match self.options.volume {
            SimVolume::View => Region::Everywhere,
            SimVolume::Box { size_m } => {
                let size = DVec3::from(size_m);
                Region::Box { center: box_center(view, size), size }
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
        Resolved { min_diameter: self.min_diameter, region, ..Resolved::of(view, self.least_pixels) }
    }

    /// Steps of a time in which the camera moves to `view`: one, or several if the time is too long.
    pub(crate) fn turns(
        &mut self,
        time_s: f64,
        view: &View,
        origin: DVec3,
        air: AirAtEye,
    ) -> Result<Vec<Turn>, SimError> {
        in_range("time of a step", time_s, "s", &TIMES_S, 1.0, "1e-5 to 1")?;
        check(view, origin)?;
        let steps = (time_s / MAX_STEP_S).ceil().max(1.0);
        (0..steps as u32).map(|_| self.turn(time_s / steps, view, origin, air)).collect()
    }

    fn turn(&mut self, time_s: f64, view: &View, origin: DVec3, air: AirAtEye) -> Result<Turn, SimError> {
        let before = std::mem::replace(&mut self.view, *view);
        let mut shift = origin - std::mem::replace(&mut self.origin, origin);
        let next = frustum(view, self.least_pixels, air, [self.options.horizon_s(), self.options.wait_s]);
        let frustum_before = std::mem::replace(&mut self.frustum, next);
        self.step = self.step.wrapping_add(1);
        self.time_s = time_s;
        let (mut elsewhere, mut boxes, mut list) = (false, 0, Vec::new());
        match self.options.volume {
            SimVolume::Box { size_m } => {
                let size = DVec3::from(size_m);
                let whole = (shift / size).round();
                shift -= size * whole;
                boxes = step_pack(-whole.as_vec3());
                elsewhere = (view.eye - before.eye).abs().cmpgt(0.5 * size).any();
            }
            SimVolume::View => {
                elsewhere = view.eye.distance(before.eye) > view.far;
                if !elsewhere {
                    let wind = air.wind.as_dvec3();
                    let seed = self.options.seed;
                    list = regions(&frustum_before, &next, &self.bins, wind, time_s, seed, self.step);
                }
            }
            _ => {}
        }
        let candidates = list.last().map_or(0, |end: &EnterRegion| end.first);
        reserve(candidates.into())?;
        let mut tangents = [[0.0; 4]; PLANES];
        for (tangent, made) in tangents.iter_mut().zip(frustum_before.tangents()) {
            *tangent = made.as_vec3().extend(0.0).to_array();
        }
        let span = self.recent.step(origin, time_s);
        let frame = StepFrame {
            kept_span: span.number,
            kept_since: span.since_s as f32,
            shift: shift.as_vec3().to_array(),
            time: time_s as f32,
            elsewhere: elsewhere.into(),
            boxes,
            frustum_before: frustum_before.relative_to(origin),
            tangents,
            oldest: (self.options.oldest_s / time_s).ceil().min(2.0e9) as u32,
            candidates,
            regions: (list.len() as u32).saturating_sub(1),
            ..self.standing(air)
        };
        Ok(Turn { frame, regions: list, begins_span: span.is_new })
    }

    /// Frame of a step of duration 0.
    pub(crate) fn standing(&self, air: AirAtEye) -> StepFrame {
        let Self { options, view, frustum, origin, .. } = self;
        let (volume, size, center) = self.volume(view);
        let gauge = options.gauge.unwrap_or_default();
        let sizes_first = MOTION_TABLE_LAST + 1;
        StepFrame {
            now: VolumeEye::new(view, *origin),
            shift: [0.0; 3],
            count: 0,
            size: size.as_vec3().to_array(),
            first: 0,
            center: (center - origin).as_vec3().to_array(),
            volume,
            wind: air.wind.to_array(),
            time: 0.0,
            seed: seed_words(options.seed),
            step: self.step,
            elsewhere: 0,
            farthest: view.far as f32,
            average: (options.drag == Drag::Rousseau2008).into(),
            events: options.max_events,
            bounce: options.bounce.fraction,
            restitution: options.bounce.restitution,
            grip: options.bounce.grip,
            bounced_size: options.bounce.size,
            bounced_time: options.bounce.max_time_s,
            gauge_height: (gauge.height_m - origin.y) as f32,
            gauge: options.gauge.is_some().into(),
            boxes: 0,
            kept_room: options.max_kept,
            gauge_area: {
                let ([x0, z0], [x1, z1]) = (gauge.low_m, gauge.high_m);
                [x0 - origin.x, z0 - origin.z, x1 - origin.x, z1 - origin.z].map(|x| x as f32)
            },
            frustum: frustum.relative_to(*origin),
            frustum_before: frustum.relative_to(*origin),
            tangents: [[0.0; 4]; PLANES],
            lags: air.lags,
            oldest: u32::MAX,
            candidates: 0,
            regions: 0,
            regions_first: sizes_first + self.bins.len() as u32 * ENTER_SIZES,
            sizes_first,
            pieces: 1,
            piece: 0,
            kept_span: 0,
            kept_since: 0.0,
            unread: 0,
            unused_2: 0,
            unused_3: 0,
        }
    }
}

fn frustum(view: &View, least_pixels: f64, air: AirAtEye, times: [f64; 2]) -> Frustum {
    let [slope, most] = air.spread.map(f64::from);
    let lag = air.lags.iter().map(|&[x, y, z, _]| Vec3::new(x, y, z).length()).fold(0.0, f32::max);
    let least = LAG_M_S + f64::from(lag);
    let spread = [least + slope * BEFORE_M, slope, least + most];
    Frustum::new(view, least_pixels, air.wind.as_dvec3(), spread, times)
}

/// Checks that single precision can represent the surroundings of the eye of a view, for an origin.
fn check(view: &View, origin: DVec3) -> Result<(), SimError> {
    view.check()?;
    let found = (view.eye - origin).abs().max_element();
    if origin.is_finite() && found <= 1.0e5 {
        return Ok(());
    }
    let (quantity, unit, allowed) = ("distance of the eye from the origin", "m", "up to 1e5");
    Err(SimError::OutOfRange(OutOfRange { quantity, found, unit, allowed: allowed.into() }))
}
