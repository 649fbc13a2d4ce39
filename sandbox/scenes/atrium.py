"""A courtyard, open to the sky, with arcades of two storeys around it."""

import math

from gltf_writer import Scene
from shapes import block, box, flat, lathe, looking, room, turn

BAY, STOREY, SLAB = 2.5, 4.5, 0.3  # from column to column; clear height; thickness of a floor
COURT = (10.0, 3.75)  # half the size of the rectangle of columns, in whole bays
AISLE = 3.75  # from the columns to the outer walls
IMPOST = 3.0  # the height at which arches spring from columns


def column():
    """Plinth, round base, a shaft that swells and tapers, a flaring capital and its slab."""
    base = [(0.24 + 0.05 * math.sin(math.pi * i / 8), 0.12 + 0.016 * i) for i in range(9)]
    shaft = [(0.2 - 0.045 * (i / 20) ** 1.7, 0.26 + 0.116 * i) for i in range(21)]
    capital = [(0.16 + 0.085 * math.sin(math.pi / 2 * i / 9) ** 2, 2.6 + 0.032 * i) for i in range(10)]
    slabs = box(0.58, 0.12, 0.58) + block((-0.25, 2.88, -0.25), (0.25, IMPOST, 0.25))
    return lathe(base + shaft + capital, 32) + flat(slabs)


def arch():
    """The wall of a bay above the impost, pierced by half a circle; its origin is the middle of that circle."""
    half, top, front, back = BAY / 2, STOREY - IMPOST, 0.2, -0.2
    angles = [math.pi * (1 - i / 16) for i in range(17)]
    curve = [(math.cos(angle), math.sin(angle)) for angle in angles]
    edge = [(-half, 0.0), *curve, (half, 0.0)]

    quads = []
    for (x0, y0), (x1, y1) in zip(edge, edge[1:]):
        quads.append([(x0, y0, front), (x1, y1, front), (x1, top, front), (x0, top, front)])
        quads.append([(x1, y1, back), (x0, y0, back), (x0, top, back), (x1, top, back)])
        quads.append([(x0, y0, back), (x1, y1, back), (x1, y1, front), (x0, y0, front)])
    return flat(quads)


def bays():
    """The centre of each bay and the rotation of its side, as (x, z, degrees)."""
    width, depth = COURT
    long, short = round(2 * width / BAY), round(2 * depth / BAY)
    yield from ((BAY * (i + 0.5) - width, side * depth, 0) for side in (-1, 1) for i in range(long))
    yield from ((side * width, BAY * (i + 0.5) - depth, 90) for side in (-1, 1) for i in range(short))


def corners():
    width, depth = COURT
    return [(x, z) for x in (-width, width) for z in (-depth, depth)]


def columns():
    """The positions (x, z) of the columns: both ends of every bay, without duplicates."""
    ends = set(corners())
    for x, z, degrees in bays():
        step = BAY / 2
        ends |= {(x - step, z), (x + step, z)} if degrees == 0 else {(x, z - step), (x, z + step)}
    return sorted(ends)


def gallery(bottom):
    """A floor around the court, from its outer walls to a little beyond the columns."""
    top, (width, depth) = bottom + SLAB, COURT
    x, z = width + AISLE, depth + AISLE
    inner_x, inner_z = width - 0.3, depth - 0.3
    return [
        *block((-x, bottom, inner_z), (x, top, z)),
        *block((-x, bottom, -z), (x, top, -inner_z)),
        *block((inner_x, bottom, -inner_z), (x, top, inner_z)),
        *block((-x, bottom, -inner_z), (-inner_x, top, inner_z)),
    ]


def atrium():
    scene = Scene()
    marble, stone = scene.material("marble", [0.72, 0.7, 0.66]), scene.material("stone", [0.6, 0.52, 0.42])
    paving, plaster = scene.material("paving", [0.5, 0.45, 0.4]), scene.material("plaster", [0.65, 0.6, 0.52])

    storeys = [0.0, STOREY + SLAB]
    x, z = COURT[0] + AISLE, COURT[1] + AISLE
    *walls, _, floor = room((-x, 0, -z), (x, storeys[1] + STOREY + SLAB, z))
    scene.place("walls", flat(walls), plaster)
    scene.place("paving", flat([floor]), paving)
    scene.place("galleries", flat([quad for storey in storeys for quad in gallery(storey + STOREY)]), stone)

    shapes = {
        "column": (scene.mesh("column", column(), marble), [(x, 0.0, z, 0) for x, z in columns()]),
        "arch": (scene.mesh("arch", arch(), stone), [(x, IMPOST, z, degrees) for x, z, degrees in bays()]),
        "corner pier": (
            scene.mesh("corner pier", flat(box(0.4, STOREY - IMPOST, 0.4)), stone),
            [(x, IMPOST, z, 0) for x, z in corners()],
        ),
    }
    for storey in storeys:
        for name, (mesh, places) in shapes.items():
            for x, y, z, degrees in places:
                scene.node(name, mesh=mesh, translation=[x, round(y + storey, 3), z], rotation=turn(degrees))
    parapet = scene.mesh("parapet", flat(box(BAY, 0.9, 0.16)), stone)
    for x, z, degrees in bays():
        scene.node("parapet", mesh=parapet, translation=[x, storeys[1], z], rotation=turn(degrees))

    scene.light("sun", "directional", [1.0, 0.93, 0.82], 3.2, **looking((3.0, 9.0, 2.0), (0.0, 0.0, 0.0)))
    colours = {"red": [1.0, 0.25, 0.15], "green": [0.25, 1.0, 0.3], "blue": [0.2, 0.4, 1.0], "amber": [1.0, 0.7, 0.2]}
    for (name, colour), (x, z) in zip(colours.items(), [(-6.25, -5.6), (1.25, -5.6), (-3.75, 5.6), (3.75, 5.6)]):
        scene.light(f"{name} light", "point", colour, 12.0, translation=[x, 2.4, z])
    scene.camera(62, 0.05, **looking((8.6, 2.2, 2.4), (-3.0, 3.3, -2.2)))
    return scene
