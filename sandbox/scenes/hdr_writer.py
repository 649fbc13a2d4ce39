"""Writes Radiance pictures (.hdr)."""

import math


def direction(x, y, width, height):
    """The unit vector that a pixel of an environment shows: the top row is +Y, the centre -Z, +X lies to the right of
    it."""
    azimuth = 2.0 * math.pi * ((x + 0.5) / width - 0.5)
    polar = math.pi * (y + 0.5) / height
    return (math.sin(azimuth) * math.sin(polar), math.cos(polar), -math.cos(azimuth) * math.sin(polar))


def hdr(width, height, radiance):
    """The picture's bytes. `radiance(x, y)`: linear RGB of a pixel, from the top left. Each pixel has three mantissas and
    an exponent (Ward, "Real Pixels", Graphics Gems II, 1991)."""
    pixels = bytearray()
    for y in range(height):
        for x in range(width):
            rgb = radiance(x, y)
            exponent = math.frexp(max(rgb))[1]
            scale = math.ldexp(256.0, -exponent)
            pixels += bytes([*(min(int(channel * scale), 255) for channel in rgb), exponent + 128])
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + f"-Y {height} +X {width}\n".encode() + bytes(pixels)


def daylight(ground):
    """A small sky: blue above, white at the horizon, grey of this radiance below it."""
    width, height = 32, 16

    def radiance(x, y):
        upwards = direction(x, y, width, height)[1]
        if upwards < 0.0:
            return [ground] * 3
        return [0.5 - 0.35 * upwards, 0.55 - 0.25 * upwards, 0.6]

    return hdr(width, height, radiance)
