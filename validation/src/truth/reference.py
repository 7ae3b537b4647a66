"""The same drop in Mitsuba 3: a dielectric mesh in front of a sky map.

To be imported after the variant is set. Two integrators draw it. `path` is Mitsuba's own: at each interface it follows
one branch, chosen at random. `split` (split.py) follows both. They have to agree; `path` is the witness that nothing is
lost by `split`.
"""

import mitsuba as mi
import numpy as np

# Interfaces after which light inside is given up. Seen obliquely, an oblate drop has a band at its rim where light goes
# round by total reflection: at 3 mm, half of it is left after 33 interfaces, a tenth after 256, a hundredth after 1024.
INTERFACES = 1024


def drop(mesh, sky, index, camera):
    """The drop before the sky. The mesh is in the units of the camera's distance."""
    water = {"type": "dielectric", "int_ior": index, "ext_ior": 1.0}
    return scene(mesh, water, environment(sky), camera)


def shadow(mesh, camera):
    """A black drop before a white sky, of which one minus the picture is the silhouette."""
    black = {"type": "diffuse", "reflectance": 0.0}
    return scene(mesh, black, {"type": "constant", "radiance": 1.0}, camera)


def scene(mesh, material, sky, camera):
    shape = {"type": "ply", "filename": mesh, "face_normals": False, "bsdf": material}
    return mi.load_dict({"type": "scene", "sky": sky, "camera": sensor(**camera), "drop": shape})


def environment(sky):
    """A map whose texels have their middles at v = (j + 0.5) / height, for Mitsuba, which has them at j / (height - 1).

    Rows at every half texel hold the same bilinear function. Mitsuba's u = atan2(x, -z) / 2 pi; a quarter turn makes
    it u = 0.5 + atan2(z, x) / 2 pi.
    """
    texels = linear(sky)
    height, width, _ = texels.shape
    rows = np.empty((2 * height + 1, width, 3), np.float32)
    rows[1::2] = texels
    rows[2:-1:2] = 0.5 * (texels[1:] + texels[:-1])
    rows[0], rows[-1] = texels[0], texels[-1]
    turn = mi.ScalarTransform4f().rotate([0, 1, 0], 90)
    return {"type": "envmap", "bitmap": mi.Bitmap(rows), "to_world": turn}


def linear(file):
    """The radiance of a picture file, rows from the top."""
    return np.array(mi.Bitmap(file).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))


def sensor(distance, yaw, pitch, fov, size):
    """The camera of `downpour specimen`: angles in degrees, `fov` vertical, pixels are means of their squares."""
    yaw, pitch = np.radians([yaw, pitch])
    back = np.array([np.sin(yaw) * np.cos(pitch), np.sin(pitch), np.cos(yaw) * np.cos(pitch)])
    return {
        "type": "perspective",
        "fov": fov,
        "fov_axis": "y",
        "near_clip": 1.0e-3 * distance,
        "far_clip": 10.0 * distance,
        "to_world": mi.ScalarTransform4f().look_at((distance * back).tolist(), [0, 0, 0], [0, 1, 0]),
        "film": {
            "type": "hdrfilm",
            "width": size,
            "height": size,
            "rfilter": {"type": "box"},
            "pixel_format": "rgb",
            "component_format": "float32",
        },
        "sampler": {"type": "multijitter"},
    }


def picture(world, integrator, samples, seed=0):
    """Linear radiance, rows from the top; `samples` per pixel."""
    return np.array(mi.render(world, integrator=integrator, spp=samples, seed=seed))


def path(depth=INTERFACES):
    """Mitsuba's path tracer, without roulette."""
    return mi.load_dict({"type": "path", "max_depth": depth, "rr_depth": 2 * INTERFACES})


def silhouette(mesh, camera):
    """Where the drop covers half of a pixel and more."""
    return picture(shadow(mesh, camera), path(1), 16).mean(axis=2) <= 0.5
