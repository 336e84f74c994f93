"""Families of surfaces for make_materials.py. Each function makes one material of its family: height in pixels of the
tile, colour (sRGB, by light or dark of one hue), roughness, and for metals how metallic; of SIZE x SIZE, without a seam."""

import numpy as np

from make_textures_fields import COLUMNS, ROWS, SIZE, blend, cells, noise, ramp, stamps, step, warped

ONE = np.ones((SIZE, SIZE))


def shades(colour, spread=0.5):
    """Dark, the colour itself, light."""
    colour = np.asarray(colour, float)
    return colour * (1.0 - spread), colour, np.clip(colour + (1.0 - colour) * spread * 0.6, 0.0, 1.0)


def surface(height, colour, roughness, metallic=None):
    return {'height': height, 'color': colour, 'roughness': np.clip(roughness, 0.04, 1.0),
            'metalness': np.zeros((SIZE, SIZE)) if metallic is None else metallic}


# ---- metals ---------------------------------------------------------------------------------------

def brushed(random, colour, rough=0.3):
    fine = noise(random, 6, 250, 0.1, stretch_x=90.0)
    coarse = noise(random, 2, 40, 0.6, stretch_x=24.0)
    return surface(0.25 * fine + 0.1 * coarse, ramp(0.5 + 0.11 * fine + 0.09 * coarse, *shades(colour, 0.28)),
                   rough + 0.03 * fine + 0.03 * coarse, ONE)


def cast(random, colour, rough=0.6):
    lumps, grain = noise(random, 10, 80, 0.7), noise(random, 60, 200, 0.2)
    pits = stamps(random, 340, 1.0, 4.0)
    return surface(0.9 * lumps + 0.3 * grain - 2.2 * pits,
                   ramp(0.5 + 0.10 * lumps + 0.06 * grain - 0.3 * pits, *shades(colour, 0.35)),
                   rough + 0.05 * lumps + 0.1 * pits, ONE)


def milled(random, colour, passes=7):
    """Arcs that a face mill leaves, pass beside pass."""
    within = (ROWS * passes) % 1.0 - 0.5
    arcs = (COLUMNS * 34 + 6.0 * within ** 2 + 0.02 * noise(random, 1, 8, 1.0)) % 1.0
    groove = np.sqrt(np.clip(1.0 - (2.0 * arcs - 1.0) ** 2, 0.0, 1.0))
    seam = 1.0 - step(0.5 - np.abs(within), 0.0, 0.035)
    fine = noise(random, 40, 240, 0.1)
    return surface(-0.7 * groove - 0.9 * seam + 0.08 * fine,
                   ramp(0.5 + 0.16 * (groove - 0.7) - 0.2 * seam + 0.04 * fine, *shades(colour, 0.3)),
                   0.22 + 0.05 * groove + 0.12 * seam, ONE)


def turned(random, colour, lines=60):
    wobble = 0.15 * noise(random, 1, 10, 1.2)
    ridge = 0.5 + 0.5 * np.cos(2.0 * np.pi * (ROWS * lines + wobble))
    fine = noise(random, 8, 250, 0.1, stretch_x=60.0)
    return surface(0.5 * ridge + 0.1 * fine, ramp(0.45 + 0.15 * ridge + 0.06 * fine, *shades(colour, 0.3)),
                   0.2 + 0.06 * (1.0 - ridge) + 0.02 * fine, ONE)


def blasted(random, colour, rough=0.48):
    dents = stamps(random, 5200, 1.4, 3.6)
    grain = noise(random, 60, 220, 0.2)
    return surface(-0.8 * dents + 0.25 * grain, ramp(0.5 + 0.10 * (dents - 0.4) + 0.06 * grain, *shades(colour, 0.25)),
                   rough + 0.05 * grain, ONE)


def galvanised(random, colour, count):
    """Spangles: crystals of zinc that each mirror another way."""
    bend_x, bend_y = 3.0 * noise(random, 4, 40, 0.8), 3.0 * noise(random, 4, 40, 0.8)
    first, second, number = (warped(f, bend_x, bend_y) for f in cells(random, count))
    tone = random.normal(0.0, 1.0, count * count)[number]
    lean = 2.0 * np.pi * random.random(count * count)[number]
    feather = np.cos(2.0 * np.pi * 26 * (COLUMNS * np.round(3 * np.cos(lean)) / 3 + ROWS * np.round(3 * np.sin(lean)) / 3))
    edge = 1.0 - step(second - first, 0.0, 0.1)
    return surface(0.25 * tone + 0.1 * feather - 0.4 * edge,
                   ramp(0.5 + 0.13 * tone + 0.03 * feather - 0.1 * edge, *shades(colour, 0.3)),
                   0.36 + 0.06 * tone + 0.05 * edge, ONE)


