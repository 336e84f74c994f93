#!/usr/bin/python3
"""Makes materials/textures/: tileable PBR sets in the folder convention of ambientCG.

Usage: scripts/make_textures.py [NAME...]; needs numpy. Each set is one function that returns height (in pixels), colour
(sRGB; one channel: grey), roughness and, for metals, metalness; normals follow from the height. Seeds are
fixed: the same files each time.
"""

import os
import struct
import sys
import zlib

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import numpy as np

from make_textures_fields import COLUMNS, ROWS, SIZE, blend, cells, noise, ramp, stamps, step, warped
from make_textures_pitch import line_paint, turf


# ---- sets -----------------------------------------------------------------------------------------

def concrete(random):
    clouds = noise(random, 1, 24, 1.3)
    grain = noise(random, 40, 200, 0.3)
    pores = stamps(random, 260, 1.0, 4.5)
    sand = stamps(random, 2600, 0.8, 1.8)
    tone = 0.5 + 0.13 * clouds + 0.05 * grain + 0.08 * (sand - 0.3) - 0.35 * pores
    colour = ramp(tone, (0.38, 0.37, 0.35), (0.57, 0.56, 0.54), (0.70, 0.69, 0.66))
    return {'height': 0.8 * clouds + 0.25 * grain + 0.3 * sand - 3.0 * np.sqrt(pores),
            'color': colour, 'roughness': 0.82 + 0.03 * clouds + 0.05 * pores}


def grain_lines(random, rings, bend):
    """Growth rings along x: contours of a field that is stretched along the board."""
    field = noise(random, 1, 6, 1.6, stretch_x=5.0) * bend + 0.03 * noise(random, 4, 80, 1.0, 14.0)
    phase = (ROWS * rings + field * rings) % 1.0
    return step(phase, 0.0, 0.75) * (1.0 - step(phase, 0.86, 1.0))


def fibres(random):
    return noise(random, 12, 240, 0.35, stretch_x=40.0)


def planks(random):
    count, gap = 4, 2.2
    board = np.floor(ROWS * count).astype(int) % count
    within = (ROWS * count) % 1.0
    rings, tone = np.zeros((SIZE, SIZE)), np.zeros((SIZE, SIZE))
    for i, shade in zip(range(count), (0.05, -0.12, 0.14, -0.04)):
        # Each board from another part of the tree: its own rings, shifted along its length.
        own = grain_lines(random, 18, 0.16)
        rings[board == i] = own[board == i]
        tone[board == i] = shade
    fibre = fibres(random)
    edge = np.minimum(within, 1.0 - within) * SIZE / count
    groove = 1.0 - step(edge, gap * 0.4, gap * 1.6)
    share = 0.42 + tone + 0.34 * (rings - 0.5) + 0.07 * fibre
    colour = ramp(share, (0.62, 0.43, 0.26), (0.50, 0.32, 0.18), (0.34, 0.20, 0.105))
    colour = blend(colour, (0.09, 0.055, 0.03), groove * 0.9)
    return {'height': -0.5 * rings + 0.22 * fibre - 6.0 * groove, 'color': colour,
            'roughness': 0.5 + 0.10 * rings + 0.03 * fibre + 0.2 * groove}


def plywood(random):
    rings = grain_lines(random, 9, 0.42)
    fibre = fibres(random)
    flecks = stamps(random, 500, 0.7, 1.2, aspect=9.0)
    share = 0.35 + 0.38 * (rings - 0.4) + 0.09 * fibre + 0.25 * flecks + 0.06 * noise(random, 1, 5, 1.2)
    colour = ramp(share, (0.86, 0.74, 0.56), (0.78, 0.63, 0.44), (0.62, 0.46, 0.29))
    return {'height': -0.2 * rings + 0.16 * fibre - 0.4 * flecks, 'color': colour,
            'roughness': 0.55 + 0.04 * rings + 0.03 * fibre}


