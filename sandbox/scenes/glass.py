"""A scene with transparent materials: tinted panes, and a trellis with an alpha mask."""

from gltf_writer import Scene
from halls import hue
from png_writer import png
from shapes import box, flat, looking, pane, room, turn


def trellis_texel(x, y):
    """Two crossing laths per 32 x 32 texels; their alpha falls to 0 within one or two texels of their edges."""
    across = min((x + y) % 32, -(x + y) % 32)
    along = min((x - y) % 32, (y - x) % 32)
    shade = 150 if across < along else 120  # one lath runs in front of the other
    alpha = max(0, min(255, 255 - 80 * (min(across, along) - 4)))
    return (shade - 30, shade, shade // 3, alpha)


def glass():
    """A room with panes that overlap in the camera's view (one is seen from its back), with opaque objects between
    them, and lights in front of and behind each pane. A trellis with an alpha mask stands at the back."""
    scene = Scene()
    plaster = scene.material("plaster", [0.65, 0.63, 0.6])
    brick, slate = scene.material("brick", [0.5, 0.2, 0.12]), scene.material("slate", [0.2, 0.25, 0.35])
    scene.place("room", flat(room((-3, 0, -4), (3, 3, 4))), plaster)
    scene.place("plinth", flat(box(0.8, 0.9, 0.8)), slate, translation=[-0.2, 0.0, -0.9], rotation=turn(25))
    scene.place("pillar", flat(box(0.5, 3.0, 0.5)), brick, translation=[1.6, 0.0, -2.2], rotation=turn(-20))
    scene.place("block", flat(box(0.6, 0.5, 0.6)), brick, translation=[-1.5, 0.0, 0.6], rotation=turn(40))

    def place_pane(name, colour, alpha, size, translation, degrees, **properties):
        tint = scene.material(f"{name} glass", colour, alpha, alphaMode="BLEND", **properties)
        scene.place(f"{name} pane", pane(*size), tint, translation=translation, rotation=turn(degrees))

    place_pane("blue", [0.15, 0.35, 0.8], 0.35, (1.7, 2.2), [-0.7, 0.0, -0.1], 8)
    place_pane("red", [0.8, 0.15, 0.1], 0.4, (1.8, 2.0), [0.2, 0.0, 0.5], 0)
    place_pane("green", [0.2, 0.7, 0.25], 0.5, (1.3, 1.6), [0.9, 0.0, 1.1], -15)
    place_pane("amber", [0.85, 0.6, 0.1], 0.3, (1.2, 1.9), [1.8, 0.0, -0.8], 160, doubleSided=True)

    texture = scene.texture("trellis", png(32, 32, trellis_texel))
    cut_out = {"alphaMode": "MASK", "alphaCutoff": 0.5, "doubleSided": True}
    wood = scene.material("trellis", [1.0, 1.0, 1.0], 1.0, texture, **cut_out)
    scene.place("trellis", pane(1.8, 2.4, 6), wood, translation=[-1.95, 0.0, -2.0], rotation=turn(12))

    in_front = [(-2.2, 2.2, 2.4), (1.9, 1.2, 2.2), (0.3, 2.4, 1.6)]
    between = [(-0.4, 1.3, 0.2), (0.7, 0.6, -0.1), (2.3, 1.8, 0.0)]
    behind = [(-0.8, 1.9, -1.2), (0.5, 2.3, -2.0), (-2.2, 0.6, -1.6), (-1.6, 1.6, -3.4), (2.3, 0.8, -3.2)]
    for index, position in enumerate([*in_front, *between, *behind]):
        scene.light(f"light {index}", "point", hue(0.618 * index % 1), 4.0, 3.2, translation=list(position))
    scene.camera(50, 0.01, **looking((0.1, 1.5, 3.8), (-0.05, 1.1, 0.0)))
    return scene
