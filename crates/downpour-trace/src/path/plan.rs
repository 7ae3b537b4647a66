//! Surfaces as rays take them, and the rays that look for their light.

use downpour_shaders::render::path::{
    PATH_APART, PATH_ENCLOSED, PATH_MIN_GLOSS, PATH_MIXED, PATH_SECONDARY_ROUGHNESS, PATH_SHARP,
};
use downpour_shaders::render::puddle_water::PUDDLE_WATER_NORMAL;
use downpour_shaders::render::scene::SCENE_BLENDED;
use glam::Vec3;

use crate::scatter::{scatter_chance, scatter_gloss};
use crate::scene::SceneView;
use crate::scene::water::{puddle_water_albedo, puddle_water_normal, puddle_water_reflectance};
use crate::surface::Surface;
use crate::translucent::translucent_albedo;

/// The rays that look for the light of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct PathPlan {
    /// Factor of the light on the diffuse base.
    pub(super) body: Vec3,
    /// Rays of the gloss alone; they come first.
    pub(super) mirrors: u32,
    /// Factor of the light that the gloss shows.
    pub(super) gloss: Vec3,
    /// Rays of the diffuse base, or of both.
    pub(super) rays: u32,
    /// Part of the latter that is drawn for the gloss.
    pub(super) chance: f32,
    /// Part of all rays that one is.
    pub(super) fraction: f32,
    /// True if rays of the gloss are drawn from its lobe; else they are a mirror's.
    pub(super) drawn: bool,
    /// True if what the gloss shows is averaged over neighboring pixels.
    pub(super) kept: bool,
    /// True if the light on what the gloss shows is averaged instead.
    pub(super) replaced: bool,
    /// Width of the mirror's ray by what the surface turns within a pixel.
    pub(super) spread: f32,
    /// True if what is averaged over neighboring pixels is left to their rays.
    pub(super) spared: bool,
    /// True if the light on what a mirror shows is left to them, too: also that of a pane, of which else no means are taken.
    pub(super) shown_spared: bool,
}

impl PathPlan {
    /// No rays.
    pub(super) const NONE: Self = Self {
        body: Vec3::ZERO,
        mirrors: 0,
        gloss: Vec3::ZERO,
        rays: 0,
        chance: 0.0,
        fraction: 0.0,
        drawn: false,
        kept: false,
        replaced: false,
        spread: 0.0,
        spared: false,
        shown_spared: false,
    };

    /// The plan without the rays of which means are taken over neighboring pixels: theirs do.
    pub(super) fn path_spared(self) -> Self {
        Self {
            spared: true,
            // A gloss without rays of its own stays without.
            kept: self.kept && (self.mirrors > 0 || self.chance > 0.0),
            rays: 0,
            mirrors: if self.kept { 0 } else { self.mirrors },
            ..self
        }
    }
}

/// The greatest part of a color.
pub(crate) fn path_max(color: Vec3) -> f32 {
    color.max_element()
}

/// Fraction of the light on its diffuse base that a surface gives back.
pub(super) fn path_albedo(surface: &Surface) -> Vec3 {
    translucent_albedo(surface) * ((1.0 - surface.transmission) * surface.occlusion)
}

/// Opacity of a surface.
pub(super) fn path_cover(surface: &Surface) -> f32 {
    if surface.flags & SCENE_BLENDED == 0 { 1.0 } else { surface.alpha.clamp(0.0, 1.0) }
}

/// Fraction of the light behind a surface that it lets through, straight on.
pub(super) fn path_open(surface: &Surface) -> Vec3 {
    let cover = path_cover(surface);
    Vec3::splat(1.0 - cover) + surface.diffuse * (surface.transmission * cover)
}