def brushed_metal(random):
    fine = noise(random, 6, 250, 0.1, stretch_x=90.0)
    coarse = noise(random, 2, 40, 0.6, stretch_x=24.0)
    share = 0.5 + 0.11 * fine + 0.09 * coarse
    return {'height': 0.22 * fine + 0.08 * coarse,
            'color': ramp(share, (0.56, 0.565, 0.57), (0.735, 0.735, 0.73), (0.84, 0.84, 0.83)),
            'roughness': 0.33 + 0.03 * fine + 0.03 * coarse, 'metalness': np.ones((SIZE, SIZE))}


def painted_metal(random):
    # Chips where scratches and soft spots of the paint meet.
    weak = noise(random, 2, 60, 1.15)
    fine = noise(random, 30, 180, 0.4)
    scratches = stamps(random, 60, 0.8, 1.5, aspect=40.0, any_angle=True)
    wear = weak + 0.18 * fine + 1.1 * scratches
    bare = step(wear, 1.75, 1.9)
    rim = step(wear, 1.35, 1.8) * (1.0 - bare)
    peel = noise(random, 12, 60, 0.6)
    rust = step(noise(random, 3, 90, 0.9), 0.2, 1.4)
    paint = ramp(0.5 + 0.12 * noise(random, 1, 12, 1.2) + 0.02 * fine,
                 (0.06, 0.22, 0.27), (0.10, 0.33, 0.38), (0.17, 0.42, 0.46))
    paint = blend(paint, (0.42, 0.46, 0.44), 0.55 * rim)
    metal = blend(ramp(0.5 + 0.2 * fine, (0.40, 0.39, 0.38), (0.60, 0.59, 0.57)), (0.33, 0.18, 0.09), rust)
    return {'height': 0.1 * peel - 2.0 * bare + 0.15 * fine * bare,
            'color': blend(paint, metal, bare),
            'roughness': 0.36 + 0.03 * peel + (0.12 + 0.25 * rust) * bare + 0.1 * rim,
            'metalness': bare * (1.0 - rust)}


def fabric(random):
    threads = 48
    u, v = COLUMNS * threads, ROWS * threads
    column, row = np.floor(u).astype(int), np.floor(v).astype(int)
    warp_up = (column + row) % 2 == 0
    across_u, across_v = u % 1.0 - 0.5, v % 1.0 - 0.5
    # A thread is a half round that dives under its neighbours at both ends of a crossing.
    warp = np.sqrt(np.clip(1.0 - (across_u / 0.5) ** 2, 0, 1)) * np.cos(np.pi * across_v * 0.9)
    weft = np.sqrt(np.clip(1.0 - (across_v / 0.5) ** 2, 0, 1)) * np.cos(np.pi * across_u * 0.9)
    body = np.where(warp_up, warp, weft)
    shades_u, shades_v = random.normal(0.0, 1.0, threads), random.normal(0.0, 1.0, threads)
    shade = np.where(warp_up, shades_u[column], 0.6 + shades_v[row])
    fuzz = noise(random, 60, 250, 0.0)
    share = 0.28 + 0.45 * body + 0.06 * shade + 0.04 * fuzz + 0.03 * noise(random, 1, 6, 1.0)
    return {'height': 2.6 * body + 0.25 * fuzz,
            'color': ramp(share, (0.07, 0.075, 0.09), (0.25, 0.28, 0.34), (0.45, 0.48, 0.54)),
            'roughness': 0.9 - 0.06 * body + 0.01 * fuzz}


