"""A ball of 50,000 triangles with five textures of 2048 x 2048 texels: how long large textures take to be seen."""

import math
import zlib

from gltf_writer import Scene
from hdr_writer import daylight
from helmet import noise
from png_writer import picture
from shapes import Surface, aim, looking

SIZE = 2048  # texels a side of the textures
CELL = 32  # texels between two places with values of their own
RINGS, SEGMENTS = 100, 250


def ramp(left, right):
    """Texels from one colour to another."""
    steps = [step / CELL for step in range(CELL)]
    return bytes(round(a + step * (b - a)) for step in steps for a, b in zip(left, right))


def texture(seed, low, high):
    """A PNG with colours between two, that differ smoothly from place to place."""
    cells = SIZE // CELL
    places = [
        [[a + noise(x, y, 8 * seed + i) * (b - a) for i, (a, b) in enumerate(zip(low, high))] for x in range(cells)]
        for y in range(cells)
    ]
    rows = bytearray()
    for y in range(SIZE):
        upper, lower = places[y // CELL], places[(y // CELL + 1) % cells]
        share = y % CELL / CELL
        row = [[a + share * (b - a) for a, b in zip(above, below)] for above, below in zip(upper, lower)]
        rows.append(0)  # not filtered
        rows += b"".join(ramp(row[x], row[(x + 1) % cells]) for x in range(cells))
    return picture(SIZE, SIZE, 2, zlib.compress(rows, 6))


def lumpy_ball():
    surface = Surface()
    for ring in range(RINGS + 1):
        polar = math.pi * ring / RINGS
        for segment in range(SEGMENTS + 1):
            azimuth = 2 * math.pi * segment / SEGMENTS
            normal = (math.sin(polar) * math.cos(azimuth), math.cos(polar), -math.sin(polar) * math.sin(azimuth))
            radius = 1 + 0.05 * math.sin(9 * polar) * math.sin(7 * azimuth)
            surface.positions.append([radius * part for part in normal])
            surface.normals.append(normal)
            surface.uvs.append((4 * segment / SEGMENTS, 2 * ring / RINGS))
    for ring in range(RINGS):
        for segment in range(SEGMENTS):
            a = ring * (SEGMENTS + 1) + segment
            b = a + SEGMENTS + 1
            surface.indices += [a, b, a + 1, a + 1, b, b + 1]
    return surface


def ball():
    scene = Scene()

    def image(name, low, high):
        seed = len(scene.document.get("textures", []))
        return {"index": scene.texture(name, texture(seed, low, high))}

    pbr = {
        "baseColorTexture": image("base colour", (60, 60, 60), (220, 220, 220)),
        "metallicRoughnessTexture": image("roughness, metalness", (0, 40, 0), (0, 220, 220)),
    }
    properties = {
        "normalTexture": image("bumps", (96, 96, 230), (160, 160, 230)),
        "occlusionTexture": image("occlusion", (120, 0, 0), (255, 0, 0)),
        "emissiveTexture": image("glow", (0, 0, 0), (20, 20, 20)),
    }
    material = scene.add(
        "materials", {"name": "all", "pbrMetallicRoughness": pbr, **properties, "emissiveFactor": [0.1, 0.1, 0.1]}
    )
    scene.place("ball", lumpy_ball(), material)
    scene.sky(daylight(0.1))
    scene.light("sun", "directional", [1.0, 0.95, 0.9], 2.5, rotation=aim((2.5, 4.0, 3.0), (0.0, 0.0, 0.0)))
    scene.camera(40, 0.05, **looking((0.0, 0.6, 3.4), (0.0, 0.0, 0.0)))
    return scene
