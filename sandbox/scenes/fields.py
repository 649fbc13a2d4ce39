"""Things on planes that are much larger."""

import math
import random

from gltf_writer import Scene
from rooms import BLUE, DAYLIGHT, GREEN, RED, WHITE
from shapes import block, box, flat, ground, lathe, looking


def plane():
    """A ball in a niche, on a plane of 1 km under a sun."""
    scene = Scene()
    white, rose = scene.material("white", WHITE), scene.material("rose", [0.75, 0.4, 0.35])
    blue = scene.material("blue", BLUE)
    scene.place("plane", flat([ground((-500, -500), (500, 500))]), white)
    sides = block((-1.2, 0, -1.2), (-1, 1.5, 1)) + block((1, 0, -1.2), (1.2, 1.5, 1))
    back, roof = block((-1, 0, -1.2), (1, 1.5, -1)), block((-1.2, 1.5, -1.2), (1.2, 1.6, 0.2))
    scene.place("niche", flat(sides + back + roof), rose)
    angles = [math.pi * ring / 16 for ring in range(1, 16)]
    profile = [(0, -0.4), *[(0.4 * math.sin(a), -0.4 * math.cos(a)) for a in angles], (0, 0.4)]
    scene.place("ball", lathe(profile, 32), blue, translation=[0.0, 0.4, -0.3])
    scene.light("sun", "directional", DAYLIGHT, 3.0, **looking((0.5, 0.8, 0.6), (0, 0, 0)))
    scene.camera(45, 0.02, **looking((1.2, 1.4, 3), (0, 0.5, -0.3)))
    return scene


def boxes():
    """2,000 boxes of ten heights on a square of 40 m. 100 of them are children of the node "falling" and hang above
    the others, on which they stand after falling 3 m."""
    scene, numbers = Scene(), random.Random(1)
    scene.place("ground", flat([ground((-20, -20), (20, 20))]), scene.material("ground", WHITE))
    colours = [scene.material(f"colour {i}", colour) for i, colour in enumerate((WHITE, RED, GREEN, BLUE))]
    heights = [round(0.2 + 0.1 * i, 1) for i in range(10)]
    meshes = [scene.mesh("box", flat(box(0.5, height, 0.5)), colours[i % 4]) for i, height in enumerate(heights)]
    places = [(round(0.85 * (i % 44 - 21.5), 3), round(0.85 * (i // 44 - 21.5), 3)) for i in range(1900)]
    shapes = [numbers.randrange(10) for _ in places]
    for (x, z), shape in zip(places, shapes):
        scene.node("box", mesh=meshes[shape], translation=[x, 0.0, z])
    for i in sorted(numbers.sample(range(1900), 100)):
        place = [places[i][0], heights[shapes[i]], places[i][1]]
        scene.node("falling box", mesh=meshes[numbers.randrange(10)], translation=place)
    scene.parent("falling", 100, translation=[0.0, 3.0, 0.0])
    scene.light("sun", "directional", DAYLIGHT, 3.0, **looking((0.6, 0.7, 0.4), (0, 0, 0)))
    scene.camera(50, 0.05, **looking((9, 4.5, 12), (0, 0.5, 0)))
    return scene


def balls(count, rings):
    """Balls of one mesh, scattered over a field under a sun: 2·rings·(rings - 1) triangles each."""
    scene, numbers = Scene(), random.Random(7)
    side = math.ceil(math.sqrt(count))
    half = 0.8 * side
    scene.place("field", flat([ground((-half, -half), (half, half))]), scene.material("green", GREEN))
    angles = [math.pi * ring / rings for ring in range(rings + 1)]
    profile = [(0.5 * math.sin(a), -0.5 * math.cos(a)) for a in angles]
    profile[0], profile[-1] = (0, -0.5), (0, 0.5)
    ball = scene.mesh("ball", lathe(profile, rings), scene.material("white", WHITE))
    for i in range(count):
        size = round(numbers.uniform(0.7, 1.3), 3)
        x = round(1.6 * (i % side) - half + numbers.uniform(0, 0.5), 3)
        z = round(1.6 * (i // side) - half + numbers.uniform(0, 0.5), 3)
        scene.node("ball", mesh=ball, translation=[x, 0.5 * size, z], scale=[size] * 3)
    scene.light("sun", "directional", DAYLIGHT, 3.0, **looking((0.2, 0.8, 0.6), (0, 0, 0)))
    scene.camera(50, 0.05, **looking((0.3, 1.6, 0.2 * half), (0.3, 1.3, 0.2 * half - 1.0)))
    return scene