def diamond_plate(random):
    height = np.zeros((SIZE, SIZE))
    cells = 6
    x, y = COLUMNS * cells, ROWS * cells
    for lean, shift in ((1.0, 0.0), (-1.0, 0.5)):
        # Two lattices of lozenges, each leaning to its own side.
        for offset in (0.0, 0.5):
            dx = (x + shift + offset) % 1.0 - 0.5
            dy = (y + offset) % 1.0 - 0.5
            along, across = (dx + lean * dy) / np.sqrt(2.0), (dy - lean * dx) / np.sqrt(2.0)
            lens = 1.0 - (np.abs(across) / 0.075 + (along / 0.235) ** 2)
            height = np.maximum(height, step(lens, 0.0, 0.9))
    dirt = noise(random, 1, 40, 1.0)
    fine = noise(random, 40, 220, 0.2)
    scratches = stamps(random, 160, 0.6, 1.0, aspect=30.0, any_angle=True)
    grime = np.clip(0.5 + 0.25 * dirt - 0.8 * height, 0.0, 1.0)
    share = 0.72 + 0.2 * height + 0.03 * fine + 0.15 * scratches - 0.4 * grime
    return {'height': 7.0 * height + 0.12 * fine - 0.3 * scratches,
            'color': ramp(share, (0.27, 0.265, 0.26), (0.52, 0.52, 0.52), (0.76, 0.76, 0.75)),
            'roughness': 0.30 + 0.26 * grime + 0.02 * fine - 0.06 * height,
            'metalness': np.ones((SIZE, SIZE))}


def cardboard(random):
    flutes = np.sin(2.0 * np.pi * COLUMNS * 40)
    pulp = noise(random, 4, 90, 0.7)
    fine = noise(random, 60, 240, 0.1)
    light = stamps(random, 900, 0.6, 1.1, aspect=10.0, any_angle=True)
    dark = stamps(random, 500, 0.5, 1.0, aspect=7.0, any_angle=True)
    share = 0.5 + 0.05 * flutes + 0.09 * pulp + 0.05 * fine + 0.22 * light - 0.3 * dark
    return {'height': 0.45 * flutes + 0.12 * pulp + 0.08 * fine + 0.15 * light,
            'color': ramp(share, (0.43, 0.30, 0.18), (0.65, 0.49, 0.32), (0.78, 0.63, 0.45)),
            'roughness': 0.88 + 0.02 * pulp}


def carpet(random):
    """Needle felt, nearly white: base_color dyes it."""
    low = stamps(random, 2600, 0.9, 1.5, aspect=9.0, any_angle=True)
    high = stamps(random, 2200, 0.9, 1.5, aspect=9.0, any_angle=True)
    tufts = noise(random, 10, 60, 0.5)
    pile = np.maximum(0.6 * low, high)
    share = 0.5 + 0.42 * (pile - 0.35) + 0.07 * tufts + 0.02 * noise(random, 1, 6, 1.0)
    return {'height': 2.0 * pile + 0.5 * tufts,
            'color': ramp(share, (0.52,) * 3, (0.80,) * 3, (0.97,) * 3)[..., 0],
            'roughness': 0.94 - 0.05 * pile, 'grades': 48}


def rusty_metal(random):
    spread = noise(random, 1, 30, 1.25) + 0.25 * noise(random, 20, 120, 0.7)
    rust = step(spread, -0.9, 0.5)
    old = step(spread, 0.3, 1.7)
    flakes = noise(random, 8, 120, 0.8)
    pits = stamps(random, 420, 0.8, 3.2)
    fine = noise(random, 40, 160, 0.3)
    metal = ramp(0.5 + 0.15 * fine + 0.1 * spread, (0.33, 0.31, 0.29), (0.50, 0.475, 0.45))
    orange = ramp(0.5 + 0.2 * flakes, (0.25, 0.115, 0.055), (0.41, 0.205, 0.095), (0.53, 0.30, 0.155))
    dark = ramp(0.5 + 0.2 * flakes, (0.11, 0.052, 0.035), (0.26, 0.12, 0.07))
    colour = blend(blend(metal, orange, rust), dark, 0.85 * old)
    return {'height': rust * (0.9 + 0.45 * flakes) + 1.2 * old - 2.0 * pits * rust,
            'color': blend(colour, (0.09, 0.05, 0.035), 0.6 * pits * rust),
            'roughness': 0.42 + 0.42 * rust + 0.03 * flakes, 'metalness': 1.0 - rust, 'grades': 48}


