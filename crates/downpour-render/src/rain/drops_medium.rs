//! Mean radiance of drops that are not drawn one by one. Twin of `shaders/wgsl/render/drops_medium.wgsl`.

use downpour_shaders::render::rain::STREAK_WHITE;
use glam::{Vec2, Vec3};

use super::StreakTable;
use super::drops_frame::DropsView;
use super::medium::MediumFrame;

/// Mean radiance of an unresolved drop before a pixel.
pub(super) fn drops_medium(
    view: &DropsView<'_>,
    table: &StreakTable,
    medium: &MediumFrame,
    x: u32,
    y: u32,
) -> Vec3 {
    let frame = view.frame;
    if frame.streak_color == STREAK_WHITE {
        return view.drops_capture_texel(frame.capture_last, 0, 0);
    }
    let size = Vec2::new(frame.camera.width as f32, frame.camera.height as f32);
    let position = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / size;
    table.streak_lookup_mean(medium.shape, position)
}