/// The surface of a puddle that a ray has come through, `distance` along the ray.
pub(super) fn path_water_surface(start: Vec3, along: Vec3, distance: f32, ripple: Vec3) -> Surface {
    Surface {
        position: start + along * distance,
        alpha: 1.0,
        normal: puddle_water_normal(Vec3::new(ripple.x, ripple.y, 0.0), 0.0, 0.0),
        // Beckmann's alpha squared is the variance of the slope.
        roughness: ripple.z.sqrt().sqrt().clamp(0.0, 1.0),
        facet: Vec3::Y,
        occlusion: 1.0,
        diffuse: Vec3::ZERO,
        flags: 0,
        normal_reflectance: Vec3::splat(PUDDLE_WATER_NORMAL),
        transmission: 0.0,
        emission: Vec3::ZERO,
        bend: 0.0,
        porosity: 0.0,
        film: 0.0,
        variance: 0.0,
        diffuse_transmission: Vec3::ZERO,
    }
}

/// A surface as it looks under water of which a fraction `clear` of the light is left.
pub(super) fn path_submerged(surface: &Surface, clear: f32, scattering_albedo: Vec3) -> Surface {
    Surface {
        diffuse: puddle_water_albedo(surface.diffuse * clear + scattering_albedo * (1.0 - clear)),
        normal_reflectance: puddle_water_reflectance(surface.normal_reflectance) * clear,
        diffuse_transmission: surface.diffuse_transmission * clear,
        emission: surface.emission * clear,
        film: 0.0,
        ..*surface
    }
}

/// A surface without its gloss, which is shown otherwise.
pub(super) fn path_matte(surface: &Surface, gloss: Vec3) -> Surface {
    Surface {
        diffuse: surface.diffuse * (Vec3::ONE - gloss),
        diffuse_transmission: surface.diffuse_transmission * (Vec3::ONE - gloss),
        normal_reflectance: Vec3::ZERO,
        roughness: 1.0,
        film: 0.0,
        ..*surface
    }
}

impl SceneView<'_> {
    /// Fraction of the light that the gloss of a surface shows to a viewer at a cosine.
    pub(super) fn path_gloss(&self, surface: &Surface, cosine: f32) -> Vec3 {
        let sharp = surface.roughness < PATH_SHARP;
        let mut gloss =
            scatter_gloss(surface.normal_reflectance, surface.roughness, cosine, sharp) * surface.occlusion;
        if surface.film > 0.0 {
            // What is above a film is open to the sky.
            let coat = self.data.wet_coat(surface.normal_reflectance, surface.roughness, cosine, false);
            gloss += (coat - gloss) * surface.film;
        }
        gloss
    }

    /// A surface as it looks along a direction to rays that are not a mirror's: what its gloss reflects, it reflects diffusely.
    pub(super) fn path_secondary(&self, surface: &Surface, towards: Vec3, roughness: f32) -> Surface {
        if roughness < PATH_SECONDARY_ROUGHNESS {
            return *surface;
        }
        // Of that there is less in gaps, as of what is diffuse.
        let open = Surface { occlusion: 1.0, ..*surface };
        let gloss = self.path_gloss(&open, (-surface.normal.dot(towards)).max(0.0));
        let matte = path_matte(surface, gloss);
        Surface { diffuse: matte.diffuse + gloss, ..matte }
    }

    /// The rays of a surface that shows itself to a viewer, to whom a pixel is `footprint` wide there. `told`: means over
    /// neighboring pixels are taken of what they find; `free`: of what the gloss shows, too.
    pub(super) fn path_plan(
        &self,
        surface: &Surface,
        view: Vec3,
        footprint: f32,
        told: bool,
        free: bool,
    ) -> PathPlan {
        let cosine = surface.normal.dot(view).max(0.0);
        // Neighboring pixels mirror directions as far apart as this.
        let spread = 2.0 * surface.bend * footprint / cosine.max(0.2);
        let sharp = surface.roughness < PATH_SHARP;
        let gloss = self.path_gloss(surface, cosine);
        let body = path_albedo(surface);
        let rays = self.frame.sky_rays;
        let drawn = told && free && !sharp && rays > 0;
        // Where neighbors mirror other things, a mean over them would be wider than the lobe.
        let kept = drawn && surface.roughness * surface.roughness >= spread * PATH_APART;
        let mut plan = PathPlan {
            body,
            mirrors: 0,
            gloss,
            rays,
            chance: 0.0,
            fraction: if told { self.frame.ray_fraction } else { 1.0 / rays.max(1) as f32 },
            drawn,
            kept,
            replaced: false,
            spread,
            spared: false,
            shown_spared: false,
        };
        if rays > 0 && path_max(body) <= 0.0 {
            plan.rays = 0;
            plan.mirrors = if drawn { rays } else { 1 };
        } else if rays > 0 && surface.roughness < PATH_MIXED {
            plan.mirrors = u32::from(path_max(gloss) > PATH_MIN_GLOSS);
        } else if kept {
            plan.chance = scatter_chance(body, gloss);
        }
        plan.replaced = free && !kept && plan.mirrors > 0;
        plan
    }
}

