"""A court under the sky."""

import math

from gltf_writer import Scene
from hdr_writer import direction, hdr
from shapes import ball, block, box, flat, ground, looking, turn

SKY_WIDTH, SKY_HEIGHT = 128, 64
SUN = (0.45, 0.75, 0.48)  # direction towards it, to be normalised
SUN_RADIUS = 4.0  # degrees; wider than the real one, so that its shadows have soft edges
SUN_RADIANCE = [120.0, 100.0, 72.0]


def sky_radiance(x, y):
    """Blue above, white at the horizon, brown below it, and a sun."""
    towards = direction(x, y, SKY_WIDTH, SKY_HEIGHT)
    length = math.sqrt(sum(c * c for c in SUN))
    cosine = sum(a * b for a, b in zip(towards, SUN)) / length
    if cosine > math.cos(math.radians(SUN_RADIUS)):
        return SUN_RADIANCE
    if towards[1] < 0.0:
        return [0.1, 0.08, 0.06]
    height = math.sqrt(towards[1])
    return [0.44 - 0.32 * height, 0.46 - 0.24 * height, 0.48 - 0.04 * height]


def court():
    """A court of 8 m x 8 m between walls of 3 m, with a gate in one of them, a canopy, a pool and a few things on the
    ground. Its only light is the sky, a picture with a sun in it."""
    scene = Scene()
    plaster, brick = scene.material("plaster", [0.75, 0.72, 0.65]), scene.material("brick", [0.5, 0.2, 0.12])
    stone, green = scene.material("stone", [0.4, 0.38, 0.35]), scene.material("green", [0.15, 0.35, 0.1])
    blue = scene.material("blue", [0.12, 0.2, 0.5])

    scene.place("ground", flat([ground((-6, -6), (6, 6))]), stone)
    scene.place("north wall", flat(block((-4.3, 0, -4.3), (4.3, 3, -4))), plaster)
    scene.place("east wall", flat(block((4, 0, -4), (4.3, 3, 4.3))), brick)
    scene.place("south wall", flat(block((-4, 0, 4), (4, 3, 4.3))), plaster)
    gate = block((-4.3, 0, -4), (-4, 3, -0.8)) + block((-4.3, 0, 0.8), (-4, 3, 4.3)) + block((-4.3, 2.2, -0.8), (-4, 3, 0.8))
    scene.place("west wall", flat(gate), plaster)
    scene.place("canopy", flat(block((-3.9, 2.3, -3.99), (3.9, 2.4, -2.2))), blue)
    for i, x in enumerate((-3.5, -1.2, 1.2, 3.5)):
        scene.place(f"post {i}", flat(box(0.15, 2.3, 0.15)), blue, translation=[x, 0.0, -2.4])
    scene.place("bench", flat(box(1.8, 0.45, 0.5)), brick, translation=[1.8, 0.0, -0.4], rotation=turn(25))
    scene.place("bush", ball(0.6), green, translation=[-1.6, 0.62, 0.4])
    scene.sky(hdr(SKY_WIDTH, SKY_HEIGHT, sky_radiance))
    scene.camera(60, 0.02, **looking((3.2, 2.0, 3.6), (-0.8, 0.9, -1.5)))
    return scene
