#!/usr/bin/python3
"""Makes the materials of materials/textures/ that belong to families, and their lines in materials/library.yaml.

Usage: scripts/make_materials.py [NAME…]; needs numpy and PIL. With make_textures.py's sets there are a hundred: folders as
ambientCG names them, 256 × 256 pixels, JPEG where that is smaller than PNG. Seeds are fixed: the same surfaces each time.
"""

import io
import os
import sys
import zlib

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import numpy as np
from PIL import Image, ImageFile

import make_materials_families as make
from make_textures import SETS, normals
from make_textures_fields import SIZE

HOME = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TILE = 256
ImageFile.MAXBLOCK = 1 << 20  # an optimised JPEG is written in one piece
LIBRARY_LINE = '  # Textured, by scripts/make_materials.py: how wide an image is on the surface.\n'

# Metres that an image covers, of the sets of make_textures.py.
SIZES = {'Concrete01': 0.8, 'Planks01': 0.6, 'Plywood01': 0.5, 'BrushedMetal01': 0.12, 'PaintedMetal01': 0.3,
         'Fabric01': 0.08, 'DiamondPlate01': 0.24, 'Cardboard01': 0.25, 'Carpet01': 0.2, 'RustyMetal01': 0.3,
         'ScratchedMetal01': 0.2, 'Brick01': 0.66, 'Marble01': 0.6, 'Granite01': 0.3, 'RubberMat01': 0.2,
         'Leather01': 0.15}

STEEL, ALUMINIUM, BRASS = (0.62, 0.63, 0.64), (0.80, 0.81, 0.82), (0.80, 0.63, 0.33)
COPPER, BRONZE, TITANIUM = (0.80, 0.49, 0.36), (0.58, 0.44, 0.28), (0.56, 0.54, 0.51)
BLACK, WHITE, GREY = (0.055, 0.055, 0.058), (0.86, 0.86, 0.84), (0.42, 0.42, 0.43)
RED, GREEN, BLUE = (0.62, 0.09, 0.07), (0.13, 0.40, 0.17), (0.08, 0.20, 0.52)
YELLOW, ORANGE, CREAM = (0.85, 0.64, 0.08), (0.84, 0.36, 0.06), (0.84, 0.79, 0.66)

