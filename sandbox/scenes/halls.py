"""Scenes with many lights of short range; each light reaches only a small part of the picture."""

import colorsys
import math
import random

from gltf_writer import Scene
from shapes import box, flat, ground, looking, room, tilt


def hue(value):
    """A bright colour, linear."""
    return [round(channel, 3) for channel in colorsys.hsv_to_rgb(value, 0.7, 1.0)]


def point(*coordinates):
    return [round(coordinate, 3) + 0.0 for coordinate in coordinates]


def hall(count):
    """A hall with pillars and one light per 2 m x 2 m of floor, so that the floor grows with the number of lights.
    Every fourth light is a spot. With a range of about 3.5 m and 2 m above the floor, about five lights reach each
    point of the floor."""
    spacing, height = 2.0, 4.0
    columns = max(math.isqrt(count // 4), 1)
    rows = math.ceil(count / columns)
    width, depth = columns * spacing, rows * spacing

    scene = Scene()
    plaster, stone = scene.material("plaster", [0.6, 0.6, 0.6]), scene.material("stone", [0.5, 0.48, 0.45])
    scene.place("room", flat(room((-width / 2, 0, -depth), (width / 2, height, 0))), plaster)
    # Pillars stand at the corners of the lights' cells. Lights keep a distance from the borders of their cells.
    pillar = scene.mesh("pillar", flat(box(0.5, height, 0.5)), stone)
    for row in range(2, rows, 2):
        for column in range(2, columns, 4):
            place = point(column * spacing - width / 2, 0, -row * spacing)
            scene.node("pillar", mesh=pillar, translation=place)

    numbers = random.Random(count)
    for index in range(count):
        row, column = divmod(index, columns)
        x = (column + 0.2 + 0.6 * numbers.random()) * spacing - width / 2
        z = -(row + 0.2 + 0.6 * numbers.random()) * spacing
        position = point(x, 1.6 + 0.8 * numbers.random(), z)
        reach, colour = round(3.3 + 0.4 * numbers.random(), 3), hue(numbers.random())
        if index % 4 == 3:
            below = (position[0], 0.0, position[2])
            scene.light(f"spot {index}", "spot", colour, 6.0, reach, (30, 55), **looking(position, below))
        else:
            scene.light(f"light {index}", "point", colour, 3.0, reach, translation=position)
    scene.camera(60, 0.05, **looking((0.3, 1.7, -0.5), (-0.2, 1.5, -8.0)))
    return scene


def fins():
    """A slope with rows of thin upright fins, seen from its foot. The camera looks through many rows, so that the
    pixels of a tile have many different depths, and each light reaches only few of them."""
    across, rows, pitch, spacing, slope = 60, 48, 0.2, 0.45, 8.0
    numbers = random.Random(1)

    def on_slope(x, height, distance):
        """The point at `height` above the slope and at `distance` up the slope from its foot."""
        sine, cosine = math.sin(math.radians(slope)), math.cos(math.radians(slope))
        return point(x, height * cosine + distance * sine, height * sine - distance * cosine)

    row = []
    for column in range(across):
        x = (column - (across - 1) / 2) * pitch
        fin = box(0.06, round(0.4 + 0.4 * numbers.random(), 3), 0.015)[:5]  # no bottom
        row += [[(x + dx, y, z) for dx, y, z in quad] for quad in fin]

    scene = Scene()
    clay, steel = scene.material("clay", [0.6, 0.55, 0.5]), scene.material("steel", [0.65, 0.65, 0.68])
    half, depth = (across + 2) * pitch / 2, (rows + 2) * spacing
    scene.place("slope", flat([ground((-half, -depth), (half, 0))]), clay, rotation=tilt(slope))
    mesh = scene.mesh("row of fins", flat(row), steel)
    for index in range(rows):
        shift = pitch * (numbers.random() - 0.5)
        place = on_slope(shift, 0, (index + 1) * spacing)
        scene.node("row of fins", mesh=mesh, translation=place, rotation=tilt(slope))

    # Each light is near the middle between two rows; the gap is the one at its jittered distance.
    for index in range(512):
        far, side = divmod(index, 16)
        x = (side - 8 + numbers.random()) * across * pitch / 16
        gap = int((far + numbers.random()) * rows / 32)
        distance = (gap + 1.35 + 0.3 * numbers.random()) * spacing
        position = on_slope(x, 0.1 + 0.35 * numbers.random(), distance)
        reach, colour = round(0.9 + 0.3 * numbers.random(), 3), hue(numbers.random())
        scene.light(f"light {index}", "point", colour, 0.25, reach, translation=position)
    scene.camera(30, 0.05, **looking((0.4, 1.2, 0.8), (0.0, -0.5, -12.0)))
    return scene
