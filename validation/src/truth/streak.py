"""Renders one streak with Mitsuba as the mean of instants, compares it with a picture of `downpour specimen --exposure`, and
prints `name value` lines.

Each instant is a mesh file, its drop where it is at that time; Mitsuba's own path tracer draws the rows round it, with the sky
hidden where it is seen directly. What is left out of a pixel over all instants shows the sky. A lamp is a bright disk a kilometer
away, which the camera does not see directly.
"""

import argparse
from pathlib import Path

import mitsuba as mi
import numpy as np

# Distance of a lamp in the units of the meshes, of which a drop has some hundreds and a path ten thousand.
LAMP_DISTANCE = 1.0e8
# Fraction of the exposure below which a pixel is not of the streak, against the most covered one.
MIN_COVER = 0.1


def arguments():
    parser = argparse.ArgumentParser()
    for name in ("ours", "meshes", "sky", "beside", "reference"):
        parser.add_argument(f"--{name}", required=True)
    for name in ("index", "distance", "fov", "reach"):
        parser.add_argument(f"--{name}", required=True, type=float)
    for name in ("width", "height", "path-samples"):
        parser.add_argument(f"--{name}", required=True, type=int)
    for name in ("yaw", "pitch", "radius", "red", "green", "blue"):
        parser.add_argument(f"--lamp-{name}", type=float)
    return parser.parse_args()


def sensor(given, rows=None):
    """The camera, level and at yaw 0, for all rows or for some."""
    import reference

    sensor = reference.sensor(given.distance, 0.0, 0.0, given.fov, given.height)
    film = sensor["film"] | {"width": given.width, "pixel_format": "rgba"}
    if rows is not None:
        film |= {"crop_offset_x": 0, "crop_offset_y": rows[0]}
        film |= {"crop_width": given.width, "crop_height": rows[1] - rows[0]}
    return mi.load_dict(sensor | {"film": film, "sampler": {"type": "independent"}})


def lamps(given):
    """The lamp as a part of a scene, if there is one."""
    if given.lamp_radius is None:
        return {}
    yaw, pitch, radius = np.radians([given.lamp_yaw, given.lamp_pitch, given.lamp_radius])
    towards = np.array([np.sin(yaw) * np.cos(pitch), np.sin(pitch), np.cos(yaw) * np.cos(pitch)])
    position = mi.ScalarTransform4f().look_at((LAMP_DISTANCE * towards).tolist(), [0, 0, 0], [0, 1, 0])
    light = {"type": "rgb", "value": [given.lamp_red, given.lamp_green, given.lamp_blue]}
    return {
        "lamp": {
            "type": "disk",
            "to_world": position.scale(float(LAMP_DISTANCE * np.tan(radius))),
            "emitter": {"type": "area", "radiance": light},
        }
    }


def rows_of(mesh, given):
    """The rows in which a mesh may be seen."""
    box = mesh.bbox()
    scale = 0.5 * given.height / np.tan(0.5 * np.radians(given.fov))
    rows = [
        0.5 * given.height - scale * y / (given.distance - side * given.reach)
        for y in (box.min.y, box.max.y)
        for side in (-1.0, 1.0)
    ]
    first = max(int(np.floor(min(rows))) - 1, 0)
    last = min(int(np.ceil(max(rows))) + 1, given.height)
    return (first, last)


def main(given):
    mi.set_variant("scalar_rgb")
    mi.set_log_level(mi.LogLevel.Error)
    import compare
    import reference

    ours = reference.linear(given.ours)
    sky = mi.load_dict(reference.environment(given.sky))
    path = mi.load_dict(
        {"type": "path", "max_depth": 256, "rr_depth": 1024, "hide_emitters": True}
    )
    empty = mi.load_dict({"type": "scene", "sky": sky, "camera": sensor(given)})
    behind = np.array(mi.render(empty, integrator=reference.path(), spp=64))[..., :3]
    water = {"type": "dielectric", "int_ior": given.index, "ext_ior": 1.0}
    layer = np.zeros((given.height, given.width, 4))
    meshes = sorted(Path(given.meshes).glob("*.ply"))
    for seed, file in enumerate(meshes):
        mesh = mi.load_dict({"type": "ply", "filename": str(file), "face_normals": False, "bsdf": water})
        rows = rows_of(mesh, given)
        if rows[0] >= rows[1]:
            continue
        camera = sensor(given, rows)
        world = mi.load_dict({"type": "scene", "sky": sky, "camera": camera, "drop": mesh} | lamps(given))
        seen = mi.render(world, integrator=path, spp=given.path_samples, seed=seed)
        layer[rows[0] : rows[1]] += np.array(seen)[..., :4]
    layer /= len(meshes)
    light, cover = layer[..., :3], layer[..., 3:]
    theirs = behind * (1.0 - cover) + light
    within = cover[..., 0] > MIN_COVER * cover.max()
    # The streak alone, as bright as if it covered its pixels all of the time.
    safe = np.maximum(cover, MIN_COVER * cover.max())
    alone = np.where(within[..., None], light / safe, behind)
    ours_light = ours - behind * (1.0 - cover)
    ours_alone = np.where(within[..., None], ours_light / safe, behind)
    factor = compare.exposure(theirs, within)
    factor_alone = compare.exposure(alone, within)
    apart = np.abs(ours - theirs)[~within].mean() / theirs[~within].mean()
    values = {
        "flip": compare.mean_flip(theirs, ours, within, factor),
        "luminance": compare.mean_luminance(ours, within) / compare.mean_luminance(theirs, within) - 1.0,
        "alone_flip": compare.mean_flip(alone, ours_alone, within, factor_alone),
        "alone": compare.mean_luminance(ours_light, within) / compare.mean_luminance(light, within) - 1.0,
        "absent": compare.mean_flip(alone, behind, within, factor_alone),
        "sky": apart,
        "cover": float(cover.max()),
        "instants": len(meshes),
    }
    mi.Bitmap(theirs.astype(np.float32)).write(given.reference)
    compare.beside(alone, ours_alone, factor_alone, given.beside)
    compare.beside(theirs, ours, factor, given.beside.replace(".png", ".diluted.png"))
    for name, value in values.items():
        print(name, repr(float(value)))


if __name__ == "__main__":
    main(arguments())
