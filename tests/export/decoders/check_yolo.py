"""YOLO's four kinds against the truth."""

from __future__ import annotations

import compare
import numpy as np
from check_coco import compare_points, expected_points
from common import Annotation, Dataset, count_parts, iou
from compare import Report
from source import Campaign, Instance

BOX_TOLERANCE = 0.05  # pixels
LOW_IOU = 0.97
ANGLES = np.radians(np.arange(0, 90, 0.25))


def hull_of_mask(mask: np.ndarray) -> np.ndarray:
    """Convex hull (n, 2) of the set pixels' squares, in order, without points on its sides."""
    rows = np.flatnonzero(mask.any(axis=1))
    first = mask[rows].argmax(axis=1)
    last = mask.shape[1] - mask[rows, ::-1].argmax(axis=1)
    points = {(int(x), int(y + d)) for x0, x1, y in zip(first, last, rows, strict=True)
              for x in (x0, x1) for d in (0, 1)}  # fmt: skip
    ordered = sorted(points)

    def chain(sequence: list[tuple[int, int]]) -> list[tuple[int, int]]:
        out: list[tuple[int, int]] = []
        for p in sequence:
            while len(out) > 1 and (out[-1][0] - out[-2][0]) * (p[1] - out[-2][1]) <= (
                out[-1][1] - out[-2][1]
            ) * (p[0] - out[-2][0]):
                out.pop()
            out.append(p)
        return out[:-1]

    return np.array(chain(ordered) + chain(ordered[::-1]), dtype=float)


