//! Stepped rain on a device: its drops, the map of what stops them and the field of their wind stay there.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use downpour_gpu::Gpu;
use downpour_sim::collision::CollisionMap;
use downpour_sim::field::VisibleDrops;
use downpour_sim::gpu::{CollisionMapOnGpu, GpuSimulation, GpuStepInput};
use downpour_sim::impacts::SplashOptions;
use downpour_sim::resolved::Resolved;
use downpour_sim::simulation::Simulation;
use downpour_sim::view::View;
use downpour_wind::gpu::{GpuWindField, WindAbout};
use downpour_wind::{UniformWindAt, WindMatrix};
use glam::DVec3;

use super::{Blown, STEPS_PER_S, StepScenery};
use crate::shower::ShowerError;

/// Stepped rain on a device. Copies are of the same drops.
#[derive(Clone, Debug)]
pub(super) struct SteppedOnGpu(Arc<Mutex<OnGpu>>);

#[derive(Debug)]
struct OnGpu {
    gpu: Gpu,
    simulation: GpuSimulation,
    map: Option<(Arc<CollisionMap>, CollisionMapOnGpu)>,
    field: Option<(Arc<Blown>, GpuWindField)>,
    /// The last question for the wind about the eye: origin, place and reach, with its answer, as long as the field is the same.
    about: Option<([DVec3; 2], f32, WindAbout)>,
}

/// The drops of a picture of stepped rain, which are on a device.
#[derive(Clone, Debug)]
pub struct SteppedPicture {
    on: SteppedOnGpu,
    /// Time from the state to the picture, s.
    pub(super) after_s: f64,
    /// Collision map at the time of the picture, where things move.
    pub(super) map: Option<CollisionMapOnGpu>,
    pub(super) resolved: Resolved,
}

impl SteppedOnGpu {
    /// Continues a simulation of the CPU.
    pub(super) fn new(gpu: &Gpu, simulation: &Simulation) -> Result<Self, ShowerError> {
        let simulation = GpuSimulation::from_cpu(gpu, simulation)?;
        let on = OnGpu { gpu: gpu.clone(), simulation, map: None, field: None, about: None };
        Ok(Self(Arc::new(Mutex::new(on))))
    }

    fn lock(&self) -> MutexGuard<'_, OnGpu> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// True if the drops are on a device.
    pub(super) fn is_on(&self, gpu: &Gpu) -> bool {
        self.lock().gpu.device() == gpu.device()
    }

    /// Makes a step.
    pub(super) fn step(
        &self,
        scenery: &StepScenery,
        view: &View,
        air: &UniformWindAt<'_>,
    ) -> Result<(), ShowerError> {
        let mut on = self.lock();
        let on = &mut *on;
        on.follow(scenery)?;
        let about = on.about(scenery.origin, view)?;
        let grid = on.field.as_ref().map(|(_, field)| field.grid_relative_to(scenery.origin));
        let input = GpuStepInput {
            field: grid.as_ref().zip(on.field.as_ref().map(|(_, field)| field.cells())),
            spread: about.map_or([0.0; 2], |about| about.spread),
            map: on.map.as_ref().map(|(_, map)| map),
            air: Some(air),
            ..GpuStepInput::new(
                view,
                scenery.origin,
                about.map_or(air.velocity().as_vec3(), |about| about.wind),
            )
        };
        Ok(on.simulation.advance(1.0 / STEPS_PER_S, &input)?)
    }

    /// The drops of a picture some time after the state, s. `now`: where things are then, unless the map of the steps says it.
    pub(super) fn picture(
        &self,
        view: &View,
        after_s: f64,
        scenery: &StepScenery,
        now: Option<&CollisionMap>,
    ) -> Result<SteppedPicture, ShowerError> {
        let mut on = self.lock();
        // There may have been no step.
        on.follow(scenery)?;
        let map = match now {
            Some(map) => Some(CollisionMapOnGpu::upload(&on.gpu, map)?),
            None => on.map.as_ref().map(|(_, map)| map.clone()),
        };
        let resolved = on.simulation.resolved(view);
        drop(on);
        Ok(SteppedPicture { on: self.clone(), after_s, map, resolved })
    }

