//! Path of a viewer's ray: the outside reflection, and each ray that leaves the drop.

use downpour_drop::optics::{optics_fresnel_polarized, optics_reflect, optics_refract};
use downpour_math::vector::{dot, normalize, scale};

use crate::surface::Surface;

/// The most reflections inside that are followed. For a sphere they leave 0.1 % of the light.
pub const INTERNAL: u32 = 4;
/// Fraction of the light below which a path is dropped.
const FAINT: f64 = 1.0e-5;

/// Follows the viewer's ray along `direction` whose point nearest to the drop's origin is `origin`. `light` is called
/// with each direction of exit and the fraction of unpolarized radiance from there; s and p are followed separately, as
/// if all planes of incidence were one. Returns true if the ray meets the drop.
pub(crate) fn follow(
    surface: &Surface<'_>,
    index: f64,
    origin: [f64; 3],
    direction: [f64; 3],
    mut light: impl FnMut([f64; 3], f64),
) -> bool {
    let Some(entry) = surface.enter(origin, direction) else { return false };
    let cosine = -dot(direction, entry.normal);
    let [s, p] = optics_fresnel_polarized(cosine, index);
    light(optics_reflect(direction, entry.normal), 0.5 * (s + p));
    let (mut s, mut p) = (1.0 - s, 1.0 - p);
    let (inside, _) = optics_refract(direction, entry.normal, 1.0 / index);
    let mut inside = normalize(inside);
    let mut point = entry.point;
    for _ in 0..=INTERNAL {
        let Some(exit) = surface.leave(point, inside) else { break };
        let [rs, rp] = optics_fresnel_polarized(dot(inside, exit.normal), 1.0 / index);
        let (outside, squared) = optics_refract(inside, scale(exit.normal, -1.0), index);
        if squared > 0.0 {
            light(normalize(outside), 0.5 * (s * (1.0 - rs) + p * (1.0 - rp)));
        }
        (s, p) = (s * rs, p * rp);
        if s + p < FAINT {
            break;
        }
        inside = normalize(optics_reflect(inside, exit.normal));
        point = exit.point;
    }
    true
}
