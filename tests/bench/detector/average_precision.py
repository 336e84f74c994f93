"""How good a detector's boxes are: COCO's average precision (AP).

As pycocotools computes it: in each picture and class the surest box first takes the box of truth with which its IoU is
highest and at least the threshold; precision over recall, made falling, is read at 101 recalls; the mean is over those,
over the classes that occur, and over the thresholds. Pictures are matched one by one, so that sums over other samples of
them cost little.
"""

import dataclasses

import numpy

from boxes import iou

THRESHOLDS = numpy.linspace(0.5, 0.95, 10)
RECALLS = numpy.linspace(0, 1, 101)


@dataclasses.dataclass
class Match:
    """One picture's boxes against its truth."""
    categories: numpy.ndarray  # [n]
    scores: numpy.ndarray      # [n]
    hits: numpy.ndarray        # [thresholds, n]: is it the box of an object?
    truths: numpy.ndarray      # [classes]: objects that there are


def match(boxes, categories, scores, true_boxes, true_categories, classes):
    """Boxes in falling order of their scores."""
    hits = numpy.zeros((len(THRESHOLDS), len(boxes)), bool)
    overlap = iou(boxes, true_boxes)
    overlap[categories[:, None] != true_categories[None, :]] = -1
    for level, threshold in enumerate(THRESHOLDS):
        free = overlap.copy()
        for box in range(len(boxes) if len(true_boxes) else 0):
            best = numpy.argmax(free[box])
            if free[box, best] >= threshold:
                hits[level, box] = True
                free[:, best] = -1
    return Match(categories, scores, hits, numpy.bincount(true_categories, minlength=classes))


def average_precision(matches):
    """AP at each threshold [thresholds], 0 … 1, the mean over the classes that occur in these pictures."""
    truths = numpy.sum([each.truths for each in matches], axis=0)
    scores = numpy.concatenate([each.scores for each in matches])
    order = numpy.argsort(-scores, kind="stable")
    categories = numpy.concatenate([each.categories for each in matches])[order]
    hits = numpy.concatenate([each.hits for each in matches], axis=1)[:, order]
    of_classes = [precision_over_recall(hits[:, categories == category], truths[category])
                  for category in numpy.nonzero(truths)[0]]
    return numpy.mean(of_classes, axis=0)


def precision_over_recall(hits, truths):
    """The mean precision at RECALLS [thresholds] of one class, from hits [thresholds, n] in falling order of scores."""
    found = numpy.cumsum(hits, axis=1)
    precision = found / (numpy.arange(hits.shape[1]) + 1)
    precision = numpy.maximum.accumulate(precision[:, ::-1], axis=1)[:, ::-1]
    precision = numpy.pad(precision, ((0, 0), (0, 1)))  # what is never reached has precision 0
    return numpy.array([numpy.mean(level[numpy.searchsorted(recall, RECALLS, side="left")])
                        for level, recall in zip(precision, found / truths)])