# ---- plastics, rubber -------------------------------------------------------------------------------

def moulded(random, colour, grain_px=0.5):
    """The fine leather of an injection mould."""
    first, second, _ = cells(random, 64)
    pebble = step(warped(second - first, 1.2 * noise(random, 8, 40, 0.6), 1.2 * noise(random, 8, 40, 0.6)), 0.0, 0.5)
    dust = noise(random, 1, 30, 1.0)
    return surface(2.0 * grain_px * pebble, ramp(0.5 + 0.05 * (pebble - 0.6) + 0.03 * dust, *shades(colour, 0.3)),
                   0.52 - 0.1 * pebble + 0.02 * dust)


def printed(random, colour, layers=56):
    """Layers of a 3D print, and the seam where they begin."""
    bend = 0.10 * noise(random, 1, 24, 0.9)
    bead = np.abs(np.cos(np.pi * (ROWS * layers + bend)))
    seam = np.clip(1.0 - np.abs(COLUMNS - 0.37 + 0.006 * noise(random, 8, 90, 0.3)) / 0.012, 0.0, 1.0)
    fine = noise(random, 20, 180, 0.5, stretch_x=8.0)
    return surface(2.4 * bead + 1.2 * seam + 0.12 * fine,
                   ramp(0.42 + 0.16 * bead + 0.04 * fine + 0.08 * seam, *shades(colour, 0.45)), 0.46 - 0.1 * bead)


def glossy(random, colour, rough=0.16):
    scratches = np.maximum(stamps(random, 60, 0.6, 0.9, aspect=70.0, any_angle=True),
                           0.7 * stamps(random, 160, 0.5, 0.8, aspect=22.0, any_angle=True))
    smudge = noise(random, 1, 14, 1.2)
    return surface(-0.35 * scratches, ramp(0.5 + 0.10 * scratches + 0.015 * smudge, *shades(colour, 0.4)),
                   rough + 0.04 * smudge + 0.2 * scratches)


def ribbed(random, colour, ribs=18, rough=0.72):
    wave = np.cos(2.0 * np.pi * COLUMNS * ribs)
    rib = step(wave, -0.3, 0.3)
    dust = np.clip(0.4 + 0.3 * noise(random, 1, 30, 1.0) - 0.4 * rib, 0.0, 1.0)
    grain = noise(random, 30, 160, 0.3)
    return surface(3.5 * rib + 0.15 * grain, ramp(0.35 + 0.3 * dust + 0.04 * grain, *shades(colour, 0.45)),
                   rough + 0.14 * dust)


def grip(random, colour, count=16):
    """Pyramids, as on handles and soles."""
    u, v = (COLUMNS + ROWS) * count, (COLUMNS - ROWS) * count
    peak = np.minimum(0.5 - np.abs(u % 1.0 - 0.5), 0.5 - np.abs(v % 1.0 - 0.5)) * 2.0
    grain, wear = noise(random, 40, 200, 0.3), noise(random, 1, 10, 1.0)
    return surface(7.0 * np.minimum(peak, 0.75), ramp(0.4 + 0.2 * peak + 0.05 * grain + 0.04 * wear, *shades(colour, 0.5)),
                   0.78 - 0.12 * step(peak, 0.7, 0.8) + 0.02 * grain)


def granulate(random, colour, fleck):
    """Crumbs pressed to a mat, some of them of another colour."""
    first, second, number = cells(random, 44)
    kind = random.random(44 * 44)[number]
    crumb = step(second - first, 0.02, 0.3)
    tone = 0.4 + 0.2 * crumb + 0.12 * (kind - 0.5)
    colours = blend(ramp(tone, *shades(colour, 0.6)), ramp(tone, *shades(fleck, 0.5)), (kind > 0.86).astype(float) * crumb)
    return surface(3.0 * crumb + 0.8 * kind, colours, 0.9 - 0.06 * crumb)


# ---- wood, fabric -----------------------------------------------------------------------------------

