//! What of a scene that moves is the same at all times: materials, textures, and the triangles of all that stands still.

use std::sync::Arc;

use downpour_scene::scene::Pose;
use downpour_weather::Loaded;
use glam::DVec3;

use crate::assemble::SceneLooks;
use crate::builder::{SceneBuilder, ScenePart};

/// What of a scene that moves is the same at all times, shared by its frames.
#[derive(Clone, Debug)]
pub(super) struct KeptScene {
    looks: Arc<SceneLooks>,
    still: Arc<ScenePart>,
    /// For each node, whether it moves.
    moves: Arc<Vec<bool>>,
    /// What triangles are relative to.
    origin: DVec3,
}

impl KeptScene {
    /// What is kept of a scene in a pose relative to `origin`, as far as another frame of it has that.
    pub(super) fn of(known: Option<&Self>, loaded: &Loaded, pose: &Pose, origin: DVec3) -> Self {
        if let Some(known) = known.filter(|known| known.origin == origin) {
            return known.clone();
        }
        let looks =
            known.map_or_else(|| Arc::new(SceneLooks::new(&loaded.scene)), |known| known.looks.clone());
        let moves = known.map_or_else(|| Arc::new(loaded.moving_nodes()), |known| known.moves.clone());
        let still = Arc::new(looks.part(&loaded.scene, pose, origin, |node| moves.get(node) != Some(&true)));
        Self { looks, still, moves, origin }
    }

    /// Builder of what stands still.
    pub(super) fn standing(&self) -> SceneBuilder {
        let mut builder = self.looks.builder();
        builder.set_still(self.still.clone());
        builder
    }

    /// Builder of the scene in a pose, with all of its meshes.
    pub(super) fn builder(&self, loaded: &Loaded, pose: &Pose) -> SceneBuilder {
        let mut builder = self.standing();
        builder.add_meshes(&self.looks, &loaded.scene, pose, self.origin, |node| {
            self.moves.get(node) == Some(&true)
        });
        builder
    }
}
