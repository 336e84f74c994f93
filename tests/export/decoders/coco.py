"""COCO instances, keypoints and panoptic, as pycocotools and panopticapi read them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import polygons
import rle
from common import Annotation, Dataset, image_readers
from PIL import Image

KINDS = {
    "coco": "instances",
    "coco-polygon": "instances",
    "coco-keypoints": "person_keypoints",
    "coco-panoptic": "panoptic",
}


def mask_of(segmentation: dict | list, height: int, width: int) -> np.ndarray:
    """Run lengths or rings to a mask (height, width)."""
    if isinstance(segmentation, dict):
        if segmentation["size"] != [height, width]:
            raise ValueError(f"run lengths of {segmentation['size']}, image {height} x {width}")
        return rle.decode(segmentation)
    return polygons.coco_polygons(segmentation, height, width)


def annotation_of(entry: dict, image: dict, name: str, split: str) -> Annotation:
    """One entry of `annotations`; everything but mask and box goes to `extras`."""
    size = image["height"], image["width"]
    extras = {k: v for k, v in entry.items() if k not in ("bbox", "visible_segmentation")}
    if "visible_segmentation" in entry:
        extras["visible_mask"] = mask_of(entry["visible_segmentation"], *size)
    mask = mask_of(entry["segmentation"], *size)
    return Annotation(
        Path(image["file_name"]).stem, split, name, mask, tuple(entry["bbox"]), extras
    )


def _panoptic(
    folder: Path, document: dict, images: dict[int, dict], split: str, stuff: dict[str, list]
) -> Iterator[Annotation]:
    """Things of the split's RGB images: id = R + 256 G + 65536 B, 0 is void. What is stuff goes to
    `stuff`: (segment, mask) by stem."""
    categories = {category["id"]: category for category in document["categories"]}
    for entry in document["annotations"]:
        image = images[entry["image_id"]]
        picture = Image.open(folder / "annotations" / f"panoptic_{split}" / entry["file_name"])
        if picture.mode != "RGB":
            raise ValueError(f"{entry['file_name']}: {picture.mode} instead of RGB")
        ids = np.array(picture).astype(np.int64) @ np.array([1, 256, 65536])
        listed = [segment["id"] for segment in entry["segments_info"]]
        if ids.shape != (image["height"], image["width"]):
            raise ValueError(f"{entry['file_name']}: not of the image's size")
        if sorted(listed) != sorted(set(np.unique(ids).tolist()) - {0}):
            raise ValueError(f"{entry['file_name']}: other segments than segments_info")
        stem = Path(image["file_name"]).stem
        for segment in entry["segments_info"]:
            category = categories[segment["category_id"]]
            if not category["isthing"]:
                stuff.setdefault(stem, []).append((segment, ids == segment["id"]))
                continue
            yield Annotation(
                stem,
                split,
                category["name"],
                ids == segment["id"],
                tuple(segment["bbox"]),
                {k: v for k, v in segment.items() if k != "bbox"},
            )


def load(folder: Path) -> Dataset:
    """Everything in `OUT/coco`, `OUT/coco-polygon`, `OUT/coco-keypoints`, `OUT/coco-panoptic`."""
    folder = Path(folder)
    kind = KINDS[folder.name]
    dataset = Dataset([], {}, [], extras={"kind": kind, "images": {}, "categories": []})
    for path in sorted(folder.glob(f"annotations/{kind}_*.json")):
        split = path.stem.removeprefix(f"{kind}_")
        document = json.loads(path.read_text())
        categories = document["categories"]
        names = {category["id"]: category["name"] for category in categories}
        if list(names) != list(range(1, len(categories) + 1)):
            dataset.problems.append(f"{path.name}: category ids are not 1, 2, ...")
        if dataset.extras["categories"] not in ([], categories):
            dataset.problems.append(f"{path.name}: other categories than another split")
        dataset.extras["categories"] = categories
        dataset.categories = [c["name"] for c in categories if c.get("isthing", 1)]
        images = {image["id"]: image for image in document["images"]}
        if len(images) != len(document["images"]):
            dataset.problems.append(f"{path.name}: an image id occurs twice")
        dataset.splits[split] = [Path(i["file_name"]).stem for i in document["images"]]
        for image in document["images"]:
            dataset.extras["images"][Path(image["file_name"]).stem] = image
        if kind == "panoptic":
            if [e["image_id"] for e in document["annotations"]] != list(images):
                dataset.problems.append(f"{path.name}: not one annotation for each image")
            stuff = dataset.extras.setdefault("stuff", {})
            found = _panoptic(folder, document, images, split, stuff)
            dataset.annotations += list(found)
        else:
            dataset.annotations += [
                annotation_of(e, images[e["image_id"]], names[e["category_id"]], split)
                for e in document["annotations"]
            ]
        dataset.images.update(image_readers(folder / "images" / split))
    return dataset


def read(folder: Path) -> Iterator[Annotation]:
    """The annotations of all splits."""
    yield from load(folder).annotations
