"""EXR files of depth and normals as Seedframe writes them, to NumPy: one part of scan lines, floats or halves, ZIP.

All else is refused by name: OpenEXR's own module reads it.
"""

from __future__ import annotations

import struct
import zlib
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import Error

_MAGIC = 20000630
_FLAGS_OF_OTHERS = 0x200 | 0x800 | 0x1000  # tiled, deep, several parts
_LINES = {0: 1, 2: 1, 3: 16}  # of a block, by compression: none, ZIPS, ZIP
_TYPES: dict[int, np.dtype[Any]] = {1: np.dtype("<f2"), 2: np.dtype("<f4")}
_MOST_PIXELS = 1 << 28


def decode_exr(data: bytes, what: str = "an EXR file") -> dict[str, npt.NDArray[np.float32]]:
    """The channels of an EXR file by their names.

    Args:
        data: the whole file.
        what: named by errors.

    Returns:
        For each channel float32, rows × columns.

    Raises:
        Error: (``corrupt``) it is damaged, or of a kind that Seedframe does not write.

    """
    try:
        return _decode(data, what)
    except (struct.error, zlib.error, ValueError, IndexError, OverflowError) as why:
        raise Error(
            f"{what} is not the whole EXR file that was written ({why}); render the frame again", "corrupt"
        ) from why


def _decode(data: bytes, what: str) -> dict[str, npt.NDArray[np.float32]]:
    magic, version = struct.unpack_from("<II", data)
    if magic != _MAGIC:
        raise ValueError("it does not begin as an EXR file does")
    if version & 0xFF != 2 or version & _FLAGS_OF_OTHERS:
        raise _other_kind(what, "tiles, deep data or several parts")
    header, place = _attributes(data, 8)
    compression = header["compression"][0]
    if compression not in _LINES:
        raise _other_kind(what, f"compression {compression}")
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    if not (width > 0 and height > 0 and width * height <= _MOST_PIXELS):
        raise ValueError(f"it says that it has {width} × {height} pixels")
    channels = _channels(header["channels"], what)
    line_bytes = width * sum(kind.itemsize for _, kind in channels)
    lines = _LINES[compression]
    blocks = -(-height // lines)
    values = np.empty((height, line_bytes), np.uint8)
    for offset in struct.unpack_from(f"<{blocks}Q", data, place):
        line, packed_bytes = struct.unpack_from("<ii", data, offset)
        first = line - top
        count = min(lines, height - first)
        if first < 0 or first % lines or count <= 0 or packed_bytes < 0:
            raise ValueError(f"it has a block at line {line}")
        packed = data[offset + 8 : offset + 8 + packed_bytes]
        values[first : first + count] = _unpacked(packed, count * line_bytes, compression).reshape(count, line_bytes)
    planes = {}
    begin = 0
    for name, kind in channels:
        plane = np.ascontiguousarray(values[:, begin : begin + width * kind.itemsize])
        planes[name] = plane.view(kind).astype(np.float32)
        begin += width * kind.itemsize
    return planes


def _other_kind(what: str, found: str) -> Error:
    return Error(
        f"{what}: expected scan lines of floats, plain or packed by ZIP, as Seedframe writes them; found {found}: read it "
        "with OpenEXR",
        "corrupt",
    )


def _attributes(data: bytes, place: int) -> tuple[dict[str, bytes], int]:
    """The header, and where it ends."""
    attributes = {}
    while data[place] != 0:
        name_end = data.index(b"\0", place)
        kind_end = data.index(b"\0", name_end + 1)
        (size,) = struct.unpack_from("<i", data, kind_end + 1)
        begin = kind_end + 5
        if size < 0 or begin + size > len(data):
            raise ValueError("it ends in its header")
        attributes[data[place:name_end].decode()] = data[begin : begin + size]
        place = begin + size
    for needed in ("channels", "compression", "dataWindow"):
        if needed not in attributes:
            raise ValueError(f"its header has no {needed}")
    return attributes, place + 1


def _channels(listed: bytes, what: str) -> list[tuple[str, np.dtype[Any]]]:
    channels = []
    place = 0
    while listed[place] != 0:
        end = listed.index(b"\0", place)
        name = listed[place:end].decode()
        kind, _, x_step, y_step = struct.unpack_from("<iiii", listed, end + 1)
        if kind not in _TYPES or (x_step, y_step) != (1, 1):
            raise _other_kind(what, f"channel {name} of another type, or not in every pixel")
        channels.append((name, _TYPES[kind]))
        place = end + 17
    return channels


def _unpacked(packed: bytes, size: int, compression: int) -> npt.NDArray[np.uint8]:
    if compression == 0 or len(packed) == size:  # what packing would not have made smaller is left as it is
        if len(packed) != size:
            raise ValueError("a block is too short")
        return np.frombuffer(packed, np.uint8)
    inflater = zlib.decompressobj()
    raw = inflater.decompress(packed, size + 1)
    if len(raw) != size or not inflater.eof:
        raise ValueError("a block is too short, or too long")
    # Differences, biased by 128; then the first half of the bytes are those at even places.
    steps = np.frombuffer(raw, np.uint8).copy()
    steps[1:] -= 128
    halves = np.add.accumulate(steps, dtype=np.uint8)
    values = np.empty(size, np.uint8)
    middle = (size + 1) // 2
    values[0::2] = halves[:middle]
    values[1::2] = halves[middle:]
    return values
