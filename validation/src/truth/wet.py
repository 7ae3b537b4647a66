"""Ground that rain has made wet: what Mitsuba has in the place of Downpour's film, and the extent of a sign's image in it.

To be imported after the variant is set.
"""

import mitsuba as mi
import numpy as np

INDEX = 1.333
# Of a level surface of water under an even sky: the part that it reflects, from above and from below.
OUTSIDE = 0.0664058
INSIDE = 1.0 - (1.0 - OUTSIDE) / INDEX**2
# Alpha of a film, crates/downpour-trace/src/wet.rs: on a smooth surface; on a porous one, without the relief of its grains.
SMOOTH_ALPHA, POROUS_ALPHA = 0.03, 0.05
# Its relief: octaves of value noise, the height of each over the edge of its cell, and the mean square of the slope at height 1.
OCTAVES, STEEP, SQUARE = 3, 0.04, 0.883
# Less of the ground's height is none, m.
LEVEL = 1.0e-4


def film(base, porosity):
    """A rough interface of water over a diffuse base, for a ground of this color when it is dry.

    Pores full of water: the base itself is the dry one, and light is thrown back and forth between it and the water's surface, which
    darkens it (Lekner & Dorf 1988; `nonlinear`). A smooth surface has that done to it when it is dry, too, in its own medium: its base
    is the one that looks like the dry color (Saunderson 1942, the other way round). The film's alpha is that of all its relief; squares
    of alphas and variances of slopes add up.
    """
    dry = np.array(base, np.float64)
    inside = dry / ((1.0 - OUTSIDE) / INDEX**2 + dry * INSIDE)
    relief = OCTAVES * STEEP**2 * SQUARE
    alpha = SMOOTH_ALPHA + (POROUS_ALPHA - SMOOTH_ALPHA) * porosity
    return {
        "type": "roughplastic",
        "distribution": "ggx",
        "int_ior": INDEX,
        "ext_ior": 1.0,
        "alpha": float(np.sqrt(alpha**2 + relief * porosity)),
        "nonlinear": True,
        "diffuse_reflectance": {"type": "rgb", "value": (inside + (dry - inside) * porosity).tolist()},
    }


def ground(scene, within):
    """Where all of a pixel shows level ground at height 0."""
    position = mi.load_dict({"type": "aov", "aovs": "at:position"})
    height = np.array(mi.render(scene, integrator=position, spp=16, seed=1))[..., -2]
    return within & (np.abs(height) < LEVEL)


def width(profile):
    """Extent of a profile at half its maximum, pixels."""
    smooth = np.convolve(profile, np.ones(3) / 3.0, "same")
    half = 0.5 * smooth.max()
    above = np.flatnonzero(smooth > half)
    first, last = above[0], above[-1]

    def crossing(inner, outer):
        if not 0 <= outer < len(smooth):
            return 0.5
        return (smooth[inner] - half) / (smooth[inner] - smooth[outer])

    return float(last - first + crossing(first, first - 1) + crossing(last, last + 1))


def spread(profile):
    """Root of the second moment of a profile, pixels: what its tails widen."""
    k = np.arange(len(profile))
    middle = np.average(k, weights=profile)
    return float(np.sqrt(np.average((k - middle) ** 2, weights=profile)))


def image(picture, on):
    """Extents - at half the maximum, and by the second moment - of the rows and of the columns, and the light, of what the ground mirrors
    of the sign: blue less green, as the base has neither, the sky as much of both and the sign no green.
    """
    light = np.where(on, picture[..., 2] - picture[..., 1], 0.0).astype(np.float64)
    return [np.array([width(light.sum(axis=k)), spread(light.sum(axis=k))]) for k in (1, 0)], light.sum()


def differences(ours, theirs, on):
    """Relative differences of an image's height and width, each by the measure that says more, and of its light."""
    (extents, light), (expected, full) = image(ours, on), image(theirs, on)
    ratios = [a / b - 1.0 for a, b in zip(extents, expected)]
    height, across = (float(ratio[np.argmax(np.abs(ratio))]) for ratio in ratios)
    return {"image_height": height, "image_width": across, "image_light": light / full - 1.0}
