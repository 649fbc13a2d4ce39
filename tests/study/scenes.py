"""The scenes of the study: those shipped with the sandbox, those that its generator writes on demand, and simple scenes
of the study, each of which varies one thing or avoids one kind of error."""

import functools
import hashlib
import json
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHIPPED = ROOT / "sandbox" / "scenes"
sys.path.append(str(SHIPPED))
sys.dont_write_bytecode = True  # otherwise importing modules would leave files in the source folders

from gltf_writer import Scene  # noqa: E402
from shapes import Surface, flat, looking  # noqa: E402

DAYLIGHT = [1.0, 0.92, 0.8]


def plates() -> Scene:
    """Two squares of 2 m that face each other, 1 m apart, with a light between them. Nothing is occluded, and surfaces
    that light each other are at least 1 m apart, so that light gathered from VPLs has no singularity."""
    scene = Scene()
    white, rose = scene.material("white", [0.7, 0.7, 0.7]), scene.material("rose", [0.75, 0.4, 0.35])
    below = [(-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)]
    above = [(x, 1, z) for x, _, z in reversed(below)]
    scene.place("lower plate", flat([below]), white)
    scene.place("upper plate", flat([above]), rose)
    scene.light("light", "point", DAYLIGHT, 1.0, translation=[0.3, 0.4, -0.2])
    scene.camera(40, 0.01, **looking((0.0, 0.6, 3.0), (0.0, 0.45, 0.0)))
    return scene


def sphere_inwards(radius: float, rings: int) -> Surface:
    """A sphere that faces inwards, with smooth normals and twice as many segments as rings."""
    surface, segments = Surface(), 2 * rings
    for ring in range(rings + 1):
        polar = math.pi * ring / rings
        for segment in range(segments + 1):
            angle = 2 * math.pi * segment / segments
            out = (math.sin(polar) * math.sin(angle), math.cos(polar), math.sin(polar) * math.cos(angle))
            surface.positions.append(tuple(radius * x for x in out))
            surface.normals.append(tuple(-x for x in out))
    row = segments + 1
    for ring in range(rings):
        for segment in range(segments):
            a = ring * row + segment
            upper, lower = [a, a + row + 1, a + 1], [a, a + row, a + row + 1]
            surface.indices += (upper if ring > 0 else []) + (lower if ring < rings - 1 else [])
    surface.indices = [i for a, b, c in zip(*[iter(surface.indices)] * 3) for i in (a, c, b)]
    return surface


def sphere() -> Scene:
    """A furnace of uniform albedo in which any two points have the same geometry term, 1 / (4 R²)."""
    scene = Scene()
    grey = scene.material("grey", [0.5, 0.5, 0.5])
    scene.place("sphere", sphere_inwards(2.0, 64), grey)
    scene.light("light", "point", [1.0, 1.0, 1.0], 3.0, translation=[0.6, 0.3, -0.4])
    scene.camera(75, 0.01, **looking((0.5, 0.3, 1.0), (0.0, 0.0, 0.0)))
    return scene


def hills(cells: int) -> Scene:
    """A hilly square of 4 m, divided into cells × cells quads; the hills do not depend on the resolution."""
    scene, surface = Scene(), Surface()
    height = lambda x, z: 0.25 * math.sin(2.1 * x) * math.cos(1.7 * z)  # noqa: E731
    for row in range(cells + 1):
        for column in range(cells + 1):
            x, z = 4 * column / cells - 2, 4 * row / cells - 2
            slope = (0.525 * math.cos(2.1 * x) * math.cos(1.7 * z), -0.425 * math.sin(2.1 * x) * math.sin(1.7 * z))
            length = math.hypot(*slope, 1.0)
            surface.positions.append((x, height(x, z), z))
            surface.normals.append((-slope[0] / length, 1 / length, -slope[1] / length))
    for row in range(cells):
        for column in range(cells):
            corner = row * (cells + 1) + column
            surface.indices += [corner + i for i in (0, cells + 1, 1, 1, cells + 1, cells + 2)]
    scene.place("hills", surface, scene.material("earth", [0.6, 0.5, 0.4]))
    scene.light("light", "point", DAYLIGHT, 6.0, translation=[0.5, 1.5, 0.3])
    scene.camera(45, 0.01, **looking((0.0, 2.2, 4.0), (0.0, 0.0, 0.0)))
    return scene


OWN = {"plates": plates, "sphere": sphere}


@functools.cache
def generators_hash() -> str:
    """The hash of the sources of the scene generators."""
    sources = [*sorted(SHIPPED.glob("*.py")), pathlib.Path(__file__)]
    return hashlib.sha256(b"".join(path.read_bytes() for path in sources)).hexdigest()[:16]


def generate(name: str, folder: pathlib.Path) -> None:
    """Writes a scene that is not shipped. `hills-N` has N cells per side, `hall-N` has N lights."""
    kind, _, number = name.partition("-")
    if name in OWN or kind == "hills":
        scene = OWN[name]() if name in OWN else hills(int(number))
        (folder / f"{name}.gltf").write_text(scene.text(), encoding="utf-8")
        return
    asked = ["hall", "--lights", number] if kind == "hall" else [name]
    subprocess.run([sys.executable, SHIPPED / "generate.py", "--out", folder, *asked], check=True, capture_output=True)


def only_camera(text: str, camera: str) -> str:
    """The scene without its other cameras; the study uses a scene's first one."""
    document = json.loads(text)
    nodes, scene = document["nodes"], document["scenes"][0]
    others = [i for i, node in enumerate(nodes) if "camera" in node and node["name"] != camera]
    scene["nodes"] = [i for i in scene["nodes"] if i not in others]
    return json.dumps(document)


def write(name: str, path: pathlib.Path, folder: pathlib.Path) -> None:
    scene, _, camera = name.partition("@")
    if camera:
        path.write_text(only_camera(find(scene, folder).read_text(encoding="utf-8"), camera), encoding="utf-8")
    else:
        generate(name, path.parent)


def find(name: str, folder: pathlib.Path) -> pathlib.Path:
    """The file of the scene; SCENE@CAMERA is a scene as that camera sees it. A scene that is not shipped is written to
    `folder`, unless these sources did so before."""
    shipped, written = SHIPPED / f"{name}.gltf", folder / generators_hash() / f"{name}.gltf"
    if shipped.exists():
        return shipped
    if not written.exists():
        written.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=written.parent) as scratch:
            write(name, pathlib.Path(scratch) / written.name, folder)
            (pathlib.Path(scratch) / written.name).rename(written)
    return written


@functools.cache
def content_hash(path: pathlib.Path) -> str:
    """The hash of the file and of all files that it refers to."""
    digest = hashlib.sha256(path.read_bytes())
    document = json.loads(path.read_text(encoding="utf-8"))
    for item in document.get("buffers", []) + document.get("images", []):
        uri = item.get("uri", "data:")
        if not uri.startswith("data:"):
            digest.update((path.parent / uri).read_bytes())
    return digest.hexdigest()[:16]