def rectangles(hull: np.ndarray, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Tight rectangles around the hull: corners (n, 4, 2) and areas (n,)."""
    along = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    u, v = hull @ along.T, hull @ across.T
    u0, u1, v0, v1 = u.min(axis=0), u.max(axis=0), v.min(axis=0), v.max(axis=0)
    corners = [
        a[:, None] * along + b[:, None] * across
        for a, b in ((u0, v0), (u1, v0), (u1, v1), (u0, v1))
    ]
    return np.stack(corners, axis=1), (u1 - u0) * (v1 - v0)


def least_area(hull: np.ndarray, width: int, height: int) -> float:
    """Least area of the tight rectangles whose corners lie in the image: of those with a side on
    the hull, the upright one, and, since the image's edge may cut the best of these off, of those
    at many angles between. (What is not tight is larger, and its corners are further out.)"""
    sides = np.roll(hull, -1, axis=0) - hull
    angles = np.concatenate(([0.0], np.arctan2(sides[:, 1], sides[:, 0]), ANGLES))
    corners, areas = rectangles(hull, angles)
    low, high = corners.min(axis=1), corners.max(axis=1)
    inside = (low >= -1e-6).all(axis=1) & (high <= np.array([width, height]) + 1e-6).all(axis=1)
    inside[0] = True
    return float(areas[inside].min())


def check_rectangle(where: str, corners: np.ndarray, mask: np.ndarray, report: Report) -> None:
    """Corners (4, 2): a rectangle around all pixels, no larger than the best."""
    height, width = mask.shape
    sides = np.roll(corners, -1, axis=0) - corners
    lengths = np.hypot(sides[:, 0], sides[:, 1])
    skew = [abs(sides[i] @ sides[(i + 1) % 4]) / max(lengths[i], 1e-9) for i in range(4)]
    # Eight decimals of 1: at most 1e-8 of a side per corner.
    rounding = 4e-8 * max(width, height) + 1e-9
    square = max(skew) <= 4 * rounding * max(lengths.max() / max(lengths.min(), 1e-9), 1)
    parallel = np.abs(sides[0] + sides[2]).max() <= 4 * rounding
    report.check(square and parallel, f"{where}: no rectangle: {corners.tolist()}")
    hull = hull_of_mask(mask)
    turn = np.sign(sides[0][0] * sides[1][1] - sides[0][1] * sides[1][0])
    normals = np.stack([-sides[:, 1], sides[:, 0]], axis=1) / lengths[:, None] * turn
    outside = -min(((hull - corners[i]) @ normals[i]).min() for i in range(4))
    report.check(outside <= 1e-4, f"{where}: pixels {outside:.4f} px outside the rectangle")
    area = float(lengths[0] * lengths[1])
    best = least_area(hull, width, height)
    report.check(area <= best * (1 + 1e-5) + 1e-3, f"{where}: area {area:.3f}, best {best:.3f}")


def _grown(mask: np.ndarray) -> np.ndarray:
    """The mask and the eight pixels around each of its own."""
    padded = np.pad(mask, 1)
    height, width = mask.shape
    return np.logical_or.reduce(
        [padded[y : y + height, x : x + width] for y in range(3) for x in range(3)]
    )


def _check_segments(pairs: list[tuple[str, Instance, Annotation]], report: Report) -> None:
    shares = []
    fragments = 0
    for where, instance, annotation in pairs:
        if count_parts(instance.mask) == 1:
            compare.same_mask(where, annotation.mask, instance.mask, report)
            continue
        shares.append(iou(annotation.mask, instance.mask))
        lost = instance.mask & ~annotation.mask
        kept_beside = _grown(lost) & instance.mask & annotation.mask
        report.check(not kept_beside.any(), f"{where}: a part of the mask is lost in part")
        fragments += bool(lost.any())
    if shares:
        low = sum(share < LOW_IOU for share in shares)
        report.remarks.append(
            f"{len(shares)} masks of several parts: IoU at least {min(shares):.4f}, "
            f"mean {np.mean(shares):.4f}, {low} below {LOW_IOU}, {fragments} without fragments"
        )


def _names_of_class(dataset: Dataset, campaign: Campaign, name: str, count: int) -> list[str]:
    """A class's keypoints, padded to `count`: from the yaml, else from its assets in order."""
    listed = dataset.extras["kpt_names"]
    if listed:
        return list(listed[campaign.categories.index(name)])
    points: dict[str, list[str]] = {}
    for frame in campaign.frames.values():
        for instance in frame.instances:
            if instance.name == name and instance.keypoints:
                points[instance.asset] = [point.name for point in instance.keypoints]
    flat = [point for asset in sorted(points) for point in points[asset]]
    return flat + [""] * (count - len(flat))


def _check_pose(
    dataset: Dataset,
    campaign: Campaign,
    pairs: list[tuple[str, Instance, Annotation]],
    report: Report,
) -> None:
    settings = dataset.extras["settings"]
    count, numbers = settings["kpt_shape"]
    report.check(numbers == 3, f"kpt_shape {settings['kpt_shape']}")
    names = {c: _names_of_class(dataset, campaign, c, count) for c in campaign.categories}
    for name, points in names.items():
        report.check(len(points) == count, f"{name}: {len(points)} keypoints, not {count}")
    longest = max(sum(point != "" for point in points) for points in names.values())
    report.check(longest == count, f"kpt_shape {count}, the longest class has {longest}")
    flip = settings.get("flip_idx")
    if flip is not None:
        pairwise = sorted(flip) == list(range(count)) and all(flip[flip[i]] == i for i in flip)
        report.check(pairwise, f"flip_idx {flip}")
    for where, instance, annotation in pairs:
        choices = expected_points(instance, names[instance.name])
        compare_points(where, annotation.extras["points"], choices, 1e-4, report)


def check(dataset: Dataset, campaign: Campaign, report: Report) -> None:
    """Any of the four; which one it is says the dataset's folder."""
    kind = dataset.extras["kind"]
    report.check(dataset.categories == campaign.categories, f"categories {dataset.categories}")
    matched = compare.compare_annotations(
        dataset, campaign, report, masks=False, boxes=kind != "obb", tolerance=BOX_TOLERANCE
    )
    pairs = [(f"{frame.stem}/{i.id}", i, annotation) for frame, i, annotation in matched]
    if kind == "segment":
        _check_segments(pairs, report)
    if kind == "pose":
        _check_pose(dataset, campaign, pairs, report)
    if kind == "obb":
        for where, instance, annotation in pairs:
            check_rectangle(where, annotation.extras["corners"], instance.mask, report)
