#!/usr/bin/python3
"""A picture of a campaign: images in one row, and below each its labels (masks by instance, tight boxes, categories).

    scripts/contact_sheet.py results/parts docs/images/demo.png 0 7 13 21
    scripts/contact_sheet.py results/fig2 sheet.jpg --columns 6        all images in rows of 6, without labels

Needs Debian's python3-pil and python3-numpy, which nothing else here does.
"""

import argparse
import colorsys
import json
import pathlib

import numpy
from PIL import Image, ImageDraw

GAP = 4


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("campaign", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("frames", type=int, nargs="*", help="default: all")
    parser.add_argument("--columns", type=int, help="images only, so many in a row")
    options = parser.parse_intermixed_args()
    folders = sorted(options.campaign.glob("frames/*/*"))
    if options.frames:
        folders = [options.campaign / "frames" / f"{f // 1000:03}" / f"{f:06}" for f in options.frames]
    if options.columns:
        images = [Image.open(picture_of(folder)).convert("RGB") for folder in folders]
        rows = [images[i:i + options.columns] for i in range(0, len(images), options.columns)]
    else:
        rows = list(zip(*(labelled_pair(folder) for folder in folders)))
    save_sheet(rows, options.output)


def picture_of(folder):
    return next(folder.glob("image.*"))


def save_sheet(rows, output):
    width, height = rows[0][0].size
    sheet = Image.new("RGB", (len(rows[0]) * (width + GAP) - GAP, len(rows) * (height + GAP) - GAP), "white")
    for row, pictures in enumerate(rows):
        for column, picture in enumerate(pictures):
            sheet.paste(picture, (column * (width + GAP), row * (height + GAP)))
    sheet.save(output, optimize=True, quality=90)


def labelled_pair(folder):
    image = Image.open(picture_of(folder)).convert("RGB")
    labels = json.loads((folder / "labels.json").read_text())
    ids = numpy.array(Image.open(folder / "instances.png"))
    shown = numpy.array(image).astype(float) * 0.35 + 0.25 * numpy.array(image.convert("L"))[:, :, None]
    seen = [i for i in labels["instances"] if i["category"] > 0 and i["area_px"] > 0]
    for instance in seen:
        mask = ids == instance["id"]
        shown[mask] = 0.35 * shown[mask] + 0.65 * numpy.array(colour(instance["category"]))
    picture = Image.fromarray(shown.clip(0, 255).astype(numpy.uint8))
    draw = ImageDraw.Draw(picture)
    for instance in seen:
        x, y, w, h = instance["box"]
        draw.rectangle([x, y, x + w - 1, y + h - 1], outline=tuple(colour(instance["category"])))
    return image, picture


def colour(category):
    hue = (0.13 + 0.618034 * category) % 1.0
    return [int(255 * c) for c in colorsys.hsv_to_rgb(hue, 0.75, 1.0)]


main()