def scratched_metal(random):
    long = stamps(random, 110, 0.7, 1.0, aspect=130.0, any_angle=True)
    short = stamps(random, 420, 0.6, 0.9, aspect=28.0, any_angle=True)
    dents = stamps(random, 26, 4.0, 14.0)
    smudge = noise(random, 1, 14, 1.2)
    scratch = np.maximum(long, 0.8 * short)
    share = 0.45 + 0.32 * scratch + 0.06 * smudge
    return {'height': -0.7 * scratch - 1.6 * dents,
            'color': ramp(share, (0.42, 0.425, 0.43), (0.60, 0.605, 0.61), (0.80, 0.80, 0.80)),
            'roughness': np.clip(0.32 + 0.07 * smudge + 0.16 * scratch, 0.18, 0.7),
            'metalness': np.ones((SIZE, SIZE)), 'grades': 96}


def brick(random):
    rows, columns, joint = 8, 3, 0.085
    y = ROWS * rows
    row = np.floor(y).astype(int)
    x = COLUMNS * columns + 0.5 * (row % 2)
    column = np.floor(x).astype(int) % columns
    wobble = 0.010 * noise(random, 4, 40, 0.8)
    aspect = rows / columns
    edge_x = (0.5 - np.abs(x % 1.0 - 0.5)) * aspect
    edge_y = 0.5 - np.abs(y % 1.0 - 0.5)
    edge = np.minimum(edge_x, edge_y) - joint + wobble
    face = step(edge, 0.0, 0.07)
    shades = random.normal(0.0, 1.0, (rows, columns))[row, column]
    warmth = random.normal(0.0, 1.0, (rows, columns))[row, column]
    clouds, grit = noise(random, 3, 40, 1.0), noise(random, 40, 150, 0.3)
    pores = stamps(random, 420, 0.8, 2.6) * face
    tone = 0.5 + 0.15 * shades + 0.10 * clouds + 0.05 * grit
    clay = ramp(tone, (0.30, 0.115, 0.075), (0.50, 0.22, 0.145), (0.64, 0.34, 0.23))
    clay = blend(clay, (0.42, 0.27, 0.20), np.clip(0.25 + 0.2 * warmth, 0.0, 0.6))
    mortar = ramp(0.5 + 0.12 * clouds + 0.12 * grit, (0.46, 0.445, 0.42), (0.66, 0.645, 0.61))
    return {'height': 6.0 * face + 0.5 * clouds + 0.3 * grit - 2.5 * pores,
            'color': blend(blend(mortar, clay, face), (0.17, 0.08, 0.06), 0.7 * pores),
            'roughness': 0.88 - 0.06 * face + 0.02 * clouds, 'grades': 64}


def marble(random):
    rough = noise(random, 6, 60, 1.3)
    veins = np.zeros((SIZE, SIZE))
    for slant, bend, width, weight in ((1, 0.17, 0.05, 1.0), (2, 0.11, 0.03, 0.55), (3, 0.13, 0.025, 0.4)):
        # Bands that run across the tile, bent by noise.
        field = COLUMNS * slant + ROWS * (slant + 1) + bend * noise(random, 1, 12, 1.5) + 0.016 * rough
        line = np.clip(1.0 - np.abs(field % 1.0 - 0.5) / (3.5 * width), 0.0, 1.0)
        strength = step(noise(random, 1, 8, 1.0), -0.9, 1.4)
        veins = np.maximum(veins, weight * strength * (0.6 * line ** 7 + 0.4 * line ** 1.6))
    clouds = noise(random, 1, 40, 1.5)
    share = 0.80 + 0.10 * clouds - 0.9 * veins
    return {'height': -0.25 * veins,
            'color': ramp(share, (0.30, 0.30, 0.31), (0.60, 0.60, 0.605), (0.83, 0.825, 0.81), (0.93, 0.925, 0.91)),
            'roughness': 0.17 + 0.06 * veins + 0.012 * clouds}


