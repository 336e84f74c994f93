"""Panoptic quality (Kirillov, He, Girshick, Rother & Dollár, Panoptic Segmentation, CVPR 2019).

A segmentation is an image of segment ids (height, width), 0 for void, and the category of each id.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

Segmentation = tuple[np.ndarray, dict[int, int]]
MATCH = 0.5  # IoU above which two segments are the same; no segment then has two matches


class Counts:
    """Of one category: matches, their IoUs, and what has no match."""

    def __init__(self) -> None:
        self.matched = self.false_positive = self.false_negative = 0
        self.iou = 0.0

    def quality(self) -> float | None:
        """Equation 1; None for a category that occurs nowhere."""
        segments = self.matched + self.false_positive / 2 + self.false_negative / 2
        return self.iou / segments if segments else None


def _count(truth: Segmentation, found: Segmentation, counts: dict[int, Counts]) -> None:
    truth_ids, truth_categories = truth
    found_ids, found_categories = found
    pairs, pixels = np.unique(np.stack([truth_ids.ravel(), found_ids.ravel()]), axis=1,
                              return_counts=True)  # fmt: skip
    overlap = {(int(a), int(b)): int(n) for (a, b), n in zip(pairs.T, pixels, strict=True)}
    truth_area = {i: int((truth_ids == i).sum()) for i in truth_categories}
    found_area = {i: int((found_ids == i).sum()) for i in found_categories}
    lost, wrong = set(truth_categories), set(found_categories)
    for (a, b), both in overlap.items():
        if a not in truth_categories or b not in found_categories:
            continue
        if truth_categories[a] != found_categories[b]:
            continue
        # Void pixels of the truth are not counted in what was found.
        union = truth_area[a] + found_area[b] - both - overlap.get((0, b), 0)
        if both > MATCH * union:
            counts[truth_categories[a]].matched += 1
            counts[truth_categories[a]].iou += both / union
            lost.discard(a)
            wrong.discard(b)
    for a in lost:
        counts[truth_categories[a]].false_negative += 1
    for b in wrong:
        if overlap.get((0, b), 0) <= MATCH * found_area[b]:  # else it is of what is void
            counts[found_categories[b]].false_positive += 1


def panoptic_quality(
    pairs: Iterable[tuple[Segmentation, Segmentation]], categories: Iterable[int]
) -> dict[int, float | None]:
    """By category, over all (truth, found) pairs of images."""
    counts = {category: Counts() for category in categories}
    for truth, found in pairs:
        _count(truth, found, counts)
    return {category: each.quality() for category, each in counts.items()}