/// Light that falls on the last surface of a path, over pi: the mean of what its surfaces gave, thrown back and forth. A path that has met
/// so many is enclosed by them, and sees no open sky.
pub(super) fn path_ambient(surface: &Surface, given: Vec3) -> Vec3 {
    let albedo = (surface.diffuse + surface.normal_reflectance).min(Vec3::ONE);
    given * PATH_ENCLOSED / (Vec3::ONE - albedo * PATH_ENCLOSED)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builder::SceneBuilder;
    use crate::data::RenderFrame;
    use crate::sky_light::SkyLight;
    use downpour_render::camera::Viewpoint;

    /// What surfaces that rays meet give back of even light: no more than falls on a white one, and of a black base the mean over
    /// the hemisphere of Schlick's reflectance, r + (1 - r) / 21, whatever it is that reflects.
    #[test]
    fn surfaces_that_rays_meet_keep_the_light_of_their_gloss() {
        let scene = SceneBuilder::new().build(&SkyLight::new(1, 1, &[[1.0; 3]]));
        let view = Viewpoint { eye: Vec3::Y, forward: Vec3::NEG_Y, up: Vec3::X, fov_y: 1.0 };
        let frame = RenderFrame::new(&scene, &view, [1, 1], 1, 0, 0).unwrap();
        let view = SceneView { data: &scene, frame: &frame };
        // The surface of water is one without a base.
        let polished = path_water_surface(Vec3::Y, Vec3::NEG_Y, 1.0, Vec3::ZERO);
        for normal_reflectance in [Vec3::ZERO, Vec3::splat(0.04), Vec3::new(0.9, 0.6, 0.3)] {
            for roughness in [0.0, 0.3, 1.0] {
                let black = Surface { normal_reflectance, roughness, ..polished };
                let white = Surface { diffuse: Vec3::ONE, ..black };
                let mut mean = Vec3::ZERO;
                for k in 0..1000u16 {
                    // Cosine-weighted.
                    let cosine = ((f32::from(k) + 0.5) / 1000.0).sqrt();
                    let towards = Vec3::new((1.0 - cosine * cosine).sqrt(), -cosine, 0.0);
                    let seen = view.path_secondary(&white, towards, 1.0);
                    assert!((seen.diffuse - Vec3::ONE).abs().max_element() < 1.0e-6);
                    mean += view.path_secondary(&black, towards, 1.0).diffuse * 1.0e-3;
                }
                if normal_reflectance == Vec3::ZERO {
                    assert_eq!(mean, Vec3::ZERO);
                } else if roughness == 0.0 {
                    let exact = normal_reflectance + (Vec3::ONE - normal_reflectance) / 21.0;
                    assert!((mean - exact).abs().max_element() < 1.0e-3, "{mean} of {exact}");
                }
            }
        }
        let mirrored = view.path_secondary(&polished, Vec3::NEG_Y, 0.0);
        assert_eq!(mirrored.normal_reflectance, polished.normal_reflectance);
    }
}
