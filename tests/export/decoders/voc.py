"""Pascal VOC: boxes from the XML, masks from the two palette images.

Corners in the XML are 1-based and inclusive; boxes here are (x, y, width, height) from 0.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from common import Annotation, Dataset, image_readers
from PIL import Image


def colour_map() -> np.ndarray:
    """VOC's 256 colours (256, 3): the bits of the index go to R, G, B in turn, highest first."""
    colours = np.zeros((256, 3), dtype=np.uint8)
    index = np.arange(256)
    for place in range(8):
        for channel in range(3):
            bit = (index >> (3 * place + channel)) & 1
            colours[:, channel] |= (bit << (7 - place)).astype(np.uint8)
    return colours


def read_palette_image(path: Path) -> np.ndarray:
    """Indices (height, width) of a palette image; ValueError unless its colours are VOC's."""
    image = Image.open(path)
    if image.mode != "P":
        raise ValueError(f"{path.parent.name}/{path.name}: mode {image.mode}, not a palette")
    indices = np.array(image)
    palette = np.reshape(image.getpalette(), (-1, 3))
    used = int(indices.max()) + 1
    if len(palette) < used or (palette[:used] != colour_map()[:used]).any():
        raise ValueError(f"{path.parent.name}/{path.name}: not VOC's colour map")
    return indices


def objects_of_xml(text: str) -> tuple[tuple[int, int], list[Annotation]]:
    """Size (width, height) and the objects, without masks, of an annotation file."""
    root = ET.fromstring(text)
    size = int(root.findtext("size/width", "")), int(root.findtext("size/height", ""))
    stem = Path(root.findtext("filename", "")).stem
    found = []
    for entry in root.iter("object"):
        left, top, right, bottom = (
            int(entry.findtext(f"bndbox/{key}", "")) for key in ("xmin", "ymin", "xmax", "ymax")
        )
        flags = {key: int(entry.findtext(key, "")) for key in ("truncated", "occluded")}
        flags["difficult"] = int(entry.findtext("difficult", ""))
        box = (left - 1, top - 1, right - left + 1, bottom - top + 1)
        found.append(Annotation(stem, "", entry.findtext("name", ""), None, box, flags))
    return size, found


def read_labelmap(path: Path) -> list[str]:
    """Classes of labelmap.txt without the background; ValueError for a foreign colour."""
    names = []
    for index, line in enumerate(path.read_text().splitlines()):
        name, colour, *_ = line.rsplit(":", 3)
        if colour != ",".join(str(value) for value in colour_map()[index]):
            raise ValueError(f"labelmap.txt: {name} has the colour {colour}")
        names.append(name)
    if names[:1] != ["background"]:
        raise ValueError("labelmap.txt does not begin with background")
    return names[1:]


def read_class_sets(folder: Path) -> dict[str, dict[str, int]]:
    """ImageSets/Main/<class>_<split>.txt: name of the file -> stem -> 1 or -1."""
    sets = {}
    for path in sorted((folder / "VOCdevkit/VOC2012/ImageSets/Main").glob("*_*.txt")):
        rows = [line.split() for line in path.read_text().splitlines()]
        sets[path.stem] = {stem: int(value) for stem, value in rows}
    return sets


def _add_masks(base: Path, stem: str, names: list[str], found: list[Annotation]) -> list[str]:
    """Object n of the XML has the value n; returns what is wrong with the two images."""
    objects = read_palette_image(base / "SegmentationObject" / f"{stem}.png")
    classes = read_palette_image(base / "SegmentationClass" / f"{stem}.png")
    problems = []
    expected = np.zeros(len(found) + 1, dtype=np.uint8)
    for number, annotation in enumerate(found, 1):
        annotation.mask = objects == number
        expected[number] = names.index(annotation.name) + 1
    if objects.max(initial=0) > len(found):
        problems.append(f"{stem}: more objects in SegmentationObject than in the XML")
    elif objects.shape != classes.shape or (expected[objects] != classes).any():
        problems.append(f"{stem}: SegmentationClass is not the class of SegmentationObject")
    return problems


def load(folder: Path) -> Dataset:
    """Everything in `OUT/voc`."""
    folder = Path(folder)
    base = folder / "VOCdevkit/VOC2012"
    dataset = Dataset(read_labelmap(base / "labelmap.txt"), {}, [])
    dataset.images = image_readers(base / "JPEGImages", {".jpg"})
    main, segmentation = base / "ImageSets/Main", base / "ImageSets/Segmentation"
    for path in sorted(segmentation.glob("*.txt")):
        split = path.stem
        stems = path.read_text().split()
        dataset.splits[split] = stems
        if (main / path.name).read_text().split() != stems:
            dataset.problems.append(f"{path.name}: Main and Segmentation differ")
        for stem in stems:
            text = (base / "Annotations" / f"{stem}.xml").read_text()
            (width, height), found = objects_of_xml(text)
            dataset.problems += _add_masks(base, stem, dataset.categories, found)
            for annotation in found:
                annotation.split = split
                if annotation.stem != stem or annotation.mask.shape != (height, width):
                    dataset.problems.append(f"{stem}: the XML is of another image")
            dataset.annotations += found
    stems = {stem for split in dataset.splits.values() for stem in split}
    for name in ("Annotations", "SegmentationClass", "SegmentationObject"):
        if {path.stem for path in (base / name).iterdir()} != stems:
            dataset.problems.append(f"{name}: other files than ImageSets says")
    dataset.extras["class_sets"] = read_class_sets(folder)
    return dataset


def read(folder: Path) -> Iterator[Annotation]:
    """The annotations of all splits."""
    yield from load(folder).annotations


def folder_names(categories: list[str]) -> list[str]:
    """Classes as file names: letters, digits, `_`, `-`, `.`; else `_` and `~<number>` behind."""
    names: list[str] = []
    for number, category in enumerate(categories, 1):
        plain = "".join(c if c.isascii() and (c.isalnum() or c in "_-.") else "_" for c in category)
        names.append(plain if plain == category and plain not in names else f"{plain}~{number}")
    return names
