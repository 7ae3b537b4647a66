//! Craters of the rain on the lattice of the ripples, made beside the picture before the one that needs them: they depend on the step
//! alone.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use downpour_lattice::LatticeError;
use downpour_lattice::puddle::{CraterMaker, Craters, PuddleRain};
use rayon::prelude::*;

use super::PuddleError;
use super::ripples::impacts_of;
use crate::background::Background;

/// Craters of steps to come.
#[derive(Debug)]
pub(super) struct CratersAhead {
    maker: CraterMaker,
    begun: BTreeMap<i64, Background<Result<Craters, LatticeError>>>,
}

/// Craters of a step that is due.
#[derive(Debug)]
pub(super) enum CratersAt {
    /// They are being made.
    Begun(Background<Result<Craters, LatticeError>>),
    /// They are to be made.
    Due(CraterMaker, Arc<PuddleRain>, i64),
    /// There are none.
    Dry,
}

impl CratersAt {
    /// The craters; waits for them or makes them.
    fn finish(self) -> Result<Craters, PuddleError> {
        Ok(match self {
            Self::Begun(task) => task.finish()?,
            Self::Due(maker, rain, step) => craters_of(&maker, &rain, step)?,
            Self::Dry => Craters::default(),
        })
    }
}

/// Craters of steps, which are waited for or made.
pub(super) fn finished(steps: Vec<CratersAt>) -> Result<Vec<Craters>, PuddleError> {
    if steps.iter().any(|step| matches!(step, CratersAt::Due(..))) {
        return steps.into_par_iter().map(CratersAt::finish).collect();
    }
    steps.into_iter().map(CratersAt::finish).collect()
}

impl CratersAhead {
    /// None yet.
    pub(super) fn new(maker: CraterMaker) -> Self {
        Self { maker, begun: BTreeMap::new() }
    }

    /// Those of a step with its rain.
    pub(super) fn take(&mut self, step: i64, rain: Option<&Arc<PuddleRain>>) -> CratersAt {
        match (self.begun.remove(&step), rain) {
            (_, None) => CratersAt::Dry,
            (Some(task), _) => CratersAt::Begun(task),
            (None, Some(rain)) => CratersAt::Due(self.maker.clone(), Arc::clone(rain), step),
        }
    }

    /// Begins with those of some steps with a rain, and forgets those of others.
    pub(super) fn begin(&mut self, steps: Range<i64>, rain: Option<&Arc<PuddleRain>>) {
        self.begun.retain(|step, _| steps.contains(step));
        let Some(rain) = rain else { return };
        for step in steps {
            self.begun.entry(step).or_insert_with(|| {
                let (maker, rain) = (self.maker.clone(), Arc::clone(rain));
                Background::begin(move || craters_of(&maker, &rain, step))
            });
        }
    }
}

/// Craters of a step of a rain.
fn craters_of(maker: &CraterMaker, rain: &PuddleRain, step: i64) -> Result<Craters, LatticeError> {
    maker.craters(&impacts_of(rain, step)?)
}