    /// Waits for the drops that a picture can show some time after the state, s.
    pub(super) fn visible_after(
        &self,
        after_s: f64,
        view: &View,
        map: Option<&CollisionMap>,
        splashes: Option<&SplashOptions>,
    ) -> Result<VisibleDrops, ShowerError> {
        Ok(self.lock().simulation.visible_after(after_s, view, map, splashes)?)
    }

    /// Rate, mm/h, of the drops in the volume.
    pub(super) fn measured_rate_mm_h(&self, map: Option<&CollisionMap>) -> Result<f64, ShowerError> {
        Ok(self.lock().simulation.measured_rate_mm_h(map)?)
    }
}

impl OnGpu {
    /// Takes over map and wind where they have changed.
    fn follow(&mut self, scenery: &StepScenery) -> Result<(), ShowerError> {
        self.map = match (self.map.take(), &scenery.map) {
            (_, None) => None,
            (Some(known), Some(map)) if Arc::ptr_eq(&known.0, map) => Some(known),
            (Some((_, on)), Some(map)) if on.size() == map.frame().size => {
                self.simulation.count_written(size_of_val(map.texels()) as u64);
                on.set(&self.gpu, map)?;
                Some((Arc::clone(map), on))
            }
            (_, Some(map)) => Some((Arc::clone(map), CollisionMapOnGpu::upload(&self.gpu, map)?)),
        };
        let Some(wind) = &scenery.wind else {
            self.field = None;
            return Ok(());
        };
        self.about = self.about.filter(|_| self.field.as_ref().is_some_and(|(of, _)| Arc::ptr_eq(of, wind)));
        let matrices = WindMatrix::encode(&wind.parts)?.len();
        let mut field = match self.field.take() {
            Some((of, field)) if Arc::ptr_eq(&of, wind) => {
                self.field = Some((of, field));
                return Ok(());
            }
            Some((of, field)) if field.has_room(&wind.grid, matrices, wind.modes.len()) => {
                if !Arc::ptr_eq(&of.mask, &wind.mask) {
                    self.simulation.count_written(size_of_val(wind.mask.openness()) as u64);
                    field.set_mask(&wind.mask)?;
                }
                field
            }
            _ => {
                let made = GpuWindField::new(&self.gpu, &wind.grid, matrices, wind.modes.len())?;
                made.set_mask(&wind.mask)?;
                made
            }
        };
        field.set_grid(&wind.grid)?;
        field.update(&wind.parts, &wind.modes)?;
        let bytes = size_of_val(&*wind.modes) + matrices * size_of::<[[f32; 4]; 3]>();
        self.simulation.count_written(bytes as u64);
        self.field = Some((Arc::clone(wind), field));
        Ok(())
    }

    /// The wind at the eye of a view, and how much it differs as far as drops are seen; `None` without a field.
    fn about(&mut self, origin: DVec3, view: &View) -> Result<Option<WindAbout>, ShowerError> {
        let Some((_, field)) = &self.field else { return Ok(None) };
        let reach = self.simulation.farthest_m(view) as f32;
        let place = [origin, view.eye];
        if let Some((of, within, known)) = &self.about
            && (*of, *within) == (place, reach)
        {
            return Ok(Some(*known));
        }
        let found = field.about(origin, (view.eye - origin).as_vec3(), reach)?;
        self.about = Some((place, reach, found));
        Ok(Some(found))
    }
}

impl SteppedPicture {
    /// Limits of the list.
    pub(crate) fn resolved(&self) -> Resolved {
        self.resolved
    }

    /// The same drops so many seconds later: the state is the same.
    pub(crate) fn later(&self, later_s: f64) -> Self {
        Self { after_s: self.after_s + later_s, ..self.clone() }
    }

    /// Calls `draw` with the drops on the device, the time from their state to the picture, s, and what stops them.
    pub(crate) fn with<T>(
        &self,
        draw: impl FnOnce(&GpuSimulation, f64, Option<&CollisionMapOnGpu>) -> T,
    ) -> T {
        draw(&self.on.lock().simulation, self.after_s, self.map.as_ref())
    }
}
