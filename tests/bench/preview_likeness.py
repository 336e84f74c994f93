#!/usr/bin/python3
"""How like a render a shaded preview is: both by `seedframe stream`, of the same frames, beside each other.

    tests/bench/preview_likeness.py [--report FILE.md] [--picture FILE.jpg] [--program P] [--blender B]

Frames 0, 1 and 2 of the configs below at 320 × 240, renders with 32 samples.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys

import numpy
from PIL import Image

HOME = pathlib.Path(__file__).resolve().parents[2]
CONFIGS = ("parts", "parts_study", "robocup_spl", "tyol_single_8_target")
SCENES = (0, 1, 2)
SIZE = ("--set", "render.width=320", "--set", "render.height=240", "--set", "render.samples=32")


def image_of(answer):
    if "error" in answer:
        sys.exit(answer["error"]["message"])
    arrays = answer["arrays"]
    image = arrays["image"]
    count = image["shape"][0] * image["shape"][1] * image["shape"][2]
    return numpy.fromfile(arrays["path"], numpy.uint8, count, offset=image["offset"]).reshape(image["shape"])


def images(options, config, fidelity):
    """Of each scene's first frame."""
    process = subprocess.Popen([options.program, "stream", HOME / f"configs/{config}.yaml", *SIZE, "--blender", options.blender],
                               stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env={**os.environ, "SEEDFRAME_CACHE": "off"})
    made = {}
    for scene in SCENES:
        process.stdin.write(json.dumps({"id": scene, "fidelity": fidelity, "scene": scene, "want": ["image"]}) + "\n")
        process.stdin.flush()
    while len(made) < len(SCENES):
        answer = json.loads(process.stdout.readline())
        if "id" in answer:
            made[answer["id"]] = image_of(answer)
    process.stdin.close()
    if process.wait() != 0:
        sys.exit("the stream ended with an error")
    return [made[scene] for scene in SCENES]


def likeness(preview, render):
    """Mean distance in codes of 255, the same of images blurred over 8 × 8 pixels, and the correlation of brightness."""
    a, b = preview.astype(float), render.astype(float)
    coarse = [image.reshape(30, 8, 40, 8, 3).mean(axis=(1, 3)) for image in (a, b)]
    brightness = [(image @ (0.2126, 0.7152, 0.0722)).ravel() for image in (a, b)]
    return abs(a - b).mean(), abs(coarse[0] - coarse[1]).mean(), numpy.corrcoef(*brightness)[0, 1]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=HOME / "build/release/seedframe")
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--report", type=pathlib.Path)
    parser.add_argument("--picture", type=pathlib.Path, help="previews above the renders of the same frames")
    options = parser.parse_args()
    rows, strips = [], []
    for config in CONFIGS:
        previews, renders = (images(options, config, fidelity) for fidelity in ("preview", "render"))
        figures = numpy.mean([likeness(*pair) for pair in zip(previews, renders)], axis=0)
        rows.append(f"| `{config}` | {figures[0]:.1f} | {figures[1]:.1f} | {figures[2]:.3f} |")
        print(rows[-1], flush=True)
        strips += [numpy.hstack(previews), numpy.hstack(renders)]
    text = f"""# How like a render a preview is

Made by `tests/bench/preview_likeness.py`: the fidelity `preview` of `seedframe stream` beside `render` (Blender `{options.blender}`, 32 samples), frames of
three scenes at 320 × 240. *Pixels*: mean distance of the values, in codes of 255; *blurred*: the same of means over 8 × 8 pixels, which noise and fine
texture do not count in; *correlation*: of brightness, over pixels.

| config | pixels | blurred | correlation |
|---|---:|---:|---:|
""" + "\n".join(rows) + "\n"
    if options.report:
        options.report.write_text(text)
    if options.picture:
        Image.fromarray(numpy.vstack(strips)).save(options.picture, quality=60)


main()
