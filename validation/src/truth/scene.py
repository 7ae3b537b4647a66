"""Renders a glTF scene with Mitsuba's path tracer, compares it with a picture of `downpour render`, and prints `name value` lines.

The file is read here anew: triangles, metallic-roughness materials with textures of base color, point lamps. Surfaces have glTF's own
reflection (gltf_bsdf.py), so that what differs is the light and not the material.

Without `--ours` it makes the reference alone, which a later call with `--keep` takes: for a machine that has a GPU, and no `downpour`.
"""

import argparse
import json
from pathlib import Path

import mitsuba as mi
import numpy as np

# Bounces; the last of them give less than a thousandth in the whitest of the rooms.
DEPTH = 24
# Batches, whose scatter is the reference's own noise: at least so many, an even number of them, of so many samples at most.
BATCHES = 4
BATCH_SAMPLES = 3000


def arguments():
    parser = argparse.ArgumentParser()
    for name in ("scene", "sky", "reference"):
        parser.add_argument(f"--{name}", required=True)
    for name in ("ours", "beside"):
        parser.add_argument(f"--{name}", default="")
    parser.add_argument("--variant", default="llvm_ad_rgb")
    parser.add_argument("--lamps", default="")
    for name in ("eye-x", "eye-y", "eye-z", "at-x", "at-y", "at-z", "fov", "scale"):
        parser.add_argument(f"--{name}", required=True, type=float)
    for name in ("width", "height", "path-samples"):
        parser.add_argument(f"--{name}", required=True, type=float)
    parser.add_argument("--bsdf", default="gltf")
    parser.add_argument("--keep", type=float, default=0.0)
    # The first batch's number: of other batches than those of another run, whose mean with it is that of all samples.
    parser.add_argument("--first-batch", type=int, default=0)
    return parser.parse_args()


def sensor(given):
    eye = [given.eye_x, given.eye_y, given.eye_z]
    at = [given.at_x, given.at_y, given.at_z]
    return {
        "type": "perspective",
        "fov": given.fov,
        "fov_axis": "y",
        "near_clip": 1.0e-2,
        "far_clip": 1.0e4,
        "to_world": mi.ScalarTransform4f().look_at(eye, at, [0, 1, 0]),
        "film": {
            "type": "hdrfilm",
            "width": int(given.width),
            "height": int(given.height),
            "rfilter": {"type": "box"},
            "pixel_format": "rgb",
            "component_format": "float32",
        },
        "sampler": {"type": "independent"},
    }


def lamps(text):
    """Point lamps: `x,y,z,r,g,b` each, separated by semicolons; the color is radiant intensity."""
    found = {}
    for k, lamp in enumerate(part for part in text.split(";") if part):
        x, y, z, *color = (float(number) for number in lamp.split(","))
        found[f"lamp_{k}"] = {
            "type": "point",
            "position": [x, y, z],
            "intensity": {"type": "rgb", "value": color},
        }
    return found


def world(given):
    import gltf
    import reference

    sky = reference.environment(given.sky)
    sky["scale"] = given.scale
    parts = {"type": "scene", "sky": sky, "camera": sensor(given)}
    parts |= lamps(given.lamps)
    parts |= gltf.shapes(given.scene, given.bsdf)
    return mi.load_dict(parts)


def surfaces(scene, given):
    """Where all of a pixel shows surfaces: a picture of the depth's being there."""
    aov = mi.load_dict({"type": "aov", "aovs": "there:shape_index"})
    seen = np.array(mi.render(scene, integrator=aov, spp=16, seed=1))
    depth = mi.load_dict({"type": "aov", "aovs": "far:depth"})
    far = np.array(mi.render(scene, integrator=depth, spp=16, seed=1))[..., -1]
    del seen
    return far > 0.0


def render(scene, given):
    # The one that follows light through holes of cards to lamps: to `path`, a card with holes is whole in the way of a lamp.
    path = mi.load_dict({"type": "volpath", "max_depth": DEPTH, "rr_depth": 6})
    pairs = max(BATCHES // 2, -(-int(given.path_samples) // (2 * BATCH_SAMPLES)))
    samples = max(int(given.path_samples) // (2 * pairs), 1)
    seeds = range(given.first_batch, given.first_batch + 2 * pairs)
    return [np.array(mi.render(scene, integrator=path, spp=samples, seed=seed)) for seed in seeds]


def halves_of(given, scene):
    """Means of both halves of the samples: kept ones, or new ones, which are then kept."""
    import reference

    kept = Path(given.reference)
    other = kept.with_suffix(".half.exr")
    if given.keep > 0 and kept.exists() and other.exists():
        both, one = reference.linear(str(kept)), reference.linear(str(other))
        return [one, 2.0 * both - one]
    batches = render(scene, given)
    halves = [np.mean(batches[k::2], axis=0) for k in range(2)]
    for picture, file in ((np.mean(halves, axis=0), kept), (halves[0], other)):
        mi.Bitmap(picture.astype(np.float32)).write(str(file))
    return halves


def main(given):
    mi.set_variant(given.variant)
    mi.set_log_level(mi.LogLevel.Error)
    import gltf_bsdf  # noqa: F401  makes the material known
    import reference

    scene = world(given)
    halves = halves_of(given, scene)
    if not given.ours:
        return
    import compare

    theirs = np.mean(halves, axis=0)
    within = surfaces(scene, given)
    ours = reference.linear(given.ours)
    factor = compare.exposure(theirs, within)
    mean = compare.mean_luminance(theirs, within)
    values = {
        "flip": compare.mean_flip(theirs, ours, within, factor),
        "luminance": compare.mean_luminance(ours, within) / mean - 1.0,
        "noise": compare.mean_flip(halves[0], halves[1], within, factor),
        "mirrored": compare.mean_flip(theirs, np.ascontiguousarray(ours[:, ::-1]), within, factor),
        "share": float(within.mean()),
        "exposure": factor,
    }
    if given.bsdf == "wet":
        import wet

        values |= wet.differences(ours, theirs, wet.ground(scene, within))
    compare.beside(theirs, ours, factor, given.beside)
    for name, value in values.items():
        print(name, repr(float(value)))


if __name__ == "__main__":
    main(arguments())
