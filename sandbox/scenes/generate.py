#!/usr/bin/env python3
"""Writes the scenes of the tests and the study as self-contained glTF. The output is identical on every run.

    generate.py [--out DIR] [--lights N] [NAME...]

Without names it writes the shipped scenes, by default next to this script. Lengths are in metres, +Y is up, lights
have the units of KHR_lights_punctual, colours are linear. A scene with one camera names it "camera".
"""

import argparse
import pathlib
import sys

sys.dont_write_bytecode = True  # otherwise importing the modules would leave files in the source folder

from atrium import atrium
from ball import ball
from court import court
from fields import balls, boxes, plane
from glass import glass
from gloss import bath, metals
from halls import fins, hall
from helmet import helmet
from house import house, street
from rooms import apartment, cornell, corner, furnace, lamp, neon, rooms, two_rooms

SHIPPED = {
    "cornell": cornell,
    "lamp": lamp,
    "corner": corner,
    "two-rooms": two_rooms,
    "neon": neon,
    "court": court,
    "furnace": furnace,
    "glass": glass,
    "fins": fins,
    "hall-256": lambda: hall(256),
    "house": house,
    "plane": plane,
    "apartment": apartment,
    "metals": metals,
    "bath": bath,
    "helmet": helmet,
    "rooms-12": lambda: rooms(12),
    "boxes": boxes,
}
# Not shipped: large, or one of many sizes.
ON_DEMAND = {
    "atrium": atrium,
    "ball": ball,
    "balls-20000": lambda: balls(20000, 32),
    "balls-100000": lambda: balls(100000, 71),
    "hall-4096": lambda: hall(4096),
    "rooms-6": lambda: rooms(6),
    "street": street,
}


def arguments():
    parser = argparse.ArgumentParser(description="Writes scenes as glTF.")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).parent, metavar="DIR")
    parser.add_argument("--lights", type=int, metavar="N", help="lights of the scene `hall`, which becomes hall-N")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join([*SHIPPED, *ON_DEMAND, "hall"]))
    given = parser.parse_args()
    if ("hall" in given.names) != (given.lights is not None):
        parser.error("the scene hall needs --lights, and the other scenes do not use it")
    if given.lights is not None and given.lights < 1:
        parser.error("--lights must be at least 1")
    for name in given.names:
        if name not in {**SHIPPED, **ON_DEMAND, "hall": None}:
            parser.error(f"there is no scene {name}; the scenes are: {', '.join([*SHIPPED, *ON_DEMAND, 'hall'])}")
    return given


def main():
    given = arguments()
    scenes = {**SHIPPED, **ON_DEMAND}
    if given.lights:
        scenes[f"hall-{given.lights}"] = lambda: hall(given.lights)
    given.out.mkdir(parents=True, exist_ok=True)
    for name in given.names or SHIPPED:
        if name == "hall":
            name = f"hall-{given.lights}"
        path = given.out / f"{name}.gltf"
        path.write_text(scenes[name]().text(), encoding="utf-8", newline="\n")
        print(path)


if __name__ == "__main__":
    main()
