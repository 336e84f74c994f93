"""COCO's four kinds against the truth."""

from __future__ import annotations

import compare
import numpy as np
import rle
from common import Dataset, iou, tight_box
from compare import Report
from source import Campaign, Frame, Instance

LEAST_IOU = 0.99  # of simplified polygons
ROUNDING = 0.005 + 1e-9  # of keypoints, pixels


def expected_points(instance: Instance, names: list[str]) -> list[np.ndarray]:
    """The possible (K, 3) arrays of x, y (continuous pixels) and visibility: the instance's points
    where its names stand in the class's list, (0, 0, 0) elsewhere."""
    points = instance.keypoints or []
    own = [point.name for point in points]
    places = range(len(names) - len(own) + 1) if own else [0]
    found = []
    for place in places:
        if own != names[place : place + len(own)]:
            continue
        table = np.zeros((len(names), 3))
        for i, point in enumerate(points):
            if point.visibility:
                table[place + i] = point.x, point.y, point.visibility
        found.append(table)
    return found


def compare_points(
    where: str, table: np.ndarray, choices: list[np.ndarray], tolerance: float, report: Report
) -> None:
    """The table must be one of the choices: visibility exactly, x and y within the tolerance."""
    close = [
        np.array_equal(table[:, 2], c[:, 2])
        and (np.abs(table[:, :2] - c[:, :2]).max(initial=0) <= tolerance)
        and not table[c[:, 2] == 0].any()
        for c in choices
        if c.shape == table.shape
    ]
    report.check(any(close), f"{where}: keypoints {table.tolist()}, not {choices[:1]}")


def _ids(dataset: Dataset, report: Report) -> None:
    ids = [a.extras["id"] for a in dataset.annotations]
    report.check(len(ids) == len(set(ids)), "an annotation id occurs twice")
    report.check(min(ids, default=1) >= 1, "an annotation id below 1")


def _images(dataset: Dataset, campaign: Campaign, report: Report) -> None:
    for stem, image in dataset.extras["images"].items():
        frame = campaign.frames.get(stem)
        if frame is None:
            continue
        same = (image["id"], image["width"], image["height"], image["seedframe_frame_id"]) == (
            frame.index + 1,
            frame.width,
            frame.height,
            frame.frame_id,
        )
        report.check(same, f"{stem}: image entry {image}")
        ending = frame.image.suffix if frame.image else ".png"
        if report.name == "coco-panoptic":
            ending = ".jpg"  # whatever the image is
        report.check(image["file_name"] == stem + ending, f"{stem}: {image['file_name']}")


def check_entry(
    frame: Frame, instance: Instance, extras: dict, amodal: bool, report: Report
) -> None:
    """The keys of one annotation that are neither mask nor box."""
    where = f"{frame.stem}/{instance.id}"
    wanted = {
        "id": (frame.index + 1) * 100000 + instance.id,
        "image_id": frame.index + 1,
        "category_id": instance.category,
        "area": int(instance.mask.sum()),
        "iscrowd": 0,
    }
    if amodal:
        wanted["visible_area"] = instance.area
        compare.same_mask(
            where, extras.get("visible_mask"), instance.visible, report, "visible mask"
        )
        box = extras.get("visible_bbox")
        report.check(box == list(instance.visible_box), f"{where}: visible_bbox {box}")
    for key, value in wanted.items():
        report.check(extras.get(key) == value, f"{where}: {key} {extras.get(key)}, not {value}")
    fraction = extras.get("visible_fraction")
    if fraction is not None or frame.twin_exact:
        good = fraction is not None and abs(fraction - instance.visible_fraction) < 1e-6
        report.check(good, f"{where}: visible_fraction {fraction}")
    segmentation = extras["segmentation"]
    if isinstance(segmentation, dict):
        counts = rle.encode(instance.mask)["counts"]
        report.check(segmentation["counts"] == counts, f"{where}: counts are not pycocotools' own")


def _polygons(dataset: Dataset, campaign: Campaign, simplified: bool, report: Report) -> None:
    worst = 1.0
    for frame in campaign.frames.values():
        for instance, annotation in compare.pair(dataset, frame, frame.instances, report):
            where = f"{frame.stem}/{instance.id}"
            rings = annotation.extras["segmentation"]
            report.check(isinstance(rings, list), f"{where}: no polygon")
            if simplified:
                share = iou(annotation.mask, instance.mask)
                worst = min(worst, share)
                report.check(share >= LEAST_IOU, f"{where}: IoU {share:.4f}")
            else:
                whole = all(float(v).is_integer() for ring in rings for v in ring)
                report.check(whole, f"{where}: coordinates that are not whole")
    if simplified:
        report.remarks.append(f"simplified polygons, smallest IoU {worst:.4f}")


