"""Polygons to masks, as the two families of readers draw them.

Points are float arrays of shape (n, 2), columns x and y, in pixels.
"""

from __future__ import annotations

import numpy as np

UPSAMPLING = 5  # of pycocotools


def _steps(lengths: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For edges of so many steps: which edge, and which step of it from 0 to its length."""
    counts = lengths + 1
    edge = np.repeat(np.arange(len(lengths)), counts)
    first = np.cumsum(counts) - counts
    return edge, np.arange(len(edge)) - first[edge]


def coco_polygon(points: np.ndarray, height: int, width: int) -> np.ndarray:
    """pycocotools' rleFrPoly: the outline on a grid five times finer, then column by column."""
    grid = np.trunc(UPSAMPLING * np.asarray(points, dtype=np.float64) + 0.5).astype(np.int64)
    start, end = grid, np.roll(grid, -1, axis=0)
    size = np.abs(end - start)
    flat = size[:, 0] >= size[:, 1]
    flip = np.where(flat, start[:, 0] > end[:, 0], start[:, 1] > end[:, 1])
    low = np.where(flip[:, None], end, start)
    high = np.where(flip[:, None], start, end)
    length = size.max(axis=1)
    rise = np.where(flat, high[:, 1] - low[:, 1], high[:, 0] - low[:, 0])
    slope = rise / np.maximum(length, 1)

    edge, step = _steps(length)
    t = np.where(flip[edge], length[edge] - step, step)
    aside = np.where(flat, low[:, 1], low[:, 0])[edge] + slope[edge] * t + 0.5
    aside = np.trunc(aside).astype(np.int64)
    u = np.where(flat[edge], low[edge, 0] + t, aside)
    v = np.where(flat[edge], aside, low[edge, 1] + t)

    moved = u[1:] != u[:-1]
    x = (np.where(u[1:] < u[:-1], u[1:], u[1:] - 1)[moved] + 0.5) / UPSAMPLING - 0.5
    y = (np.minimum(v[1:], v[:-1])[moved] + 0.5) / UPSAMPLING - 0.5
    on_column = (np.floor(x) == x) & (x >= 0) & (x <= width - 1)
    row = np.ceil(np.clip(y[on_column], 0, height)).astype(np.int64)
    flips = np.zeros(height * width + 1, dtype=np.int64)
    np.add.at(flips, x[on_column].astype(np.int64) * height + row, 1)
    inside = np.cumsum(flips[:-1]) % 2 == 1
    return inside.reshape(width, height).T


def coco_polygons(rings: list[list[float]], height: int, width: int) -> np.ndarray:
    """The union of an annotation's rings [x0, y0, x1, y1, ...]."""
    mask = np.zeros((height, width), dtype=bool)
    for ring in rings:
        if len(ring) < 6 or len(ring) % 2:
            raise ValueError(f"a ring of {len(ring)} numbers")
        mask |= coco_polygon(np.reshape(ring, (-1, 2)), height, width)
    return mask


def _paint_outline(mask: np.ndarray, start: np.ndarray, end: np.ndarray) -> None:
    """One pixel a step of the longer axis, from left to right; half-way cases stay behind."""
    swap = (start[:, 0] > end[:, 0])[:, None]
    start, end = np.where(swap, end, start), np.where(swap, start, end)
    run = end[:, 0] - start[:, 0]
    rise = np.abs(end[:, 1] - start[:, 1])
    down = np.where(end[:, 1] < start[:, 1], -1, 1)
    length, across = np.maximum(run, rise), np.minimum(run, rise)
    edge, i = _steps(length)
    twice = np.maximum(2 * length[edge], 1)
    aside = -((length[edge] - 2 * i * across[edge]) // twice)  # ceil((2 i across - length) / ...)
    flat = (run >= rise)[edge]
    x = start[edge, 0] + np.where(flat, i, aside)
    y = start[edge, 1] + down[edge] * np.where(flat, aside, i)
    inside = (x >= 0) & (y >= 0) & (x < mask.shape[1]) & (y < mask.shape[0])
    mask[y[inside], x[inside]] = True


def fill_polygon(points: np.ndarray, height: int, width: int) -> np.ndarray:
    """OpenCV's fillPoly for whole pixel coordinates: even-odd inside, and the outline itself."""
    mask = np.zeros((height, width), dtype=bool)
    start = np.asarray(points, dtype=np.int64)
    end = np.roll(start, -1, axis=0)
    _paint_outline(mask, start, end)

    slanted = start[:, 1] != end[:, 1]
    start, end = start[slanted], end[slanted]
    if len(start) == 0:
        return mask
    swap = (start[:, 1] > end[:, 1])[:, None]
    upper, lower = np.where(swap, end, start), np.where(swap, start, end)
    rows = lower[:, 1] - upper[:, 1]
    run = (lower[:, 0] - upper[:, 0]) << 16  # OpenCV counts in 1/65536 of a pixel
    slope = np.sign(run) * (np.abs(run) // rows)
    edge, step = _steps(rows - 1)
    y = upper[edge, 1] + step
    x = (upper[edge, 0] << 16) + slope[edge] * step
    order = np.lexsort((x, y))
    x, y = x[order], y[order]
    first = np.maximum((x[0::2] + 0xFFFF) >> 16, 0)
    last = np.minimum(x[1::2] >> 16, width - 1)
    drawn = (first <= last) & (y[0::2] >= 0) & (y[0::2] < height)
    changes = np.zeros((height, width + 1), dtype=np.int64)
    np.add.at(changes, (y[0::2][drawn], first[drawn]), 1)
    np.add.at(changes, (y[0::2][drawn], last[drawn] + 1), -1)
    return mask | (np.cumsum(changes[:, :-1], axis=1) > 0)


def yolo_polygon(numbers: np.ndarray, height: int, width: int) -> np.ndarray:
    """ultralytics: float32 shares of the sides, times the sides, truncated, filled."""
    points = np.asarray(numbers, dtype=np.float32).reshape(-1, 2)
    scaled = points * np.array([width, height], dtype=np.float32)
    return fill_polygon(scaled.astype(np.int32), height, width)
