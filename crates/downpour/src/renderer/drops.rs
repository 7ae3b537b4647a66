//! Drops of a frame: a list, or a question to the device that finds them.

use downpour_shaders::sim::field::{FIELD_BOUNCED, FIELD_SPLASH};
use downpour_sim::field::{DropKind, EyeDrop, VisibleDrops};
use downpour_sim::resolved::Resolved;

use crate::shower::ShowerView;

/// Drops of a frame.
#[derive(Clone, Debug)]
pub(super) enum Drops {
    /// These.
    Listed(VisibleDrops),
    /// Those that the device finds.
    #[cfg_attr(not(feature = "wgpu"), expect(dead_code, reason = "no device finds any"))]
    OfDevice(Box<ShowerView>),
}

/// Drops that a device has found.
#[derive(Clone, Debug)]
pub(super) struct Found {
    /// The drops relative to the eye, with their place among those that were known.
    pub(super) drops: Vec<(EyeDrop, Option<u32>)>,
    /// Number of drops that were looked at.
    pub(super) simulated: u64,
}

impl Drops {
    /// Limits of the list.
    pub(super) fn resolved(&self) -> &Resolved {
        match self {
            Self::Listed(drops) => &drops.resolved,
            Self::OfDevice(shown) => &shown.resolved,
        }
    }

    /// The list, with what the device has found.
    pub(super) fn with(self, found: Option<Found>) -> VisibleDrops {
        let shown = match self {
            Self::Listed(drops) => return drops,
            Self::OfDevice(shown) => shown,
        };
        let Found { drops, simulated } = found.unwrap_or(Found { drops: Vec::new(), simulated: 0 });
        let in_world = |(drop, known): (EyeDrop, Option<u32>)| {
            let droplet = known.and_then(|known| shown.droplets.get(known as usize));
            // The device lists all others by what stands in place of a terminal speed; a drop that falls has one.
            let kind = if drop.speed <= FIELD_SPLASH {
                DropKind::Splash
            } else if drop.speed < FIELD_BOUNCED {
                DropKind::Dripped
            } else if drop.speed > FIELD_BOUNCED {
                DropKind::Falling
            } else {
                DropKind::Bounced
            };
            droplet.copied().unwrap_or_else(|| drop.to_falling(shown.view.eye, kind))
        };
        let drops = drops.into_iter().map(in_world).collect();
        VisibleDrops { drops, simulated, resolved: shown.resolved }
    }
}
