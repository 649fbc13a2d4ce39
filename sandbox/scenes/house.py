"""A house with two rooms on a terrain, and a street of such houses with furniture, trees and tiled roofs."""

import math

from gltf_writer import Scene
from rooms import BLUE, WHITE
from shapes import Surface, block, box, flat, lathe, looking, tilt, turn, wall

GRASS, WOOD, BLANKET = [0.35, 0.4, 0.2], [0.45, 0.26, 0.12], [0.4, 0.12, 0.08]
HEIGHT = 2.8  # of the rooms
EAVES = ((-4.8, -6.8), (4.8, 3.8))  # two corners (x, z) of the ceiling's slab
SLOPE = 30  # of a tiled roof, degrees
RISE = (EAVES[1][1] - EAVES[0][1]) / 2 * math.tan(math.radians(SLOPE))  # of its ridge over the slab


def terrain(level):
    """A square of 1 km that is level within `level` metres of the origin, and hilly beyond. Its cells grow from 0.5 m
    at the origin to 60 m at its edges."""
    steps = range(-24, 25)
    places = [500 * (0.025 * t + 0.975 * t**3) for t in (step / 24 for step in steps)]

    def height(x, z):
        hilliness = min(max((math.hypot(x, z) - level) / 100, 0), 1)
        return hilliness * (12 * math.sin(x / 70) * math.cos(z / 90) + 3 * math.sin(x / 40 + 1) * math.sin(z / 45))

    surface, row = Surface(), len(places)
    for z in places:
        for x in places:
            slopes = (height(x + 0.1, z) - height(x - 0.1, z)) / 0.2, (height(x, z + 0.1) - height(x, z - 0.1)) / 0.2
            length = math.hypot(*slopes, 1)
            surface.positions.append((x, height(x, z), z))
            surface.normals.append((-slopes[0] / length, 1 / length, -slopes[1] / length))
    for corner in (z * row + x for z in range(row - 1) for x in range(row - 1)):
        surface.indices += [corner + i for i in (0, row, 1, 1, row, row + 1)]
    return surface


def walls():
    """A front room of 8 m x 6 m with a door towards +Z and a window towards +X; behind it, a back room of 8 m x 2.8 m
    with a window towards -Z."""
    return flat(
        wall((-4.3, 0, 3.0), (4.3, HEIGHT, 3.3), [(-2.5, -1.5, 0, 2.1)])
        + wall((4.0, 0, -6.0), (4.3, HEIGHT, 3.0), [(-1.4, 1.0, 0.7, 2.2)])
        + wall((-4.3, 0, -6.3), (4.3, HEIGHT, -6.0), [(0.5, 2.0, 0.9, 2.2)])
        + block((-4.3, 0, -6.0), (-4.0, HEIGHT, 3.0))
        + wall((-4.0, 0, -3.2), (4.0, HEIGHT, -3.0), [(-3.2, -2.3, 0, 2.1)])
    )


def house_meshes(scene):
    """The parts of the house, by name."""
    white, wood, red = scene.material("white", WHITE), scene.material("wood", WOOD), scene.material("red", BLANKET)
    (x0, z0), (x1, z1) = EAVES
    quads = {
        "floor": (wood, block((-4.3, -0.2, -6.3), (4.3, 0.02, 3.3))),
        "ceiling": (white, block((x0, HEIGHT, z0), (x1, HEIGHT + 0.2, z1))),
        "table": (wood, block((0.3, 0.02, -1.6), (1.7, 0.77, -0.8))),
        "bed": (red, block((1.9, 0.02, -5.8), (2.9, 0.5, -3.8))),
    }
    meshes = {name: scene.mesh(name, flat(faces), material) for name, (material, faces) in quads.items()}
    return {"walls": scene.mesh("walls", walls(), white), **meshes}


def sun(scene):
    """It shines through the door and the window of a house that is not turned."""
    scene.light("sun", "directional", [1.0, 0.95, 0.85], 4.0, **looking((0.55, 0.42, 0.6), (0, 0, 0)))


def house():
    scene = Scene()
    scene.place("terrain", terrain(20), scene.material("grass", GRASS))
    for name, mesh in house_meshes(scene).items():
        scene.node(name, mesh=mesh)
    sun(scene)
    scene.camera(60, 0.02, "inside", **looking((-3.2, 1.6, 2.4), (1.5, 1.0, -1.5)))
    scene.camera(60, 0.02, "outside", **looking((14, 3, 12), (0, 1.2, 0)))
    return scene


def attic():
    """A roof of two slopes, whose lower side the ceiling's slab closes."""
    (x0, z0), (x1, z1) = EAVES
    ridge, middle = RISE, (z0 + z1) / 2
    front = [(x0, 0, z1), (x1, 0, z1), (x1, ridge, middle), (x0, ridge, middle)]
    back = [(x1, 0, z0), (x0, 0, z0), (x0, ridge, middle), (x1, ridge, middle)]
    gables = Surface(
        [(x1, 0, z1), (x1, 0, z0), (x1, ridge, middle), (x0, 0, z0), (x0, 0, z1), (x0, ridge, middle)],
        [(1, 0, 0)] * 3 + [(-1, 0, 0)] * 3,
        [0, 1, 2, 3, 4, 5],
    )
    return flat([front, back]) + gables


