"""VOC, patches, WebDataset and statistics against the truth."""

from __future__ import annotations

from collections import Counter

import compare
import numpy as np
import stats
from check_coco import check_entry
from common import Dataset
from compare import Report
from source import Campaign, Instance
from voc import folder_names

# A resized patch has nearly the mean light of its rectangle; another object's has not.
MEAN_LIGHT = 0.04


def voc_flags(instance: Instance) -> tuple[int, int]:
    """truncated: over 15 % of the silhouette is outside the box of the visible pixels; occluded:
    over 5 % of what is in it is hidden."""
    x, y, width, height = instance.visible_box
    in_box = int(instance.silhouette[y : y + height, x : x + width].sum())
    truncated = 100 * (instance.amodal_area - in_box) > 15 * instance.amodal_area
    occluded = 100 * (in_box - instance.area) > 5 * in_box
    return int(truncated), int(occluded)


def check_voc(dataset: Dataset, campaign: Campaign, report: Report) -> None:
    """Masks, boxes, flags, and the lists of images of each class."""
    report.check(dataset.categories == campaign.categories, f"categories {dataset.categories}")
    for frame, instance, annotation in compare.compare_annotations(dataset, campaign, report):
        where, extras = f"{frame.stem}/{instance.id}", annotation.extras
        found, wanted = (extras["truncated"], extras["occluded"]), voc_flags(instance)
        if frame.twin_exact:
            report.check(found == wanted, f"{where}: truncated, occluded {found}, not {wanted}")
        report.check(extras["difficult"] == 0, f"{where}: difficult")
    shown = {s: {i.name for i in frame.instances} for s, frame in campaign.frames.items()}
    sets = {}
    for split, stems in dataset.splits.items():
        for name, file in zip(campaign.categories, folder_names(campaign.categories), strict=True):
            sets[f"{file}_{split}"] = {s: 1 if name in shown[s] else -1 for s in stems}
    found = dataset.extras["class_sets"]
    report.check(found.keys() == sets.keys(), f"ImageSets/Main: files {sorted(found)}")
    for name in sorted(sets.keys() & found.keys()):
        report.check(found[name] == sets[name], f"ImageSets/Main/{name}.txt: other images")


def _linear(pixels: np.ndarray) -> np.ndarray:
    """Mean linear light (3,) of sRGB pixels (h, w, 3)."""
    values = pixels.astype(float) / 255
    low, high = values / 12.92, ((values + 0.055) / 1.055) ** 2.4
    return np.where(values <= 0.04045, low, high).mean(axis=(0, 1))


def check_patches(dataset: Dataset, campaign: Campaign, report: Report) -> None:
    """One file for each instance, in its class's folder, of one size or of its box's; pixels."""
    report.check(dataset.categories == campaign.categories, f"categories {dataset.categories}")
    folders = folder_names(campaign.categories)
    report.check(dataset.extras["folders"] == folders, f"folders {dataset.extras['folders']}")
    compare.compare_annotations(_by_id(dataset), campaign, report, masks=False, boxes=False)
    sizes = Counter(a.extras["pixels"].shape[:2] for a in dataset.annotations)
    uniform = len(sizes) == 1 and len({*next(iter(sizes))}) == 1
    images: dict[str, np.ndarray] = {}
    for annotation in dataset.annotations:
        frame = campaign.frames.get(annotation.stem)
        number, pixels = annotation.extras["id"], annotation.extras["pixels"]
        instance = next((i for i in frame.instances if i.id == number), None) if frame else None
        where = f"{annotation.split}/{annotation.stem}_{number:05}"
        if not report.check(instance is not None, f"{where}: of no instance"):
            continue
        if frame.stem not in images:
            images[frame.stem] = compare.read_image(frame)
        x, y, width, height = instance.box
        crop = images[frame.stem][y : y + height, x : x + width]
        if pixels.shape == crop.shape:
            report.check((pixels == crop).all(), f"{where}: other pixels than the image")
        elif not uniform:
            report.check(False, f"{where}: size {pixels.shape[:2]}, box {height} x {width}")
        else:
            off = float(np.abs(_linear(pixels) - _linear(crop)).max())
            report.check(off <= MEAN_LIGHT, f"{where}: mean light is {off:.3f} from the image's")