def wood(random, colour, dark, rings=11, pores=0.0, bend=0.22):
    field = noise(random, 1, 6, 1.6, stretch_x=5.0) * bend + 0.03 * noise(random, 4, 80, 1.0, 14.0)
    phase = (ROWS * rings + field * rings) % 1.0
    ring = step(phase, 0.0, 0.75) * (1.0 - step(phase, 0.86, 1.0))
    fibre = noise(random, 12, 240, 0.35, stretch_x=40.0)
    pore = stamps(random, int(1400 * pores), 0.6, 1.1, aspect=14.0) if pores else np.zeros((SIZE, SIZE))
    share = 0.25 + 0.5 * ring + 0.10 * fibre + 0.07 * noise(random, 1, 6, 1.2)
    colours = blend(ramp(share, np.minimum(1.0, np.asarray(colour) * 1.12), colour, dark), np.asarray(dark) * 0.55, 0.7 * pore)
    return surface(-0.4 * ring + 0.2 * fibre - 1.0 * pore, colours, 0.48 + 0.08 * ring + 0.03 * fibre + 0.1 * pore)


def chips(random, colour, count, aspect):
    """Board of pressed flakes: each lies over those before it, in its own tone and direction."""
    tone, height = np.full((SIZE, SIZE), 0.35), np.zeros((SIZE, SIZE))
    for layer in range(5):
        flake = stamps(random, count, 4.0, 11.0, aspect=aspect, any_angle=True)
        lies = flake > 0.12
        tone = np.where(lies, 0.5 + 0.22 * random.normal() + 0.25 * (flake - 0.5), tone)
        height = np.where(lies, 0.6 * layer + 1.4 * np.sqrt(flake), height)
    grain = noise(random, 30, 220, 0.2)
    return surface(height + 0.15 * grain, ramp(tone + 0.05 * grain, *shades(colour, 0.45)), 0.72 + 0.03 * grain)


def woven(random, warp_colour, weft_colour, threads=40, twill=1):
    """A thread dives under those across it; twill: how many it passes over (1: plain weave)."""
    u, v = COLUMNS * threads, ROWS * threads
    column, row = np.floor(u).astype(int), np.floor(v).astype(int)
    period = twill + 1
    warp_up = (column + row) % period != 0 if twill > 1 else (column + row) % 2 == 0
    across_u, across_v = u % 1.0 - 0.5, v % 1.0 - 0.5
    body = np.where(warp_up, np.sqrt(np.clip(1.0 - (across_u / 0.5) ** 2, 0, 1)) * np.cos(np.pi * across_v * 0.8),
                    np.sqrt(np.clip(1.0 - (across_v / 0.5) ** 2, 0, 1)) * np.cos(np.pi * across_u * 0.8))
    uneven = np.where(warp_up, random.normal(0, 1, threads)[column], random.normal(0, 1, threads)[row])
    fuzz = noise(random, 60, 250, 0.0)
    share = 0.25 + 0.45 * body + 0.06 * uneven + 0.05 * fuzz
    colours = np.where(warp_up[..., None], ramp(share, *shades(warp_colour, 0.6)), ramp(share, *shades(weft_colour, 0.6)))
    return surface(2.4 * body + 0.3 * fuzz, colours, 0.92 - 0.06 * body)


def felt(random, colour):
    low = stamps(random, 2400, 0.8, 1.3, aspect=12.0, any_angle=True)
    high = stamps(random, 2000, 0.8, 1.3, aspect=12.0, any_angle=True)
    pile, clouds = np.maximum(0.6 * low, high), noise(random, 1, 30, 0.9)
    return surface(1.6 * pile + 0.4 * clouds, ramp(0.4 + 0.35 * (pile - 0.35) + 0.06 * clouds, *shades(colour, 0.5)),
                   0.95 - 0.04 * pile)


# ---- stone, concrete --------------------------------------------------------------------------------

def layered(random, colour, layers=9, rough=0.6):
    """Slate, sandstone: beds that noise has bent."""
    bed = ROWS * layers + 0.7 * noise(random, 1, 10, 1.3, stretch_x=3.0)
    ledge = np.floor(bed) + step(bed % 1.0, 0.75, 1.0)
    tone = np.cos(2.0 * np.pi * ledge / layers * 3.0)
    clouds, grit = noise(random, 3, 60, 1.0), noise(random, 50, 220, 0.2)
    edge = step(bed % 1.0, 0.7, 0.8) * (1.0 - step(bed % 1.0, 0.9, 1.0))
    return surface(1.1 * tone + 0.8 * clouds + 0.35 * grit - 1.2 * edge,
                   ramp(0.5 + 0.13 * tone + 0.10 * clouds + 0.06 * grit - 0.12 * edge, *shades(colour, 0.4)),
                   rough + 0.04 * clouds + 0.03 * grit)


