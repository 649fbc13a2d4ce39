"""Scenes with metals, plastics and mirrors."""

import math

from gltf_writer import Scene
from hdr_writer import daylight
from png_writer import opaque_png
from shapes import aim, ball, block, box, cylinder, flat, ground, looking, pane, room, turn

GOLD, COPPER, CHROME = [1.0, 0.77, 0.34], [0.95, 0.64, 0.54], [0.55, 0.556, 0.554]
ROUGHNESSES = (0.05, 0.2, 0.4, 0.7, 1.0)


def metals():
    """Two rows of balls on a floor in front of a wall: metal ones on a step at the back, plastic ones in front, each from
    nearly smooth on the left to rough on the right. A sun, a sky and a lamp between the rows light them."""
    scene = Scene()
    stone, plaster = scene.material("stone", [0.35, 0.35, 0.38]), scene.material("plaster", [0.7, 0.68, 0.62])
    scene.place("floor", flat([ground((-5, -2.4), (5, 5))]), stone)
    scene.place("wall", flat(block((-5, 0, -2.6), (5, 3.2, -2.4))), plaster)
    scene.place("step", flat(block((-3, 0, -1.8), (3, 0.6, -0.6))), plaster)
    for i, roughness in enumerate(ROUGHNESSES):
        x = 1.15 * (i - 2)
        name, colour = ("copper", COPPER) if i % 2 else ("gold", GOLD)
        metal = scene.glossy(f"{name} {roughness}", colour, roughness, 1.0)
        scene.place(f"metal ball {i}", ball(0.5), metal, translation=[x, 1.1, -1.2])
        plastic = scene.glossy(f"plastic {roughness}", [0.55, 0.06, 0.05], roughness)
        scene.place(f"plastic ball {i}", ball(0.5), plastic, translation=[x, 0.5, 0.4])
    scene.sky(daylight(0.12))
    scene.light("sun", "directional", [1.0, 0.93, 0.8], 3.0, rotation=aim((2.5, 4.0, 3.0), (0.0, 0.0, 0.0)))
    scene.light("lamp", "point", [1.0, 0.8, 0.6], 4.0, translation=[-0.6, 2.2, 0.2])
    scene.camera(42, 0.02, **looking((0.0, 1.9, 6.4), (0.0, 0.8, -0.4)))
    return scene


TILE_TEXELS, EDGE_TEXELS = 32, 3


def tile_normal(x, y):
    """Of a tile with rounded edges, in a texel: x to the right, y up."""
    def slope(i):
        before, behind = EDGE_TEXELS - i, i - (TILE_TEXELS - 1 - EDGE_TEXELS)
        return 0.25 * (max(behind, 0) - max(before, 0))

    normal = (slope(x), -slope(y), 1.0)
    length = math.sqrt(sum(part * part for part in normal))
    return tuple(round(127.5 + 127.5 * part / length) for part in normal)


def tiled(surface, width):
    """The surface with a texture that repeats after so many metres, upright on walls."""
    for (x, y, z), normal in zip(surface.positions, surface.normals):
        along = z if abs(normal[0]) > 0.5 else x
        down = z if abs(normal[1]) > 0.5 else -y
        surface.uvs.append([along / width, down / width])
    return surface


def bath():
    """A bathroom of 3 m x 3 m with glossy tiles, a tub, a chrome pipe and a mirror on the wall. Its only light is a panel
    at the ceiling."""
    scene = Scene()
    plaster = scene.material("plaster", [0.75, 0.74, 0.7])
    edges = {"normalTexture": {"index": scene.texture("tile", opaque_png(TILE_TEXELS, TILE_TEXELS, tile_normal))}}
    tiles = scene.glossy("tiles", [0.25, 0.45, 0.5], 0.15, **edges)
    slabs = scene.glossy("slabs", [0.3, 0.28, 0.26], 0.3, **edges)
    enamel = scene.glossy("enamel", [0.8, 0.8, 0.78], 0.1)
    silver = scene.glossy("silver", [0.93, 0.93, 0.92], 0.0, 1.0)
    chrome = scene.glossy("chrome", CHROME, 0.08, 1.0)
    wood, towel = scene.glossy("wood", [0.35, 0.2, 0.1], 0.5), scene.material("towel", [0.7, 0.25, 0.15])

    north, south, east, west, ceiling, floor = (flat([quad]) for quad in room((-1.5, 0, -1.5), (1.5, 2.5, 1.5)))
    for name, surface in (("first wall", north), ("second wall", south), ("third wall", east), ("fourth wall", west)):
        scene.place(name, tiled(surface, 0.25), tiles)
    scene.place("ceiling", ceiling, plaster)
    scene.place("floor", tiled(floor, 0.5), slabs)
    scene.place("mirror", pane(1.2, 1.0), silver, translation=[0.4, 1.05, -1.495])
    scene.place("cabinet", flat(box(1.0, 0.75, 0.45)), wood, translation=[0.4, 0.0, -1.27])
    sides = block((-1.45, 0, -1.2), (-0.7, 0.1, 1.0)) + block((-1.45, 0.1, -1.2), (-0.7, 0.55, -1.1))
    sides += block((-1.45, 0.1, 0.9), (-0.7, 0.55, 1.0)) + block((-1.45, 0.1, -1.1), (-1.38, 0.55, 0.9))
    scene.place("tub", flat(sides + block((-0.77, 0.1, -1.1), (-0.7, 0.55, 0.9))), enamel)
    scene.place("pipe", cylinder(0.06, 2.2), chrome, translation=[-0.45, 0.0, -1.3])
    scene.place("jar", cylinder(0.09, 0.2), chrome, translation=[0.65, 0.75, -1.2])
    scene.place("towel", flat(box(0.3, 0.12, 0.25)), towel, translation=[0.15, 0.75, -1.2], rotation=turn(20))
    panel = scene.emitter("panel", [0.8, 0.8, 0.8], [18.0, 17.0, 15.0])
    scene.place("lamp", flat([ground((-0.4, -0.4), (0.4, 0.4))[::-1]]), panel, translation=[0.2, 2.49, 0.1])
    scene.camera(60, 0.02, **looking((1.1, 1.5, 1.4), (-0.2, 0.9, -1.0)))
    return scene
