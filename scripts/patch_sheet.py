#!/usr/bin/python3
"""A contact sheet of exported patches: a row for each class, its patches as they come.

    scripts/patch_sheet.py EXPORTS results/scenes/robocup_patches.jpg [COLUMNS]
"""

import json
import pathlib
import sys

from PIL import Image, ImageDraw

CELL, GAP, NAMES = 64, 3, 84  # pixels


def main():
    folder, out = pathlib.Path(sys.argv[1]) / "patches", sys.argv[2]
    columns = int(sys.argv[3]) if len(sys.argv) > 3 else 20
    classes = json.loads((folder / "classes.json").read_text())
    sheet = Image.new("RGB", (NAMES + columns * (CELL + GAP), len(classes) * (CELL + GAP)), "white")
    pen = ImageDraw.Draw(sheet)
    for row, each in enumerate(classes):
        y = row * (CELL + GAP)
        found = sorted(folder.glob(f"*/{each['folder']}/*.png"))
        pen.text((4, y + CELL // 2 - 12), f"{each['name']}\n{len(found)}", fill="black")
        for column, file in enumerate(found[:: max(1, len(found) // columns)][:columns]):
            patch = Image.open(file).convert("RGB").resize((CELL, CELL), Image.Resampling.NEAREST)
            sheet.paste(patch, (NAMES + column * (CELL + GAP), y))
    sheet.save(out, quality=85, optimize=True)


if __name__ == "__main__":
    main()
