//! Heights and velocities in 32 or 16 bits.

use downpour_shaders::lattice::puddle::PUDDLE_HALF_SCALE;
use half::f16;
use half::slice::HalfFloatSliceExt;
use rayon::prelude::*;

/// Storage of the state between sweeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PuddleStorage {
    /// 32 bits each.
    #[default]
    Full,
    /// 16 bits each, as the 32-bit texel of Tatarchuk & Isidoro 2006: half the memory. Heights and velocities are
    /// rounded to 1 part in 2048 (to 6e-11 m below 6e-8 m) after each sweep.
    Half,
}

/// One number per cell, in rows of whole quads.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Field {
    Full(Vec<f32>),
    Half(Vec<f16>),
}

/// Some rows of a field.
pub(crate) enum Plane<'a> {
    Full(&'a mut [f32]),
    Half(&'a mut [f16]),
}

impl Field {
    fn new(storage: PuddleStorage, cells: usize) -> Self {
        match storage {
            PuddleStorage::Full => Self::Full(vec![0.0; cells]),
            PuddleStorage::Half => Self::Half(vec![f16::ZERO; cells]),
        }
    }

    /// Reads as many numbers as `out` holds, from cell `at` on.
    pub(crate) fn read(&self, at: usize, out: &mut [f32]) {
        match self {
            Self::Full(values) => out.copy_from_slice(&values[at..at + out.len()]),
            Self::Half(values) => {
                values[at..at + out.len()].convert_to_f32_slice(out);
                for value in out {
                    *value *= 1.0 / PUDDLE_HALF_SCALE;
                }
            }
        }
    }

    pub(crate) fn get(&self, at: usize) -> f32 {
        let mut out = [0.0];
        self.read(at, &mut out);
        out[0]
    }

    pub(crate) fn set(&mut self, at: usize, value: f32) {
        self.whole().write(at, &[value]);
    }

    fn whole(&mut self) -> Plane<'_> {
        match self {
            Self::Full(values) => Plane::Full(values),
            Self::Half(values) => Plane::Half(values),
        }
    }

    /// Splits the field into bands of so many cells, in parallel.
    pub(crate) fn bands(&mut self, cells: usize) -> impl IndexedParallelIterator<Item = Plane<'_>> {
        let (full, half): (&mut [f32], &mut [f16]) = match self {
            Self::Full(values) => (values, &mut []),
            Self::Half(values) => (&mut [], values),
        };
        let count = full.len().max(half.len()).div_ceil(cells);
        let full = Parts::new(full, cells, count);
        let half = Parts::new(half, cells, count);
        full.into_par_iter().zip(half).map(|(full, half)| match (full, half) {
            (Some(part), _) => Plane::Full(part),
            (None, part) => Plane::Half(part.unwrap_or_default()),
        })
    }
}

/// Parts of a slice, or the same number of empty parts.
struct Parts;

impl Parts {
    #[expect(clippy::new_ret_no_self, reason = "a list of optional parts is all that is wanted")]
    fn new<T: Send>(slice: &mut [T], cells: usize, count: usize) -> Vec<Option<&mut [T]>> {
        let mut parts: Vec<Option<&mut [T]>> = slice.chunks_mut(cells).map(Some).collect();
        parts.resize_with(count, || None);
        parts
    }
}

impl Plane<'_> {
    pub(crate) fn write(&mut self, at: usize, values: &[f32]) {
        match self {
            Self::Full(out) => out[at..at + values.len()].copy_from_slice(values),
            Self::Half(out) => {
                // In chunks, because the library converts slices by SIMD instructions.
                let out = &mut out[at..at + values.len()];
                for (out, values) in out.chunks_mut(64).zip(values.chunks(64)) {
                    let mut scaled = [0.0; 64];
                    for (scaled, value) in scaled.iter_mut().zip(values) {
                        *scaled = (value * PUDDLE_HALF_SCALE).clamp(-65504.0, 65504.0);
                    }
                    out.convert_from_f32_slice(&scaled[..values.len()]);
                }
            }
        }
    }
}

/// Height, m, and velocity, m/s, of every cell.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct State {
    pub(crate) heights: Field,
    pub(crate) velocities: Field,
}

impl State {
    pub(crate) fn new(storage: PuddleStorage, cells: usize) -> Self {
        Self { heights: Field::new(storage, cells), velocities: Field::new(storage, cells) }
    }
}