def _keypoints(dataset: Dataset, campaign: Campaign, amodal: bool, report: Report) -> None:
    lists = {c["name"]: c["keypoints"] for c in dataset.extras["categories"]}
    for category in dataset.extras["categories"]:
        for edge in category["skeleton"]:
            good = len(edge) == 2 and all(1 <= i <= len(category["keypoints"]) for i in edge)
            report.check(good, f"{category['name']}: skeleton {edge}")
    for frame in campaign.frames.values():
        for instance in frame.instances:
            if instance.keypoints:
                report.check(bool(lists[instance.name]), f"{instance.name}: no keypoints")
    classes = {name for name, points in lists.items() if points}
    pairs = compare.compare_annotations(dataset, campaign, report, keypoint_classes=classes)
    for frame, instance, annotation in pairs:
        where = f"{frame.stem}/{instance.id}"
        check_entry(frame, instance, annotation.extras, amodal, report)
        table = np.reshape(annotation.extras["keypoints"], (-1, 3)).astype(float)
        seen = int((table[:, 2] > 0).sum())
        number = annotation.extras["num_keypoints"]
        report.check(number == seen, f"{where}: num_keypoints {number}, not {seen}")
        table[table[:, 2] > 0, :2] += 0.5
        choices = expected_points(instance, lists[instance.name])
        for choice in choices:  # pixel indices begin at 0, the centre of the first pixel
            choice[choice[:, 2] > 0, :2] = np.maximum(choice[choice[:, 2] > 0, :2], 0.5)
        compare_points(where, table, choices, ROUNDING, report)


def _panoptic(dataset: Dataset, campaign: Campaign, report: Report) -> None:
    colours = {tuple(c["color"]) for c in dataset.extras["categories"]}
    report.check(len(colours) == len(dataset.extras["categories"]), "two categories of one colour")
    report.check((0, 0, 0) not in colours, "a category is black")
    *things, background = dataset.extras["categories"]
    for category in things:
        report.check(category["isthing"] == 1, f"{category['name']}: not a thing")
    found = (background["name"], background["isthing"], background["id"])
    wanted = ("background", 0, len(things) + 1)
    report.check(found == wanted, f"the last category is {found}, not {wanted}")
    for stem, frame in campaign.frames.items():
        segments = dataset.extras["stuff"].get(stem, [])
        (segment, mask), *more = segments or [({"area": 0}, frame.unlabelled & False)]
        report.check(not more, f"{stem}: {len(segments)} segments of stuff")
        compare.same_mask(stem, mask, frame.unlabelled, report, "background")
        good = segment["area"] == mask.sum()
        good &= not mask.any() or tuple(segment["bbox"]) == tight_box(mask)
        report.check(good, f"{stem}: area or box of the background: {segment}")
    for frame, instance, annotation in compare.compare_annotations(dataset, campaign, report):
        where, extras = f"{frame.stem}/{instance.id}", annotation.extras
        wanted = (instance.id, instance.category, instance.area, 0)
        found = (extras["id"], extras["category_id"], extras["area"], extras["iscrowd"])
        report.check(found == wanted, f"{where}: segment {found}, not {wanted}")


def check(
    dataset: Dataset, campaign: Campaign, report: Report, amodal: bool, simplified: bool
) -> None:
    """Any of the four; which one it is says the dataset's folder."""
    report.check(dataset.categories == campaign.categories, f"categories {dataset.categories}")
    for category in dataset.extras["categories"]:
        wanted = "object" if category.get("isthing", 1) else "background"
        report.check(category["supercategory"] == wanted, f"{category}: supercategory")
    _images(dataset, campaign, report)
    if report.name == "coco-panoptic":
        _panoptic(dataset, campaign, report)
        return
    _ids(dataset, report)
    if report.name == "coco-keypoints":
        _keypoints(dataset, campaign, amodal, report)
        return
    polygon = report.name == "coco-polygon"
    exact = not (polygon and simplified)
    pairs = compare.compare_annotations(dataset, campaign, report, masks=exact)
    for frame, instance, annotation in pairs:
        check_entry(frame, instance, annotation.extras, amodal, report)
    if polygon:
        _polygons(dataset, campaign, simplified, report)
