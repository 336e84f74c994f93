#!/usr/bin/python3
"""A contact sheet of all textured materials of the library: a ball of each in a simple light, made of all of its images.

No rendering: a microfacet model (GGX; Walter et al. 2007) under one lamp, and the mean of an overcast sky mirrored.

    scripts/material_sheet.py [-o results/scenes/materials.jpg]
"""

import argparse
import pathlib

import numpy as np
from PIL import Image, ImageDraw

HOME = pathlib.Path(__file__).resolve().parents[1]
COLUMNS, CELL, BALL = 10, 132, 118  # pixels
SUPERSAMPLED = 2
LAMP = np.array([-0.5, 0.55, 0.67]) / np.linalg.norm([-0.5, 0.55, 0.67])
EYE = np.array([0.0, 0.0, 1.0])


def linear(values):
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def encoded(values):
    values = np.clip(values, 0.0, 1.0)
    return np.where(values <= 0.0031308, values * 12.92, 1.055 * values ** (1 / 2.4) - 0.055)


def image_of(folder, role, default):
    files = list(folder.glob(f"*_{role}.*"))
    if not files:
        return np.full((1, 1, 3), default)
    return np.asarray(Image.open(files[0]).convert("RGB")) / 255.0


def looked_up(image, u, v):
    """The pixel at u, v in tiles; v points up."""
    height, width = image.shape[:2]
    return image[np.floor((1.0 - v % 1.0) * height).astype(int) % height, np.floor(u % 1.0 * width).astype(int) % width]


def sky(direction, rough):
    """What is mirrored: bright above, dark below, softer the rougher."""
    edge = 0.08 + rough
    return 0.10 + 0.85 / (1.0 + np.exp(-np.clip(direction[..., 1] / edge, -30, 30) * 2.0))


def ball(folder):
    side = BALL * SUPERSAMPLED
    y, x = np.mgrid[0:side, 0:side]
    x, y = (x + 0.5) / side * 2 - 1, 1 - (y + 0.5) / side * 2
    inside = x ** 2 + y ** 2 < 1
    z = np.sqrt(np.clip(1 - x ** 2 - y ** 2, 1e-6, 1))
    normal = np.stack([x, y, z], -1)
    # A tile is as wide as a radian of the ball, seen from the front.
    u, v = np.arctan2(x, z), np.arcsin(np.clip(y, -1, 1))
    color, rough, metal, bump = (looked_up(image_of(folder, role, default), u, v) for role, default in
                                 (("Color", 0.8), ("Roughness", 0.5), ("Metalness", 0.0), ("NormalGL", 0.5)))
    color, rough, metal = linear(color), np.maximum(rough[..., :1], 0.05), metal[..., :1]
    bump = bump * 2 - 1
    right = np.stack([z, 0 * x, -x], -1)
    right /= np.maximum(np.linalg.norm(right, axis=-1, keepdims=True), 1e-6)
    up = np.cross(normal, right)
    normal = right * bump[..., :1] + up * bump[..., 1:2] + normal * bump[..., 2:]
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    half = (LAMP + EYE) / np.linalg.norm(LAMP + EYE)
    to_lamp, to_half, to_eye = (np.clip((normal * each).sum(-1, keepdims=True), 1e-3, 1) for each in (LAMP, half, EYE))
    lit = (normal * LAMP).sum(-1, keepdims=True) > 0
    alpha = rough ** 2
    spread = alpha ** 2 / (np.pi * (to_half ** 2 * (alpha ** 2 - 1) + 1) ** 2)
    k = (rough + 1) ** 2 / 8
    shadowing = to_lamp / (to_lamp * (1 - k) + k) * to_eye / (to_eye * (1 - k) + k)
    base = 0.04 * (1 - metal) + color * metal
    fresnel = base + (1 - base) * (1 - float(EYE @ half)) ** 5
    mirrored = 2 * to_eye * normal - EYE
    lamp = lit * to_lamp * (color * (1 - metal) / np.pi + spread * shadowing * fresnel / (4 * to_lamp * to_eye)) * 2.6
    around = color * (1 - metal) * (0.32 + 0.22 * normal[..., 1:2]) + sky(mirrored, rough[..., 0])[..., None] * (
        base + (np.maximum(1 - rough, base) - base) * (1 - to_eye) ** 5)
    shown = np.where(inside[..., None], lamp + around, linear(np.array(0.93)))
    shown = shown.reshape(BALL, SUPERSAMPLED, BALL, SUPERSAMPLED, 3).mean(axis=(1, 3))
    return Image.fromarray((encoded(shown) * 255 + 0.5).astype(np.uint8))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=pathlib.Path, default=HOME / "results" / "scenes" / "materials.jpg")
    options = parser.parse_args()
    folders = sorted(folder for folder in (HOME / "materials" / "textures").iterdir() if folder.is_dir())
    rows = -(-len(folders) // COLUMNS)
    sheet = Image.new("RGB", (COLUMNS * CELL, rows * (CELL + 6)), (237, 237, 237))
    pen = ImageDraw.Draw(sheet)
    for index, folder in enumerate(folders):
        x, y = index % COLUMNS * CELL, index // COLUMNS * (CELL + 6)
        sheet.paste(ball(folder), (x + (CELL - BALL) // 2, y + 4))
        pen.text((x + (CELL - pen.textlength(folder.name)) / 2, y + BALL + 6), folder.name, fill="black")
    sheet.save(options.output, quality=88, optimize=True)
    print(f"{len(folders)} materials: {options.output}")


if __name__ == "__main__":
    main()
