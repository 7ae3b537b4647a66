//! What stands still in a scene that moves: the same in the buffers of all frames, so that a device is given the rest alone.

use std::ops::Range;
use std::sync::Arc;

use crate::builder::ScenePart;
use crate::data::SceneData;

/// What the buffers of a frame share with those of other frames of a scene that moves.
#[derive(Clone, Debug)]
pub struct StillPart {
    /// Triangles that stand still, the first in the buffers of triangles and corners. Their nodes are those behind the root.
    pub(crate) part: Arc<ScenePart>,
    /// Triangles of them that are the glass of lamps, with their materials.
    pub(crate) glass: Vec<(u32, u32)>,
    /// Number of texels of all textures.
    pub(crate) texels: usize,
}

/// Places in the buffers of a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct StillRanges {
    pub(crate) nodes: Range<usize>,
    pub(crate) triangles: Range<usize>,
    pub(crate) corners: Range<usize>,
    pub(crate) texels: Range<usize>,
}

impl SceneData {
    /// What stands still in two frames of one scene: places in its buffers where both have the same. `None` for two scenes, and for one that
    /// does not move.
    #[cfg_attr(not(any(feature = "wgpu", test)), expect(dead_code, reason = "devices ask for it"))]
    pub(crate) fn still_ranges(&self, before: &Self) -> Option<StillRanges> {
        let (now, before) = (self.still.as_deref()?, before.still.as_deref()?);
        let is_same = Arc::ptr_eq(&now.part, &before.part) && now.glass == before.glass;
        is_same.then(|| StillRanges {
            nodes: 1..1 + now.part.node_count(),
            triangles: 0..now.part.triangle_count(),
            corners: 0..3 * now.part.triangle_count(),
            texels: 0..now.texels,
        })
    }
}
