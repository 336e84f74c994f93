#!/usr/bin/python3
"""Draws what the exports say about one frame over its image, for people to look at.

    scripts/export_sheet.py EXPORTS_DIR STEM docs/images/exports.jpg

Reads coco-panoptic, coco-keypoints, yolo-detect, yolo-obb, bop and patches, as far as they are there.
"""

import json
import pathlib
import sys

import numpy
from PIL import Image, ImageDraw

SCALE = 2
TILES = 3  # a row
WIDTH = 1464  # of the sheet, at most


def main():
    folder, stem, out = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    split = next(path.parent.name for path in (folder / "yolo-detect" / "images").glob(f"*/{stem}.*"))
    photo = Image.open(next((folder / "yolo-detect" / "images" / split).glob(f"{stem}.*"))).convert("RGB")
    photo = photo.resize((photo.width * SCALE, photo.height * SCALE), Image.Resampling.LANCZOS)
    drawn = [("image", photo), ("panoptic", panoptic(folder, split, stem, photo)),
             ("yolo-detect", yolo_boxes(folder, split, stem, photo)), ("yolo-obb", oriented(folder, split, stem, photo)),
             ("coco-keypoints", keypoints(folder, split, stem, photo)), ("bop depth", depth(folder, split, stem, photo)),
             ("bop full and visible", masks(folder, split, stem, photo)), ("patches", patches(folder, split, stem, photo))]
    drawn = drawn[:1] + [(name, tile) for name, tile in drawn[1:] if tile is not None]
    rows = -(-len(drawn) // TILES)
    sheet = Image.new("RGB", (TILES * (photo.width + 8) + 8, rows * (photo.height + 28) + 8), "white")
    pen = ImageDraw.Draw(sheet)
    for index, (name, tile) in enumerate(drawn):
        x = 8 + index % TILES * (photo.width + 8)
        y = 24 + index // TILES * (photo.height + 28)
        sheet.paste(tile, (x, y))
        pen.text((x, y - 14), name, fill="black")
    sheet.thumbnail((WIDTH, WIDTH))
    sheet.save(out, quality=86)


def color_of(index):
    """Colours that neighbours can be told apart by."""
    return tuple(int(c) for c in numpy.array([(index * 67 + 40) % 200 + 55, (index * 131 + 90) % 200 + 55, (index * 29) % 200 + 55]))


def panoptic(folder, split, stem, photo):
    path = folder / "coco-panoptic" / "annotations" / f"panoptic_{split}" / f"{stem}.png"
    if not path.exists():
        return None
    ids = numpy.array(Image.open(path)).astype(int) @ [1, 256, 65536]
    colors = numpy.zeros((*ids.shape, 3), dtype=numpy.uint8)
    for segment in numpy.unique(ids[ids > 0]):
        colors[ids == segment] = color_of(int(segment))
    overlay = Image.fromarray(colors).resize(photo.size, Image.Resampling.NEAREST)
    return Image.blend(photo, overlay, 0.6)


def rows_of(folder, name, split, stem):
    path = folder / name / "labels" / split / f"{stem}.txt"
    return [[float(word) for word in line.split()] for line in path.read_text().splitlines()] if path.exists() else None


def yolo_boxes(folder, split, stem, photo):
    rows = rows_of(folder, "yolo-detect", split, stem)
    tile = photo.copy()
    pen = ImageDraw.Draw(tile)
    for row in rows:
        x, y, w, h = row[1] * photo.width, row[2] * photo.height, row[3] * photo.width, row[4] * photo.height
        pen.rectangle([x - w / 2, y - h / 2, x + w / 2, y + h / 2], outline=color_of(int(row[0]) + 1), width=2)
    return tile


def oriented(folder, split, stem, photo):
    rows = rows_of(folder, "yolo-obb", split, stem)
    if rows is None:
        return None
    tile = photo.copy()
    pen = ImageDraw.Draw(tile)
    for row in rows:
        corners = [(x * photo.width, y * photo.height) for x, y in zip(row[1::2], row[2::2])]
        pen.line(corners + corners[:1], fill=color_of(int(row[0]) + 1), width=2)
    return tile


def keypoints(folder, split, stem, photo):
    path = folder / "coco-keypoints" / "annotations" / f"person_keypoints_{split}.json"
    if not path.exists():
        return None
    coco = json.loads(path.read_text())
    image = next(image for image in coco["images"] if image["file_name"].startswith(f"{stem}."))
    skeletons = {category["id"]: category["skeleton"] for category in coco["categories"]}
    tile = photo.copy()
    pen = ImageDraw.Draw(tile)
    for annotation in coco["annotations"]:
        if annotation["image_id"] != image["id"]:
            continue
        points = [((x + 0.5) * SCALE, (y + 0.5) * SCALE, v) for x, y, v in zip(*[iter(annotation["keypoints"])] * 3)]
        for start, end in skeletons[annotation["category_id"]]:
            if points[start - 1][2] and points[end - 1][2]:
                pen.line([points[start - 1][:2], points[end - 1][:2]], fill="white", width=2)
        for x, y, v in points:
            if v:
                pen.ellipse([x - 4, y - 4, x + 4, y + 4], fill="lime" if v == 2 else "red", outline="black")
    return tile


def scene_of(folder, split, stem):
    found = list((folder / "bop" / split).glob(f"*/depth/{stem}.png"))
    return found[0].parent.parent if found else None


def depth(folder, split, stem, photo):
    scene = scene_of(folder, split, stem)
    if scene is None:
        return None
    values = numpy.array(Image.open(scene / "depth" / f"{stem}.png")).astype(float)
    near, far = numpy.percentile(values[values > 0], [1, 99])
    grey = numpy.where(values > 0, 255 - 215 * numpy.clip((values - near) / (far - near), 0, 1), 0)
    return Image.fromarray(grey.astype(numpy.uint8)).convert("RGB").resize(photo.size, Image.Resampling.NEAREST)


def masks(folder, split, stem, photo):
    scene = scene_of(folder, split, stem)
    if scene is None:
        return None
    tile = numpy.array(photo).astype(float) * 0.35
    for path in sorted((scene / "mask").glob(f"{stem}_*.png")):
        color = numpy.array(color_of(int(path.stem[-6:]) + 1))
        for name, share in (("mask", 0.25), ("mask_visib", 0.5)):
            mask = numpy.array(Image.open(scene / name / path.name).resize(photo.size, Image.Resampling.NEAREST)) > 0
            tile[mask] = tile[mask] * (1 - share) + color * share
    return Image.fromarray(tile.astype(numpy.uint8))


def patches(folder, split, stem, photo):
    found = sorted((folder / "patches" / split).glob(f"*/{stem}_*.png"))
    if not found:
        return None
    tile = Image.new("RGB", photo.size, "white")
    pen = ImageDraw.Draw(tile)
    for index, path in enumerate(found):
        x, y = index % 6 * 104 + 8, index // 6 * 92 + 4
        tile.paste(Image.open(path).resize((64, 64), Image.Resampling.NEAREST), (x, y))
        pen.text((x, y + 66), path.parent.name, fill="black")
    return tile


if __name__ == "__main__":
    main()
