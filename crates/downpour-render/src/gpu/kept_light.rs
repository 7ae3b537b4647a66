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

/// Means of a picture that were found before it, and those that it finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct KeptMeans {
    /// Their number.
    pub(super) number: u32,
    /// Classes, from the first, of which the picture finds the means though no drop may have them: one more in each picture, until all
    /// are known and none is looked for.
    pub(super) classes: u32,
    /// True if all are known before the picture.
    pub(super) are_all: bool,
}

/// Light that is kept from picture to picture, and everything that it was found from.
#[derive(Clone, Debug)]
pub struct KeptLight {
    /// The frame of its drops, with the number of its means.
    pub(super) drops: DropsFrame,
    pub(super) classes: Vec<StreakPath>,
    pub(super) table: wgpu::Buffer,
    pub(super) medium: MediumOf,
}

impl KeptLight {
    /// The means of drops in a table: those of the last picture if they are the same, else new ones.
    pub(super) fn means(
        last: Option<&Self>,
        drops: &DropsFrame,
        classes: &[StreakPath],
        table: &wgpu::Buffer,
    ) -> KeptMeans {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        // Means have no random numbers, and are not of single drops.
        let seedless = |frame: &DropsFrame| DropsFrame {
            camera: Camera { seed: 0, ..frame.camera },
            known: 0,
            made_classes: 0,
            count: 0,
            ..*frame
        };
        let same = last.filter(|last| {
            last.table == *table && seedless(&last.drops) == seedless(drops) && last.classes == classes
        });
        match same {
            Some(KeptLight { drops: DropsFrame { known, made_classes, .. }, .. }) => {
                let all = classes.len() as u32;
                KeptMeans {
                    number: *known,
                    classes: (made_classes + 1).min(all),
                    are_all: *made_classes == all,
                }
            }
            None => {
                let number = 1 + NEXT.fetch_add(1, Ordering::Relaxed) % (NUMBERS - 1);
                KeptMeans { number, classes: 0, are_all: false }
            }
        }
    }
}
