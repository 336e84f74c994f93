"""Classification patches, as torchvision's ImageFolder finds them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from common import Annotation, Dataset
from PIL import Image

CLASSES = "classes.json"


def load(folder: Path) -> Dataset:
    """Everything in `OUT/patches`. extras of an annotation: `id`, `pixels` (height, width, 3)."""
    folder = Path(folder)
    classes = json.loads((folder / CLASSES).read_text())
    names = {entry["folder"]: entry["name"] for entry in classes}
    dataset = Dataset([entry["name"] for entry in classes], {}, [])
    dataset.extras["folders"] = list(names)
    found: dict[tuple, str] = {}  # the folders of classes are the same in every split
    for split_folder in sorted(path for path in folder.iterdir() if path.is_dir()):
        split = split_folder.name
        folders = sorted(path.name for path in split_folder.iterdir())
        found.setdefault(tuple(folders), split)
        if set(folders) - set(names) or len(found) > 1:
            dataset.problems.append(f"{split}: folders {folders}")
        stems = set()
        for path in sorted(split_folder.glob("*/*")):
            stem, _, number = path.stem.partition("_")
            image = Image.open(path)
            if path.suffix != ".png" or image.mode != "RGB" or len(number) != 5:
                dataset.problems.append(f"{split}/{path.parent.name}/{path.name}: no RGB patch")
                continue
            extras = {"id": int(number), "pixels": np.array(image)}
            name = names.get(path.parent.name, "")
            dataset.annotations.append(Annotation(stem, split, name, None, None, extras))
            stems.add(stem)
        dataset.splits[split] = sorted(stems)
    shown = {annotation.name for annotation in dataset.annotations}
    wanted = {folder for folder, name in names.items() if name in shown}
    for folders in found:
        if set(folders) != wanted:
            dataset.problems.append(f"folders {folders}, patches in {sorted(wanted)}")
    return dataset


def read(folder: Path) -> Iterator[Annotation]:
    """The patches of all splits."""
    yield from load(folder).annotations