def rock(random, colour, rough=0.75, pores=300):
    clouds, grit = noise(random, 2, 70, 0.95), noise(random, 50, 230, 0.2)
    pore = stamps(random, pores, 1.0, 5.0)
    flecks = stamps(random, 700, 0.8, 2.4, aspect=1.6, any_angle=True)
    return surface(1.3 * clouds + 0.4 * grit - 3.0 * np.sqrt(pore),
                   ramp(0.5 + 0.12 * clouds + 0.07 * grit + 0.12 * flecks - 0.3 * pore, *shades(colour, 0.45)),
                   rough + 0.04 * clouds)


def veined(random, colour, vein, rough=0.16):
    rough_bend, veins = noise(random, 6, 60, 1.3), np.zeros((SIZE, SIZE))
    for slant, bend, width, weight in ((1, 0.19, 0.05, 1.0), (2, 0.12, 0.03, 0.6), (3, 0.14, 0.025, 0.45)):
        field = COLUMNS * slant - ROWS * (slant + 1) + bend * noise(random, 1, 12, 1.5) + 0.016 * rough_bend
        line = np.clip(1.0 - np.abs(field % 1.0 - 0.5) / (3.5 * width), 0.0, 1.0)
        veins = np.maximum(veins, weight * step(noise(random, 1, 8, 1.0), -0.9, 1.4) * (0.6 * line ** 7 + 0.4 * line ** 1.6))
    clouds = noise(random, 1, 40, 1.5)
    return surface(-0.25 * veins, blend(ramp(0.5 + 0.13 * clouds, *shades(colour, 0.3)), vein, np.clip(veins, 0.0, 0.95)),
                   rough + 0.06 * veins)


def speckled(random, colours, count, gap, ground, rough):
    """Terrazzo, gravel in concrete, pebbles: pieces of several colours in a ground."""
    first, second, number = cells(random, count)
    bend = noise(random, 10, 60, 0.7)
    piece = step(second - first + 0.03 * bend, gap, gap + 0.08)
    kind = random.integers(0, len(colours), count * count)[number]
    tone = 0.5 + 0.2 * random.normal(0.0, 1.0, count * count)[number] + 0.06 * noise(random, 30, 200, 0.3)
    shown = ramp(0.5 + 0.1 * bend, *shades(ground, 0.3))
    for k, colour in enumerate(colours):
        shown = np.where(((kind == k) & (piece > 0))[..., None], blend(shown, ramp(tone, *shades(colour, 0.35)), piece), shown)
    return surface(rough[2] * piece, shown, rough[0] + (rough[1] - rough[0]) * piece)


def poured(random, colour, cracks=0.0, boards=0, pores=220):
    """Concrete, screed, plaster: smooth, with the marks of boards, or cracked."""
    clouds, grain, pore = noise(random, 1, 24, 1.3), noise(random, 40, 220, 0.3), stamps(random, pores, 1.0, 4.0)
    line, mark = np.zeros((SIZE, SIZE)), np.zeros((SIZE, SIZE))
    if cracks:
        first, second, _ = cells(random, 3)
        gap = warped(second - first, 14 * noise(random, 2, 30, 1.0), 14 * noise(random, 2, 30, 1.0))
        line = (1.0 - np.clip(gap / (0.045 * cracks), 0.0, 1.0)) * step(noise(random, 1, 5, 1.0), -0.6, 0.4)
    if boards:
        edge = 0.5 - np.abs((ROWS * boards) % 1.0 - 0.5)
        mark = (1.0 - step(edge, 0.0, 0.05)) + 0.35 * noise(random, 6, 200, 0.5, stretch_x=30.0)
    share = 0.5 + 0.12 * clouds + 0.06 * grain - 0.3 * pore - 0.9 * line - 0.22 * mark
    return surface(0.7 * clouds + 0.25 * grain - 2.6 * np.sqrt(pore) - 5.0 * line + 0.8 * mark,
                   ramp(share, *shades(colour, 0.42)), 0.8 + 0.03 * clouds + 0.1 * line)