# Name, metres that an image covers, family, its arguments.
MATERIALS = [
    ('BrushedSteel', 0.12, make.brushed, STEEL), ('BrushedAluminium', 0.12, make.brushed, ALUMINIUM, 0.34),
    ('BrushedBrass', 0.12, make.brushed, BRASS), ('BrushedCopper', 0.12, make.brushed, COPPER),
    ('BrushedTitanium', 0.12, make.brushed, TITANIUM, 0.36), ('AnodisedBlack', 0.12, make.brushed, (0.12, 0.12, 0.13), 0.4),
    ('AnodisedBlue', 0.12, make.brushed, (0.14, 0.27, 0.55), 0.36),
    ('CastIron', 0.15, make.cast, (0.24, 0.24, 0.245), 0.66), ('CastAluminium', 0.15, make.cast, (0.66, 0.66, 0.66), 0.54),
    ('CastBronze', 0.15, make.cast, BRONZE, 0.52), ('CastZinc', 0.12, make.cast, (0.55, 0.56, 0.58), 0.48),
    ('MilledSteel', 0.14, make.milled, STEEL), ('MilledAluminium', 0.14, make.milled, ALUMINIUM, 6),
    ('MilledBrass', 0.14, make.milled, BRASS, 8), ('TurnedSteel', 0.06, make.turned, STEEL),
    ('TurnedBrass', 0.06, make.turned, BRASS, 44), ('BlastedSteel', 0.08, make.blasted, (0.50, 0.50, 0.51)),
    ('BlastedAluminium', 0.08, make.blasted, (0.70, 0.71, 0.72), 0.52), ('Gunmetal', 0.08, make.blasted, (0.20, 0.21, 0.23)),
    ('GalvanisedFine', 0.25, make.galvanised, (0.66, 0.68, 0.70), 16), ('GalvanisedCoarse', 0.4, make.galvanised, (0.62, 0.64, 0.66), 8),
    ('MouldedBlack', 0.05, make.moulded, BLACK), ('MouldedGrey', 0.05, make.moulded, GREY),
    ('MouldedWhite', 0.05, make.moulded, WHITE, 0.35), ('MouldedRed', 0.05, make.moulded, RED),
    ('MouldedBlue', 0.05, make.moulded, BLUE), ('MouldedYellow', 0.05, make.moulded, YELLOW),
    ('MouldedGreen', 0.05, make.moulded, GREEN),
    ('PrintedOrange', 0.015, make.printed, ORANGE), ('PrintedWhite', 0.015, make.printed, WHITE),
    ('PrintedBlack', 0.015, make.printed, BLACK), ('PrintedGreen', 0.02, make.printed, (0.20, 0.52, 0.16), 44),
    ('PrintedBlue', 0.02, make.printed, (0.10, 0.27, 0.62), 44), ('PrintedGrey', 0.015, make.printed, GREY),
    ('GlossyRed', 0.2, make.glossy, (0.58, 0.05, 0.05)), ('GlossyBlack', 0.2, make.glossy, (0.03, 0.03, 0.032)),
    ('GlossyCream', 0.2, make.glossy, CREAM, 0.2), ('GlossyBlue', 0.2, make.glossy, (0.06, 0.18, 0.45)),
    ('RubberRibbed', 0.15, make.ribbed, (0.10, 0.10, 0.10)), ('RubberGrip', 0.06, make.grip, (0.075, 0.075, 0.08)),
    ('RubberGripBlue', 0.06, make.grip, (0.10, 0.18, 0.36), 12), ('RubberGranulate', 0.15, make.granulate, (0.10, 0.10, 0.105), (0.20, 0.30, 0.50)),
    ('RubberRed', 0.15, make.ribbed, (0.40, 0.09, 0.07), 26), ('Oak', 0.4, make.wood, (0.72, 0.55, 0.36), (0.52, 0.36, 0.20), 12, 1.0),
    ('Walnut', 0.4, make.wood, (0.38, 0.25, 0.16), (0.19, 0.115, 0.07), 9, 0.6), ('Pine', 0.4, make.wood, (0.84, 0.68, 0.44), (0.68, 0.45, 0.22), 8, 0.0, 0.3),
    ('Beech', 0.3, make.wood, (0.80, 0.61, 0.44), (0.70, 0.50, 0.34), 16, 0.5, 0.1), ('Ash', 0.4, make.wood, (0.82, 0.72, 0.57), (0.66, 0.53, 0.37), 10, 0.8),
    ('Cherry', 0.4, make.wood, (0.63, 0.37, 0.22), (0.47, 0.23, 0.12), 10, 0.2), ('Ebony', 0.3, make.wood, (0.13, 0.095, 0.08), (0.055, 0.042, 0.038), 14, 0.3),
    ('ChipBoard', 0.2, make.chips, (0.68, 0.52, 0.34), 620, 2.2), ('StrandBoard', 0.4, make.chips, (0.72, 0.55, 0.34), 60, 6.0),
    ('Linen', 0.05, make.woven, (0.70, 0.64, 0.52), (0.74, 0.69, 0.58)), ('CottonRed', 0.05, make.woven, (0.52, 0.10, 0.10), (0.46, 0.08, 0.09), 52),
    ('Denim', 0.04, make.woven, (0.13, 0.19, 0.34), (0.55, 0.57, 0.60), 48, 2), ('TwillKhaki', 0.05, make.woven, (0.46, 0.42, 0.28), (0.40, 0.36, 0.24), 48, 3),
    ('CheckedCloth', 0.06, make.woven, (0.10, 0.25, 0.20), (0.62, 0.60, 0.52), 32), ('FeltGrey', 0.1, make.felt, (0.40, 0.40, 0.41)),
    ('FeltGreen', 0.1, make.felt, (0.10, 0.33, 0.19)), ('FeltBlue', 0.1, make.felt, (0.10, 0.16, 0.36)),
    ('Slate', 0.4, make.layered, (0.23, 0.245, 0.26), 9, 0.5), ('Sandstone', 0.5, make.layered, (0.68, 0.52, 0.35), 7, 0.82),
    ('Limestone', 0.4, make.rock, (0.74, 0.70, 0.61), 0.8), ('Basalt', 0.4, make.rock, (0.17, 0.17, 0.18), 0.7, 520),
    ('MarbleGreen', 0.6, make.veined, (0.10, 0.22, 0.17), (0.62, 0.68, 0.62)), ('MarbleBlack', 0.6, make.veined, (0.045, 0.045, 0.05), (0.78, 0.76, 0.70), 0.12),
    ('Terrazzo', 0.4, make.speckled, ((0.62, 0.30, 0.24), (0.24, 0.25, 0.27), (0.80, 0.76, 0.66)), 26, 0.1, (0.72, 0.70, 0.66), (0.22, 0.2, 0.0)),
    ('Gravel', 0.3, make.speckled, ((0.46, 0.44, 0.41), (0.34, 0.33, 0.32), (0.58, 0.53, 0.46)), 22, 0.05, (0.20, 0.19, 0.18), (0.95, 0.8, 4.0)),
    ('ConcreteSmooth', 1.0, make.poured, (0.60, 0.60, 0.58), 0, 0, 90), ('ConcreteBoarded', 0.8, make.poured, (0.55, 0.54, 0.52), 0, 5),
    ('ConcreteCracked', 1.2, make.poured, (0.50, 0.49, 0.47), 1.0), ('ScreedDark', 0.8, make.poured, (0.27, 0.27, 0.28), 0, 0, 120),
    ('ConcreteAggregate', 0.3, make.speckled, ((0.52, 0.47, 0.41), (0.42, 0.42, 0.43), (0.64, 0.62, 0.58)), 30, 0.16, (0.55, 0.54, 0.52), (0.85, 0.7, 2.0)),
    ('TilesWhite', 0.6, make.tiles, (0.86, 0.86, 0.84), (0.55, 0.54, 0.52)), ('TilesTerracotta', 0.8, make.tiles, (0.60, 0.31, 0.20), (0.48, 0.46, 0.43), 4, 0.6),
    ('HammeredGreen', 0.1, make.hammered, (0.12, 0.34, 0.27)), ('HammeredGrey', 0.1, make.hammered, (0.44, 0.46, 0.48)),
    ('PowderOrange', 0.08, make.powder, ORANGE), ('PowderBlack', 0.08, make.powder, (0.06, 0.06, 0.062), 0.5),
    ('ChippedYellow', 0.3, make.chipped, (0.78, 0.56, 0.06)), ('ChippedRed', 0.3, make.chipped, (0.52, 0.09, 0.06), 1.5),
    ('RustLight', 0.3, make.rusty, (0.50, 0.49, 0.48), -0.4, 1.6), ('RustHeavy', 0.3, make.rusty, (0.30, 0.27, 0.25), 1.8, 0.0),
    ('CortenSteel', 0.6, make.rusty, (0.38, 0.28, 0.22), 2.4, 0.9)]


