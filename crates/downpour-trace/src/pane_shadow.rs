//! Light of lamps and the sun that falls through a wet pane. Twin of `shaders/wgsl/render/pane_shadow.wgsl`.
//!
//! Tatarchuk & Isidoro 2006, section 5, project the masses of the drops on what stands behind the pane, and draw a
//! highlight in the middle of the shadow of each heavy drop. Here a drop is a lens: light that falls on it is missing
//! behind it, and comes together at its focal length `f`, where it is a bright point; as far again it is as wide as the
//! drop, and beyond it is spread over what a drop of mean size makes of it. So all forms of light but the paper's are kept:
//! over the pane the mean fraction is that of dry glass at any distance.
//!
//! Limits: all drops have the mean focal length; light of the sky has no shadows of drops; the reflections of the drops'
//! surfaces are those of dry glass.

use downpour_drop::optics::optics_fresnel;
use downpour_math::ops;
use downpour_render::glass::{PaneError, PaneShade, RenderPane, WetPane};
use downpour_shaders::render::glass::GLASS_PICTURE_INDEX;
use downpour_shaders::render::pane_shadow::{PANE_SHADOW_LEVELS, PANE_SHADOW_PEAK, PANE_SHADOW_TATARCHUK};
use glam::{DVec3, Vec2, Vec3};

use crate::data::SceneData;
use crate::frame_scene::FrameScene;
use crate::scene::SceneView;

impl SceneData {
    /// Removes the rows of the pane, which are the last of the table, and returns them; none without a pane.
    pub(crate) fn take_pane(&mut self) -> Vec<[u32; 4]> {
        if self.pane == 0 {
            return Vec::new();
        }
        let rows = self.table.split_off(self.pane as usize);
        self.pane = 0;
        rows
    }

    /// Adds the rows of a pane at the end of the table; nothing for no rows.
    pub(crate) fn add_pane(&mut self, rows: &[[u32; 4]]) {
        if !rows.is_empty() {
            self.pane = self.table.len() as u32;
            self.table.extend(rows);
        }
        self.place_shared();
    }

    /// Sets the pane in front of the lamps; replaces an earlier one; `axes`: its corner, right, down and outward, in the
    /// scene's coordinates.
    pub fn set_pane(&mut self, shade: &PaneShade, axes: [Vec3; 4]) {
        self.take_pane();
        self.add_pane(&shade.rows(axes));
    }

    /// Reads the pane.
    fn pane_load(&self) -> RenderPane {
        RenderPane::pane_load(&self.table, self.pane)
    }

    /// Reads columns, rows and first texel of a level.
    fn pane_level(&self, level: u32) -> [u32; 3] {
        let [columns, rows, first, _] = self.table[(self.pane + PANE_SHADOW_LEVELS + level) as usize];
        [columns, rows, first]
    }

    /// Reads eight texels.
    fn pane_texels(&self, row: u32) -> [u32; 4] {
        self.table[row as usize]
    }
}

/// True if anything that the picture may show is lit through the pane: something on the eye's side of it, within the box
/// around the eye and the pane, and a lamp or a sun.
#[must_use]
pub fn is_lit_through(pane: &WetPane, frame_scene: &FrameScene) -> bool {
    let Ok([corner, across, down, _]) = pane.axes(&frame_scene.viewpoint) else { return false };
    if frame_scene.data.light_count == 0 || !pane.has_shadows() {
        return false;
    }
    let eye = DVec3::from(frame_scene.viewpoint.eye);
    let [width, height] = pane.size_m();
    let [right, down] = [across * width, down * height];
    let corners = [corner, corner + right, corner + down, corner + right + down];
    let low = corners.iter().fold(eye, |low, &at| low.min(at)).as_vec3();
    let high = corners.iter().fold(eye, |high, &at| high.max(at)).as_vec3();
    frame_scene.data.triangles.iter().any(|triangle| {
        let a = Vec3::from(triangle.corner);
        let (b, c) = (a + Vec3::from(triangle.edge_1), a + Vec3::from(triangle.edge_2));
        low.cmple(a.max(b).max(c)).all() && high.cmpge(a.min(b).min(c)).all()
    })
}

/// Sets the pane as it is now before the lamps of a frame, so that they throw the shadows of its drops.
///
/// # Errors
/// As [`WetPane::axes`] and [`WetPane::shade`].
pub fn set_pane(pane: &WetPane, frame_scene: &mut FrameScene) -> Result<(), PaneError> {
    let Some(shade) = pane.shade()? else { return Ok(()) };
    let axes = pane.axes(&frame_scene.viewpoint)?;
    frame_scene.data.set_pane(&shade, axes.map(DVec3::as_vec3));
    Ok(())
}

