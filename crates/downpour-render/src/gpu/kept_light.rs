//! Light that stays from picture to picture while the eye, the plate, the lamps and the rain stand still: of unresolved rain before each
//! pixel, and the mean radiance of each class of drops. They are those of the first picture to the bit: rays to lamps, too, which a picture
//! by itself draws anew.

use std::sync::atomic::{AtomicU32, Ordering};

use downpour_gpu::wgpu;

use super::medium::MediumOf;
use crate::camera::Camera;
use crate::rain::{DropsFrame, StreakPath};

/// Numbers under which means are kept are below this: exact as f32.
const NUMBERS: u32 = 1 << 24;

/// What the kept light of a picture was found from, and where it is.
#[derive(Clone, Debug)]
pub struct KeptLight {
    /// The frame of its drops, with the number of its means.
    pub(super) drops: DropsFrame,
    pub(super) classes: Vec<StreakPath>,
    pub(super) table: wgpu::Buffer,
    pub(super) medium: MediumOf,
}

impl KeptLight {
    /// Number of the means of drops in a table: that of the last picture if they are the same, else a new one.
    pub(super) fn number(
        last: Option<&Self>,
        drops: &DropsFrame,
        classes: &[StreakPath],
        table: &wgpu::Buffer,
    ) -> u32 {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        // Means have no random numbers.
        let seedless = |frame: &DropsFrame| DropsFrame {
            camera: Camera { seed: 0, ..frame.camera },
            known: 0,
            ..*frame
        };
        let same = last.filter(|last| {
            last.table == *table && seedless(&last.drops) == seedless(drops) && last.classes == classes
        });
        same.map_or_else(|| 1 + NEXT.fetch_add(1, Ordering::Relaxed) % (NUMBERS - 1), |last| last.drops.known)
    }
}
