"""YOLO's four kinds of label files, with ultralytics' arithmetic.

Rows are shares of the image's sides. The size of an image is not in the labels: it is read from
the image, or, for exports without images, given as `sizes`.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
import polygons
import yaml
from common import Annotation, Box, Dataset, image_readers
from PIL import Image

SPLITS = ("train", "val", "test")


def box_of_points(points: np.ndarray) -> Box:
    """Box (x, y, width, height) around points (n, 2)."""
    low, high = points.min(axis=0), points.max(axis=0)
    return (float(low[0]), float(low[1]), float(high[0] - low[0]), float(high[1] - low[1]))


def box_of_centre(numbers: np.ndarray, width: int, height: int) -> Box:
    """Box in pixels of shares (x centre, y centre, width, height)."""
    x, y, w, h = (float(number) for number in numbers)
    return ((x - w / 2) * width, (y - h / 2) * height, w * width, h * height)


def annotation_of(
    kind: str, line: str, names: list[str], size: tuple[int, int], shape: list[int] | None
) -> Annotation:
    """One row; `size` is (width, height), `shape` the pose's [points, numbers a point].

    extras: `corners` (4, 2) pixels for obb, `points` (K, 3) pixels and visibility for pose.
    """
    words = line.split()
    category = int(words[0])
    if not 0 <= category < len(names):
        raise ValueError(f"class {category}")
    numbers = np.array([float(word) for word in words[1:]])
    width, height = size
    annotation = Annotation("", "", names[category])
    columns = {"detect": 4, "obb": 8, "pose": 4 + (shape[0] * shape[1] if shape else 0)}.get(kind)
    if len(numbers) != columns and (kind != "segment" or len(numbers) < 6 or len(numbers) % 2):
        raise ValueError(f"a row of {len(words)} columns")
    shares = numbers if kind != "pose" else np.delete(numbers, np.s_[6 :: shape[1]])
    if not ((shares >= 0) & (shares <= 1)).all():
        raise ValueError("coordinates outside [0, 1]")
    if kind in ("detect", "pose"):
        annotation.box = box_of_centre(numbers[:4], width, height)
    if kind == "pose":
        points = numbers[4:].reshape(shape)
        annotation.extras["points"] = points * np.array([width, height, 1])
    if kind == "segment":
        annotation.mask = polygons.yolo_polygon(numbers, height, width)
        annotation.box = box_of_points(numbers.reshape(-1, 2) * np.array([width, height]))
    if kind == "obb":
        annotation.extras["corners"] = numbers.reshape(4, 2) * np.array([width, height])
    return annotation


def load(folder: Path, sizes: Mapping[str, tuple[int, int]] | None = None) -> Dataset:
    """Everything in `OUT/yolo-<kind>`; `sizes`: stem -> (width, height)."""
    folder = Path(folder)
    kind = folder.name.removeprefix("yolo-")
    settings = yaml.safe_load((folder / "data.yaml").read_text())
    names = [settings["names"][i] for i in range(len(settings["names"]))]
    dataset = Dataset(names, {}, [], extras={"settings": settings, "kind": kind})
    counted = yaml.safe_load((folder / "data_with_nc.yaml").read_text())
    if counted.pop("nc") != len(names) or counted.pop("names") != names:
        dataset.problems.append("data_with_nc.yaml: other classes than data.yaml")
    dataset.extras["kpt_names"] = counted.pop("kpt_names", None)
    if counted != {key: value for key, value in settings.items() if key != "names"}:
        dataset.problems.append("data_with_nc.yaml: other splits than data.yaml")
    if settings.keys() - {"train", "val", "test", "names", "kpt_shape", "flip_idx"}:
        dataset.problems.append(f"data.yaml: keys {sorted(settings)}")
    if "path" in settings:
        dataset.problems.append("data.yaml: has a path, the folder cannot be moved")
    for key in ("train", "val"):
        if key not in settings:
            dataset.problems.append(f"data.yaml: no {key}")
    for split in SPLITS:
        labels = folder / "labels" / split
        images = image_readers(folder / "images" / split)
        if not labels.is_dir():
            continue
        if split != "val" and settings.get(split) != f"images/{split}":
            dataset.problems.append(f"data.yaml: {split} is {settings.get(split)}")
        files = sorted(labels.iterdir())
        dataset.splits[split] = [path.stem for path in files]
        if images and set(images) != set(dataset.splits[split]):
            dataset.problems.append(f"{split}: not one label file for each image")
        dataset.images.update(images)
        for path in files:
            if sizes is None:
                size = Image.open(io.BytesIO(images[path.stem]())).size
            else:
                size = sizes[path.stem]
            for number, line in enumerate(path.read_text().splitlines(), 1):
                try:
                    found = annotation_of(kind, line, names, size, settings.get("kpt_shape"))
                except ValueError as error:
                    dataset.problems.append(f"{path.name}:{number}: {error}")
                    continue
                found.stem, found.split = path.stem, split
                dataset.annotations.append(found)
    val = "images/val" if dataset.splits.get("val") else "images/train"
    if settings.get("val") not in (val, "images/val"):
        dataset.problems.append(f"data.yaml: val is {settings.get('val')}")
    return dataset


def read(folder: Path, sizes: Mapping[str, tuple[int, int]] | None = None) -> Iterator[Annotation]:
    """The annotations of all splits."""
    yield from load(folder, sizes).annotations
