"""PNG files as Seedframe writes them, to NumPy: grey or RGB, 8 or 16 bits, not interlaced."""

from __future__ import annotations

import struct
import zlib
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import Error

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_NONE, _SUB, _UP, _AVERAGE, _PAETH = range(5)
_LONGEST_EXPANSION = 1032  # of deflate: a small file that states a large picture lies


def decode_png(data: bytes, what: str = "a PNG file") -> npt.NDArray[Any]:
    """The pixels of a PNG file.

    Args:
        data: the whole file.
        what: named by errors.

    Returns:
        uint8 or uint16, rows × columns for grey, rows × columns × 3 for RGB.

    Raises:
        Error: (``corrupt``) it is damaged, or of a kind that Seedframe does not write.

    """
    width, height, bits, channels, packed = _chunks(data, what)
    pixel_bytes = channels * bits // 8
    row_bytes = width * pixel_bytes
    size = height * (row_bytes + 1)
    if size > _LONGEST_EXPANSION * max(len(packed), 64):
        raise _damaged(what, "it is too short for the size that it states")
    try:
        inflater = zlib.decompressobj()
        raw = inflater.decompress(packed, size + 1)
    except zlib.error as why:
        raise _damaged(what, str(why)) from why
    if len(raw) != size or not inflater.eof:
        raise _damaged(what, f"its pixels are not {size} bytes")
    rows = np.frombuffer(raw, np.uint8).reshape(height, row_bytes + 1)
    filters = rows[:, 0]
    if filters.max() > _PAETH:
        raise _damaged(what, f"a row has filter {filters.max()}, and there are 0 to 4")
    values = _unfilter(filters, rows[:, 1:].reshape(height, width, pixel_bytes))
    shape = (height, width) if channels == 1 else (height, width, channels)
    if bits == 16:
        return values.reshape(height, -1).view(">u2").astype(np.uint16).reshape(shape)
    return values.reshape(shape)


def _chunks(data: bytes, what: str) -> tuple[int, int, int, int, bytes]:
    """Width, height, bits a channel, channels, and the packed pixels."""
    if data[:8] != _SIGNATURE:
        raise _damaged(what, "it does not begin as a PNG file does")
    place = 8
    header = b""
    packed = []
    while True:
        if place + 12 > len(data):
            raise _damaged(what, "it ends too early")
        length, kind = struct.unpack_from(">I4s", data, place)
        content = data[place + 8 : place + 8 + length]
        end = place + 8 + length
        if end + 4 > len(data):
            raise _damaged(what, "it ends too early")
        if zlib.crc32(content, zlib.crc32(kind)) != struct.unpack_from(">I", data, end)[0]:
            raise _damaged(what, f"the sum of its {kind.decode('latin-1')} is wrong")
        place = end + 4
        if kind == b"IHDR":
            header = content
        elif kind == b"IDAT":
            packed.append(content)
        elif kind == b"IEND":
            break
    if len(header) != 13:
        raise _damaged(what, "it has no header")
    width, height, bits, color, _, _, interlaced = struct.unpack(">IIBBBBB", header)
    if bits not in (8, 16) or color not in (0, 2) or interlaced or not width or not height:
        raise Error(
            f"{what}: expected a grey or RGB PNG with 8 or 16 bits a channel, not interlaced, as Seedframe writes; found "
            f"colour type {color}, {bits} bits{', interlaced' if interlaced else ''}",
            "corrupt",
        )
    return width, height, bits, 3 if color == 2 else 1, b"".join(packed)


def _damaged(what: str, why: str) -> Error:
    return Error(f"{what} is not the whole PNG file that was written: {why}; render the frame again", "corrupt")


def _unfilter(filters: npt.NDArray[np.uint8], rows: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """Values from rows × columns × bytes of a pixel, each predicted as its row's filter says (PNG, section 9)."""
    if np.all(filters == _NONE):
        return rows.copy()
    vertical = np.all((filters == _UP) | (filters == _NONE))
    if vertical and not np.any(filters[1:] == _NONE):
        return np.add.accumulate(rows, axis=0, dtype=np.uint8)
    if np.all((filters == _SUB) | (filters == _NONE)):
        values = np.add.accumulate(rows, axis=1, dtype=np.uint8)
        values[filters == _NONE] = rows[filters == _NONE]
        return values
    return _unfilter_by_diagonals(filters, rows)


def _unfilter_by_diagonals(filters: npt.NDArray[np.uint8], rows: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """A value needs those left of it and above it, so those of a diagonal need only the two diagonals before."""
    height, width, depth = rows.shape
    diagonals = width + height - 1
    # Each row begins one place further to the right than the one above: the rest of a longer row read as a shorter one.
    padded = np.zeros((height, width + height, depth), np.uint8)
    padded[:, :width] = rows
    skewed = padded.reshape(-1)[: height * diagonals * depth].reshape(height, diagonals, depth)
    # Two diagonals of zeros before the first, and one row of them above the first. What is left of the image is zero, and
    # stays so, as all that predicts it is zero; what is right of it is never looked at.
    values = np.zeros((diagonals + 2, height + 1, depth), np.uint8)
    values[2:, 1:] = skewed.transpose(1, 0, 2)
    predict = _predict_average if np.all(filters == _AVERAGE) else _Mixed(filters)
    low = np.empty((height, depth), np.uint8)
    for step in range(diagonals):
        left = values[step + 1, 1:]
        above = values[step + 1, :-1]
        beside = values[step, :-1]
        here = values[step + 2, 1:]
        np.add(here, predict(left, above, beside, low), out=here)
    # The way back: row r is diagonals r to r + width - 1.
    whole = np.zeros((height, width + height, depth), np.uint8)
    whole.reshape(-1)[: height * diagonals * depth] = values[2:, 1:].transpose(1, 0, 2).reshape(-1)
    return np.ascontiguousarray(whole[:, :width])


def _predict_average(left: Any, above: Any, beside: Any, low: Any) -> Any:
    """(left + above) // 2 without a carry."""
    half = np.bitwise_xor(left, above, out=low)
    np.right_shift(half, 1, out=half)
    return np.add(half, left & above, out=half)


class _Mixed:
    """Predictions of rows with filters of their own."""

    def __init__(self, filters: npt.NDArray[np.uint8]) -> None:
        self._rows = [(kind, np.nonzero(filters == kind)[0]) for kind in (_SUB, _UP, _AVERAGE, _PAETH)]
        self._rows = [(kind, rows) for kind, rows in self._rows if len(rows)]

    def __call__(self, left: Any, above: Any, beside: Any, low: Any) -> Any:
        low[:] = 0
        for kind, rows in self._rows:
            if kind == _SUB:
                low[rows] = left[rows]
            elif kind == _UP:
                low[rows] = above[rows]
            elif kind == _AVERAGE:
                low[rows] = (left[rows].astype(np.uint16) + above[rows]) >> 1
            else:
                low[rows] = _paeth(
                    left[rows].astype(np.int16), above[rows].astype(np.int16), beside[rows].astype(np.int16)
                )
        return low


def _paeth(left: Any, above: Any, beside: Any) -> Any:
    guess = left + above - beside
    to_left, to_above, to_beside = (np.abs(guess - each) for each in (left, above, beside))
    return np.where(
        (to_left <= to_above) & (to_left <= to_beside), left, np.where(to_above <= to_beside, above, beside)
    )
