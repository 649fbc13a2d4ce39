"""Surfaces, and rotations as quaternions (x, y, z, w). A quad is four coplanar corners, counter-clockwise as seen from
the front. Lengths are in metres, +Y is up, angles are in degrees."""

import math
from dataclasses import dataclass, field


@dataclass
class Surface:
    """Indexed triangles, counter-clockwise as seen from the front."""

    positions: list = field(default_factory=list)
    normals: list = field(default_factory=list)
    indices: list = field(default_factory=list)
    uvs: list = field(default_factory=list)  # empty, or one per position

    def __add__(self, other):
        later = [index + len(self.positions) for index in other.indices]
        return Surface(
            self.positions + other.positions, self.normals + other.normals, self.indices + later, self.uvs + other.uvs
        )


def flat(quads):
    """Quads as a surface, each with the normal of its plane."""
    surface = Surface()
    for quad in quads:
        first = len(surface.positions)
        surface.positions += quad
        surface.normals += [normal(quad)] * 4
        surface.indices += [first + i for i in (0, 1, 2, 0, 2, 3)]
    return surface


def normal(quad):
    a, b, _, d = quad
    u = [b[i] - a[i] for i in range(3)]
    v = [d[i] - a[i] for i in range(3)]
    cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    length = math.sqrt(sum(x * x for x in cross))
    return [x / length + 0.0 for x in cross]  # + 0.0 turns -0.0 into 0.0


def block(low, high):
    """The six faces of a closed box between two corners, in the order +Z, -Z, +X, -X, +Y, -Y."""
    (a, b, c), (x, y, z) = low, high
    return [
        [(a, b, z), (x, b, z), (x, y, z), (a, y, z)],
        [(x, b, c), (a, b, c), (a, y, c), (x, y, c)],
        [(x, b, z), (x, b, c), (x, y, c), (x, y, z)],
        [(a, b, c), (a, b, z), (a, y, z), (a, y, c)],
        [(a, y, z), (x, y, z), (x, y, c), (a, y, c)],
        [(a, b, c), (x, b, c), (x, b, z), (a, b, z)],
    ]


def box(width, height, depth):
    """A block that stands on the origin."""
    return block((-width / 2, 0, -depth / 2), (width / 2, height, depth / 2))


def room(low, high):
    """A block seen from inside."""
    return [quad[::-1] for quad in block(low, high)]


def wall(low, high, openings):
    """A block that is thin along x or z, with openings right through it. Each is (start, end, bottom, top), along the
    wall and upwards; from the wall's beginning to its end."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    along_x = x1 - x0 > z1 - z0
    done, end_of_wall = (x0, x1) if along_x else (z0, z1)

    def part(start, end, bottom, top):
        if start >= end or bottom >= top:
            return []
        return block((start, bottom, z0), (end, top, z1)) if along_x else block((x0, bottom, start), (x1, top, end))

    quads = []
    for start, end, bottom, top in openings:
        quads += part(done, start, y0, y1) + part(start, end, y0, bottom) + part(start, end, top, y1)
        done = end
    return quads + part(done, end_of_wall, y0, y1)


def ground(low, high):
    """A level quad that faces up, between two corners (x, z) at height 0."""
    (a, c), (x, z) = low, high
    return [(a, 0, z), (x, 0, z), (x, 0, c), (a, 0, c)]


def pane(width, height, repeats=None):
    """An upright quad that stands on the origin and faces +Z; its texture, if any, repeats so many times across it."""
    x = width / 2
    surface = flat([[(-x, 0, 0), (x, 0, 0), (x, height, 0), (-x, height, 0)]])
    if repeats:
        u, v = repeats, repeats * height / width
        surface.uvs = [(0, v), (u, v), (u, 0), (0, 0)]
    return surface


def lathe(profile, segments):
    """A surface of revolution about +Y, with smooth normals. `profile` is a list of (radius, height), bottom first; it
    may begin and end on the axis."""
    surface = Surface()
    for ring, (radius, height) in enumerate(profile):
        below, above = profile[max(ring - 1, 0)], profile[min(ring + 1, len(profile) - 1)]
        outwards, upwards = above[1] - below[1], below[0] - above[0]
        length = math.hypot(outwards, upwards)
        for segment in range(segments + 1):
            angle = 2 * math.pi * (segment % segments) / segments
            x, z = math.sin(angle), math.cos(angle)
            surface.positions.append((radius * x, height, radius * z))
            surface.normals.append((outwards / length * x, upwards / length, outwards / length * z))
    row = segments + 1
    for ring in range(len(profile) - 1):
        for segment in range(segments):
            corner = ring * row + segment
            surface.indices += [corner + i for i in (0, 1, row + 1)] if profile[ring][0] > 0 else []
            surface.indices += [corner + i for i in (0, row + 1, row)] if profile[ring + 1][0] > 0 else []
    return surface


def cylinder(radius, height):
    """Stands on the origin; without a bottom."""
    return lathe([(radius, 0), (radius, height)], 32) + lathe([(radius, height), (0, height)], 32)


def ball(radius):
    """A sphere around the origin, of 16 x 32 facets with smooth normals."""
    angles = [math.pi * ring / 16 for ring in range(1, 16)]
    arc = [(radius * math.sin(angle), -radius * math.cos(angle)) for angle in angles]
    return lathe([(0, -radius), *arc, (0, radius)], 32)


def turn(degrees):
    """A rotation about +Y."""
    half = math.radians(degrees) / 2
    return [0.0, round(math.sin(half), 7), 0.0, round(math.cos(half), 7)]


def tilt(degrees):
    """A rotation about +X."""
    x, y, z, w = turn(degrees)
    return [y, x, z, w]


def aim(start, target):
    """The rotation that turns -Z from `start` towards `target` and keeps +X horizontal; for cameras and lights."""
    x, y, z = (b - a for a, b in zip(start, target))
    yaw, pitch = math.atan2(-x, -z) / 2, math.atan2(y, math.hypot(x, z)) / 2
    quaternion = [
        math.cos(yaw) * math.sin(pitch),
        math.sin(yaw) * math.cos(pitch),
        -math.sin(yaw) * math.sin(pitch),
        math.cos(yaw) * math.cos(pitch),
    ]
    return [round(part, 7) + 0.0 for part in quaternion]


def looking(start, target):
    """The transform of a camera or a light at `start` that looks at `target`."""
    return {"translation": list(start), "rotation": aim(start, target)}
