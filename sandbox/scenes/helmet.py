"""A scene with every kind of texture: a painted metal helmet with rivets, scratches and a glowing visor."""

import math

from gltf_writer import Scene
from hdr_writer import daylight
from png_writer import opaque_png
from shapes import Surface, aim, box, flat, ground, looking, pane, turn

SIZE = 256  # texels a side; u goes from the front of the helmet to its back, on both sides, v from the top down
RINGS, SEGMENTS = 28, 52
SEAMS_DOWN, SEAMS_AROUND = (0.36, 0.8), (0.22, 0.42, 0.68, 0.9)
VISOR = (0.34, 0.49, 0.57)  # its end, top and bottom
PAINT, STEEL, DARK = (118, 26, 20), (196, 190, 182), (30, 30, 32)


def noise(x, y, seed=0):
    """Any number in [0, 1) for whole numbers."""
    bits = (x * 374761393 + y * 668265263 + seed * 2147483647) & 0xFFFFFFFF
    bits = ((bits ^ (bits >> 13)) * 1274126177) & 0xFFFFFFFF
    return ((bits ^ (bits >> 16)) & 0xFFFF) / 65536


def smooth_noise(x, y, seed):
    """The same between whole numbers."""
    left, top = math.floor(x), math.floor(y)
    s, t = x - left, y - top
    upper = (1 - s) * noise(left, top, seed) + s * noise(left + 1, top, seed)
    lower = (1 - s) * noise(left, top + 1, seed) + s * noise(left + 1, top + 1, seed)
    return (1 - t) * upper + t * lower


def to_seam(x, y):
    """Texels to the nearest seam between two panels."""
    u, v = (x + 0.5) / SIZE, (y + 0.5) / SIZE
    across = min(abs(u - seam) for seam in SEAMS_DOWN)
    return SIZE * min(across, *(abs(v - seam) for seam in SEAMS_AROUND))


