#!/usr/bin/python3
"""Makes materials/hdri/: equirectangular environment maps as linear OpenEXR files of half floats.

Usage: scripts/make_hdris.py [NAME...]; needs numpy. Each map is one function from directions (unit vectors,
z up) to radiance (linear Rec. 709). Blender's layout: the middle of the image looks along +x, its left
along +y, its top up. The mean radiance over the sphere becomes MEAN. Seeds are fixed, and the files hold no
date: the same files each time.
"""

import os
import struct
import sys
import zlib

import numpy as np

WIDTH, HEIGHT, SAMPLES = 512, 256, 4
MEAN = 0.7
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def step(field, low, high):
    """0 below low, 1 above high, smooth between."""
    t = np.clip((field - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def mix(first, second, share):
    first, second = np.asarray(first, float), np.asarray(second, float)
    return first + (second - first) * np.asarray(share)[..., None]


def noise(random, points, low, high, waves=48):
    """Smooth noise of mean 0 and deviation 1 in space, of low to high radians a unit."""
    total = np.zeros(points.shape[:-1])
    for _ in range(waves):
        axis = random.standard_normal(3)
        frequency = low * (high / low) ** random.random()
        total += np.sin(points @ (axis / np.linalg.norm(axis) * frequency) + random.random() * 2.0 * np.pi) \
            * (low / frequency) ** 0.6
    return total / total.std()


def towards(azimuth_deg, elevation_deg):
    a, e = np.radians(azimuth_deg), np.radians(elevation_deg)
    return np.array([np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e)])


# ---- maps -----------------------------------------------------------------------------------------

def soft_box(directions, azimuth, elevation, width, height, radiance, roll_deg=0.0):
    """A cloth lit from behind: brightest in the middle; width and height for a distance of 1."""
    middle = towards(azimuth, elevation)
    right = np.cross(middle, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    upward = np.cross(right, middle)
    c, s = np.cos(np.radians(roll_deg)), np.sin(np.radians(roll_deg))
    right, upward = c * right + s * upward, c * upward - s * right
    depth = directions @ middle
    ahead = depth > 1e-3
    x = np.where(ahead, directions @ right / np.where(ahead, depth, 1.0), 9.0) / (width / 2.0)
    y = np.where(ahead, directions @ upward / np.where(ahead, depth, 1.0), 9.0) / (height / 2.0)
    edge = 1.0 - step(np.maximum(np.abs(x), np.abs(y)), 0.93, 1.0)
    glow = 0.55 + 0.45 * np.exp(-1.2 * (x * x + y * y))
    return (edge * glow)[..., None] * np.asarray(radiance)


def studio(_random, directions):
    """Dark grey room with a cove; a large key on the left, a fill, a top light and two strips behind."""
    up = directions[..., 2]
    wall = mix((0.040, 0.041, 0.043), (0.075, 0.077, 0.082), np.exp(-((up - 0.02) / 0.3) ** 2))
    light = mix((0.085, 0.083, 0.080), wall, step(up, -0.35, -0.02))
    for box in ((42.0, 38.0, 0.95, 0.95, (13.0, 12.4, 11.6), 6.0),
                (-58.0, 22.0, 0.62, 1.05, (4.6, 5.0, 5.6), 0.0),
                (5.0, 78.0, 1.20, 0.55, (7.5, 7.5, 7.6), 20.0),
                (152.0, 26.0, 0.20, 1.10, (12.0, 12.2, 12.6), 0.0),
                (-140.0, 26.0, 0.20, 1.10, (9.0, 9.2, 9.8), 0.0)):
        light = light + soft_box(directions, *box)
    return light


def overcast(random, directions):
    """The CIE's overcast sky with some structure, over dark ground with a line of trees far away."""
    up = directions[..., 2]
    high = np.clip(up, 0.0, 1.0)
    # Clouds lie on a plane overhead and shrink towards the horizon.
    plane = np.stack([directions[..., 0] / (high + 0.16), directions[..., 1] / (high + 0.16), 0.0 * up], -1)
    clouds = noise(random, plane, 1.2, 9.0)
    fade = step(high, 0.02, 0.25)
    sun = np.exp(-(1.0 - directions @ towards(65.0, 48.0)) / 0.10)
    value = (1.0 + 2.0 * high) / 3.0 * (1.0 + 0.11 * clouds * fade) + 0.45 * sun
    sky = value[..., None] * mix((0.93, 0.97, 1.04), (1.06, 1.0, 0.93), np.clip(0.5 * sun + 0.12 * clouds * fade, 0, 1))
    flat = np.stack([directions[..., 0], directions[..., 1], 0.0 * up], -1)
    flat /= np.maximum(1e-6, np.linalg.norm(flat, axis=-1, keepdims=True))
    trees = 0.035 + 0.016 * noise(random, flat, 3.0, 14.0) + 0.006 * noise(random, flat, 30.0, 90.0)
    wood = mix((0.035, 0.045, 0.028), (0.10, 0.115, 0.11), step(up, 0.0, 0.09))
    low = np.clip(-up, 1e-4, 1.0)
    soil = np.stack([directions[..., 0] / (low + 0.05), directions[..., 1] / (low + 0.05), 0.0 * up], -1)
    patches = noise(random, soil, 0.8, 12.0) * step(low, 0.02, 0.3)
    ground = mix((0.115, 0.11, 0.095), (0.20, 0.20, 0.195), np.exp(-low / 0.12)) * (1.0 + 0.12 * patches)[..., None]
    scene = mix(wood, sky, step(up - trees, -0.002, 0.004))
    return mix(ground, scene, step(up, -0.004, 0.002))


HALL_LOW, HALL_HIGH = np.array([-17.0, -11.0, -0.9]), np.array([15.0, 12.0, 7.6])


def lamp_rows(x, y):
    """1 on a luminaire: four rows along the hall, panels of 1.5 m x 0.4 m every 3.2 m."""
    lit = np.zeros(x.shape)
    for row in (-7.5, -2.5, 2.5, 7.5):
        along = (x + 0.4) % 3.2 - 1.6
        lit += (1.0 - step(np.abs(along), 0.72, 0.78)) * (1.0 - step(np.abs(y - row), 0.18, 0.22))
    return lit


def hall(random, directions):
    """Indoors on the floor of a sports hall: lamps between beams, windows high in one wall, a green floor."""
    with np.errstate(divide='ignore', invalid='ignore'):
        reach = np.where(directions > 0.0, HALL_HIGH / directions, HALL_LOW / directions)
    reach = np.where(np.isfinite(reach), reach, 1e9)
    side = np.argmin(reach, axis=-1)
    points = directions * np.min(reach, axis=-1)[..., None]
    x, y, z = points[..., 0], points[..., 1], points[..., 2] - HALL_LOW[2]
    # Corners are darker, and so is what lies far from the lamps.
    inset = np.minimum(points - HALL_LOW, HALL_HIGH - points)
    others = np.sort(inset, axis=-1)[..., 1]
    shade = 0.62 + 0.38 * step(others, 0.0, 2.5)

    beams = step(np.abs((x + 2.0) % 3.2 - 1.6), 1.36, 1.42)
    ceiling = mix((0.20, 0.20, 0.195), (0.13, 0.125, 0.12), beams) * (1.0 + 0.1 * np.cos(y * 12.0))[..., None]
    ceiling = ceiling * shade[..., None] + lamp_rows(x, y)[..., None] * np.array([13.5, 13.2, 12.2])

    along = np.where(side == 0, y, x)
    boards = 0.06 * np.cos(2.0 * np.pi * z / 0.24) ** 8
    grain = 0.05 * noise(random, np.stack([along * 0.4, z * 9.0, side * 7.0], -1), 1.0, 6.0)
    wood = np.array([0.36, 0.235, 0.13]) * (1.0 - boards + grain)[..., None]
    blocks = np.maximum(step(np.abs(z % 0.4 - 0.2), 0.185, 0.195), step(np.abs(along % 0.8 - 0.4), 0.388, 0.394))
    plaster = np.array([0.43, 0.425, 0.40]) * (1.0 - 0.10 * blocks)[..., None]
    wall = mix(wood, plaster, step(z, 2.58, 2.62))
    wall = mix(wall, (0.11, 0.16, 0.27), step(z, 2.62, 2.66) * (1.0 - step(z, 2.96, 3.0)))
    door = (1.0 - step(np.abs(along + 4.0), 1.05, 1.1)) * (1.0 - step(z, 2.2, 2.25)) * (side == 0)
    wall = mix(wall, (0.10, 0.12, 0.13), door)
    wall = wall * (shade * (0.62 + 0.38 * step(z, 0.0, 5.5)))[..., None]
    glass = step(z, 4.9, 4.95) * (1.0 - step(z, 7.0, 7.05)) * ((side == 1) & (y > 0.0))
    glass = glass * (1.0 - step(np.abs((x + 0.3) % 1.6 - 0.8), 0.70, 0.73))
    wall = mix(wall, np.array([2.7, 3.1, 3.7]), glass)

    distance = np.hypot(x, y)
    floor = np.array([0.070, 0.165, 0.085]) * (0.85 + 0.25 * step(others, 0.0, 4.0))[..., None]
    stripes = (np.abs(np.abs(x) - 9.0) < 0.04) | (np.abs(y - 6.5) < 0.04) | (np.abs(y + 6.5) < 0.04)
    floor = mix(floor, (0.5, 0.5, 0.48), stripes * 0.8)
    # Lamps mirrored in the varnish, blurred; more where the view grazes.
    tall = HALL_HIGH[2] - HALL_LOW[2]
    stretch = 1.0 + tall / -HALL_LOW[2]
    mirrored_y = y * stretch
    rows = sum(np.exp(-((mirrored_y - row) / 0.8) ** 2) for row in (-7.5, -2.5, 2.5, 7.5))
    graze = 0.04 + 0.5 * (1.0 - np.clip(-directions[..., 2], 0.0, 1.0)) ** 5
    inside = 1.0 - step(np.abs(x * stretch + 1.0), 11.0, 17.0)
    floor = floor + (graze * rows * inside * 1.6 * np.exp(-distance / 9.0))[..., None]

    light = np.where((side == 2)[..., None], np.where((points[..., 2] > 0.0)[..., None], ceiling, floor), wall)
    return light


ARENA_LOW, ARENA_HIGH = np.array([-13.0, -9.0, -0.5]), np.array([13.0, 9.0, 7.0])
CLOTH = np.array([(0.45, 0.03, 0.03), (0.03, 0.06, 0.30), (0.02, 0.02, 0.02), (0.45, 0.45, 0.44), (0.05, 0.22, 0.08),
                  (0.40, 0.20, 0.03), (0.16, 0.16, 0.18), (0.10, 0.03, 0.16), (0.50, 0.40, 0.05), (0.03, 0.20, 0.24)])


def crowd(random, along, z, wall, spacing, share):
    """People side by side: how much of the wall they hide, and their colours."""
    count = 128
    cloth = CLOTH[random.integers(0, len(CLOTH), count)]
    legs = CLOTH[random.integers(0, 3, count)] * 0.5 + 0.012
    skin = np.array([0.42, 0.24, 0.16]) * random.uniform(0.25, 1.1, (count, 1))
    shift, tall = random.uniform(-0.16, 0.16, count), random.uniform(0.78, 1.08, count)
    there = random.random(count) < share
    who = (np.floor(along / spacing).astype(int) + 37 * wall) % count
    x = (along / spacing - np.floor(along / spacing) - 0.5) * spacing - shift[who]
    height = z / tall[who]
    body = np.maximum(np.abs(x) / 0.25, np.abs(height - 0.72) / 0.74) ** 4
    head = np.hypot(x / 0.10, (height - 1.6) / 0.14)
    hidden = np.where(np.minimum(body, head) < 1.0, 1.0, 0.0) * there[who]
    colour = np.where((head < 1.0)[..., None], skin[who], np.where((height > 0.8)[..., None], cloth[who], legs[who]))
    return hidden, colour * (0.75 + 0.25 * np.cos(x * 6.0))[..., None]


def banners(random, along, z, wall):
    """Cloth on the boards around the field, with stripes for letters."""
    count, width = 64, 2.6
    ground = CLOTH[random.integers(0, len(CLOTH), count)] * 1.3
    ink = np.where((ground.sum(1) < 0.6)[:, None], np.full(3, 0.6), np.full(3, 0.03))
    which = (np.floor(along / width).astype(int) + 19 * wall) % count
    x = along / width - np.floor(along / width)
    letters = (np.sin(2.0 * np.pi * x * (7.0 + which % 5)) > -0.1) & (x > 0.12) & (x < 0.86)
    letters &= np.abs(z - 0.52) < 0.16 * (0.6 + 0.4 * np.sin(40.0 * x + which))
    inside = (np.abs(x - 0.5) < 0.47) & (np.abs(z - 0.5) < 0.36) & (which % 4 != 0)
    return inside * 1.0, np.where(letters[..., None], ink[which], ground[which])


def arena(window, lamp):
    """A hall at a tournament: banners on boards, people behind them, tables, and windows that show `window`."""
    def make(random, directions):
        with np.errstate(divide='ignore', invalid='ignore'):
            reach = np.where(directions > 0.0, ARENA_HIGH / directions, ARENA_LOW / directions)
        reach = np.where(np.isfinite(reach), reach, 1e9)
        side = np.argmin(reach, axis=-1)
        points = directions * np.min(reach, axis=-1)[..., None]
        x, y, z = points[..., 0], points[..., 1], points[..., 2] - ARENA_LOW[2]
        along = np.where(side == 0, y, x)
        wall = 2 * side + (np.where(side == 0, x, y) > 0.0)
        light = 0.55 + 0.45 * step(z, -0.5, 4.0)
        plaster = np.array([0.46, 0.45, 0.42]) * (1.0 - 0.06 * step(np.abs(along % 3.0 - 1.5), 1.42, 1.46))[..., None]
        surface = mix(plaster, (0.24, 0.27, 0.31), 1.0 - step(z, 2.3, 2.34))
        posters, poster_colour = banners(random, along + 0.7, (z - 3.2) / 1.3, wall)
        surface = mix(surface, poster_colour, posters * (wall % 2))
        tables = (1.0 - step(np.abs(z - 0.74), 0.03, 0.05)) * (np.abs(along % 4.0 - 2.0) < 1.6)
        for spacing, share in ((0.62, 0.5), (0.85, 0.45)):
            hidden, colour = crowd(random, along, z - 0.1, wall, spacing, share)
            surface = mix(surface, colour, hidden)
        surface = mix(surface, (0.30, 0.24, 0.17), tables)
        screens = (np.abs(along % 2.0 - 1.0) < 0.17) & (np.abs(z - 0.92) < 0.12) & (np.floor(along / 2.0) % 3 != 0)
        surface = mix(surface, (0.25, 0.34, 0.45), screens * 1.0)
        boards = 1.0 - step(z, 0.55, 0.57)
        surface = mix(surface, (0.50, 0.50, 0.48), boards)
        hung, cloth = banners(random, along, z / 0.56, wall)
        surface = mix(surface, cloth, hung * boards) * light[..., None]
        glass = step(z, 4.4, 4.45) * (1.0 - step(z, 6.4, 6.45)) * (1.0 - step(np.abs(along % 2.1 - 1.05), 0.92, 0.95))
        glass = glass * ((side == 1) | (wall == 1))
        clouds = 1.0 + 0.25 * noise(random, np.stack([along, z, 0.0 * z], -1), 0.5, 3.0)
        surface = mix(surface, np.array(window) * np.clip(clouds, 0.3, 2.0)[..., None], glass)
        trusses = step(np.abs(x % 4.0 - 2.0), 1.86, 1.9)
        ceiling = mix((0.22, 0.22, 0.215), (0.10, 0.10, 0.105), trusses)
        ceiling = ceiling + lamp_rows(x, y)[..., None] * np.array(lamp)
        floor = np.array([0.17, 0.165, 0.16]) * np.ones(z.shape + (1,))
        level = np.where((points[..., 2] > 0.0)[..., None], ceiling, floor)
        return np.where((side == 2)[..., None], level, surface)
    return make


MAPS = [('studio', studio, 31), ('overcast', overcast, 32), ('hall', hall, 33),
        ('arena_day', arena((3.4, 3.7, 4.2), (9.0, 9.0, 8.8)), 34),
        ('arena_evening', arena((1.5, 0.85, 0.55), (13.0, 11.4, 8.6)), 35),
        ('arena_night', arena((0.02, 0.025, 0.05), (13.5, 13.3, 13.0)), 36)]


# ---- files ----------------------------------------------------------------------------------------

def directions_of(width, height):
    """The direction of each pixel's middle."""
    azimuth = 2.0 * np.pi * (0.5 - (np.arange(width) + 0.5) / width)
    elevation = np.pi * (0.5 - (np.arange(height) + 0.5) / height)
    a, e = np.meshgrid(azimuth, elevation)
    return np.stack([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)], axis=-1)


def render(make, seed):
    """HEIGHT x WIDTH x 3, each pixel the mean of SAMPLES x SAMPLES directions."""
    random = np.random.Generator(np.random.Philox(seed))
    fine = make(random, directions_of(WIDTH * SAMPLES, HEIGHT * SAMPLES))
    image = fine.reshape(HEIGHT, SAMPLES, WIDTH, SAMPLES, 3).mean(axis=(1, 3))
    solid_angle = np.sin(np.pi * (np.arange(HEIGHT) + 0.5) / HEIGHT)
    mean = ((image @ LUMINANCE).mean(axis=1) * solid_angle).sum() / solid_angle.sum()
    return image * (MEAN / mean)


def attribute(name, kind, data):
    return name.encode() + b'\0' + kind.encode() + b'\0' + struct.pack('<I', len(data)) + data


def zip_block(raw):
    """OpenEXR's ZIP: the bytes' halves apart, differences, deflate; as it was if that is not smaller."""
    data = np.frombuffer(raw, np.uint8)
    apart = np.concatenate([data[0::2], data[1::2]]).astype(np.int16)
    apart[1:] = (apart[1:] - apart[:-1] + 128) % 256
    packed = zlib.compress(apart.astype(np.uint8).tobytes(), 9)
    return packed if len(packed) < len(raw) else raw


def write_exr(path, image):
    height, width = image.shape[:2]
    window = struct.pack('<4i', 0, 0, width - 1, height - 1)
    channels = b''.join(name + b'\0' + struct.pack('<iB3xii', 1, 0, 1, 1) for name in (b'B', b'G', b'R')) + b'\0'
    header = struct.pack('<II', 20000630, 2)
    header += attribute('channels', 'chlist', channels) + attribute('compression', 'compression', b'\x03')
    header += attribute('dataWindow', 'box2i', window) + attribute('displayWindow', 'box2i', window)
    header += attribute('lineOrder', 'lineOrder', b'\0')
    header += attribute('pixelAspectRatio', 'float', struct.pack('<f', 1.0))
    header += attribute('screenWindowCenter', 'v2f', struct.pack('<2f', 0.0, 0.0))
    header += attribute('screenWindowWidth', 'float', struct.pack('<f', 1.0)) + b'\0'
    halves = image[..., ::-1].astype('<f2')
    blocks = []
    for y in range(0, height, 16):
        # Line by line, all of B, then of G, then of R.
        packed = zip_block(halves[y:y + 16].transpose(0, 2, 1).tobytes())
        blocks.append(struct.pack('<iI', y, len(packed)) + packed)
    offset, offsets = len(header) + 8 * len(blocks), []
    for block in blocks:
        offsets.append(offset)
        offset += len(block)
    with open(path, 'wb') as out:
        out.write(header + struct.pack(f'<{len(offsets)}Q', *offsets) + b''.join(blocks))


def main():
    folder = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'materials', 'hdri')
    os.makedirs(folder, exist_ok=True)
    for name, make, seed in MAPS:
        if len(sys.argv) < 2 or name in sys.argv[1:]:
            path = os.path.join(folder, name + '.exr')
            image = render(make, seed)
            write_exr(path, image)
            print(f'{name}: {os.path.getsize(path) / 1024:.0f} KiB, radiance {image.min():.3f} to {image.max():.1f}',
                  flush=True)


main()