def tiles(random, colour, joint, count=4, rough=0.14):
    x, y = COLUMNS * count, ROWS * count
    edge = np.minimum(0.5 - np.abs(x % 1.0 - 0.5), 0.5 - np.abs(y % 1.0 - 0.5))
    face = step(edge, 0.018, 0.05)
    tone = random.normal(0.0, 1.0, (count, count))[np.floor(y).astype(int), np.floor(x).astype(int)]
    clouds, grit = noise(random, 1, 30, 1.2), noise(random, 40, 200, 0.2)
    return surface(4.0 * face + 0.1 * clouds, blend(ramp(0.5 + 0.15 * grit, *shades(joint, 0.3)),
                   ramp(0.5 + 0.10 * tone + 0.05 * clouds, *shades(colour, 0.3)), face),
                   0.85 + (rough - 0.85) * face + 0.02 * clouds)


# ---- painted, rusty ---------------------------------------------------------------------------------

def hammered(random, colour):
    """Hammer finish: shallow cells of a paint with metal flakes."""
    first, _, _ = cells(random, 30)
    dimple = step(warped(first, 2.0 * noise(random, 4, 30, 0.8), 2.0 * noise(random, 4, 30, 0.8)), 0.05, 0.6)
    flakes = noise(random, 80, 250, 0.0)
    return surface(2.2 * dimple, ramp(0.5 + 0.16 * (0.5 - dimple) + 0.04 * flakes, *shades(colour, 0.5)),
                   0.24 + 0.12 * dimple, 0.35 * ONE)


def powder(random, colour, rough=0.42):
    peel, fine = noise(random, 20, 80, 0.5), noise(random, 80, 250, 0.1)
    return surface(0.5 * peel + 0.1 * fine, ramp(0.5 + 0.03 * peel + 0.04 * fine, *shades(colour, 0.3)), rough + 0.03 * peel)


def chipped(random, colour, wear=1.7):
    """Paint off at scratches and weak spots; bare metal, partly rusty, in the chips."""
    weak, fine = noise(random, 2, 60, 1.15), noise(random, 30, 180, 0.4)
    scratches = stamps(random, 60, 0.8, 1.5, aspect=40.0, any_angle=True)
    worn = weak + 0.18 * fine + 1.1 * scratches
    bare, rim = step(worn, wear, wear + 0.15), step(worn, wear - 0.4, wear + 0.05)
    rust = step(noise(random, 3, 90, 0.9), 0.1, 1.3)
    paint = blend(ramp(0.5 + 0.10 * noise(random, 1, 12, 1.2) + 0.02 * fine, *shades(colour, 0.35)), (0.45, 0.46, 0.44),
                  0.5 * rim * (1.0 - bare))
    metal = blend(ramp(0.5 + 0.2 * fine, (0.40, 0.39, 0.38), (0.60, 0.59, 0.57)), (0.33, 0.18, 0.09), rust)
    return surface(0.1 * fine - 2.0 * bare, blend(paint, metal, bare), 0.38 + (0.12 + 0.25 * rust) * bare + 0.02 * fine,
                   bare * (1.0 - rust))


def rusty(random, colour, spread, old):
    """spread: how much of the metal is rust, old: how much of that is dark."""
    field = noise(random, 1, 30, 1.25) + 0.25 * noise(random, 20, 120, 0.7)
    rust, dark = step(field, -spread, -spread + 1.2), step(field, old, old + 1.2)
    flakes, pits, fine = noise(random, 8, 120, 0.8), stamps(random, 420, 0.8, 3.2), noise(random, 40, 160, 0.3)
    orange = ramp(0.5 + 0.2 * flakes, (0.25, 0.115, 0.055), (0.43, 0.215, 0.10), (0.55, 0.32, 0.165))
    shown = blend(ramp(0.5 + 0.15 * fine + 0.08 * field, *shades(colour, 0.3)), orange, rust)
    shown = blend(shown, ramp(0.5 + 0.2 * flakes, (0.11, 0.052, 0.035), (0.25, 0.12, 0.075)), 0.85 * dark * rust)
    return surface(rust * (0.9 + 0.45 * flakes) + dark - 2.0 * pits * rust, blend(shown, (0.09, 0.05, 0.035), 0.6 * pits * rust),
                   0.4 + 0.44 * rust + 0.03 * flakes, 1.0 - rust)
