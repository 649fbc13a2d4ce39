"""PNG images with 8 bits per channel."""

import struct
import zlib

from deflate import deflated


def chunk(kind, content):
    check = zlib.crc32(kind + content)
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", check)


def picture(width, height, colour_type, packed):
    header = struct.pack(">IIBBBBB", width, height, 8, colour_type, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")


def png(width, height, texel):
    """`texel(x, y)` returns red, green, blue and alpha, each 0 to 255; row 0 is at the top."""
    rows = bytearray()
    for y in range(height):
        rows.append(0)  # this row is not filtered
        for x in range(width):
            rows += bytes(texel(x, y))
    # Stored without compression: versions of zlib compress the same input differently.
    return picture(width, height, 6, zlib.compress(rows, 0))


def opaque_png(width, height, texel):
    """Compressed. `texel(x, y)` returns red, green and blue."""
    rows = bytearray()
    for y in range(height):
        row = bytes(channel for x in range(width) for channel in texel(x, y))
        rows.append(1)  # each byte is stored as the difference from that of the texel to the left
        rows += bytes((byte - left) % 256 for byte, left in zip(row, bytes(3) + row))
    return picture(width, height, 2, deflated(bytes(rows)))
