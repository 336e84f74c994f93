#!/usr/bin/python3
"""How large a report is, how long it takes to make, and how soon it can be used.

    tests/bench/report.py [--frames N] [--report FILE]

Prints a table, also into the report; exits with 1 if a target is missed. Needs what tests/browser/install.sh installs.
"""

import argparse
import base64
import io
import json
import os
import pathlib
import random
import resource
import subprocess
import sys
import tempfile
import time

import PIL.Image

HOME = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = HOME / "build" / "release" / "seedframe"
MOST_BYTES = 50e6
MOST_READY_MS = 2000
BESIDE = 100_000  # frames, of a campaign whose thumbnails are in a folder
PICTURES = HOME / "docs" / "images" / "demo.jpg"
LONGER_SIDE = 100  # pixels of a thumbnail in a page with 10,000 of them


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=10_000, help="of the campaign in one file")
    parser.add_argument("--report", type=pathlib.Path, help="write the table there too")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="seedframe-bench-", dir=HOME / "build") as folder:
        folder = pathlib.Path(folder)
        inside = measure(folder / "inside", options.frames, "160", "120")
        weighted = with_pictures(folder / "inside" / "report.html", options.frames)
        beside = measure(folder / "beside", BESIDE, "64", "48")
        text = table(options.frames, inside, weighted, beside)
        print(text, end="", flush=True)
        if options.report:
            options.report.write_text(text)
    met = weighted["bytes"] <= MOST_BYTES and max(weighted["ready"], inside["ready"], beside["ready"]) <= MOST_READY_MS
    return 0 if met else 1


def measure(campaign, frames, width, height):
    call("submit", HOME / "configs" / "parts.yaml", "-o", campaign, "--quiet", "--set", "labels=geometry", "--set",
         f"scenes={frames // 5}", "--set", f"render.width={width}", "--set", f"render.height={height}", "--set",
         "render.passes=[]")
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.perf_counter()
    call("report", campaign)
    wall = time.perf_counter() - start
    now = resource.getrusage(resource.RUSAGE_CHILDREN)
    page = campaign / "report.html"
    parts = campaign / "report_files"
    return {"frames": frames, "wall": wall, "cpu": now.ru_utime - used.ru_utime + now.ru_stime - used.ru_stime,
            "bytes": page.stat().st_size,
            "beside": sum(part.stat().st_size for part in parts.iterdir()) if parts.is_dir() else 0, **opened(page)}


def opened(page):
    done = subprocess.run(["node", HOME / "tests" / "bench" / "page_start.mjs", page], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"report.py: {page}: {done.stderr}")
    return json.loads(done.stdout)


def with_pictures(page, frames):
    """The same page with as many bytes more as pictures of all frames would have."""
    more = base64.b64encode(random.Random(1).randbytes(round(frames * picture_bytes()))).decode()
    text = page.read_text()
    heavy = page.with_name("heavy.html")
    heavy.write_text(text.replace("</body>", f'<script type="application/json" id="weight">"{more}"</script></body>'))
    result = {"bytes": heavy.stat().st_size, **opened(heavy)}
    heavy.unlink()
    return result


def picture_bytes():
    """Of one thumbnail in a sheet, by the four frames of the demo that the README shows."""
    demo = PIL.Image.open(PICTURES).convert("RGB")
    frame = (demo.width // 4, demo.height // 2)
    sheet = PIL.Image.new("RGB", (4 * LONGER_SIDE, LONGER_SIDE * frame[1] // frame[0]))
    for i in range(4):
        cut = demo.crop((i * frame[0], 0, (i + 1) * frame[0], frame[1]))
        sheet.paste(cut.resize((LONGER_SIDE, sheet.height), PIL.Image.Resampling.BOX), (i * LONGER_SIDE, 0))
    encoded = io.BytesIO()
    sheet.save(encoded, "WEBP", quality=72)
    return len(encoded.getvalue()) / 4


def table(frames, inside, weighted, beside):
    def row(what, numbers, wall=""):
        size = f"{numbers['bytes'] / 1e6:.1f} MB" + (f" + {numbers['beside'] / 1e6:.0f} MB" if numbers.get("beside") else "")
        return (f"| {what} | {size} | {wall} | {numbers['ready'] / 1000:.2f} s | {numbers['grid'] / 1000:.2f} s | "
                f"{numbers['filter'] / 1000:.2f} s |")

    def made(numbers):
        return f"{numbers['wall']:.0f} s, {1000 * numbers['cpu'] / numbers['frames']:.1f} ms of a core a frame"

    ready = max(weighted["ready"], inside["ready"])
    met = "met" if weighted["bytes"] <= MOST_BYTES and ready <= MOST_READY_MS else "missed"
    return "\n".join([
        "# Reports", "",
        "Made by `scripts/bench.sh report` (`tests/bench/report.py`): the scenes of `configs/parts.yaml`, some 20 objects and 105 drawn",
        "variables, labels only. In a browser: from opening the file until the first page is there; then until the grid shows frames;",
        "then until a filter over a draw has been applied (with Playwright's own time). Targets for 10,000 frames in one file:",
        f"{MOST_BYTES / 1e6:.0f} MB, {MOST_READY_MS / 1000:.0f} s: {met}.", "",
        "| | size | made in | first page | grid | filter |", "|---|---:|---:|---:|---:|---:|",
        row(f"{frames:,} frames, 160 × 120, in one file", inside, made(inside)),
        row("the same with the weight of pictures", weighted),
        row(f"{beside['frames']:,} frames, 64 × 48, with a folder beside it", beside, made(beside)), "",
        f"A thumbnail of a rendered frame of the demo takes {picture_bytes() / 1000:.1f} kB, {4 * picture_bytes() / 3000:.1f} kB in base64: \"the weight",
        "of pictures\" is as many random bytes."]) + "\n"


def call(*arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          env={**os.environ, "SEEDFRAME_CACHE": "off"})
    if done.returncode != 0:
        sys.exit(f"report.py: seedframe {' '.join(map(str, arguments))}: {done.stderr}")


if __name__ == "__main__":
    sys.exit(main())
