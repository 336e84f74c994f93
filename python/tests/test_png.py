import struct
import unittest
import zlib

import numpy as np
import support  # noqa: F401, so that the package is found

from seedframe import Error
from seedframe.png import decode_png


def chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def encode(values, filters, interlaced=0, color=None):
    """A PNG whose row r has filter filters[r]; written by the definition, a byte at a time."""
    height, width = values.shape[:2]
    channels = 1 if values.ndim == 2 else values.shape[2]
    rows = values.astype(values.dtype.newbyteorder(">")).reshape(height, -1).view(np.uint8).astype(int)
    step = channels * values.dtype.itemsize
    raw = bytearray()
    for r in range(height):
        raw.append(filters[r])
        for i in range(rows.shape[1]):
            a = rows[r, i - step] if i >= step else 0
            b = rows[r - 1, i] if r > 0 else 0
            c = rows[r - 1, i - step] if r > 0 and i >= step else 0
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            raw.append((rows[r, i] - (0, a, b, (a + b) // 2, paeth)[filters[r]]) % 256)
    color = (2 if channels == 3 else 0) if color is None else color
    header = struct.pack(">IIBBBBB", width, height, values.dtype.itemsize * 8, color, 0, 0, interlaced)
    packed = zlib.compress(bytes(raw))
    half = len(packed) // 2
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        chunk(*each) for each in ((b"IHDR", header), (b"IDAT", packed[:half]), (b"IDAT", packed[half:]), (b"IEND", b""))
    )


class Png(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(1)

    def test_reads_every_filter_type_and_shape(self):
        for kind in (np.uint8, np.uint16):
            for shape in ((7, 11), (11, 7), (1, 9), (9, 1), (1, 1), (6, 5, 3), (1, 4, 3), (5, 1, 3)):
                values = self.random.integers(0, np.iinfo(kind).max + 1, shape).astype(kind)
                for filters in [[f] * shape[0] for f in range(5)] + [self.random.integers(0, 5, shape[0]).tolist()]:
                    with self.subTest(kind=kind, shape=shape, filters=filters):
                        read = decode_png(encode(values, filters))
                        self.assertEqual(read.dtype, kind)
                        np.testing.assert_array_equal(read, values)

    def test_extreme_values_wrap(self):
        values = np.full((8, 8), 255, np.uint8)
        values[::2] = 0
        for f in range(5):
            np.testing.assert_array_equal(decode_png(encode(values, [f] * 8)), values)

    def test_refuses_what_seedframe_does_not_write(self):
        values = np.zeros((2, 2), np.uint8)
        for damage in ({"interlaced": 1}, {"color": 3}, {"color": 6}):
            with self.assertRaisesRegex(Error, "expected a grey or RGB PNG") as caught:
                decode_png(encode(values, [0, 0], **damage), "x.png")
            self.assertEqual(caught.exception.kind, "corrupt")

    def test_damage_is_an_error_whatever_it_is(self):
        good = encode(self.random.integers(0, 256, (6, 5, 3)).astype(np.uint8), [1, 2, 3, 4, 0, 3])
        for end in range(len(good)):
            with self.assertRaises(Error):
                decode_png(good[:end])
        for place in range(len(good)):
            bad = bytearray(good)
            bad[place] ^= 0x15
            with self.assertRaises(Error, msg=f"byte {place}"):
                decode_png(bytes(bad))

    def test_a_small_file_cannot_ask_for_much_memory(self):
        header = struct.pack(">IIBBBBB", 1 << 20, 1 << 20, 16, 2, 0, 0, 0)
        data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"")) + chunk(b"IEND", b"")
        with self.assertRaisesRegex(Error, "too short for the size"):
            decode_png(data)


if __name__ == "__main__":
    unittest.main()
