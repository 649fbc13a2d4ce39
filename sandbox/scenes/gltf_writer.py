"""Builds glTF 2.0 documents with an embedded buffer."""

import base64
import json
import math
import struct

FLOAT, UNSIGNED_INT = 5126, 5125
VERTICES, INDICES = 34962, 34963
CLAMP_TO_EDGE = 33071


class Scene:
    """A glTF document under construction; the methods return indices into its lists."""

    def __init__(self):
        self.data = bytearray()
        self.document = {
            "asset": {"version": "2.0", "generator": "Candela"},
            "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": {"KHR_lights_punctual": {"lights": []}},
            "scene": 0,
            "scenes": [{"nodes": []}],
        }

    def add(self, kind, item):
        items = self.document.setdefault(kind, [])
        items.append(item)
        return len(items) - 1

    def use(self, extension):
        if extension not in self.document["extensionsUsed"]:
            self.document["extensionsUsed"].append(extension)

    def accessor(self, rows, component_type, code, target):
        """One value or vector per row, in a separate buffer view."""
        view = {"buffer": 0, "byteOffset": len(self.data), "target": target}
        for row in rows:
            self.data += struct.pack(f"<{len(row)}{code}", *row)
        view["byteLength"] = len(self.data) - view["byteOffset"]
        accessor = {
            "bufferView": self.add("bufferViews", view),
            "componentType": component_type,
            "count": len(rows),
            "type": {1: "SCALAR", 2: "VEC2", 3: "VEC3"}[len(rows[0])],
            "min": [min(column) for column in zip(*rows)],
            "max": [max(column) for column in zip(*rows)],
        }
        return self.add("accessors", accessor)

    def vertices(self, rows):
        return self.accessor([single(row) for row in rows], FLOAT, "f", VERTICES)

    def material(self, name, colour, alpha=1.0, texture=None, extensions=None, **properties):
        """A Lambertian material."""
        pbr = {"baseColorFactor": [*colour, alpha], "metallicFactor": 0.0, "roughnessFactor": 1.0}
        if texture is not None:
            pbr["baseColorTexture"] = {"index": texture}
        self.use("KHR_materials_specular")
        all_extensions = {"KHR_materials_specular": {"specularFactor": 0.0}, **(extensions or {})}
        described = {"name": name, "pbrMetallicRoughness": pbr, "extensions": all_extensions, **properties}
        return self.add("materials", described)

    def glossy(self, name, colour, roughness, metalness=0.0, **properties):
        """A material that also reflects in the mirror direction."""
        pbr = {"baseColorFactor": [*colour, 1.0], "metallicFactor": metalness, "roughnessFactor": roughness}
        return self.add("materials", {"name": name, "pbrMetallicRoughness": pbr, **properties})

    def emitter(self, name, colour, radiance, **properties):
        """A material that emits `radiance` (linear RGB, cd/m2) and reflects `colour`."""
        strength = max(radiance)
        self.use("KHR_materials_emissive_strength")
        emission = {
            "emissiveFactor": [channel / strength for channel in radiance],
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": strength}},
        }
        return self.material(name, colour, **emission, **properties)

    def sky(self, hdr):
        """Light from all directions: a Radiance picture, equirectangular."""
        self.use("CANDELA_environment")
        uri = "data:application/octet-stream;base64," + base64.b64encode(hdr).decode()
        self.document["scenes"][0]["extensions"] = {"CANDELA_environment": {"uri": uri}}

    def texture(self, name, png, repeats=True):
        """A texture that repeats, or whose edges go on beyond it."""
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(png)}
        self.data += png + bytes(-len(png) % 4)  # floats that follow stay aligned
        image = {"name": name, "mimeType": "image/png", "bufferView": self.add("bufferViews", view)}
        texture = {"source": self.add("images", image)}
        if not repeats:
            texture["sampler"] = self.add("samplers", {"wrapS": CLAMP_TO_EDGE, "wrapT": CLAMP_TO_EDGE})
        return self.add("textures", texture)

    def mesh(self, name, surface, material):
        """`surface` is a Surface of shapes.py; its texture coordinates are optional."""
        attributes = {"POSITION": self.vertices(surface.positions), "NORMAL": self.vertices(surface.normals)}
        if surface.uvs:
            attributes["TEXCOORD_0"] = self.vertices(surface.uvs)
        indices = self.accessor([[index] for index in surface.indices], UNSIGNED_INT, "I", INDICES)
        primitive = {"attributes": attributes, "indices": indices, "material": material}
        return self.add("meshes", {"name": name, "primitives": [primitive]})

    def node(self, name, **properties):
        self.document["scenes"][0]["nodes"].append(self.add("nodes", {"name": name, **properties}))

    def parent(self, name, count, **transform):
        """A node whose children are the last `count` nodes."""
        roots = self.document["scenes"][0]["nodes"]
        children = roots[-count:]
        del roots[-count:]
        self.node(name, children=children, **transform)

    def place(self, name, surface, material, **transform):
        """A mesh and the single node that uses it."""
        self.node(name, mesh=self.mesh(name, surface, material), **transform)

    def light(self, name, kind, colour, intensity, reach=None, cone=None, **transform):
        """Intensity in candela, or lux for a directional light; reach in metres; cone: inner and outer, in degrees."""
        light = {"type": kind, "name": name, "color": colour, "intensity": intensity}
        if reach is not None:
            light["range"] = reach
        if cone is not None:
            inner, outer = (round(math.radians(angle), 6) for angle in cone)
            light["spot"] = {"innerConeAngle": inner, "outerConeAngle": outer}
        lights = self.document["extensions"]["KHR_lights_punctual"]["lights"]
        lights.append(light)
        self.node(name, **transform, extensions={"KHR_lights_punctual": {"light": len(lights) - 1}})

    def camera(self, vertical_fov, near, name="camera", **transform):
        """`vertical_fov` in degrees, `near` in metres. The first camera is the default one."""
        perspective = {"yfov": round(math.radians(vertical_fov), 6), "znear": near}
        camera = self.add("cameras", {"name": name, "type": "perspective", "perspective": perspective})
        self.node(name, camera=camera, **transform)

    def text(self):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        self.document["buffers"] = [{"byteLength": len(self.data), "uri": uri}]
        return json.dumps(self.document, indent=1) + "\n"


def single(vector):
    """Rounds to single precision, as stored in the buffer; glTF requires `min` and `max` to match the stored values."""
    return struct.unpack(f"<{len(vector)}f", struct.pack(f"<{len(vector)}f", *vector))
