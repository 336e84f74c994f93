#!/usr/bin/python3
"""Makes materials/decals/: prints that a part wears, as texture sets of a colour alone.

Usage: scripts/make_decals.py [NAME…]; needs numpy. The numbers of jerseys, 1 to 5: dark on nearly white, which base_color
dyes. Strokes of one width with round ends, drawn of straight lines and arcs: no font is asked.
"""

import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import numpy as np

from make_textures import to_bytes, write_png

SIDE, SUPERSAMPLED = 256, 4
STROKE = 0.15  # of the side
CLOTH, INK = 0.97, 0.13  # sRGB


def arc(x, y, radius, start_deg, end_deg, steps=24):
    angles = [math.radians(start_deg + (end_deg - start_deg) * i / steps) for i in range(steps + 1)]
    return [(x + radius * math.cos(a), y + radius * math.sin(a)) for a in angles]


# Lines through points; the square is one wide and high, y points up.
NUMBERS = {
    '1': [[(0.37, 0.66), (0.54, 0.80), (0.54, 0.20)]],
    '2': [arc(0.50, 0.63, 0.17, 160.0, -38.0) + [(0.34, 0.20), (0.69, 0.20)]],
    '3': [[(0.34, 0.80), (0.65, 0.80), (0.50, 0.56)] + arc(0.49, 0.38, 0.18, 86.0, -140.0)],
    '4': [[(0.72, 0.36), (0.27, 0.36), (0.56, 0.80)], [(0.60, 0.50), (0.60, 0.20)]],
    '5': [[(0.66, 0.80), (0.38, 0.80), (0.36, 0.51)] + arc(0.49, 0.38, 0.18, 118.0, -140.0)],
}


def distance(lines):
    """From the middle of each fine pixel to the nearest of the lines."""
    side = SIDE * SUPERSAMPLED
    y, x = np.mgrid[0:side, 0:side]
    x, y = (x + 0.5) / side, 1.0 - (y + 0.5) / side
    nearest = np.full((side, side), np.inf)
    for line in lines:
        for (x0, y0), (x1, y1) in zip(line, line[1:]):
            length = math.hypot(x1 - x0, y1 - y0)
            along = np.clip(((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / length ** 2, 0.0, 1.0)
            nearest = np.minimum(nearest, np.hypot(x - x0 - along * (x1 - x0), y - y0 - along * (y1 - y0)))
    return nearest


def number(lines):
    inside = (distance(lines) < STROKE / 2.0).astype(float)
    covered = inside.reshape(SIDE, SUPERSAMPLED, SIDE, SUPERSAMPLED).mean(axis=(1, 3))
    return CLOTH + (INK - CLOTH) * covered


def main():
    home = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    for digit, lines in NUMBERS.items():
        name = f'JerseyNumber{digit}'
        if len(sys.argv) > 1 and name not in sys.argv[1:]:
            continue
        folder = os.path.join(home, 'materials', 'decals', name)
        os.makedirs(folder, exist_ok=True)
        path = os.path.join(folder, f'{name}_Color.png')
        write_png(path, to_bytes(number(lines)))
        print(f'{name}: {os.path.getsize(path) / 1024:.1f} KiB', flush=True)


if __name__ == '__main__':
    main()