def halved(field):
    return (field[0::2, 0::2] + field[1::2, 0::2] + field[0::2, 1::2] + field[1::2, 1::2]) / 4.0


def encoded(values, quality):
    """As PNG or as JPEG, whichever is smaller: the ending and the bytes."""
    pixels = Image.fromarray(np.clip(values * 255.0 + 0.5, 0, 255).astype(np.uint8))
    files = {}
    for ending, arguments in (('png', {'optimize': True}), ('jpg', {'quality': quality, 'optimize': True, 'subsampling': 0})):
        stream = io.BytesIO()
        pixels.save(stream, 'PNG' if ending == 'png' else 'JPEG', **arguments)
        files[ending] = stream.getvalue()
    return min(files.items(), key=lambda item: len(item[1]))


def write_material(name, family, arguments):
    random = np.random.Generator(np.random.Philox(zlib.crc32(name.encode())))
    fields = family(random, *arguments)
    assert SIZE == 2 * TILE
    normal = halved(normals(fields['height']))
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    folder = os.path.join(HOME, 'materials', 'textures', name)
    os.makedirs(folder, exist_ok=True)
    for file in os.listdir(folder):
        os.remove(os.path.join(folder, file))
    total = 0
    for role, values, quality in (('Color', halved(fields['color']), 85), ('NormalGL', normal * 0.5 + 0.5, 85),
                                  ('Roughness', halved(fields['roughness']), 75), ('Metalness', halved(fields['metalness']), 80)):
        ending, data = encoded(values, quality)
        with open(os.path.join(folder, f'{name}_{role}.{ending}'), 'wb') as out:
            out.write(data)
        total += len(data)
    print(f'{name}: {total / 1024:.0f} KiB', flush=True)
    return total


def write_library():
    path = os.path.join(HOME, 'materials', 'library.yaml')
    with open(path, encoding='utf-8') as source:
        text = source.read().split('\n' + LIBRARY_LINE)[0].rstrip('\n') + '\n'
    sizes = {**SIZES, **{material[0]: material[1] for material in MATERIALS}}
    with open(path, 'w', encoding='utf-8') as out:
        out.write(text + '\n' + LIBRARY_LINE)
        for name in sorted(sizes):
            out.write(f'  {name}: {{textures: {name}, texture_size_m: {sizes[name]}}}\n')


def main():
    assert set(SIZES) == {name for name, _, _ in SETS}
    assert len(SIZES) + len(MATERIALS) == 100, len(SIZES) + len(MATERIALS)
    total = 0
    for name, _, family, *arguments in MATERIALS:
        if len(sys.argv) < 2 or name in sys.argv[1:]:
            total += write_material(name, family, arguments)
    write_library()
    print(f'{total / 1e6:.1f} MB')


if __name__ == '__main__':
    main()
