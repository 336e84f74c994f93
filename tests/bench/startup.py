#!/usr/bin/python3
"""How long the program takes for next to nothing, and what it loads for that.

    tests/bench/startup.py [--report FILE]

Prints a table, also into the report; exits with 1 if a target is missed.
"""

import argparse
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

HOME = pathlib.Path(__file__).resolve().parents[2]
BUILD = HOME / "build" / "release"
PROGRAM = BUILD / "seedframe"
MODULE = BUILD / "seedframe_image_module.so"
MOST_S = 0.1
ROUNDS = 21
RENDERED_FRAMES = (1, 10)
RENDER_ROUNDS = 7
CONFIG = """seedframe: 1
name: small
scenes: 4
categories: [gear]
render: {width: 64, height: 48}
labels: geometry
objects: {o: {asset: gear, category: gear, rest_on_ground: true}}
ground: {material: Planks01}
world: {hdri: studio}
camera: {distance_m: 0.4}
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--report", type=pathlib.Path, help="write the table there too")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="seedframe-bench-", dir=HOME / "build") as folder:
        folder = pathlib.Path(folder)
        config, campaign, cache = folder / "small.yaml", folder / "small", folder / "cache"
        config.write_text(CONFIG)
        call({}, "submit", config, "-o", campaign, "--quiet")
        call({}, "export", campaign, "--format", "coco")
        call({"SEEDFRAME_CACHE": str(cache)}, "check", config)
        rows = [
            row("`--version`", True, {}, "--version"),
            row("`status`", True, {}, "status", campaign),
            row("`explain` of a frame", True, {}, "explain", campaign, "0"),
            row("`export` of unchanged frames", True, {}, "export", campaign, "--format", "coco"),
            row("`check`, images known to be good", True, {"SEEDFRAME_CACHE": str(cache)}, "check", config),
            row("`check`, images decoded", False, {}, "check", config),
            *[row_of_submit(folder / "rendered", frames) for frames in RENDERED_FRAMES],
        ]
    text = "\n".join([
        "# Start-up", "",
        "Made by `scripts/bench.sh startup` (`tests/bench/startup.py`): the whole program, a campaign of 4 frames with a texture",
        f"set of {texture_files()} files and an environment map, the disk's cache warm. Of {ROUNDS} runs the shortest, the median, and the median of the",
        "time on a processor; the target is for the shortest, since a busy machine lengthens the others. `submit` renders the first",
        f"frames of `configs/bench_small.yaml`, which has 100, in {blender_version()}, which nothing is known of before;",
        f"of {RENDER_ROUNDS} runs.", "",
        "| | shortest | median | processor | target | |", "|---|---:|---:|---:|---|---|",
        *[line for line, _ in rows], "",
        f"The program loads {libraries(PROGRAM)} shared libraries, the module that it opens to decode or encode images",
        f"{libraries(MODULE)} (`ldd`)."]) + "\n"
    print(text, end="")
    if options.report:
        options.report.write_text(text)
    return 0 if all(met for _, met in rows) else 1


def row(what, has_target, environment, *arguments):
    runs = [call(environment, *arguments) for _ in range(ROUNDS)]
    return tell(what, has_target, runs)


def row_of_submit(campaign, frames):
    runs = []
    for _ in range(RENDER_ROUNDS):
        shutil.rmtree(campaign, ignore_errors=True)
        runs.append(call({}, "submit", HOME / "configs" / "bench_small.yaml", "-o", campaign, "--quiet", "--frames", frames,
                         "--blender", "/usr/bin/blender"))
    return tell(f"`submit` of {frames} frame{'s' if frames > 1 else ''}, Blender's start in it", False, runs)


def tell(what, has_target, runs):
    walls, processor = sorted(wall for wall, _ in runs), sorted(cpu for _, cpu in runs)
    met = not has_target or walls[0] <= MOST_S
    target = f"{MOST_S} s | {'met' if met else 'missed'}" if has_target else "|"
    middle = len(runs) // 2
    return f"| {what} | {walls[0]:.3f} s | {walls[middle]:.3f} s | {processor[middle]:.3f} s | {target} |", met


def call(environment, *arguments):
    """Seconds by the wall's clock and on a processor."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.perf_counter()
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          env={**os.environ, "SEEDFRAME_CACHE": "off", **environment})
    wall = time.perf_counter() - start
    if done.returncode != 0:
        sys.exit(f"startup.py: seedframe {' '.join(map(str, arguments))}: {done.stderr}")
    now = resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, now.ru_utime - used.ru_utime + now.ru_stime - used.ru_stime


def blender_version():
    return subprocess.run(["/usr/bin/blender", "--version"], capture_output=True, text=True, check=True).stdout.split("\n")[0]


def texture_files():
    return len(list((HOME / "materials" / "textures" / "Planks01").glob("*.*")))


def libraries(file):
    listed = subprocess.run(["ldd", file], capture_output=True, text=True, check=True).stdout
    return len(re.findall(r"=>", listed))


if __name__ == "__main__":
    sys.exit(main())