def _by_id(dataset: Dataset) -> Dataset:
    """Patches lie in folders by class: brings those of an image into the order of their ids,
    which is that of the instances in labels.json."""
    ordered = sorted(dataset.annotations, key=lambda a: (a.stem, a.extras["id"]))
    return Dataset(dataset.categories, dataset.splits, ordered)


def check_patch_splits(dataset: Dataset, splits: dict[str, list[str]], report: Report) -> None:
    """Patches of a frame are in the split in which other formats have the frame."""
    homes = {stem: split for split, stems in splits.items() for stem in stems}
    for annotation in dataset.annotations:
        home = homes.get(annotation.stem)
        where = f"{annotation.stem}_{annotation.extras['id']:05}"
        report.check(annotation.split == home, f"{where}: in {annotation.split}, not {home}")
    report.check(
        dataset.splits.keys() == splits.keys(), f"splits {sorted(dataset.splits)}"
    )


def check_webdataset(dataset: Dataset, campaign: Campaign, report: Report, amodal: bool) -> None:
    """As COCO, with instances.png and what the sample says of its frame."""
    ids = [a.extras["id"] for a in dataset.annotations]
    report.check(len(ids) == len(set(ids)), "an annotation id occurs twice")
    for number, name in dataset.extras["names"].items():
        known = 1 <= number <= len(campaign.categories)
        good = known and campaign.categories[number - 1] == name
        report.check(good, f"category {number}: {name}")
    for frame, instance, annotation in compare.compare_annotations(dataset, campaign, report):
        where = f"{frame.stem}/{instance.id}"
        check_entry(frame, instance, annotation.extras, amodal, report)
        compare.same_mask(
            where, annotation.extras["ids_mask"], instance.visible, report, "instances.png"
        )
    for stem, entry in dataset.extras["images"].items():
        frame = campaign.frames.get(stem)
        if frame:
            found = (entry["frame"], entry["frame_id"], entry["width"], entry["height"])
            wanted = (frame.index, frame.frame_id, frame.width, frame.height)
            report.check(found == wanted, f"{stem}: {found}, not {wanted}")


def check_statistics(
    dataset: Dataset, campaign: Campaign, splits: dict[str, list[str]], report: Report
) -> None:
    """Every number computed again; `splits`: of another format, since statistics name no images."""
    document = dataset.extras["document"]
    edges = document["bins"]["size_below_px"]
    report.check(
        edges == [2 ** (i + 1) for i in range(len(edges))], f"edges of the size histogram {edges}"
    )
    report.check(document["bins"]["positions"] == [stats.GRID] * 2, "bins: positions")
    for key in ("visible_below", "truncation_below"):
        tenths = [round(10 * edge, 9) for edge in document["bins"][key]]
        report.check(tenths == list(range(1, 11)), f"bins: {key}")
    report.check(set(document["splits"]) == set(splits), f"splits {sorted(document['splits'])}")
    for split in sorted(document["splits"].keys() & splits.keys()):
        found = _flat(document["splits"][split])
        wanted = _flat(stats.compute(campaign, splits[split], edges))
        for path, value in wanted.items():
            other = found.get(path)
            report.check(other == value, f"{split}/{path}: {other}, not {value}")
        extra = found.keys() - wanted.keys()
        report.check(not extra, f"{split}: undocumented {sorted(extra)}")


def _flat(tree: dict, prefix: str = "") -> dict[str, object]:
    """Leaves of nested dicts by their path."""
    leaves: dict[str, object] = {}
    for key, value in tree.items():
        if isinstance(value, dict):
            leaves |= _flat(value, f"{prefix}{key}/")
        else:
            leaves[prefix + key] = value
    return leaves