impl SceneView<'_> {
    /// A texel of a level: cover, and gathered cover. `texels` is the first row of the texels.
    fn pane_shadow_texel(&self, texels: u32, level: u32, column: i32, line: i32) -> Vec2 {
        let [width, height, first] = self.data.pane_level(level);
        let x = column.clamp(0, width as i32 - 1) as u32;
        let y = line.clamp(0, height as i32 - 1) as u32;
        let index = first + y * width + x;
        let word = self.data.pane_texels(texels + index / 8)[((index / 2) % 4) as usize];
        let pair = word >> (16 * (index % 2));
        Vec2::new((pair & 255) as f32, ((pair >> 8) & 255) as f32 * PANE_SHADOW_PEAK) / 255.0
    }

    /// A level at a position in [0, 1], bilinear.
    fn pane_shadow_level(&self, texels: u32, level: u32, position: Vec2) -> Vec2 {
        let [width, height, _] = self.data.pane_level(level);
        let at = position * Vec2::new(width as f32, height as f32) - 0.5;
        let low = at.floor();
        let part = at - low;
        let (x, y) = (low.x as i32, low.y as i32);
        let upper = self.pane_shadow_texel(texels, level, x, y) * (1.0 - part.x)
            + self.pane_shadow_texel(texels, level, x + 1, y) * part.x;
        let lower = self.pane_shadow_texel(texels, level, x, y + 1) * (1.0 - part.x)
            + self.pane_shadow_texel(texels, level, x + 1, y + 1) * part.x;
        upper * (1.0 - part.y) + lower * part.y
    }

    /// Cover and gathered cover around a position of [0, 1], over a width in meters.
    fn pane_shadow_at(&self, pane: &RenderPane, position: Vec2, width: f32) -> Vec2 {
        let texels = width * pane.texels_per_meter;
        let level = ops::log2(texels.max(1.0)).clamp(0.0, pane.last as f32);
        let low = level.floor();
        let part = level - low;
        let mut found = self.pane_shadow_level(pane.first, low as u32, position) * (1.0 - part);
        if part > 0.0 {
            found += self.pane_shadow_level(pane.first, low as u32 + 1, position) * part;
        }
        found
    }

    /// Fraction of light that comes through the pane to a position from a distance along a direction; `spread` is half the angle
    /// that its source takes. 1 where the pane is not between them.
    pub(crate) fn pane_shadow_fraction(
        &self,
        position: Vec3,
        direction: Vec3,
        distance: f32,
        spread: f32,
    ) -> f32 {
        if self.frame.pane == 0 {
            return 1.0;
        }
        let pane = self.data.pane_load();
        let towards = direction.dot(pane.outward);
        let above = (pane.corner - position).dot(pane.outward);
        let away = above / if towards == 0.0 { 1.0 } else { towards };
        if towards.abs() < 1.0e-4 || away <= 0.0 || away >= distance {
            return 1.0;
        }
        let on = position + direction * away - pane.corner;
        let at = Vec2::new(on.dot(pane.across) / pane.width, on.dot(pane.down) / pane.height);
        if at.x < 0.0 || at.y < 0.0 || at.x > 1.0 || at.y > 1.0 {
            return 1.0;
        }
        // Both surfaces of the glass, and what goes to and fro between them.
        let mirrored = optics_fresnel(towards.abs(), GLASS_PICTURE_INDEX);
        let clear = (1.0 - mirrored) / (1.0 + mirrored);
        let soft = 2.0 * away * spread;
        let cover = self.pane_shadow_at(&pane, at, soft);
        if pane.form == PANE_SHADOW_TATARCHUK {
            return clear * (1.0 - cover.x + cover.y);
        }
        let [radius, focus] = pane.drops;
        // How wide the light of a drop is, in its own radii: a point at the focus.
        let wide = (1.0 - away / focus).abs();
        let gathered = (1.0 - wide).max(0.0);
        let spot = self.pane_shadow_at(&pane, at, soft + 2.0 * radius * (wide - 1.0).max(0.0));
        clear * (1.0 - cover.x + spot.x * (1.0 - gathered) + cover.y * gathered)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builder::SceneBuilder;
    use crate::data::{RenderFrame, SceneData};
    use crate::sky_light::SkyLight;
    use downpour_render::camera::Viewpoint;
    use downpour_render::glass::GlassPictureDrop;
    use downpour_render::glass::PaneShadows;

    /// A pane of 0.2 m x 0.1 m at z = 0, drops of 2 mm on it 8 mm apart, light from +z.
    fn scene(form: PaneShadows) -> (SceneData, f32) {
        let drops: Vec<GlassPictureDrop> = (0..25 * 12)
            .map(|k| GlassPictureDrop {
                center: [4.0e-3 + (k % 25) as f32 * 8.0e-3, 6.0e-3 + (k / 25) as f32 * 8.0e-3],
                radius: 2.0e-3,
                sphere: 2.2e-3,
                along: [0.0, 1.0],
                behind: 1.0,
                droop: [0.0, 1.0],
                ..Default::default()
            })
            .collect();
        let shade = PaneShade::new([0.2, 0.1], &drops, form, 0.0, 1.333);
        let mut data = SceneBuilder::new().build(&SkyLight::uniform([1.0; 3]));
        data.set_pane(&shade, [Vec3::new(-0.1, 0.05, 0.0), Vec3::X, Vec3::NEG_Y, Vec3::Z]);
        (data, 2.2e-3 / 0.333)
    }

    fn fraction(data: &SceneData, x: f32, y: f32, away: f32) -> f32 {
        let eye = Viewpoint { eye: Vec3::ZERO, forward: Vec3::Z, up: Vec3::Y, fov_y: 1.0 };
        let frame = RenderFrame::new(data, &eye, [8, 8], 1, 1, 0).expect("a frame");
        let view = SceneView { data, frame: &frame };
        view.pane_shadow_fraction(Vec3::new(x - 0.1, 0.05 - y, -away), Vec3::Z, 10.0, 0.0)
    }

    /// The mean over a period of the drops, far from the pane's edges.
    fn mean(data: &SceneData, away: f32) -> f32 {
        let n = 64;
        let step = 8.0e-3 / n as f32;
        let at = |k: u32| fraction(data, 0.1 + (k % n) as f32 * step, 0.05 + (k / n) as f32 * step, away);
        (0..n * n).map(at).sum::<f32>() / (n * n) as f32
    }

    #[test]
    fn drops_keep_the_light_at_any_distance() {
        let (data, focus) = scene(PaneShadows::Lens);
        let root = (1.52f32 - 1.0) / 2.52;
        let mirrored = root * root;
        let clear = (1.0 - mirrored) / (1.0 + mirrored);
        for away in [1.0e-4, 0.5 * focus, focus, 1.7 * focus, 4.0 * focus, 0.3, 2.0] {
            let found = mean(&data, away);
            assert!((found / clear - 1.0).abs() < 0.012, "{away} m: {found} of {clear}");
        }
    }

    #[test]
    fn light_comes_together_at_the_focus_and_is_missing_beyond() {
        let (data, focus) = scene(PaneShadows::Lens);
        let (middle, between) = ([0.1, 0.05], [0.104, 0.054]);
        let [[bx, by], [ax, ay]] = [middle, between].map(|[x, y]: [f32; 2]| {
            // The nearest middle of a drop, and the middle between four.
            let of = |at: f32, first: f32| first + ((at - first) / 8.0e-3).round() * 8.0e-3;
            [of(x, 4.0e-3), of(y, 6.0e-3)]
        });
        let (gap_x, gap_y) = (bx + 4.0e-3, by + 4.0e-3);
        assert!((ax - bx).abs() < 9.0e-3 && (ay - by).abs() < 9.0e-3);
        // Touching the pane there are no shadows.
        assert!((fraction(&data, bx, by, 1.0e-5) - fraction(&data, gap_x, gap_y, 1.0e-5)).abs() < 0.02);
        assert!(fraction(&data, bx, by, focus) > 4.0);
        assert!(fraction(&data, bx + 1.5e-3, by, focus) < 0.2);
        // Far away a drop's shadow has what the light of all is: their cover of pi / 16.
        let (dark, light) = (fraction(&data, bx, by, 1.0), fraction(&data, gap_x, gap_y, 1.0));
        let cover = std::f32::consts::PI * 4.0 / 64.0;
        assert!((dark / (light - dark) - cover).abs() < 0.02, "{dark} {light}");
    }

    #[test]
    fn the_papers_form_has_its_highlight_at_any_distance() {
        let (data, _) = scene(PaneShadows::Tatarchuk2006);
        let x = 4.0e-3 + 12.0 * 8.0e-3;
        let y = 6.0e-3 + 5.0 * 8.0e-3;
        for away in [0.01, 0.1, 1.0] {
            assert!(fraction(&data, x, y, away) > 4.0 && fraction(&data, x + 1.5e-3, y, away) < 0.2);
        }
    }

    #[test]
    fn beside_the_pane_and_before_it_nothing_changes() {
        let (data, _) = scene(PaneShadows::Lens);
        for (x, y, away) in [(-0.01, 0.05, 0.1), (0.1, 0.11, 0.1), (0.1, 0.05, -0.1), (0.1, 0.05, 11.0)] {
            assert_eq!(fraction(&data, x, y, away), 1.0, "{x} {y} {away}");
        }
    }
}
