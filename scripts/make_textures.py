#!/usr/bin/python3
"""Makes materials/textures/: tileable PBR sets in the folder convention of ambientCG.

Usage: scripts/make_textures.py [NAME...]; needs numpy. Each set is one function that returns height (in pixels), colour
(sRGB), roughness and, for metals, metalness; normals follow from the height. Noise is made in the
frequency domain, so every field repeats without a seam. Seeds are fixed: the same files each time.
"""

import os
import struct
import sys
import zlib

import numpy as np

SIZE = 512
ROWS, COLUMNS = np.mgrid[0:SIZE, 0:SIZE] / SIZE


# ---- fields ---------------------------------------------------------------------------------------

def noise(random, low, high, slope=1.0, stretch_x=1.0, stretch_y=1.0):
    """Noise of mean 0 and deviation 1 with frequencies from low to high cycles a tile; amplitude falls
    as 1 / frequency^slope. Stretched: longer features along that axis."""
    fy = np.fft.fftfreq(SIZE, 1.0 / SIZE)[:, None] * stretch_y
    fx = np.fft.fftfreq(SIZE, 1.0 / SIZE)[None, :] * stretch_x
    frequency = np.hypot(fx, fy)
    inside = (frequency >= low) & (frequency <= high)
    gain = np.where(inside, np.maximum(frequency, 1e-9) ** -slope, 0.0)
    field = np.fft.ifft2(np.fft.fft2(random.standard_normal((SIZE, SIZE))) * gain).real
    field -= field.mean()
    return field / field.std()


def step(field, low, high):
    """0 below low, 1 above high, smooth between."""
    t = np.clip((field - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def blend(first, second, share):
    first, second = np.asarray(first, float), np.asarray(second, float)
    return first + (second - first) * share[..., None]


def ramp(share, *colours):
    """Colours at equal steps of share 0 to 1, linear between."""
    stops = np.linspace(0.0, 1.0, len(colours))
    share = np.clip(share, 0.0, 1.0)
    return np.stack([np.interp(share, stops, [c[i] for c in colours]) for i in range(3)], axis=-1)


def stamps(random, count, low, high, aspect=1.0, any_angle=False):
    """Round dots (or strokes, aspect > 1) of radii low to high pixels: 1 in the middle, 0 outside."""
    field = np.zeros((SIZE, SIZE))
    for _ in range(count):
        x, y = random.random(2) * SIZE
        radius = low * (high / low) ** random.random()
        angle = random.random() * np.pi if any_angle else 0.0
        reach = int(radius * aspect) + 2
        offsets = np.arange(-reach, reach + 1)
        dy, dx = offsets[:, None] - y % 1.0, offsets[None, :] - x % 1.0
        along = (dx * np.cos(angle) + dy * np.sin(angle)) / aspect
        across = dy * np.cos(angle) - dx * np.sin(angle)
        dot = np.clip(1.0 - (along ** 2 + across ** 2) / radius ** 2, 0.0, 1.0)
        place = np.ix_((int(y) + offsets) % SIZE, (int(x) + offsets) % SIZE)
        field[place] = np.maximum(field[place], dot)
    return field


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


SETS = [('Concrete01', concrete, 11), ('Planks01', planks, 12), ('Plywood01', plywood, 13),
        ('BrushedMetal01', brushed_metal, 14), ('PaintedMetal01', painted_metal, 15),
        ('Fabric01', fabric, 16), ('DiamondPlate01', diamond_plate, 17), ('Cardboard01', cardboard, 18)]


# ---- files ----------------------------------------------------------------------------------------

def normals(height):
    """OpenGL convention: x right, y up the image; the slope of the height in pixels."""
    right = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) / 2.0
    down = (np.roll(height, -1, 0) - np.roll(height, 1, 0)) / 2.0
    normal = np.stack([-right, down, np.ones_like(height)], axis=-1)
    return normal / np.linalg.norm(normal, axis=-1, keepdims=True)


def to_bytes(values):
    return np.floor(np.clip(values, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


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
    folder = os.path.join(root, name)
    os.makedirs(folder, exist_ok=True)
    images = {'Color': fields['color'], 'Roughness': fields['roughness'],
              'NormalGL': normals(fields['height']) * 0.5 + 0.5}
    if 'metalness' in fields:
        images['Metalness'] = fields['metalness']
    total = 0
    for map_name, values in images.items():
        path = os.path.join(folder, f'{name}_{map_name}.png')
        write_png(path, to_bytes(values))
        total += os.path.getsize(path)
    print(f'{name}: {total / 1024:.0f} KiB', flush=True)


def main():
    home = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    root = os.path.join(home, 'materials', 'textures')
    for name, make, seed in SETS:
        if len(sys.argv) < 2 or name in sys.argv[1:]:
            write_set(root, name, make(np.random.Generator(np.random.Philox(seed))))


main()
