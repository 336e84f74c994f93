#!/usr/bin/python3
"""Where twin, Cycles and exact arithmetic agree: makes results/stability/twin.md.

    tests/stability/stability.py [--report FILE]

Runs build/release/tests/stability, which renders about 130 frames of 320 x 240 with Blender: two minutes.
"""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

HOME = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = HOME / "build" / "release" / "tests" / "stability"
HEAD = """# Twin, Cycles and exact arithmetic

Made by `tests/stability/stability.py` (`scripts/bench.sh stability`). Four frames of 320 × 240 a case. *Inside* and *edge* are the pixels where Cycles'
index pass and the twin differ ([twin.md](../../docs/twin.md#the-check)); *refused* says whether the check with its default tolerances would refuse any of the frames.
*CGAL asked*: pixels of which CGAL's exact kernel was asked what the ray through their centre meets first — those that differ (60 a frame at most), and 80 others of each frame, most at outlines.
*Ties*: two instances at exactly the same depth, so that either answer is right. *Twin off*, *Cycles off*: how many of the rest each got otherwise than CGAL.
"""
COLUMNS = "| case | inside | edge | of pixels | refused | CGAL asked | ties | twin off | Cycles off |\n|---|---:|---:|---:|---|---:|---:|---:|---:|"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--report", type=pathlib.Path, help="write the table there too")
    options = parser.parse_args()
    text = table(measure())
    print(text)
    if options.report:
        options.report.parent.mkdir(parents=True, exist_ok=True)
        options.report.write_text(text, encoding="utf-8")


def measure():
    with tempfile.TemporaryDirectory(prefix="seedframe-stability-") as folder:
        scripts = pathlib.Path(folder) / "scripts"
        shutil.copytree(HOME / "blender_scripts", scripts)
        move_the_world(scripts / "scene_builder.py")
        lines = []
        with subprocess.Popen([str(PROGRAM), folder], stdout=subprocess.PIPE, text=True) as process:
            for line in process.stdout:
                print(line, end="", file=sys.stderr)
                lines.append(json.loads(line))
        if process.returncode != 0:
            sys.exit(f"stability ended with {process.returncode}")
        return lines


def move_the_world(script):
    """Everything is a child of the camera; where that stands is where Blender's float32 coordinates begin."""
    text = script.read_text(encoding="utf-8")
    known = "        self.scene.camera = camera\n"
    assert text.count(known) == 1
    moved = known + ("        camera.location = [float(c) for c in "
                     "__import__('os').environ['SEEDFRAME_STABILITY_ORIGIN'].split(',')]\n")
    script.write_text(text.replace(known, moved), encoding="utf-8")


def table(lines):
    parts = [HEAD]
    group = None
    for line in lines:
        if line["group"] != group:
            group = line["group"]
            parts.append(f"\n## {group[0].upper() + group[1:]}\n\n{COLUMNS}")
        parts.append("| {name} | {inside_px} | {edge_px} | {pixels:,} | {refused} | {exact_asked} | {exact_ties} | "
                     "{twin_differs} | {cycles_differs} |".format(**{**line, "refused": "yes" if line["refused"] else "no"}))
    far = [line for line in lines if line["group"].startswith("distance")]
    if far:
        moved = ", ".join(f"{line['name']}: {line['from_first_case_px']}" for line in far)
        parts.append(f"\nPixels of the twin that differ from the scene at the origin: {moved}.")
    total = {key: sum(line[key] for line in lines) for key in ("exact_asked", "exact_ties", "twin_differs", "cycles_differs")}
    parts.append("\nIn all CGAL was asked {exact_asked:,} times; {exact_ties} were ties; the twin was off {twin_differs} times, Cycles {cycles_differs} times.\n"
                 .format(**total))
    return "\n".join(parts)


if __name__ == "__main__":
    sys.exit(main())