def granite(random):
    first, second, number = cells(random, 70)
    right, down = 1.8 * noise(random, 20, 120, 0.4), 1.8 * noise(random, 20, 120, 0.4)
    first, second, number = (warped(field, right, down) for field in (first, second, number))
    kind = random.random(70 * 70)[number]
    tone = random.normal(0.0, 1.0, 70 * 70)[number]
    inner = step(second - first, 0.0, 0.22)
    colour = np.empty((SIZE, SIZE, 3))
    # Feldspar, quartz, plagioclase, mica.
    for low, high, dark, light in ((0.0, 0.42, (0.52, 0.37, 0.32), (0.68, 0.52, 0.46)),
                                   (0.42, 0.68, (0.48, 0.475, 0.47), (0.64, 0.635, 0.63)),
                                   (0.68, 0.84, (0.70, 0.68, 0.655), (0.83, 0.81, 0.79)),
                                   (0.84, 1.01, (0.045, 0.045, 0.05), (0.13, 0.125, 0.125))):
        chosen = (kind >= low) & (kind < high)
        colour[chosen] = ramp(0.5 + 0.3 * tone + 0.06 * noise(random, 30, 120, 0.3), dark, light)[chosen]
    flecks = stamps(random, 900, 0.8, 2.6, aspect=1.8, any_angle=True) > 0.3
    colour = blend(colour * (0.82 + 0.18 * inner)[..., None], (0.07, 0.068, 0.07), 0.85 * flecks)
    mica = (kind >= 0.84) | flecks
    return {'height': 0.12 * inner - 0.2 * mica, 'color': colour, 'roughness': 0.20 + 0.12 * mica, 'grades': 48}


def rubber_mat(random):
    count = 8
    x, y = COLUMNS * count, ROWS * count
    dx, dy = x % 1.0 - 0.5, y % 1.0 - 0.5
    stud = step(0.36 - np.hypot(dx, dy), 0.0, 0.05)
    ring = np.abs(np.hypot(dx, dy) - 0.36) < 0.03
    grain = noise(random, 30, 140, 0.3)
    dust = np.clip(0.35 + 0.3 * noise(random, 1, 30, 1.0) - 0.5 * stud + 0.15 * ring, 0.0, 1.0)
    scuffs = stamps(random, 60, 0.8, 1.3, aspect=24.0, any_angle=True) * stud
    share = 0.25 + 0.5 * dust + 0.03 * grain + 0.35 * scuffs + 0.10 * stud
    return {'height': 5.0 * stud + 0.12 * grain,
            'color': ramp(share, (0.055, 0.055, 0.057), (0.115, 0.114, 0.112), (0.24, 0.235, 0.225)),
            'roughness': 0.70 + 0.18 * dust - 0.05 * stud, 'grades': 48}


def leather(random):
    right, down = 1.6 * noise(random, 4, 24, 0.8), 1.6 * noise(random, 4, 24, 0.8)
    first, second, _ = cells(random, 38)
    pebble = step(warped(second - first, right, down), 0.02, 0.42)
    creases = warped(noise(random, 2, 12, 1.0), right, down)
    crease = (1.0 - np.clip(np.abs(creases) / 0.10, 0.0, 1.0)) * step(noise(random, 1, 6, 1.0), 0.0, 1.0)
    clouds = noise(random, 1, 16, 1.2)
    share = 0.34 + 0.32 * pebble + 0.09 * clouds - 0.25 * crease
    return {'height': 2.4 * pebble - 1.6 * crease,
            'color': ramp(share, (0.13, 0.062, 0.032), (0.33, 0.165, 0.085), (0.52, 0.29, 0.16)),
            'roughness': 0.62 - 0.16 * pebble + 0.02 * clouds, 'grades': 48}


SETS = [('Concrete01', concrete, 11), ('Planks01', planks, 12), ('Plywood01', plywood, 13),
        ('BrushedMetal01', brushed_metal, 14), ('PaintedMetal01', painted_metal, 15),
        ('Fabric01', fabric, 16), ('DiamondPlate01', diamond_plate, 17), ('Cardboard01', cardboard, 18),
        ('Carpet01', carpet, 19), ('RustyMetal01', rusty_metal, 20), ('ScratchedMetal01', scratched_metal, 21),
        ('Brick01', brick, 22), ('Marble01', marble, 23), ('Granite01', granite, 24),
        ('RubberMat01', rubber_mat, 25), ('Leather01', leather, 26),
        ('Turf01', turf, 40), ('LinePaint01', line_paint, 41)]


