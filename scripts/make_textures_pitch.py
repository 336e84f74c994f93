"""Sets for make_textures.py: the carpet of a soccer field for robots, and the paint of its lines.

Seen from half a metre and more, so they are meant for tiles of a metre or so (texture_size_m): finer pile would lie
between the pixels and sparkle there.
"""

import numpy as np

from make_textures_fields import SIZE, noise, ramp, stamps, step


def turf(random):
    """Short pile, brushed along x, nearly white: base_color dyes it. Trodden flat and dusty here and there."""
    strands = noise(random, 50, 250, 0.2, stretch_x=2.5)
    tufts = noise(random, 24, 110, 0.5)
    clumps = noise(random, 5, 24, 0.8)
    clouds = noise(random, 1, 5, 1.0)
    # Where feet turn: the pile lies flat, in short arcs' worth of strokes, and dust sits in it.
    scuffs = step(stamps(random, 34, 2.5, 6.0, aspect=5.0, any_angle=True) + 0.12 * tufts, 0.15, 0.8)
    flat = step(clouds + 0.35 * clumps, 0.6, 2.2)
    lint = stamps(random, 26, 0.7, 1.0, aspect=3.0, any_angle=True)
    share = 0.55 + 0.085 * strands + 0.075 * tufts + 0.05 * clumps + 0.06 * clouds - 0.15 * flat - 0.15 * scuffs
    tone = ramp(share, (0.40,) * 3, (0.74,) * 3, (0.98,) * 3)[..., 0]
    pile = (0.35 * tufts + 0.22 * strands) * (1.0 - 0.6 * np.maximum(flat, scuffs))
    return {'height': pile + 0.5 * clumps, 'color': np.clip(tone + 0.12 * lint, 0.0, 1.0),
            'roughness': np.full((SIZE, SIZE), 0.97), 'grades': 48}


def line_paint(random):
    """Water paint on pile, nearly white: thin where it was trodden, grey with dust and rubber."""
    tufts = noise(random, 24, 120, 0.4)
    worn = noise(random, 2, 30, 0.9)
    scuffs = step(stamps(random, 46, 1.5, 4.0, aspect=9.0, any_angle=True), 0.1, 0.9)
    thin = step(worn + 0.55 * tufts, 1.0, 2.4)
    share = 0.80 + 0.05 * tufts + 0.05 * noise(random, 1, 8, 1.0) - 0.42 * thin - 0.30 * scuffs
    colour = ramp(share, (0.34, 0.37, 0.33), (0.68, 0.69, 0.66), (0.97, 0.97, 0.95))
    return {'height': 0.5 * tufts - 0.6 * thin, 'color': colour,
            'roughness': np.full((SIZE, SIZE), 0.9), 'grades': 48}
