"""Small scenes of a few walls."""

import math

from gltf_writer import Scene
from shapes import block, box, flat, lathe, looking, room, turn, wall

WHITE = [0.725, 0.71, 0.68]
RED = [0.63, 0.065, 0.05]
GREEN = [0.14, 0.45, 0.091]
BLUE = [0.1, 0.2, 0.55]
DAYLIGHT = [1.0, 0.92, 0.8]


def cornell_box(ceiling):
    """The Cornell box (Goral et al. 1984) with its later measured data, scaled to 2 m and open towards +Z, without a
    light. `ceiling`: its quads."""
    scene = Scene()
    white, red, green = scene.material("white", WHITE), scene.material("red", RED), scene.material("green", GREEN)

    walls = {
        "floor": (white, [[(-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)]]),
        "ceiling": (white, ceiling),
        "back wall": (white, [[(-1, 0, -1), (1, 0, -1), (1, 2, -1), (-1, 2, -1)]]),
        "left wall": (red, [[(-1, 0, 1), (-1, 0, -1), (-1, 2, -1), (-1, 2, 1)]]),
        "right wall": (green, [[(1, 0, -1), (1, 0, 1), (1, 2, 1), (1, 2, -1)]]),
    }
    for name, (material, quads) in walls.items():
        scene.place(name, flat(quads), material)
    short, tall = flat(box(0.6, 0.6, 0.6)), flat(box(0.6, 1.2, 0.6))
    scene.place("short block", short, white, translation=[0.33, 0.0, 0.39], rotation=turn(-17))
    scene.place("tall block", tall, white, translation=[-0.33, 0.0, -0.26], rotation=turn(17))
    return scene


def look_into_cornell_box(scene):
    """The opening, 2.9 m away, fills a square picture except for a thin margin."""
    scene.camera(39.3, 0.01, translation=[0.0, 1.0, 3.9])


def cornell():
    """The Cornell box with a point light."""
    scene = cornell_box([ceiling_quad(-1, 1, -1, 1)])
    # Far enough below the ceiling that the ceiling is not overexposed there, and far enough above the tall block that
    # the block's shadow reaches the walls. 4 cd at 1.6 m give pi / 2 lux on the floor, a radiance of 0.36. That is
    # middle grey after indirect light is added and the picture is tone-mapped.
    scene.light("ceiling light", "point", DAYLIGHT, 4.0, translation=[0.0, 1.6, 0.0])
    look_into_cornell_box(scene)
    return scene


def lamp():
    """The Cornell box with its own lamp, a rectangle in the ceiling. Its size is the measured one (130 mm x 105 mm in a
    box 552.8 mm wide); its radiance is the measured spectrum in linear RGB, with the value that is usual for it."""
    x, z = 130 / 552.8, 105 / 552.8
    ceiling = [
        ceiling_quad(-1, 1, -1, -z),
        ceiling_quad(-1, 1, z, 1),
        ceiling_quad(-1, -x, -z, z),
        ceiling_quad(x, 1, -z, z),
    ]
    scene = cornell_box(ceiling)
    scene.place("lamp", flat([ceiling_quad(-x, x, -z, z)]), scene.emitter("lamp", [0.78] * 3, [17.0, 12.0, 4.0]))
    look_into_cornell_box(scene)
    return scene


def ceiling_quad(x0, x1, z0, z1):
    """A part of the Cornell box's ceiling."""
    return [(x0, 2, z0), (x1, 2, z0), (x1, 2, z1), (x0, 2, z1)]


def corner():
    """Two walls and a floor that meet at the origin, lit by a spot light close to it. There the light gathered from
    nearby virtual lights grows without bound."""
    scene = Scene()
    white = scene.material("white", WHITE)
    rose, azure = scene.material("rose", [0.75, 0.4, 0.35]), scene.material("azure", [0.35, 0.5, 0.75])
    walls = {
        "floor": (white, [(0, 0, 2), (2, 0, 2), (2, 0, 0), (0, 0, 0)]),
        "left wall": (rose, [(0, 0, 2), (0, 0, 0), (0, 2, 0), (0, 2, 2)]),
        "right wall": (azure, [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)]),
    }
    for name, (material, quad) in walls.items():
        scene.place(name, flat([quad]), material)
    spot = looking((0.6, 0.65, 0.55), (0.0, 0.0, 0.0))
    scene.light("spot", "spot", DAYLIGHT, 2.5, cone=(25, 40), **spot)
    scene.camera(45, 0.01, **looking((1.25, 0.95, 1.4), (0.2, 0.25, 0.2)))
    return scene