# ---- files ----------------------------------------------------------------------------------------

def normals(height):
    """OpenGL convention: x right, y up the image; the slope of the height in pixels."""
    right = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) / 2.0
    down = (np.roll(height, -1, 0) - np.roll(height, 1, 0)) / 2.0
    normal = np.stack([-right, down, np.ones_like(height)], axis=-1)
    return normal / np.linalg.norm(normal, axis=-1, keepdims=True)


def to_bytes(values, grades=256):
    """Fewer grades than 256 make smaller files; 128, the level of a plain normal, stays one of them."""
    size = 256.0 / grades
    rounded = np.floor((np.clip(values, 0.0, 1.0) * 255.0 + 0.5) / size + (0.5 if grades < 256 else 0.0)) * size
    return np.clip(rounded, 0.0, 255.0).astype(np.uint8)


def filtered_row(row, before, bytes_a_pixel):
    """The PNG filter with the smallest sum of differences, as libpng chooses it."""
    left = np.concatenate([np.zeros(bytes_a_pixel, np.int16), row[:-bytes_a_pixel]])
    corner = np.concatenate([np.zeros(bytes_a_pixel, np.int16), before[:-bytes_a_pixel]])
    guess = left + before - corner
    distances = np.stack([abs(guess - left), abs(guess - before), abs(guess - corner)])
    paeth = np.choose(np.argmin(distances, axis=0), [left, before, corner])
    candidates = [row, row - left, row - before, row - (left + before) // 2, row - paeth]
    costs = [np.abs(c.astype(np.int8).astype(np.int16)).sum() for c in candidates]
    best = int(np.argmin(costs))
    return bytes([best]) + candidates[best].astype(np.uint8).tobytes()


def write_png(path, pixels):
    height, width = pixels.shape[:2]
    channels = 1 if pixels.ndim == 2 else 3
    rows = pixels.reshape(height, width * channels).astype(np.int16)
    before, raw = np.zeros(width * channels, np.int16), []
    for row in rows:
        raw.append(filtered_row(row, before, channels))
        before = row
    header = struct.pack('>IIBBBBB', width, height, 8, 0 if channels == 1 else 2, 0, 0, 0)
    with open(path, 'wb') as out:
        out.write(b'\x89PNG\r\n\x1a\n')
        for kind, data in ((b'IHDR', header), (b'IDAT', zlib.compress(b''.join(raw), 9)), (b'IEND', b'')):
            out.write(struct.pack('>I', len(data)) + kind + data)
            out.write(struct.pack('>I', zlib.crc32(kind + data)))


def write_set(root, name, fields):
    """grades, if given: of the normals and the roughness; the colour has twice as many."""
    folder = os.path.join(root, name)
    os.makedirs(folder, exist_ok=True)
    images = {'Color': fields['color'], 'Roughness': fields['roughness'],
              'NormalGL': normals(fields['height']) * 0.5 + 0.5}
    if 'metalness' in fields:
        images['Metalness'] = fields['metalness']
    total = 0
    for map_name, values in images.items():
        path = os.path.join(folder, f'{name}_{map_name}.png')
        grades = 256 if map_name == 'Metalness' else fields.get('grades', 256)
        write_png(path, to_bytes(values, min(256, 2 * grades) if map_name == 'Color' else grades))
        total += os.path.getsize(path)
    print(f'{name}: {total / 1024:.0f} KiB', flush=True)


def main():
    home = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    root = os.path.join(home, 'materials', 'textures')
    for name, make, seed in SETS:
        if len(sys.argv) < 2 or name in sys.argv[1:]:
            write_set(root, name, make(np.random.Generator(np.random.Philox(seed))))


if __name__ == '__main__':
    main()
