"""Reads what a comparison needs of a glTF file: triangles in the world, and how their materials look.

To be imported after the variant is set.
"""

import json
from pathlib import Path

import mitsuba as mi
import numpy as np

KINDS = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class File:
    def __init__(self, name):
        self.folder = Path(name).parent
        self.json = json.loads(Path(name).read_text())
        self.buffers = [(self.folder / b["uri"]).read_bytes() for b in self.json["buffers"]]

    def accessor(self, index):
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        kind = np.dtype(KINDS[accessor["componentType"]])
        count = COUNTS[accessor["type"]]
        stride = view.get("byteStride", kind.itemsize * count)
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        rows = np.lib.stride_tricks.as_strided(
            np.frombuffer(self.buffers[view["buffer"]], np.uint8)[start:],
            (accessor["count"], kind.itemsize * count),
            (stride, 1),
        )
        values = np.ascontiguousarray(rows).view(kind).reshape(accessor["count"], count)
        if accessor.get("normalized"):
            values = values.astype(np.float32) / np.iinfo(kind).max
        return values


def local(node):
    if "matrix" in node:
        return np.array(node["matrix"], np.float64).reshape(4, 4).T
    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = turn * np.array(node.get("scale", [1, 1, 1]))
    matrix[:3, 3] = node.get("translation", [0, 0, 0])
    return matrix


def placed(file):
    """Nodes with meshes and their matrices."""
    found = []

    def walk(index, above):
        node = file.json["nodes"][index]
        matrix = above @ local(node)
        if "mesh" in node:
            found.append((node["mesh"], matrix))
        for child in node.get("children", []):
            walk(child, matrix)

    for root in file.json["scenes"][file.json.get("scene", 0)]["nodes"]:
        walk(root, np.eye(4))
    return found


def texture(file, used, factor):
    """A texture of colors or light times a factor."""
    source = file.json["textures"][used["index"]]["source"]
    image = mi.Bitmap(str(file.folder / file.json["images"][source]["uri"]))
    linear = np.array(image.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False), np.float32)
    return {"type": "bitmap", "bitmap": mi.Bitmap(linear * np.array(factor, np.float32)), "raw": True}


def channel(file, used, index, factor):
    """One channel of a texture of numbers, times a factor."""
    source = file.json["textures"][used["index"]]["source"]
    image = mi.Bitmap(str(file.folder / file.json["images"][source]["uri"]))
    pixels = np.array(image.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.UInt8, True), np.float32) / 255.0
    one = np.ascontiguousarray(pixels[..., index : index + 1] * factor)
    return {"type": "bitmap", "bitmap": mi.Bitmap(one), "raw": True}


def material(file, index, kind):
    found = file.json["materials"][index] if index is not None else {}
    look = found.get("pbrMetallicRoughness", {})
    base = look.get("baseColorFactor", [1, 1, 1, 1])
    roughness, metallic = look.get("roughnessFactor", 1.0), look.get("metallicFactor", 1.0)
    color = {"type": "rgb", "value": base[:3]}
    if "baseColorTexture" in look:
        color = texture(file, look["baseColorTexture"], base[:3])
    if "metallicRoughnessTexture" in look:
        used = look["metallicRoughnessTexture"]
        roughness, metallic = channel(file, used, 1, roughness), channel(file, used, 2, metallic)
    porosity = found.get("extras", {}).get("porosity")
    if kind == "wet" and porosity is not None:
        import wet

        bsdf = wet.film(base[:3], porosity)
    elif kind == "principled":
        bsdf = {"type": "principled", "base_color": color, "roughness": roughness, "metallic": metallic, "specular": 0.5}
        if not isinstance(roughness, dict):
            bsdf["roughness"] = max(roughness, 0.03)
    else:
        number = lambda value: value if isinstance(value, dict) else {"type": "rgb", "value": [float(value)] * 3}
        bsdf = {"type": "gltf", "base": color, "roughness": number(roughness), "metallic": number(metallic)}
        leaf = found.get("extensions", {}).get("KHR_materials_diffuse_transmission", {})
        through = leaf.get("diffuseTransmissionColorFactor", [1, 1, 1])
        bsdf["part"] = float(leaf.get("diffuseTransmissionFactor", 0.0))
        bsdf["through"] = {"type": "rgb", "value": through}
        if "diffuseTransmissionColorTexture" in leaf:
            bsdf["through"] = texture(file, leaf["diffuseTransmissionColorTexture"], through)
    two_sided = {"type": "twosided", "inner": bsdf} if kind == "principled" else bsdf
    glow = found.get("emissiveFactor")
    lit = found.get("emissiveTexture")
    strength = found.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
    emission = None if not glow or max(glow) == 0 else [strength * g for g in glow]
    if emission:
        # Without a texture the number stays one until it is an emitter's: a texture of its own may not be above 1.
        emission = mi.load_dict(texture(file, lit, emission)) if lit else {"type": "rgb", "value": emission}
    if found.get("alphaMode") == "MASK" and "baseColorTexture" in look:
        source = file.json["textures"][look["baseColorTexture"]["index"]]["source"]
        pixels = np.array(mi.Bitmap(str(file.folder / file.json["images"][source]["uri"])))
        if pixels.shape[-1] == 4:
            hole = (pixels[..., 3:] >= 255 * found.get("alphaCutoff", 0.5)).astype(np.float32)
            alpha = {"type": "bitmap", "bitmap": mi.Bitmap(np.ascontiguousarray(hole)), "raw": True}
            two_sided = {"type": "mask", "inner": two_sided, "opacity": alpha}
    return mi.load_dict(two_sided), emission


def shapes(name, kind):
    """Parts of a scene, a mesh for each primitive at its position."""
    file = File(name)
    found = {}
    looks = {}
    for k, (mesh, matrix) in enumerate(placed(file)):
        for p, part in enumerate(file.json["meshes"][mesh]["primitives"]):
            attributes = part["attributes"]
            positions = file.accessor(attributes["POSITION"]).astype(np.float64)
            positions = positions @ matrix[:3, :3].T + matrix[:3, 3]
            indices = file.accessor(part["indices"]).reshape(-1, 3).astype(np.uint32)
            if np.linalg.det(matrix[:3, :3]) < 0:
                indices = indices[:, ::-1]
            of = part.get("material")
            if of not in looks:
                looks[of] = material(file, of, kind)
            bsdf, emission = looks[of]
            properties = mi.Properties()
            properties["bsdf"] = bsdf
            if emission is not None:
                properties["emitter"] = mi.load_dict({"type": "area", "radiance": emission})
            smooth = "NORMAL" in attributes
            made = mi.Mesh(
                f"part_{k}_{p}", len(positions), len(indices), properties, smooth, "TEXCOORD_0" in attributes
            )
            values = mi.traverse(made)
            values["vertex_positions"] = positions.astype(np.float32).ravel()
            values["faces"] = indices.ravel()
            if smooth:
                normals = file.accessor(attributes["NORMAL"]) @ np.linalg.inv(matrix[:3, :3])
                normals /= np.linalg.norm(normals, axis=1, keepdims=True)
                values["vertex_normals"] = normals.astype(np.float32).ravel()
            if "TEXCOORD_0" in attributes:
                values["vertex_texcoords"] = file.accessor(attributes["TEXCOORD_0"]).astype(np.float32).ravel()
            values.update()
            found[f"part_{k}_{p}"] = made
    return found
