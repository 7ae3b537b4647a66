//! The models of a weather at a time: animations that play, and places that have keys.

use super::{Loaded, Weather};
use downpour_scene::scene::{Placed, Play, Pose};

impl Loaded {
    /// True if models move: an animation plays, or a place has keys.
    #[must_use]
    pub fn is_animated(&self) -> bool {
        self.animations.iter().any(Option::is_some) || !self.moving.is_empty()
    }

    /// For each node of the scene, whether what it shows may move: it, a node above it or a joint of its skin is animated, or is one of a
    /// model whose place has keys.
    #[must_use]
    pub fn moving_nodes(&self) -> Vec<bool> {
        let animations: Vec<usize> = self.animations.iter().copied().flatten().collect();
        let placed: Vec<usize> = self.moving.iter().flat_map(|(_, nodes)| nodes).copied().collect();
        self.scene.moving_nodes(&animations, &placed)
    }

    /// Pose of the scene at a time in seconds, of the weather that it was loaded for: animations have run for that time at their
    /// speed, and models are where their keys say.
    #[must_use]
    pub fn pose(&self, weather: &Weather, time_s: f64) -> Pose {
        let play = |(model, &animation): (usize, &Option<usize>)| {
            let animation = animation?;
            let speed = weather.models.get(model).map_or(1.0, |model| model.animation_speed);
            // Days have too many seconds for single precision; a round of a movement has not.
            let length = self.scene.animations.get(animation).map_or(0.0, |a| f64::from(a.length_s()));
            let time = if length > 0.0 { (time_s * speed).rem_euclid(length) } else { 0.0 };
            Some(Play { animation, time_s: single(time) })
        };
        let plays: Vec<Play> = self.animations.iter().enumerate().filter_map(play).collect();
        let mut places = Vec::new();
        for (index, model) in weather.models_at(time_s) {
            let nodes = self.moving.iter().find(|(moving, _)| *moving == index).map(|(_, nodes)| nodes);
            let nodes = nodes.into_iter().flatten();
            places.extend(nodes.zip(model.transforms()).map(|(&node, transform)| Placed { node, transform }));
        }
        self.scene.pose_with(&plays, &places)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a time within a movement, in seconds")]
fn single(time_s: f64) -> f32 {
    time_s as f32
}
