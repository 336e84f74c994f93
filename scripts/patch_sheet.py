#!/usr/bin/python3
"""A contact sheet of exported patches: a row for each class, its patches as they come.

    scripts/patch_sheet.py results/scenes/robocup_patches.jpg EXPORTS…
"""

import json
import pathlib
import sys

from PIL import Image, ImageDraw

COLUMNS, CELL, GAP, NAMES = 20, 64, 3, 84  # all but the first in pixels


def main():
    out, folders = sys.argv[1], [pathlib.Path(name) / "patches" for name in sys.argv[2:]]
    classes = json.loads((folders[0] / "classes.json").read_text())
    sheet = Image.new("RGB", (NAMES + COLUMNS * (CELL + GAP), len(classes) * (CELL + GAP)), "white")
    pen = ImageDraw.Draw(sheet)
    for row, each in enumerate(classes):
        y = row * (CELL + GAP)
        found = [file for folder in folders for file in sorted(folder.glob(f"*/{each['folder']}/*.png"))]
        pen.text((4, y + CELL // 2 - 12), f"{each['name']}\n{len(found)}", fill="black")
        shown = [found[i * len(found) // COLUMNS] for i in range(COLUMNS)] if len(found) > COLUMNS else found
        for column, file in enumerate(shown):
            patch = Image.open(file).convert("RGB").resize((CELL, CELL), Image.Resampling.NEAREST)
            sheet.paste(patch, (NAMES + column * (CELL + GAP), y))
    sheet.save(out, quality=85, optimize=True)


if __name__ == "__main__":
    main()
