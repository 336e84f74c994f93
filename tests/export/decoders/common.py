"""What all decoders hand out, and the few measures of masks that several of them need.

Masks are bool arrays of shape (height, width), row 0 at the top. Pixel (r, c) covers
[c, c+1) x [r, r+1); boxes are (x, y, width, height) in these coordinates.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

Box = tuple[float, float, float, float]


@dataclass
class Annotation:
    """One object of one image, as a format's own reader would see it."""

    stem: str  # file name of the image without folder and suffix: "000042"
    split: str
    name: str  # class
    mask: np.ndarray | None = None
    box: Box | None = None
    extras: dict[str, Any] = field(default_factory=dict)


@dataclass
class Dataset:
    """All that one export holds."""

    categories: list[str]
    splits: dict[str, list[str]]  # split -> stems in the format's order
    annotations: list[Annotation]
    images: dict[str, Callable[[], bytes]] = field(default_factory=dict)  # stem -> file's bytes
    scenes: dict[str, int] = field(default_factory=dict)  # stem -> scene, where the format says it
    problems: list[str] = field(default_factory=list)  # faults that reading alone shows
    extras: dict[str, Any] = field(default_factory=dict)

    def of_image(self, stem: str) -> list[Annotation]:
        """The annotations of one image, in the format's order."""
        if "by_stem" not in self.__dict__:
            self.__dict__["by_stem"] = by_stem = {}
            for annotation in self.annotations:
                by_stem.setdefault(annotation.stem, []).append(annotation)
        return self.__dict__["by_stem"].get(stem, [])


# Endings of pictures, and what PIL calls their formats.
PICTURES = {".png": "PNG", ".jpg": "JPEG", ".webp": "WEBP", ".tif": "TIFF"}


def image_readers(
    folder: Path, suffixes: Collection[str] = PICTURES
) -> dict[str, Callable[[], bytes]]:
    """Readers of the images directly in a folder; none if there is no such folder."""
    if not folder.is_dir():
        return {}
    return {p.stem: p.read_bytes for p in sorted(folder.iterdir()) if p.suffix in suffixes}


def tight_box(mask: np.ndarray) -> tuple[int, int, int, int]:
    """Smallest box around the set pixels; (0, 0, 0, 0) when there is none."""
    columns = np.flatnonzero(mask.any(axis=0))
    if columns.size == 0:
        return (0, 0, 0, 0)
    rows = np.flatnonzero(mask.any(axis=1))
    return (
        int(columns[0]),
        int(rows[0]),
        int(columns[-1] - columns[0] + 1),
        int(rows[-1] - rows[0] + 1),
    )


def iou(a: np.ndarray, b: np.ndarray) -> float:
    """Intersection over union of two masks; 1 when both are empty."""
    union = np.count_nonzero(a | b)
    return np.count_nonzero(a & b) / union if union else 1.0


def count_parts(mask: np.ndarray) -> int:
    """Number of 8-connected components of the set pixels."""
    padded = np.zeros((mask.shape[0], mask.shape[1] + 2), dtype=np.int8)
    padded[:, 1:-1] = mask
    steps = np.diff(padded, axis=1)
    parent: list[int] = []

    def root(i: int) -> int:
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    above: list[tuple[int, int, int]] = []  # runs of the row above: first, past the last, number
    for row in steps:
        here = []
        for start, end in zip(np.flatnonzero(row == 1), np.flatnonzero(row == -1), strict=True):
            number = len(parent)
            parent.append(number)
            here.append((int(start), int(end), number))
            for other_start, other_end, other in above:
                if other_start <= end and start <= other_end:
                    parent[root(other)] = root(number)
        above = here
    return sum(parent[i] == i for i in range(len(parent)))
