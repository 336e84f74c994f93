"""Fields for make_textures.py: SIZE x SIZE arrays that repeat without a seam. Noise is made in the frequency domain."""

import numpy as np

SIZE = 512
ROWS, COLUMNS = np.mgrid[0:SIZE, 0:SIZE] / SIZE


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


def cells(random, count):
    """A net of cells around count x count points: distances to the nearest and to the second nearest, in
    cells, and the number of the nearest."""
    jitter = random.random((count, count, 2)) * 0.8 + 0.1
    x, y = COLUMNS * count, ROWS * count
    column, row = np.floor(x).astype(int), np.floor(y).astype(int)
    first, second = np.full((SIZE, SIZE), 9.0), np.full((SIZE, SIZE), 9.0)
    nearest = np.zeros((SIZE, SIZE), int)
    for dr in range(-2, 3):
        for dc in range(-2, 3):
            r, c = (row + dr) % count, (column + dc) % count
            distance = np.hypot(column + dc + jitter[r, c, 0] - x, row + dr + jitter[r, c, 1] - y)
            closer = distance < first
            second = np.where(closer, first, np.minimum(second, distance))
            nearest = np.where(closer, r * count + c, nearest)
            first = np.where(closer, distance, first)
    return first, second, nearest


def warped(field, right, down):
    """The field, pulled right and down by so many pixels."""
    row, column = np.mgrid[0:SIZE, 0:SIZE]
    return field[(row + np.rint(down).astype(int)) % SIZE, (column + np.rint(right).astype(int)) % SIZE]
