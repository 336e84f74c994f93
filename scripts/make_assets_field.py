"""The field of the RoboCup Standard Platform League (rules of 2017), in millimetres: its carpet, and its lines."""

import math
import random

from make_assets_forms import grouped, painted
from make_assets_shapes import box, circle, shell

# The field is measured between the middles of its lines; x runs from goal to goal.
HALF_X, HALF_Y, BORDER = 4500.0, 3000.0, 700.0
THICKNESS = 10.0

# ---- carpet ---------------------------------------------------------------------------------------

CARPET, TURNED, SEAM = range(3)
FIELD_SLOTS = ('carpet', 'carpet_turned', 'seam')
ROLL_WIDTH, GAP, SEAM_DEPTH = 2000.0, 1.6, 2.5


def spl_field():
    """Lengths from a roll side by side, every other one with its pile the other way. In the seams between them a
    darker strip lies a little lower, so that nothing else is seen there."""
    x, y = HALF_X + BORDER, HALF_Y + BORDER
    edges = [-y]
    while edges[-1] + ROLL_WIDTH < y:
        edges.append(edges[-1] + ROLL_WIDTH)
    edges.append(y)
    pieces = []
    for i, (low, high) in enumerate(zip(edges, edges[1:])):
        low, high = (max(-y, low + GAP / 2.0) if i > 0 else low), (high - GAP / 2.0 if high < y else high)
        pieces.append(painted(box(-x, x, low, high, 0.0, THICKNESS), TURNED if i % 2 else CARPET))
    for edge in edges[1:-1]:
        strip = box(-x + 1.0, x - 1.0, edge - GAP, edge + GAP, 1.0, THICKNESS - SEAM_DEPTH)
        pieces.append(painted(strip, SEAM))
    return grouped(pieces)


# ---- lines ----------------------------------------------------------------------------------------

LINE_WIDTH = 50.0
# From inside the carpet to a little above it.
LINE_LOW, LINE_HIGH, LINE_STEP = THICKNESS - 4.0, THICKNESS + 0.7, 0.1
WEAR, WEAR_STEP = 0.9, 12.0  # deviation of an edge, and the distance of its points


def wear():
    """A smooth push (x, y) of deviation WEAR at each place, in waves of 16 to 90 mm."""
    draw = random.Random(2017)
    waves = []
    for _ in range(40):
        length = 16.0 * (90.0 / 16.0) ** draw.random()
        angle, phase, push = (2.0 * math.pi * draw.random() for _ in range(3))
        waves.append((2.0 * math.pi / length * math.cos(angle), 2.0 * math.pi / length * math.sin(angle), phase, push))
    share = WEAR * 2.0 / math.sqrt(len(waves))

    def at(x, y):
        pushes = [(math.sin(kx * x + ky * y + phase), push) for kx, ky, phase, push in waves]
        return (share * sum(a * math.cos(push) for a, push in pushes),
                share * sum(a * math.sin(push) for a, push in pushes))
    return at


def strip(push, path, z_high, closed=False):
    """A line along a path of points (x, y), its two edges pushed about each by itself."""
    rings = []
    count = len(path)
    for i, (x, y) in enumerate(path):
        before = path[i - 1] if closed or i > 0 else path[0]
        after = path[(i + 1) % count] if closed or i + 1 < count else path[-1]
        length = math.dist(before, after)
        across = LINE_WIDTH / 2.0 * (before[1] - after[1]) / length, LINE_WIDTH / 2.0 * (after[0] - before[0]) / length
        right, left = (x - across[0], y - across[1]), (x + across[0], y + across[1])
        right, left = (tuple(a + b for a, b in zip(edge, push(*edge))) for edge in (right, left))
        rings.append([(*left, LINE_LOW), (*right, LINE_LOW), (*right, z_high), (*left, z_high)])
    return shell(rings, closed=closed)


def straight(x0, y0, x1, y1):
    steps = max(1, math.ceil(math.dist((x0, y0), (x1, y1)) / WEAR_STEP))
    return [(x0 + (x1 - x0) * i / steps, y0 + (y1 - y0) * i / steps) for i in range(steps + 1)]


def spl_lines():
    """Edges as feet leave them. Where lines cross, one lies a little above the other."""
    half = LINE_WIDTH / 2.0
    x, y = HALF_X + half, HALF_Y
    along_x = [straight(-x, -y, x, -y), straight(-x, y, x, y), straight(-50.0, 0.0, 50.0, 0.0)]
    along_y = [straight(-HALF_X, -y, -HALF_X, y), straight(HALF_X, -y, HALF_X, y), straight(0.0, -y, 0.0, y)]
    for side in (-1.0, 1.0):
        front, spot = side * (HALF_X - 600.0), side * (HALF_X - 1300.0)
        along_y.append(straight(front, -1100.0 - half, front, 1100.0 + half))
        along_x += [straight(side * HALF_X, 1100.0, front, 1100.0), straight(side * HALF_X, -1100.0, front, -1100.0)]
        along_x.append(straight(spot - 50.0, 0.0, spot + 50.0, 0.0))
        along_y.append(straight(spot, -50.0, spot, 50.0))
    push = wear()
    pieces = [strip(push, path, LINE_HIGH) for path in along_x]
    pieces += [strip(push, path, LINE_HIGH - LINE_STEP) for path in along_y]
    pieces.append(strip(push, circle(750.0, 400), LINE_HIGH - 2.0 * LINE_STEP, closed=True))
    return grouped([painted(piece, 0) for piece in pieces])


ASSETS = [('spl_field', spl_field), ('spl_lines', spl_lines)]
SLOTS = {'spl_field': FIELD_SLOTS, 'spl_lines': ('line',)}
