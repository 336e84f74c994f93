"""What the detector is taught of a picture's boxes, and which boxes its answers are.

A box is x0, y0, x1, y1 in pixels; pixel c covers [c, c + 1). The detector's grid has a cell every STRIDE pixels, and the
centre of the cell in row r and column c is x = (c + 0.5) · STRIDE, y = (r + 0.5) · STRIDE. For each class it says how sure
it is that the middle of an object is in a cell, and for each cell how far the object's four sides are from its centre:
CenterNet's heat map ("Objects as Points", Zhou et al. 2019) with the sides and the widths of TTFNet (Liu et al. 2020).
"""

import numpy

STRIDE = 4


def iou(a, b):
    """Intersection over union of each of a [n, 4] with each of b [m, 4]: [n, m]. Boxes without area have 0."""
    corner0 = numpy.maximum(a[:, None, :2], b[None, :, :2])
    corner1 = numpy.minimum(a[:, None, 2:], b[None, :, 2:])
    both = numpy.prod(numpy.clip(corner1 - corner0, 0, None), axis=2)
    union = area(a)[:, None] + area(b)[None, :] - both
    return numpy.divide(both, union, out=numpy.zeros_like(both), where=union > 0)


def area(boxes):
    return numpy.prod(numpy.clip(boxes[:, 2:] - boxes[:, :2], 0, None), axis=1)


def moved(boxes, dx, dy, width, height):
    """Boxes of a picture that was moved by (dx, dy) pixels, cut at its edges, and which of them keep half their area."""
    whole = boxes + numpy.array([dx, dy, dx, dy], numpy.float32)
    cut = numpy.clip(whole, 0, numpy.array([width, height, width, height], numpy.float32))
    return cut, area(cut) >= 0.5 * area(whole)


def mirrored(boxes, width):
    """Boxes of a picture whose left and right were exchanged."""
    return numpy.stack([width - boxes[:, 2], boxes[:, 1], width - boxes[:, 0], boxes[:, 3]], axis=1)


def targets(boxes, categories, classes, width, height):
    """What the detector should say of a picture with these boxes [n, 4] of these categories [n], 0 … classes − 1.

    Heat [classes, rows, columns]: 1 in the cell of each box's middle, falling off around it. Sides [4, rows, columns]:
    pixels to the left, top, right and bottom side. Weights [rows, columns] of the sides: 1 in all for each box, over the
    cells of its middle half; of two boxes in one cell the smaller counts.
    """
    rows, columns = height // STRIDE, width // STRIDE
    heat = numpy.zeros((classes, rows, columns), numpy.float32)
    sides = numpy.zeros((4, rows, columns), numpy.float32)
    weights = numpy.zeros((rows, columns), numpy.float32)
    x, y = (numpy.arange(columns) + 0.5) * STRIDE, (numpy.arange(rows) + 0.5) * STRIDE
    for index in numpy.argsort(-area(boxes), kind="stable"):
        x0, y0, x1, y1 = boxes[index]
        column = min(int((x0 + x1) / 2 / STRIDE), columns - 1)
        row = min(int((y0 + y1) / 2 / STRIDE), rows - 1)
        across = fall_off(numpy.arange(columns) - column, (x1 - x0) / STRIDE)
        down = fall_off(numpy.arange(rows) - row, (y1 - y0) / STRIDE)
        numpy.maximum(heat[categories[index]], down[:, None] * across[None, :], out=heat[categories[index]])
        inside = ((abs(y - (y0 + y1) / 2) < (y1 - y0) / 4)[:, None] & (abs(x - (x0 + x1) / 2) < (x1 - x0) / 4)[None, :])
        inside[row, column] = True
        r, c = numpy.nonzero(inside)
        sides[:, r, c] = x[c] - x0, y[r] - y0, x1 - x[c], y1 - y[r]
        weights[r, c] = 1 / len(r)
    return heat, sides, weights


def fall_off(cells, side):
    """A bell that is 1 at 0 cells; a box's side is in cells too."""
    sigma = 0.09 * side + 1 / 6
    return numpy.exp(-(cells / sigma) ** 2 / 2)


def boxes_of(heat, sides, most=50, least=0.02):
    """The boxes of an answer, surest first: boxes [n, 4], categories [n], scores [n].

    They are the cells that are as sure as all eight around them, `most` of them and none below `least`.
    """
    classes, rows, columns = heat.shape
    framed = numpy.pad(heat, ((0, 0), (1, 1), (1, 1)), constant_values=-1)
    around = numpy.max([framed[:, r:r + rows, c:c + columns] for r in range(3) for c in range(3)], axis=0)
    category, row, column = numpy.nonzero((heat >= around) & (heat >= least))
    scores = heat[category, row, column]
    first = numpy.argsort(-scores, kind="stable")[:most]
    category, row, column = category[first], row[first], column[first]
    left, top, right, bottom = sides[:, row, column]
    x, y = (column + 0.5) * STRIDE, (row + 0.5) * STRIDE
    edges = numpy.array([columns, rows, columns, rows]) * STRIDE
    boxes = numpy.clip(numpy.stack([x - left, y - top, x + right, y + bottom], axis=1), 0, edges)
    return boxes, category, scores[first]
