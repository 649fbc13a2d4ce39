"""A compressor whose output is always the same: versions of zlib compress the same input differently."""

import struct
import zlib

SHORTEST, LONGEST, FARTHEST = 3, 258, 32768


def table(first, base, count, extra_bits):
    """(code, its smallest value, its extra bits) of RFC 1951, section 3.2.5."""
    rows = []
    for i in range(count):
        rows.append((first + i, base, extra_bits(i)))
        base += 1 << extra_bits(i)
    return rows


LENGTHS = table(257, SHORTEST, 28, lambda i: max(i // 4 - 1, 0)) + [(285, LONGEST, 0)]
DISTANCES = table(0, 1, 30, lambda i: max(i // 2 - 1, 0))


class Bits:
    def __init__(self):
        self.bits, self.count, self.done = 0, 0, bytearray()

    def number(self, value, count):
        """The lowest bit first."""
        self.bits |= value << self.count
        self.count += count
        while self.count >= 8:
            self.done.append(self.bits & 255)
            self.bits >>= 8
            self.count -= 8

    def code(self, value, count):
        """The highest bit first."""
        self.number(int(f"{value:0{count}b}"[::-1], 2), count)

    def symbol(self, value):
        """A literal or length, with the fixed codes."""
        if value < 144:
            self.code(48 + value, 8)
        elif value < 256:
            self.code(400 + value - 144, 9)
        elif value < 280:
            self.code(value - 256, 7)
        else:
            self.code(192 + value - 280, 8)

    def copy(self, length, distance):
        code, base, extra = next(row for row in reversed(LENGTHS) if row[1] <= length)
        self.symbol(code)
        self.number(length - base, extra)
        code, base, extra = next(row for row in reversed(DISTANCES) if row[1] <= distance)
        self.code(code, 5)
        self.number(distance - base, extra)


def common(data, a, b):
    """The number of bytes that are the same from a and from b on."""
    length = 0
    while length < LONGEST and b + length < len(data) and data[a + length] == data[b + length]:
        length += 1
    return length


def deflated(data):
    """A zlib stream of one block with the fixed codes; each place is compared with the last one that begins alike."""
    bits = Bits()
    bits.number(0b011, 3)
    last, at = {}, 0
    while at < len(data):
        before = last.get(data[at : at + SHORTEST])
        length = 0 if before is None or at - before > FARTHEST else common(data, before, at)
        if length >= SHORTEST:
            bits.copy(length, at - before)
        else:
            length = 1
            bits.symbol(data[at])
        for place in range(at, at + length):
            last[data[place : place + SHORTEST]] = place
        at += length
    bits.symbol(256)
    bits.number(0, 7)
    return b"\x78\x01" + bytes(bits.done) + struct.pack(">I", zlib.adler32(data))
