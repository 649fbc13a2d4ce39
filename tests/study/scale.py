"""Large scenes: the time to load each and to render its first frame, and the largest memory, as scenes grow."""

import array
import json
import math
import pathlib
import subprocess
import tempfile
from typing import Any

Json = dict[str, Any]
Row = dict[str, Any]

FLOAT, UNSIGNED_INT = 5126, 5125


class LargeScene:
    """A glTF document with a binary file beside it. Unlike gltf_writer, it packs whole arrays at once."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.document: Json = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": []}],
            "nodes": [],
            "meshes": [],
            "bufferViews": [],
            "accessors": [],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.01}}],
            "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": {"KHR_lights_punctual": {"lights": []}},
        }
        self.node({"camera": 0, "translation": [0, 3, 3], "rotation": [-math.sin(math.pi / 8), 0, 0, math.cos(math.pi / 8)]})

    def node(self, node: Json, root: bool = True) -> int:
        nodes = self.document["nodes"]
        nodes.append(node)
        if root:
            self.document["scenes"][0]["nodes"].append(len(nodes) - 1)
        return len(nodes) - 1

    def light(self, at: tuple[float, float, float], candela: float, reach: float | None = None) -> None:
        lights = self.document["extensions"]["KHR_lights_punctual"]["lights"]
        lights.append({"type": "point", "intensity": candela} | ({} if reach is None else {"range": reach}))
        self.node({"translation": at, "extensions": {"KHR_lights_punctual": {"light": len(lights) - 1}}})

    def accessor(self, values: array.array, kind: str, count: int, bounds: Json) -> int:
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(values) * 4}
        self.data += values.tobytes()
        self.document["bufferViews"].append(view)
        component = FLOAT if values.typecode == "f" else UNSIGNED_INT
        accessor = {"bufferView": len(self.document["bufferViews"]) - 1, "componentType": component, "count": count}
        self.document["accessors"].append({**accessor, "type": kind, **bounds})
        return len(self.document["accessors"]) - 1

    def grid(self, cells: int, side: float, height: float) -> int:
        """A hilly square of cells × cells quads that faces up, centred at the origin. Returns its mesh."""
        positions, normals, indices = array.array("f"), array.array("f"), array.array("I")
        for row in range(cells + 1):
            z = (row / cells - 0.5) * side
            for column in range(cells + 1):
                x = (column / cells - 0.5) * side
                positions.extend((x, height * math.sin(2.1 * x) * math.cos(1.7 * z), z))
                along_x = 2.1 * height * math.cos(2.1 * x) * math.cos(1.7 * z)
                along_z = -1.7 * height * math.sin(2.1 * x) * math.sin(1.7 * z)
                length = math.sqrt(along_x**2 + 1 + along_z**2)
                normals.extend((-along_x / length, 1 / length, -along_z / length))
        for row in range(cells):
            for corner in range(row * (cells + 1), row * (cells + 1) + cells):
                below = corner + cells + 1
                indices.extend((corner, below, corner + 1, corner + 1, below, below + 1))
        bounds = {"min": [-side / 2, -height, -side / 2], "max": [side / 2, height, side / 2]}
        count = (cells + 1) ** 2
        vertices = {
            "POSITION": self.accessor(positions, "VEC3", count, bounds),
            "NORMAL": self.accessor(normals, "VEC3", count, {}),
        }
        corners = self.accessor(indices, "SCALAR", len(indices), {})
        self.document["meshes"].append({"primitives": [{"attributes": vertices, "indices": corners}]})
        return len(self.document["meshes"]) - 1

    def write(self, folder: pathlib.Path) -> pathlib.Path:
        lights = self.document["extensions"]["KHR_lights_punctual"]["lights"]
        if not lights:
            self.light((0.5, 2.0, 0.3), 20.0)
        self.document["buffers"] = [{"byteLength": len(self.data), "uri": "scene.bin"}]
        (folder / "scene.bin").write_bytes(self.data)
        path = folder / "scene.gltf"
        path.write_text(json.dumps(self.document, separators=(",", ":")), encoding="utf-8")
        return path


def places(count: int) -> list[tuple[float, float]]:
    """The centres of the cells of a square grid over 4 m × 4 m."""
    side = math.ceil(math.sqrt(count))
    return [(4 * (i % side + 0.5) / side - 2, 4 * (i // side + 0.5) / side - 2) for i in range(count)]


def triangles(count: int) -> LargeScene:
    scene = LargeScene()
    scene.node({"mesh": scene.grid(round(math.sqrt(count / 2)), 4.0, 0.25)})
    return scene


def instances(count: int) -> LargeScene:
    scene = LargeScene()
    mesh = scene.grid(1, 0.9 * 4 / math.sqrt(count), 0.0)
    for x, z in places(count):
        scene.node({"mesh": mesh, "translation": [x, 0.1 * math.sin(3 * x), z]})
    return scene


def lights(count: int) -> LargeScene:
    scene = LargeScene()
    scene.node({"mesh": scene.grid(64, 4.0, 0.0)})
    spacing = 4 / math.sqrt(count)
    for x, z in places(count):
        scene.light((x, 0.5 * spacing, z), 0.5 * spacing**2, 2 * spacing)
    return scene


def nodes(count: int) -> LargeScene:
    """Most of them are empty."""
    scene = instances(64)
    for _ in range(count):
        scene.node({})
    return scene


def chain(count: int) -> LargeScene:
    """Each node is the child of the one before, and has a mesh."""
    scene = LargeScene()
    mesh, step = scene.grid(1, 0.2, 0.0), 2.0 / count
    first = len(scene.document["nodes"])
    for i in range(count):
        child = {} if i == count - 1 else {"children": [first + i + 1]}
        scene.node({"mesh": mesh, "translation": [step, 0, 0], **child}, root=i == 0)
    return scene


# By what grows: the scene, and the sizes.
GROWTH = {
    "triangles": (triangles, [62_500, 250_000, 1_000_000, 4_000_000]),
    "instances": (instances, [1_000, 10_000, 100_000]),
    "lights": (lights, [1_000, 10_000, 100_000]),
    "nodes": (nodes, [10_000, 100_000, 1_000_000]),
    "nodes in a chain": (chain, [1_000, 10_000, 100_000]),
}


def measure(study: pathlib.Path, kind: str, count: int) -> Row:
    with tempfile.TemporaryDirectory() as folder:
        path = GROWTH[kind][0](count).write(pathlib.Path(folder))
        output = subprocess.run([study, "scale", path], check=True, capture_output=True, text=True).stdout
    return {"kind": kind, "count": count, **json.loads(output)}


def print_row(row: Row) -> None:
    print(
        f"{row['count']:>10,} {row['kind']:<17} {row['load_s']:>8.2f} s {row['frame_s']:>8.2f} s "
        f"{row['peak_bytes'] / 2**20:>8.0f} MiB",
        flush=True,
    )


def run(study: pathlib.Path, out: pathlib.Path) -> None:
    """Prints a table and draws scale.png."""
    print(f"{'':>28} {'load':>10} {'1st frame':>10} {'memory':>12}")
    rows = []
    for kind, (_, counts) in GROWTH.items():
        for count in counts:
            rows.append(measure(study, kind, count))
            print_row(rows[-1])
    import charts

    charts.scale(rows, out)
    print(f"study: {out / 'scale.png'}")
