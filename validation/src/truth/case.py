"""Renders one case with Mitsuba, compares it with a picture of `downpour specimen`, and prints `name value` lines.

`case.py probe VARIANT` only says whether the variant works here.
"""

import argparse
import sys

import mitsuba as mi
import numpy as np

# Batches of the path tracer, whose scatter is its error.
BATCHES = 8


def arguments():
    parser = argparse.ArgumentParser()
    for name in ("variant", "ours", "mesh", "sky", "beside", "reference"):
        parser.add_argument(f"--{name}", required=True)
    for name in ("index", "distance", "yaw", "pitch", "fov"):
        parser.add_argument(f"--{name}", required=True, type=float)
    for name in ("size", "samples", "path-samples"):
        parser.add_argument(f"--{name}", required=True, type=int)
    return parser.parse_args()


def probe(variant):
    """A vectorised variant compiles with whatever LLVM is found; an old one ends the process at the first kernel."""
    mi.set_variant(variant)
    import drjit as dr

    angles = dr.safe_acos(dr.linspace(mi.Float, -2.0, 2.0, 64))
    assert abs(float(dr.mean(angles)[0]) - 0.5 * np.pi) < 1.0e-3, "the compiled kernel is wrong"


def main(given):
    mi.set_variant(given.variant)
    mi.set_log_level(mi.LogLevel.Error)
    import compare
    import reference

    names = ("distance", "yaw", "pitch", "fov", "size")
    camera = {name: getattr(given, name) for name in names}
    ours = reference.linear(given.ours)
    within = reference.silhouette(given.mesh, camera)
    if not within.any() or within.all():
        sys.exit("the drop is not in the picture, or all of it")
    world = reference.drop(given.mesh, given.sky, given.index, camera)
    batches = [
        reference.picture(world, reference.path(), max(given.path_samples // BATCHES, 1), seed=seed)
        for seed in range(BATCHES)
    ]
    traced = np.mean(batches, axis=0)
    if given.variant.startswith("llvm"):
        import split  # noqa: F401  makes the integrator known

        theirs = reference.picture(world, mi.load_dict({"type": "split"}), given.samples)
    else:
        theirs = traced
    factor = compare.exposure(theirs, within)
    mean = compare.mean_luminance(theirs, within)
    scatter = np.std([compare.mean_luminance(batch, within) for batch in batches], ddof=1) / np.sqrt(BATCHES)
    outside = ~within
    values = {
        "flip": compare.mean_flip(theirs, ours, within, factor),
        "luminance": compare.mean_luminance(ours, within) / mean - 1.0,
        "path_flip": compare.mean_flip(traced, ours, within, factor),
        "path": compare.mean_luminance(traced, within) / mean - 1.0,
        "path_error": scatter / mean,
        "sky": np.abs(ours - theirs)[outside].mean() / theirs[outside].mean(),
        "mirrored": compare.mean_flip(theirs, np.ascontiguousarray(ours[:, ::-1]), within, factor),
        "exposure": factor,
    }
    mi.Bitmap(theirs.astype(np.float32)).write(given.reference)
    compare.beside(theirs, ours, factor, given.beside)
    for name, value in values.items():
        print(name, repr(float(value)))


if __name__ == "__main__":
    if sys.argv[1:2] == ["probe"]:
        probe(sys.argv[2])
    else:
        main(arguments())
