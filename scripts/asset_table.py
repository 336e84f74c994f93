#!/usr/bin/python3
"""Writes results/assets/assets.md: the price of every built-in asset and of its levels of detail.

    scripts/asset_table.py [ASSETS [OUTPUT]]
"""

import json
import pathlib
import sys

HOME = pathlib.Path(__file__).resolve().parent.parent

HEAD = """# The built-in assets

Made by `scripts/asset_table.py` from `assets/*/asset.json`. Error: the two-sided Hausdorff distance, from above, as a
share of the asset's longest side; of level 0 from the imported mesh (quantisation alone), of the others from level 0,
after compression. Bits: of the whole stream (connectivity, UVs and slots too) for each coordinate. A level is for views
in which the longest side spans at most so many pixels; 1/20 pixel of such a view is the bound.

| asset | level | triangles | saved | bytes | bits/coordinate | error | 1/20 px | for |
|---|---|---:|---:|---:|---:|---:|---:|---:|
"""


def share(value):
    return f"1/{1.0 / value:,.0f}" if value > 0.0 else "0"


def rows(asset):
    size = max(asset["measures"]["size_m"])
    finest = asset["levels"][0]["triangles"]
    for i, level in enumerate(asset["levels"]):
        saved = "" if i == 0 else f"{100.0 * (1.0 - level['triangles'] / finest):.0f} %"
        yield (f"| {asset['name'] if i == 0 else ''} | {i} | {level['triangles']:,} | {saved} | {level['bytes']:,} | "
               f"{level['bits_per_coordinate']:.1f} | {share(level['error_share'])} | "
               f"{share(level['bound_m'] / size)} | {level['pixels']:g} px |")


def surface_row(asset):
    m, r = asset["measures"], asset["repairs"]
    found = ", ".join(f"{count} {key.replace('_', ' ')}" for key, count in sorted(r.items()) if count) or "none"
    size = " × ".join(f"{1000.0 * side:.1f}" for side in m["size_m"])
    volume = "" if m["volume_m3"] is None else f"{1e6 * m['volume_m3']:,.2f}"
    return (f"| {asset['name']} | {size} | {1e4 * m['area_m2']:,.1f} | {volume} | {'yes' if m['watertight'] else 'no'} | "
            f"{m['parts']} | {'' if m['genus'] is None else m['genus']} | {m['self_intersections']:,} | {found} |")


def main(arguments):
    root = pathlib.Path(arguments[0]) if arguments else HOME / "assets"
    output = pathlib.Path(arguments[1]) if len(arguments) > 1 else HOME / "results" / "assets" / "assets.md"
    assets = [json.loads(path.read_text()) for path in sorted(root.glob("*/asset.json"))]
    total = [sum(sum(level["bytes"] for level in a["levels"][first:]) for a in assets) for first in (0, 1)]
    text = HEAD + "\n".join(row for asset in assets for row in rows(asset))
    text += (f"\n\n{len(assets)} assets, {sum(len(a['levels']) - 1 for a in assets)} coarser levels; "
             f"{total[0]:,} bytes, {total[1]:,} of them in coarser levels.\n")
    text += ("\n## Surfaces\n\n| asset | size, mm | area, cm² | volume, cm³ | watertight | parts | genus | "
             "crossing pairs | found in the file |\n|---|---|---:|---:|---|---:|---:|---:|---|\n")
    text += "\n".join(surface_row(asset) for asset in assets) + "\n"
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(text)


if __name__ == "__main__":
    main(sys.argv[1:])
