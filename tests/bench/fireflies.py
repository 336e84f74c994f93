#!/usr/bin/python3
"""How much do frames sparkle? Makes results/scenes/fireflies.md: fireflies a frame at 64 samples, against many.

A pixel is a firefly if its luminance (scene-linear, of passes.exr) is above

    2 × the largest of the 3 × 3 pixels around it in the reference + a tenth of the reference's mean.

So an edge that noise moves by a pixel is none, nor is noise in the dark. Each scene is rendered as its config says, and
without its limit on indirect light. "stands out": how far the brightest firefly is above what was allowed.

    tests/bench/fireflies.py [--frames 3] [--width 80] [--samples 64] [--reference 4096] [--report FILE]
"""

import argparse
import contextlib
import os
import pathlib
import sqlite3
import subprocess
import sys
import tempfile

import numpy
from overhead import version_of

HOME = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(HOME / "python" / "src"))
from seedframe.exr import decode_exr  # noqa: E402, it is no installed package here

SCENES = ("robocup_spl", "robocup_hall", "parts_study")
VARIANTS = (("as it is", ()), ("no limit", ("render.clamp_indirect=0",)))
ABOVE_NEIGHBOURS, ABOVE_DARK = 2.0, 0.1
LUMINANCE = {"R": 0.2126, "G": 0.7152, "B": 0.0722}  # Rec. 709


def luminance_of(file):
    channels = decode_exr(file.read_bytes(), str(file))
    return sum(weight * next(values for name, values in channels.items() if name.endswith(f"Combined.{color}"))
               for color, weight in LUMINANCE.items())


def allowed_above(reference):
    """What is still no firefly, for each pixel."""
    padded = numpy.pad(reference, 1, mode="edge")
    height, width = reference.shape
    around = [padded[row:row + height, column:column + width] for row in range(3) for column in range(3)]
    return ABOVE_NEIGHBOURS * numpy.max(around, axis=0) + ABOVE_DARK * reference.mean()


def render(options, scene, samples, settings, campaign):
    """The luminance of each frame, and how long workers took for all."""
    command = [options.program, "submit", HOME / "configs" / f"{scene}.yaml", "-o", campaign, "--quiet", "--blender",
               options.blender, "--threads", "1"]
    for setting in (f"render.samples={samples}", f"render.width={options.width}", f"render.height={options.width * 3 // 4}",
                    f"scenes={options.frames}", "frames_per_scene=1", "render.passes=[]", *settings):
        command += ["--set", setting]
    subprocess.run(command, check=True, env={**os.environ, "SEEDFRAME_CACHE": "off"}, stdout=subprocess.DEVNULL)
    with contextlib.closing(sqlite3.connect(campaign / "campaign.sqlite")) as store:
        seconds, = store.execute("SELECT sum(build_s + render_s) FROM attempts WHERE outcome = 'done'").fetchone()
    files = sorted((campaign / "frames").rglob("passes.exr"))
    return [luminance_of(file) for file in files], seconds


def rows_of(options, scene, folder):
    references, seconds = render(options, scene, options.reference, (), folder / f"{scene}-reference")
    print(f"{scene}: reference in {seconds:.0f} s", file=sys.stderr, flush=True)
    allowed = [allowed_above(reference) for reference in references]
    for index, (name, settings) in enumerate(VARIANTS):
        pictures, seconds = render(options, scene, options.samples, settings, folder / f"{scene}-{index}")
        counts = [int((picture > limit).sum()) for picture, limit in zip(pictures, allowed)]
        outstanding = max(float((picture / limit).max()) for picture, limit in zip(pictures, allowed))
        darker = numpy.mean([picture.mean() / reference.mean() - 1 for picture, reference in zip(pictures, references)])
        pixels = sum(picture.size for picture in pictures)
        print(f"{scene}, {name}: {counts} in {seconds:.0f} s", file=sys.stderr, flush=True)
        yield (f"| `{scene}` | {name} | {', '.join(map(str, counts))} | {1e6 * sum(counts) / pixels:.0f} | "
               f"{f'{outstanding:.1f} ×' if outstanding > 1 else ''} | {100 * darker:+.1f} % |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=3)
    parser.add_argument("--width", type=int, default=80, help="pixels; the height is three quarters of it")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--reference", type=int, default=4096, help="samples")
    parser.add_argument("--scene", action="append", choices=SCENES)
    parser.add_argument("--blender", default=f"python:{HOME}/venv/blender-4.5")
    parser.add_argument("--program", type=pathlib.Path, default=HOME / "build" / "release" / "seedframe")
    parser.add_argument("--report", type=pathlib.Path, help="write the table there too")
    options = parser.parse_args()
    lines = ["# Fireflies", "",
             "Made by `scripts/bench.sh fireflies`; `tests/bench/fireflies.py` says how. "
             f"{options.frames} frames of each scene, {options.width} × {options.width * 3 // 4} pixels, {options.samples} samples, "
             f"against {options.reference:,}; {version_of(options.blender)}.", "",
             "A firefly is a pixel that is more than twice as bright as the brightest of the 3 × 3 around it in the reference (and a tenth of "
             "the mean more, so that the noise of dark places is none). *Stands out*: the brightest one over what was allowed. "
             "*Brightness*: the frames' mean against the reference, which has the config's limit.", "",
             "| scene | `clamp_indirect` | fireflies in each frame | in a million pixels | stands out | brightness |",
             "|---|---|---:|---:|---:|---:|"]
    with tempfile.TemporaryDirectory(prefix="seedframe-bench-") as folder:
        for scene in options.scene or SCENES:
            lines += rows_of(options, scene, pathlib.Path(folder))
    text = "\n".join(lines) + "\n"
    print(text)
    if options.report:
        options.report.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