def two_rooms():
    """Two rooms of 4 m x 2.6 m x 4 m on both sides of a wall at x = 0, 0.2 m thick, with an opening of 0.9 m x 2 m. The
    light is in one room, the camera in the other. The origin of the door's node is its hinge; at a rotation of 0 it is
    closed."""
    scene = Scene()
    white, red, blue = scene.material("white", WHITE), scene.material("red", RED), scene.material("blue", BLUE)
    wood = scene.material("wood", [0.45, 0.26, 0.12])

    lit = room((-4.1, 0, -2), (-0.1, 2.6, 2))
    # Replace the wall towards +X by the parts around its opening, given as ranges of z and y.
    del lit[2]
    for (z0, z1), (y0, y1) in [((-2, -0.45), (0, 2.6)), ((0.45, 2), (0, 2.6)), ((-0.45, 0.45), (2, 2.6))]:
        lit.append([(-0.1, y0, z0), (-0.1, y0, z1), (-0.1, y1, z1), (-0.1, y1, z0)])
    dark = [[(-x, y, z) for x, y, z in reversed(quad)] for quad in lit]
    front, back, _, _, top, bottom = room((-0.1, 0, -0.45), (0.1, 2, 0.45))
    scene.place("room", flat([*lit, *dark, front, back, top, bottom]), white)

    leaf = flat(block((-0.02, 0, 0), (0.02, 2.03, 0.94)))
    scene.place("door", leaf, wood, translation=[0.125, 0.0, -0.47], rotation=turn(105))
    scene.place("cupboard", flat(box(0.6, 1.8, 1.2)), red, translation=[-3.75, 0.0, -0.2])
    scene.place("chest", flat(box(0.7, 0.7, 0.7)), blue, translation=[2.2, 0.0, -1.3], rotation=turn(30))

    scene.light("lamp", "point", DAYLIGHT, 9.0, translation=[-1.9, 2.0, 0.5])
    scene.camera(65, 0.01, **looking((3.8, 1.7, 1.7), (0.6, 0.85, -0.4)))
    return scene


def furnace():
    """A closed box of uniform albedo with a light inside: summed over all bounces, all emitted light is absorbed."""
    scene = Scene()
    grey = scene.material("grey", [0.5, 0.5, 0.5])
    scene.place("room", flat(room((-1, -1, -1), (1, 1, 1))), grey)
    scene.light("light", "point", [1.0, 1.0, 1.0], 2.0, translation=[0.2, 0.3, -0.1])
    scene.camera(80, 0.01, translation=[0.0, 0.0, 0.9])
    return scene


def neon():
    """A room of 4 m x 2.6 m x 4 m in which two neon tubes on the walls and a ball on the floor glow. There are no other
    lights."""
    scene = Scene()
    white, wood = scene.material("white", WHITE), scene.material("wood", [0.45, 0.26, 0.12])
    pink = scene.emitter("pink neon", [0.6] * 3, [24.0, 3.0, 9.0])
    blue = scene.emitter("blue neon", [0.6] * 3, [2.0, 8.0, 28.0])
    warm = scene.emitter("warm glass", [0.7] * 3, [9.0, 6.0, 2.7])
    scene.place("room", flat(room((-2, 0, -2), (2, 2.6, 2))), white)
    scene.place("table", flat(box(1.0, 0.7, 0.6)), wood, translation=[-0.5, 0.0, -0.7], rotation=turn(20))
    scene.place("stool", flat(box(0.35, 0.45, 0.35)), wood, translation=[0.3, 0.0, 0.6], rotation=turn(40))
    scene.place("pink tube", flat(block((-1.2, 1.75, -1.88), (1.2, 1.8, -1.83))), pink)
    scene.place("blue tube", flat(block((-1.88, 0.7, -1.0), (-1.83, 0.75, 1.4))), blue)
    angles = [math.pi * ring / 16 for ring in range(1, 16)]
    sides = [(0.18 * math.sin(angle), -0.18 * math.cos(angle)) for angle in angles]
    ball = lathe([(0, -0.18), *sides, (0, 0.18)], 32)
    scene.place("ball", ball, warm, translation=[0.95, 0.18, -0.1])
    scene.camera(65, 0.01, **looking((1.7, 1.5, 1.8), (-0.3, 0.75, -0.6)))
    return scene


