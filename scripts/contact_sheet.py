#!/usr/bin/python3
"""A picture of a campaign: images in one row, and below each its labels (masks by instance, tight boxes, categories).

    scripts/contact_sheet.py results/parts docs/images/demo.png 0 7 13 21

Needs Debian's python3-pil and python3-numpy, which nothing else here does.
"""

import colorsys
import json
import pathlib
import sys

import numpy
from PIL import Image, ImageDraw

GAP = 4


def main():
    campaign, output, frames = pathlib.Path(sys.argv[1]), sys.argv[2], [int(f) for f in sys.argv[3:]]
    columns = [labelled_pair(campaign / "frames" / f"{f // 1000:03}" / f"{f:06}") for f in frames]
    width, height = columns[0][0].size
    sheet = Image.new("RGB", (len(columns) * (width + GAP) - GAP, 2 * height + GAP), "white")
    for i, pair in enumerate(columns):
        for row, picture in enumerate(pair):
            sheet.paste(picture, (i * (width + GAP), row * (height + GAP)))
    sheet.save(output, optimize=True)


def labelled_pair(folder):
    image = Image.open(folder / "image.png").convert("RGB")
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