def tiles():
    """Rows of tiles that overlap, in the plane y = 0 from z = 0 downhill to the eaves. A tile is the upper half of a
    pipe that widens downhill."""
    (x0, z0), (x1, z1) = EAVES
    rows, columns = 20, round((x1 - x0) / 0.2)
    pitch = math.hypot((z1 - z0) / 2, RISE) / rows
    surface = Surface()
    for row in range(rows):
        for column in range(columns):
            first = len(surface.positions)
            for z, radius in ((row * pitch, 0.08), ((row + 1.2) * pitch, 0.1)):
                for x, y in ((-math.cos(math.pi * i / 8), math.sin(math.pi * i / 8)) for i in range(9)):
                    surface.positions.append((x0 + 0.2 * (column + 0.5) + radius * x, radius * y, z))
                    surface.normals.append((x, y, 0))
            for i in range(first, first + 8):
                surface.indices += [i, i + 9, i + 1, i + 1, i + 9, i + 10]
    return surface


def furniture(scene):
    """Meshes of things with curves, and where they are in a house, as (mesh, x, height, z)."""
    legs = [(0.03 + 0.015 * math.sin(1.2 * ring), 0.03 * ring) for ring in range(16)]
    leg = lathe(legs, 16)
    seat = box(0.45, 0.04, 0.45)
    chair = flat([[(x, y + 0.45, z) for x, y, z in quad] for quad in seat])
    for dx, dz in ((-0.18, -0.18), (0.18, -0.18), (-0.18, 0.18), (0.18, 0.18)):
        chair += Surface([(x + dx, y, z + dz) for x, y, z in leg.positions], leg.normals, leg.indices)
    vase = lathe([(0.05 + 0.05 * math.sin(ring / 6) ** 2, 0.015 * ring) for ring in range(25)], 48)
    wood, blue = scene.material("chair", WOOD), scene.material("blue", BLUE)
    chair, vase = scene.mesh("chair", chair, wood), scene.mesh("vase", vase, blue)
    chairs = [(chair, x, 0.02, z) for x in (0.6, 1.4) for z in (-2.0, -0.4)]
    return [*chairs, *((vase, x, 0.77, -1.2) for x in (0.6, 1.0, 1.4)), (vase, 3.9, 0.02, -2.8)]


def street():
    """Ten houses on each side of a street, with tiled roofs and two trees each: more than a million triangles."""
    scene = Scene()
    scene.place("terrain", terrain(110), scene.material("grass", GRASS))
    scene.place("street", flat(block((-90, -0.1, -4), (90, 0.03, 4))), scene.material("asphalt", [0.15, 0.15, 0.16]))
    parts, clay = house_meshes(scene), scene.material("clay", [0.5, 0.22, 0.14])
    parts["attic"] = scene.mesh("attic", attic(), clay)
    roof, things = scene.mesh("tiles", tiles(), clay), furniture(scene)
    crown = scene.mesh("crown", lathe(crown_profile(), 64), scene.material("leaves", [0.12, 0.3, 0.08]))
    trunk = scene.mesh("trunk", lathe([(0.16, 0.0), (0.11, 2.4)], 24), scene.material("bark", [0.2, 0.14, 0.1]))

    def build(number, translation, rotation):
        top, middle = HEIGHT + 0.2, (EAVES[0][1] + EAVES[1][1]) / 2
        for name, mesh in parts.items():
            scene.node(name, mesh=mesh, translation=[0.0, top if name == "attic" else 0.0, 0.0])
        for mesh, *place in things:
            scene.node("thing", mesh=mesh, translation=place)
        for x in (-6.5, 6.5):
            scene.node("trunk", mesh=trunk, translation=[x, 0.0, 4.5])
            scene.node("crown", mesh=crown, translation=[x, 2.0, 4.5])
        for degrees in (0, 180):
            scene.node("tiles", mesh=roof, rotation=tilt(SLOPE))
            scene.parent("slope", 1, translation=[0.0, top + RISE, middle], rotation=turn(degrees))
        count = len(parts) + len(things) + 6
        scene.parent(f"house {number}", count, translation=translation, rotation=rotation)

    for number in range(20):
        side, column = (-1 if number < 10 else 1), number % 10
        build(number + 1, [16.0 * (column - 4.5), 0.0, 12.0 * side], turn(0 if side < 0 else 180))
    sun(scene)
    scene.camera(60, 0.05, "street", **looking((2.0, 2.0, 3.0), (-9, 2.4, -10)))
    scene.camera(60, 0.02, "room", **looking((4.8, 1.6, -9.6), (9.5, 1.0, -13.5)))
    return scene


def crown_profile():
    """A lumpy ball, 4 m high."""
    angles = [math.pi * ring / 32 for ring in range(33)]
    radius = lambda a: 1.4 * abs(round(math.sin(a), 9)) * (1 + 0.08 * math.sin(9 * a))  # noqa: E731
    return [(radius(a), 2.0 - 2.0 * math.cos(a)) for a in angles]
