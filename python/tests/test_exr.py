import struct
import unittest
import zlib

import numpy as np
import support  # noqa: F401, so that the package is found

from seedframe import Error
from seedframe.exr import decode_exr


def pack(raw):
    """What OpenEXR's ZIP does: even and odd bytes apart, differences, deflate."""
    values = np.frombuffer(raw, np.uint8)
    apart = np.concatenate([values[0::2], values[1::2]])
    steps = apart.copy()
    steps[1:] = apart[1:] - apart[:-1] + 128
    packed = zlib.compress(steps.tobytes())
    return packed if len(packed) < len(raw) else raw


def encode(channels, compression=3, version=2, top=0):
    height, width = next(iter(channels.values())).shape
    listed = b"".join(
        name.encode() + b"\0" + struct.pack("<iiii", 1 if values.dtype == np.float16 else 2, 0, 1, 1)
        for name, values in channels.items()
    )
    window = struct.pack("<4i", 0, top, width - 1, top + height - 1)
    header = struct.pack("<II", 20000630, version)
    for name, kind, value in (
        (b"channels", b"chlist", listed + b"\0"),
        (b"compression", b"compression", bytes([compression])),
        (b"dataWindow", b"box2i", window),
    ):
        header += name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value
    header += b"\0"
    lines = 16 if compression == 3 else 1
    blocks = []
    for first in range(0, height, lines):
        raw = b"".join(
            values[line].tobytes() for line in range(first, min(first + lines, height)) for values in channels.values()
        )
        packed = pack(raw) if compression else raw
        blocks.append(struct.pack("<ii", top + first, len(packed)) + packed)
    places = []
    place = len(header) + 8 * len(blocks)
    for block in blocks:
        places.append(struct.pack("<Q", place))
        place += len(block)
    return header + b"".join(places) + b"".join(blocks)


class Exr(unittest.TestCase):
    def setUp(self):
        random = np.random.default_rng(1)
        self.noise = random.normal(size=(35, 7)).astype(np.float32)
        self.flat = np.full((35, 7), 1e10, np.float32)
        self.halves = random.normal(size=(35, 7)).astype(np.float16)

    def test_reads_floats_and_halves_packed_or_not(self):
        for compression in (0, 2, 3):
            for top in (0, 5, -3):
                with self.subTest(compression=compression, top=top):
                    wanted = {"A": self.noise, "X": self.flat, "Z": self.halves}
                    read = decode_exr(encode(wanted, compression, top=top))
                    self.assertEqual(list(read), ["A", "X", "Z"])
                    for name, values in wanted.items():
                        self.assertEqual(read[name].dtype, np.float32)
                        np.testing.assert_array_equal(read[name], values.astype(np.float32))

    def test_says_what_it_does_not_read(self):
        for bad, told in (
            (encode({"Z": self.flat}, version=2 | 0x200), "tiles"),
            (
                encode({"Z": self.flat}).replace(b"compression\0\x01\0\0\0\x03", b"compression\0\x01\0\0\0\x04"),
                "compression 4",
            ),
        ):
            with self.assertRaisesRegex(Error, told):
                decode_exr(bad)

    def test_damage_is_an_error_or_other_values_never_anything_else(self):
        good = encode({"Z": self.flat})
        for end in range(len(good)):
            with self.assertRaises(Error):
                decode_exr(good[:end])
        for place in range(len(good)):
            for flip in (0x01, 0x80, 0xFF):
                bad = bytearray(good)
                bad[place] ^= flip
                try:
                    decode_exr(bytes(bad))
                except Error as error:
                    self.assertEqual(error.kind, "corrupt")


if __name__ == "__main__":
    unittest.main()
