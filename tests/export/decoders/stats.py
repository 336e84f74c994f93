"""Statistics: reads statistics.json and computes the same numbers from the frames."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from common import Annotation, Dataset
from source import Campaign, Frame, Instance

GRID = 8


def load(folder: Path) -> Dataset:
    """Statistics hold no annotations: all is in extras["document"]."""
    document = json.loads((Path(folder) / "statistics.json").read_text())
    splits: dict[str, list[str]] = {split: [] for split in document["splits"]}
    first = next(iter(document["splits"].values()), {"classes": {}})
    dataset = Dataset(sorted(first["classes"]), splits, [], extras={"document": document})
    if document["version"] != 1:
        dataset.problems.append(f"version {document['version']}")
    return dataset


def read(folder: Path) -> Iterator[Annotation]:
    """Nothing: for the signature that all decoders share."""
    yield from load(folder).annotations


def size_bin(pixels: int, edges: list[int]) -> int:
    """Bin of a square with so many pixels; beyond the last edge the last bin."""
    return next((i for i, edge in enumerate(edges) if pixels < edge * edge), len(edges) - 1)


def tenth(part: int, whole: int) -> int:
    """Bin 0 to 9 of a share; 1 belongs to the last. A share of nothing is 0."""
    return min(10 * part // whole, 9) if whole else 0


def cell(box: tuple[int, int, int, int], width: int, height: int) -> int:
    """Cell of the grid over the image, row by row, in which the centre of a box lies."""
    x, y, w, h = box
    column = (2 * x + w) * GRID // (2 * width)
    row = (2 * y + h) * GRID // (2 * height)
    return min(row, GRID - 1) * GRID + min(column, GRID - 1)


def _class(instances: list[tuple[Frame, Instance]], edges: list[int]) -> dict[str, Any]:
    sizes, visible, truncation = [0] * len(edges), [0] * 10, [0] * 10
    positions = [0] * (GRID * GRID)
    for frame, instance in instances:
        sizes[size_bin(instance.area, edges)] += 1
        visible[tenth(instance.area, instance.amodal_area)] += 1
        outside = instance.amodal_area - instance.in_image
        truncation[tenth(outside, instance.amodal_area)] += 1
        positions[cell(instance.visible_box, frame.width, frame.height)] += 1
    return {
        "images": len({frame.stem for frame, _ in instances}),
        "instances": len(instances),
        "pixels": sum(instance.area for _, instance in instances),
        "positions": positions,
        "size_histogram": sizes,
        "truncation_histogram": truncation,
        "visible_histogram": visible,
    }


def compute(campaign: Campaign, stems: list[str], edges: list[int]) -> dict[str, Any]:
    """What `splits.<split>` must hold; `edges`: of the size histogram."""
    frames = [campaign.frames[stem] for stem in stems]
    names = campaign.categories
    counts = [Counter(i.name for i in frame.instances) for frame in frames]
    per_image = Counter(len(frame.instances) for frame in frames)
    return {
        "images": len(frames),
        "background_images": per_image[0],
        "instances_per_image": [per_image[n] for n in range(max(per_image, default=-1) + 1)],
        "classes": {
            name: _class([(f, i) for f in frames for i in f.instances if i.name == name], edges)
            for name in names
        },
        "co_occurrence": {
            a: {b: sum(c[a] > (a == b) and c[b] > (a == b) for c in counts) for b in names}
            for a in names
        },
    }
