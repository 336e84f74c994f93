"""What must hold for every format: the images, the splits, and masks, boxes and classes."""

from __future__ import annotations

import numpy as np
from common import Annotation, Dataset, iou
from PIL import Image
from source import Campaign, Frame, Instance

SHOWN = 10


class Report:
    """Differences of one format, and remarks that are none."""

    def __init__(self, name: str):
        self.name = name
        self.differences: list[str] = []
        self.remarks: list[str] = []

    def check(self, good: bool, text: str) -> bool:
        """Notes the text as a difference unless `good`."""
        if not good:
            self.differences.append(text)
        return bool(good)

    def lines(self, summary: str) -> list[str]:
        """One line, or the first differences and their number; then the remarks."""
        count = len(self.differences)
        lines = [f"{self.name}: {summary}, " + (f"{count} differences" if count else "all equal")]
        lines += [f"  {text}" for text in self.differences[:SHOWN]]
        lines += [f"  ... {count - SHOWN} more"] if count > SHOWN else []
        return lines + [f"  note: {text}" for text in self.remarks]


def compare_images(dataset: Dataset, campaign: Campaign, report: Report) -> None:
    """Every frame in one split, and its image byte for byte the campaign's."""
    stems = [stem for split in dataset.splits.values() for stem in split]
    report.check(len(stems) == len(set(stems)), "an image is listed twice")
    report.check(
        set(stems) == set(campaign.frames),
        f"images: {len(set(stems))}, frames: {len(campaign.frames)}",
    )
    for split, found in dataset.splits.items():
        report.check(found == sorted(found), f"{split}: images are not in the frames' order")
        report.check(split in ("train", "val", "test"), f"split {split}")
    report.check(bool(dataset.splits.get("train")), "nothing in train")
    expected = {stem for stem, frame in campaign.frames.items() if frame.image}
    report.check(
        set(dataset.images) == expected,
        f"{len(dataset.images)} image files, {len(expected)} frames with an image",
    )
    for stem in sorted(expected & set(dataset.images)):
        same = dataset.images[stem]() == campaign.frames[stem].image.read_bytes()
        report.check(same, f"{stem}: the image is not the campaign's")


def read_image(frame: Frame) -> np.ndarray:
    """The campaign's image, (height, width, 3) sRGB."""
    return np.array(Image.open(frame.image).convert("RGB"))


def compare_scenes(dataset: Dataset, scenes: dict[str, int], report: Report) -> None:
    """All frames of a scene in one split; `scenes`: stem -> scene."""
    homes: dict[int, set[str]] = {}
    for split, stems in dataset.splits.items():
        for stem in stems:
            if stem in scenes:
                homes.setdefault(scenes[stem], set()).add(split)
    for scene, splits in homes.items():
        report.check(len(splits) == 1, f"scene {scene} is in {', '.join(sorted(splits))}")


def compare_splits(datasets: dict[str, Dataset], reports: dict[str, Report]) -> None:
    """All formats have split the frames in the same way as the first."""
    first: dict[str, set[str]] = {}
    for name, dataset in datasets.items():
        if name in ("statistics", "patches"):  # statistics have no images, patches not all of them
            continue
        splits = {split: set(stems) for split, stems in dataset.splits.items() if stems}
        first = first or splits
        reports[name].check(splits == first, "other splits than the format before")


def pair(
    dataset: Dataset, frame: Frame, instances: list[Instance], report: Report
) -> list[tuple[Instance, Annotation]]:
    """Instances and annotations of one image in their order, which all formats keep."""
    found = dataset.of_image(frame.stem)
    report.check(
        len(found) == len(instances),
        f"{frame.stem}: {len(found)} annotations, {len(instances)} instances",
    )
    return list(zip(instances, found, strict=False))


def same_mask(
    where: str, mask: np.ndarray | None, expected: np.ndarray, report: Report, what: str = "mask"
) -> None:
    """Bit for bit."""
    if mask is None or mask.shape != expected.shape:
        report.check(False, f"{where}: no {what} of the image's size")
    elif (mask != expected).any():
        off = np.count_nonzero(mask != expected)
        report.check(False, f"{where}: {what}: {off} pixels differ, IoU {iou(mask, expected):.4f}")


def same_box(
    where: str, box: tuple | None, expected: tuple, report: Report, tolerance: float = 0.0
) -> None:
    """Each of the four sides within the tolerance, in pixels."""
    if box is None:
        report.check(False, f"{where}: no box")
        return
    sides = np.array([box[0], box[1], box[0] + box[2], box[1] + box[3]])
    x, y, w, h = expected
    error = np.abs(sides - np.array([x, y, x + w, y + h])).max()
    report.check(error <= tolerance, f"{where}: box {box}, not {expected}")


def compare_annotations(
    dataset: Dataset,
    campaign: Campaign,
    report: Report,
    *,
    masks: bool = True,
    boxes: bool = True,
    tolerance: float = 0.0,
    bop: bool = False,
    keypoint_classes: set[str] | None = None,
) -> list[tuple[Frame, Instance, Annotation]]:
    """Classes, masks and boxes of every image; returns the pairs. With `bop`, names are assets and
    masks and boxes those of the visible pixels. `keypoint_classes`: only instances of these."""
    pairs = []
    for stem, frame in campaign.frames.items():
        instances = frame.instances
        if keypoint_classes is not None:
            instances = [i for i in instances if i.name in keypoint_classes]
        for instance, annotation in pair(dataset, frame, instances, report):
            where = f"{stem}/{instance.id}"
            name = instance.asset if bop else instance.name
            report.check(annotation.name == name, f"{where}: {annotation.name}, not {name}")
            if masks:
                mask = instance.visible if bop else instance.mask
                same_mask(where, annotation.mask, mask, report)
            if boxes:
                box = instance.visible_box if bop else instance.box
                same_box(where, annotation.box, box, report, tolerance)
            pairs.append((frame, instance, annotation))
    return pairs


def classes_of_assets(campaign: Campaign) -> dict[str, str] | None:
    """Class of each asset; None if one is used for two classes."""
    pairs = {(i.asset, i.name) for frame in campaign.frames.values() for i in frame.instances}
    classes = dict(pairs)
    return classes if len(classes) == len(pairs) else None


def compare_contents(
    datasets: dict[str, Dataset],
    reports: dict[str, Report],
    classes: dict[str, str] | None,
    amodal: bool,
) -> None:
    """All formats with upright boxes hold the same (stem, class, box), boxes in whole pixels.

    BOP names assets, which `classes` translates, and always has the boxes of what is visible."""
    left_out = {"coco-keypoints", "statistics", "patches", "yolo-obb"}
    left_out |= {"bop"} if amodal or classes is None else set()
    first: list[tuple] | None = None
    for name, dataset in datasets.items():
        if name in left_out:
            continue
        contents = sorted(
            (
                a.stem,
                classes.get(a.name, a.name) if name == "bop" else a.name,
                _whole_pixels(a.box),
            )
            for a in dataset.annotations
        )
        first = contents if first is None else first
        reports[name].check(contents == first, "other (image, class, box) than the format before")


def _whole_pixels(box: tuple) -> tuple[int, ...]:
    sides = (box[0], box[1], box[0] + box[2], box[1] + box[3])
    return tuple(int(np.floor(side + 0.5)) for side in sides)