def to_rivet(x, y):
    """Texels to the middle of the nearest rivet. Rivets stand in rows on both sides of the lower seams."""
    nearest = SIZE
    for seam in SEAMS_AROUND[1:]:
        for side in (-7, 7):
            middle = 16 * (x // 16) + 8
            nearest = min(nearest, math.hypot(x - middle, y - (SIZE * seam + side)))
    return nearest


def in_visor(x, y, margin=0):
    """Whether the point is in the visor, made smaller by so many texels."""
    end, top, bottom = (SIZE * side for side in VISOR)
    return x < end - margin and top + margin <= y < bottom - margin


def is_scratch(x, y):
    for i in range(9):
        start, row, slope = 256 * noise(i, 1), 256 * noise(i, 2), noise(i, 3) - 0.5
        if 0 <= x - start < 20 + 70 * noise(i, 4) and abs(y - row - slope * (x - start)) < 0.7:
            return True
    return False


def is_worn(x, y):
    """Whether the paint is off: along seams, on scratches, and in spots."""
    spots = smooth_noise(x / 6, y / 6, 1) + 0.5 * smooth_noise(x / 2, y / 2, 2)
    return is_scratch(x, y) or to_rivet(x, y) < 2.5 or spots > 1.15 + 0.04 * min(to_seam(x, y), 6)


def height(x, y):
    """In texels. Columns beyond the front and the back are those of the other side of the helmet, which is its mirror
    image."""
    x = min(max(x, -1 - x), 2 * SIZE - 1 - x)
    if in_visor(x, y):
        return -3.0 if in_visor(x, y, 2) else -1.5
    groove = -1.6 * max(0.0, 1 - to_seam(x, y) / 2.5)
    rivet = max(0.0, 2.2 - 0.25 * to_rivet(x, y) ** 2)
    dents = 5.0 * smooth_noise(x / 24, y / 24, 3)
    return groove + min(rivet, 1.4) + dents - (0.5 if is_scratch(x, y) else 0.0)


def base_colour(x, y):
    if in_visor(x, y):
        return DARK
    return STEEL if is_worn(x, y) else PAINT


def emission(x, y):
    """Bars of light in the visor."""
    return (255, 150, 60) if in_visor(x, y, 4) and x % 12 < 9 else (0, 0, 0)


def occlusion_roughness_metalness(x, y):
    """The channels of glTF. Steel is smoother where the paint has come off by scratches."""
    seam, rivet = to_seam(x, y), to_rivet(x, y)
    open_share = 0.4 if in_visor(x, y) else min(1.0, 0.45 + 0.2 * seam, 0.4 + 0.15 * rivet if rivet > 2.5 else 1.0)
    worn = is_worn(x, y)
    rough = 0.25 if is_scratch(x, y) else 0.42 if worn else 0.32 + 0.2 * smooth_noise(x / 16, y / 16, 4)
    shares = (open_share, 0.15 if in_visor(x, y) else rough, 1.0 if worn and not in_visor(x, y) else 0.0)
    return tuple(round(255 * share) for share in shares)


def normals():
    """The texel function of the normal texture: x to the right, y up."""
    rows = [[height(x, y) for x in range(-1, SIZE + 1)] for y in range(SIZE)]

    def texel(x, y):
        above, below = rows[max(y - 1, 0)][x + 1], rows[min(y + 1, SIZE - 1)][x + 1]
        slope = (0.5 * (rows[y][x] - rows[y][x + 2]), 0.5 * (below - above), 1.0)
        length = math.sqrt(sum(part * part for part in slope))
        return tuple(round(127.5 + 127.5 * part / length) for part in slope)

    return texel


def outline(v):
    """Radius and height of the helmet, v from the top down."""
    if v < 0.5:
        angle = math.pi * v
        return 0.5 * math.sin(angle), 0.62 + 0.5 * math.cos(angle)
    below = (v - 0.5) / 0.5
    return 0.5 - 0.07 * below + 0.12 * below**6, 0.62 * (1 - below)


def shell():
    """A helmet that stands on the origin and looks along +Z. It is a little longer than wide. The texture of its right
    half is that of the left one, mirrored."""
    surface = Surface()
    for side in (1, -1):
        first = len(surface.positions)
        for ring in range(RINGS + 1):
            v = ring / RINGS
            radius, y = outline(v)
            above, below = outline(max(v - 0.01, 0.0)), outline(min(v + 0.01, 1.0))
            outwards, upwards = above[1] - below[1], below[0] - above[0]
            for segment in range(SEGMENTS // 2 + 1):
                u = segment / (SEGMENTS // 2)
                x, z = side * math.sin(math.pi * u), math.cos(math.pi * u)
                surface.positions.append((0.85 * radius * x, y, radius * z))
                across = (outwards * x / 0.85, upwards, outwards * z)
                length = math.sqrt(sum(part * part for part in across)) if ring else 1.0
                surface.normals.append([part / length for part in across] if ring else [0.0, 1.0, 0.0])
                surface.uvs.append((u, v))
        row = SEGMENTS // 2 + 1
        for ring in range(RINGS):
            for segment in range(SEGMENTS // 2):
                corner = first + ring * row + segment
                triangles = [(corner, corner + row, corner + row + 1)]
                triangles += [(corner, corner + row + 1, corner + 1)] if ring else []
                for triangle in triangles:
                    surface.indices += triangle if side > 0 else triangle[::-1]
    return surface


def helmet():
    """The helmet on a plinth, between a red and a green screen in front of a wall. A sun, a sky and a lamp light it."""
    scene = Scene()

    def picture(name, texel):
        return {"index": scene.texture(name, opaque_png(SIZE, SIZE, texel), repeats=False)}

    packed = picture("occlusion, roughness, metalness", occlusion_roughness_metalness)
    pbr = {"baseColorTexture": picture("paint", base_colour), "metallicRoughnessTexture": packed}
    properties = {"normalTexture": picture("bumps", normals()), "occlusionTexture": packed}
    properties["emissiveTexture"] = picture("visor", emission)
    properties["emissiveFactor"] = [1.0, 1.0, 1.0]
    properties["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": 6.0}}
    steel = scene.add("materials", {"name": "painted steel", "pbrMetallicRoughness": pbr, **properties})
    scene.use("KHR_materials_emissive_strength")
    stone, plaster = scene.material("stone", [0.35, 0.35, 0.38]), scene.material("plaster", [0.7, 0.68, 0.62])
    red, green = scene.material("red", [0.6, 0.08, 0.06]), scene.material("green", [0.08, 0.45, 0.1])
    scene.place("floor", flat([ground((-4, -2), (4, 4))]), stone)
    scene.place("wall", pane(8.0, 2.6), plaster, translation=[0.0, 0.0, -2.0])
    scene.place("red screen", flat(box(0.1, 1.6, 1.6)), red, translation=[-1.6, 0.0, -0.2], rotation=turn(15))
    scene.place("green screen", flat(box(0.1, 1.6, 1.6)), green, translation=[1.6, 0.0, -0.2], rotation=turn(-15))
    scene.place("plinth", flat(box(1.3, 0.4, 1.3)), plaster)
    scene.place("helmet", shell(), steel, translation=[0.0, 0.4, 0.0], rotation=turn(25))
    scene.sky(daylight(0.1))
    scene.light("sun", "directional", [1.0, 0.93, 0.8], 2.5, rotation=aim((2.5, 4.0, 3.0), (0.0, 0.0, 0.0)))
    scene.light("lamp", "point", [1.0, 0.8, 0.6], 3.0, translation=[-0.9, 1.9, 1.0])
    scene.camera(38, 0.02, **looking((0.3, 1.35, 3.2), (0.0, 0.88, 0.0)))
    return scene