def rooms(count):
    """Rooms of 4 m x 2.6 m x 4 m in a row along +X, numbered from 1 and joined by doors. The light is in the first."""
    scene = Scene()
    white, wood = scene.material("white", WHITE), scene.material("wood", [0.5, 0.35, 0.2])
    end = 4.2 * count
    slabs = block((-0.2, -0.2, -2.2), (end, 0, 2.2)) + block((-0.2, 2.6, -2.2), (end, 2.8, 2.2))
    sides = block((-0.2, 0, -2.2), (end, 2.6, -2)) + block((-0.2, 0, 2), (end, 2.6, 2.2))
    ends = block((-0.2, 0, -2), (0, 2.6, 2)) + block((end - 0.2, 0, -2), (end, 2.6, 2))
    between = [wall((4.2 * i - 0.2, 0, -2), (4.2 * i, 2.6, 2), [(-0.45, 0.45, 0, 2)]) for i in range(1, count)]
    scene.place("rooms", flat(slabs + sides + ends + sum(between, [])), white)
    chest = scene.mesh("chest", flat(box(0.7, 0.7, 0.7)), wood)
    for i in range(count):
        scene.node(f"chest {i + 1}", mesh=chest, translation=[round(4.2 * i + 2.2, 1), 0.0, -1.2], rotation=turn(30))
    scene.light("lamp", "point", DAYLIGHT, 30.0, translation=[2.0, 2.2, 0.5])
    for number in sorted({2, 3, 6, count}):
        x = round(4.2 * (number - 1), 1)
        scene.camera(65, 0.02, f"room-{number}", **looking((x + 3.6, 1.6, 1.6), (x + 0.6, 0.9, -0.6)))
    return scene


def apartment():
    """Four rooms of 4 m x 2.6 m x 4 m around the origin, in a circle by way of three doors. The lamp hangs in the
    first, the camera is in the second."""
    scene = Scene()
    white, wood = scene.material("white", WHITE), scene.material("wood", [0.45, 0.26, 0.12])
    red, blue = scene.material("red", RED), scene.material("blue", BLUE)
    shell = (
        block((-4.3, -0.2, -4.3), (4.3, 0, 4.3))
        + block((-4.3, 2.6, -4.3), (4.3, 2.8, 4.3))
        + block((-4.3, 0, -4.3), (4.3, 2.6, -4.1))
        + block((-4.3, 0, 4.1), (4.3, 2.6, 4.3))
        + block((-4.3, 0, -4.1), (-4.1, 2.6, 4.1))
        + block((4.1, 0, -4.1), (4.3, 2.6, 4.1))
    )
    inner = (
        wall((-0.1, 0, -4.1), (0.1, 2.6, 4.1), [(-2.6, -1.7, 0, 2), (1.4, 2.3, 0, 2)])
        + wall((0.1, 0, -0.1), (4.1, 2.6, 0.1), [(2.4, 3.3, 0, 2)])
        + block((-4.1, 0, -0.1), (-0.1, 2.6, 0.1))
    )
    scene.place("shell", flat(shell), white)
    scene.place("inner walls", flat(inner), white)
    scene.place("cupboard", flat(box(0.6, 1.8, 1.2)), red, translation=[-3.75, 0.0, -2.2])
    scene.place("table", flat(box(1.2, 0.75, 0.8)), wood, translation=[1.2, 0.0, -3.3], rotation=turn(10))
    scene.place("bed", flat(box(1.0, 0.5, 2.0)), blue, translation=[3.4, 0.0, 2.8])
    scene.place("chest", flat(box(0.7, 0.7, 0.7)), red, translation=[-2.6, 0.0, 3.3], rotation=turn(30))
    scene.light("lamp", "point", DAYLIGHT, 20.0, translation=[-2.0, 2.2, -1.8])
    scene.camera(65, 0.02, **looking((3.8, 1.6, -0.4), (0.6, 0.9, -3.0)))
    return scene
