"""An integrator for Mitsuba 3 that draws nothing at random but the positions within a pixel.

To be imported after the variant is set, a vectorised one. Rays, dielectric and sky are Mitsuba's. Drops are taken to be
convex: light that has left does not come back.
"""

import drjit as dr
import mitsuba as mi
from reference import INTERFACES

# Fraction of the light below which a branch is not followed.
MIN_FRACTION = 1.0e-6


def branch(component):
    context = mi.BSDFContext()
    context.component = component
    return context


# The components of Mitsuba's dielectric.
REFLECTION, TRANSMISSION = branch(0), branch(1)


def sky(scene, direction, active):
    """The radiance that comes from a direction."""
    interaction = dr.zeros(mi.SurfaceInteraction3f)
    interaction.wi = -direction
    return scene.environment().eval(interaction, active)


def follow(context, meets, active):
    """The direction of a branch at an interface, and its share of the light."""
    sample, weight = meets.bsdf().sample(context, meets, 0.5, mi.Point2f(0.5), active)
    return meets.to_world(sample.wo), dr.select(active, mi.Spectrum(weight), 0)


class Split(mi.SamplingIntegrator):
    """Follows both branches at each interface: what leaves sees the sky, what stays continues."""

    @dr.syntax
    def sample(self, scene, sampler, ray, medium=None, active=True):
        meets = scene.ray_intersect(ray, mi.Bool(active))
        hits = meets.is_valid()
        light = mi.Spectrum(dr.select(hits, 0, sky(scene, ray.d, ~hits)))
        mirrored, weight = follow(REFLECTION, meets, hits)
        light += weight * sky(scene, mirrored, hits)
        entering, fraction = follow(TRANSMISSION, meets, hits)
        inside = meets.spawn_ray(entering)
        alive = mi.Bool(hits)
        count = mi.UInt32(0)
        while alive:
            meets = scene.ray_intersect(inside, alive)
            # A ray that slips out between two triangles sees the sky.
            slipped = alive & ~meets.is_valid()
            light += dr.select(slipped, fraction * sky(scene, inside.d, slipped), 0)
            alive &= meets.is_valid()
            leaving, weight = follow(TRANSMISSION, meets, alive)
            passes = alive & dr.any(weight > 0)
            light += dr.select(passes, fraction * weight * sky(scene, leaving, passes), 0)
            mirrored, weight = follow(REFLECTION, meets, alive)
            fraction *= weight
            inside = meets.spawn_ray(mirrored)
            count += 1
            alive &= (dr.max(fraction) > MIN_FRACTION) & (count < INTERFACES)
        return light, mi.Bool(active), []


mi.register_integrator("split", Split)
