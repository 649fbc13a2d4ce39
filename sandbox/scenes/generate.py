#!/usr/bin/env python3
"""Writes the shipped scenes as self-contained glTF beside this script. The same bytes every time.

    generate.py [SCENE...]      default: all of them

Lengths in metres, +Y up, lights in the units of KHR_lights_punctual, colours linear.
"""

import base64
import json
import math
import pathlib
import struct
import sys

FLOAT, UNSIGNED_INT = 5126, 5125
VERTICES, INDICES = 34962, 34963


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

    def accessor(self, rows, component_type, code, target):
        """One value or vector a row, in a buffer view of its own."""
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

    def material(self, name, colour):
        pbr = {"baseColorFactor": [*colour, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}
        return self.add("materials", {"name": name, "pbrMetallicRoughness": pbr})

    def mesh(self, name, quads, material):
        """Planar quads of four corners each, counter-clockwise from their front."""
        positions, normals, indices = [], [], []
        for quad in quads:
            first = len(positions)
            positions += [single(corner) for corner in quad]
            normals += [normal(quad)] * 4
            indices += [[first + i] for i in (0, 1, 2, 0, 2, 3)]
        primitive = {
            "attributes": {
                "POSITION": self.accessor(positions, FLOAT, "f", VERTICES),
                "NORMAL": self.accessor(normals, FLOAT, "f", VERTICES),
            },
            "indices": self.accessor(indices, UNSIGNED_INT, "I", INDICES),
            "material": material,
        }
        return self.add("meshes", {"name": name, "primitives": [primitive]})

    def point_light(self, name, colour, candela):
        lights = self.document["extensions"]["KHR_lights_punctual"]["lights"]
        lights.append({"type": "point", "name": name, "color": colour, "intensity": candela})
        return {"KHR_lights_punctual": {"light": len(lights) - 1}}

    def camera(self, name, vertical_fov, near):
        perspective = {"yfov": round(math.radians(vertical_fov), 6), "znear": near}
        return self.add("cameras", {"name": name, "type": "perspective", "perspective": perspective})

    def node(self, name, **properties):
        self.document["scenes"][0]["nodes"].append(self.add("nodes", {"name": name, **properties}))

    def text(self):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        self.document["buffers"] = [{"byteLength": len(self.data), "uri": uri}]
        return json.dumps(self.document, indent=1) + "\n"


def single(vector):
    """Rounded to single precision, as the buffer holds it; glTF wants `min` and `max` to agree."""
    return struct.unpack("<3f", struct.pack("<3f", *vector))


def normal(quad):
    a, b, _, d = quad
    u = [b[i] - a[i] for i in range(3)]
    v = [d[i] - a[i] for i in range(3)]
    cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    length = math.sqrt(sum(x * x for x in cross))
    return single([x / length + 0.0 for x in cross])  # + 0.0 makes -0.0 plain


def box(width, height, depth):
    """The six faces of a closed box that stands on the origin."""
    x, y, z = width / 2, height, depth / 2
    return [
        [(-x, 0, z), (x, 0, z), (x, y, z), (-x, y, z)],
        [(x, 0, -z), (-x, 0, -z), (-x, y, -z), (x, y, -z)],
        [(x, 0, z), (x, 0, -z), (x, y, -z), (x, y, z)],
        [(-x, 0, -z), (-x, 0, z), (-x, y, z), (-x, y, -z)],
        [(-x, y, z), (x, y, z), (x, y, -z), (-x, y, -z)],
        [(-x, 0, -z), (x, 0, -z), (x, 0, z), (-x, 0, z)],
    ]


def turn(degrees):
    """Quaternion (x, y, z, w) of a turn about +Y."""
    half = math.radians(degrees) / 2
    return [0.0, round(math.sin(half), 7), 0.0, round(math.cos(half), 7)]


def cornell():
    """The box of Goral et al. (1984) as Cornell measured it later, scaled to a room of 2 m and open towards +Z."""
    scene = Scene()
    white = scene.material("white", [0.725, 0.71, 0.68])
    red = scene.material("red", [0.63, 0.065, 0.05])
    green = scene.material("green", [0.14, 0.45, 0.091])

    walls = {
        "floor": (white, [(-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)]),
        "ceiling": (white, [(-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1)]),
        "back wall": (white, [(-1, 0, -1), (1, 0, -1), (1, 2, -1), (-1, 2, -1)]),
        "left wall": (red, [(-1, 0, 1), (-1, 0, -1), (-1, 2, -1), (-1, 2, 1)]),
        "right wall": (green, [(1, 0, -1), (1, 0, 1), (1, 2, 1), (1, 2, -1)]),
    }
    for name, (material, quad) in walls.items():
        scene.node(name, mesh=scene.mesh(name, [quad], material))
    scene.node(
        "short block",
        mesh=scene.mesh("short block", box(0.6, 0.6, 0.6), white),
        translation=[0.33, 0.0, 0.39],
        rotation=turn(-17),
    )
    scene.node(
        "tall block",
        mesh=scene.mesh("tall block", box(0.6, 1.2, 0.6), white),
        translation=[-0.33, 0.0, -0.26],
        rotation=turn(17),
    )

    # Far enough below the ceiling that its spot there is a glow rather than a glare, above the tall block by enough
    # that its shadow reaches the walls. 4 cd at 1.6 m make pi / 2 lux on the floor, which then shows a radiance of 0.36:
    # middle grey once the box's own light is added and the picture tone-mapped.
    light = scene.point_light("ceiling light", [1.0, 0.92, 0.8], 4.0)
    scene.node("ceiling light", translation=[0.0, 1.6, 0.0], extensions=light)
    # The opening, 2.9 m away, fills a square picture but for a thin margin.
    scene.node("camera", camera=scene.camera("camera", 39.3, 0.01), translation=[0.0, 1.0, 3.9])
    return scene


SCENES = {"cornell": cornell}


def main(names):
    for name in names or SCENES:
        if name not in SCENES:
            sys.exit(f"generate.py: no scene is called {name}; there are: {', '.join(SCENES)}")
        path = pathlib.Path(__file__).with_name(name + ".gltf")
        path.write_text(SCENES[name]().text(), encoding="utf-8", newline="\n")
        print(path)


if __name__ == "__main__":
    main(sys.argv[1:])
