#!/usr/bin/python3
"""How fast masks become annotations, against a plain encoder in Python, and in how much memory.

    tests/bench/export.py [--report FILE]

Prints a table, also into the report; exits with 1 if a target is missed.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

HOME = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = HOME / "build" / "release" / "tests" / "bench_export"
LEAST_FRAMES_PER_SECOND = 2_000  # COCO's run lengths of ten instances of 640 x 480, a core
LEAST_RATIO = 100                # against Python, an instance of 1280 x 720
MOST_GROWTH = 1.1                # of memory, from 1,000 to 100,000 frames
ROUNDS = 5


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--report", type=pathlib.Path, help="write the table there too")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="seedframe-bench-") as folder:
        folder = pathlib.Path(folder)
        rounds = [compare_rle(folder) for _ in range(ROUNDS)]
        steps = [json.loads(run("encode")) for _ in range(ROUNDS)]
        streams = {frames: json.loads(run("stream", str(folder / str(frames)), str(frames), "coco"))
                   for frames in (1_000, 100_000)}
    ratio = median(python / ours for python, ours in rounds)
    python, ours = (median(times) for times in zip(*rounds))
    step = {key: 1e3 * median(each[key] for each in steps) for key in steps[0] if key.endswith("_s")}
    rate = 1e3 / step["encode_s"]
    first, again = streams[100_000]
    growth = first["peak_kib"] / streams[1_000][0]["peak_kib"]
    verdicts = [rate >= LEAST_FRAMES_PER_SECOND, ratio >= LEAST_RATIO, growth <= MOST_GROWTH]
    lines = [
        "# Writing annotations", "",
        "Made by `scripts/bench.sh export` (`tests/bench/export.py`). One core, ten wavy rings of 30 to 80 px radius in 640 × 480, some over",
        f"others. Medians of {ROUNDS} rounds in turn.", "",
        "| | measured | target | |", "|---|---:|---:|---|",
        f"| COCO entries with run lengths, from ids in memory | {rate:,.0f} frames/s ({step['encode_s']:.2f} ms a frame) | "
        f"≥ {LEAST_FRAMES_PER_SECOND:,} | {told(verdicts[0])} |",
        f"| run lengths of an instance of 1280 × 720, against plain Python in the same round ({1e3 * python:.1f} ms and "
        f"{1e6 * ours:.0f} µs) | {ratio:,.0f} × faster | ≥ {LEAST_RATIO} × | {told(verdicts[1])} |",
        f"| peak memory, 1,000 and 100,000 frames ({streams[1_000][0]['peak_kib'] / 1024:.1f} and "
        f"{first['peak_kib'] / 1024:.1f} MiB) | × {growth:.3f} | ≤ {MOST_GROWTH} | {told(verdicts[2])} |",
        "", "The plain encoder is a loop over the pixels, as a first version in Python would be; its string is the same. Against the 17 ms that a peer's Python",
        f"takes for an instance, measured elsewhere, it would be {0.017 / ours:,.0f} ×. Peak memory includes making the frames.", "",
        "Before the entries of a frame can be written, its files are read and checked, on as many cores as there are:", "",
        "| step | ms a frame |", "|---|---:|",
        f"| SHA-256 of labels.json and instances.png | {step['hash_s']:.3f} |",
        f"| labels.json parsed and checked | {step['read_labels_s']:.2f} |",
        f"| instances.png decoded (libpng) | {step['decode_png_s']:.2f} |",
        f"| areas and boxes measured and compared with the labels | {step['extents_s']:.2f} |",
        f"| COCO entries | {step['encode_s']:.2f} |", "",
        f"A whole export of 100,000 such frames from disk, one thread, without images: {first['frames'] / first['seconds']:,.0f} frames/s; "
        f"again, with nothing changed, {again['frames'] / again['seconds']:,.0f} frames/s.", ""]
    text = "\n".join(lines)
    print(text)
    if options.report:
        options.report.write_text(text, encoding="utf-8")
    return not all(verdicts)


def compare_rle(folder):
    """Seconds an instance takes in plain Python and in ours; both strings must be equal."""
    mask_file = folder / "mask.raw"
    ours = json.loads(run("rle", str(mask_file)))
    width, height = ours["width"], ours["height"]
    pixels = mask_file.read_bytes()
    rows = [list(pixels[row * width:(row + 1) * width]) for row in range(height)]
    start = time.perf_counter()
    counts = plain_rle(rows, width, height)
    seconds = time.perf_counter() - start
    if counts != ours["counts"]:
        sys.exit("the two encoders disagree")
    return seconds, ours["seconds"]


def plain_rle(rows, width, height):
    runs, inside, length = [], 0, 0
    for column in range(width):
        for row in range(height):
            if rows[row][column] != inside:
                runs.append(length)
                inside, length = 1 - inside, 0
            length += 1
    runs.append(length)
    text = []
    for index, run_length in enumerate(runs):
        value = run_length - runs[index - 2] if index > 2 else run_length
        more = True
        while more:
            group = value & 31
            value >>= 5
            more = value != -1 if group & 16 else value != 0
            text.append(chr(48 + (group | 32 if more else group)))
    return "".join(text)


def run(*arguments):
    return subprocess.run([str(PROGRAM), *arguments], capture_output=True, text=True, check=True).stdout


def median(values):
    ordered = sorted(values)
    return ordered[len(ordered) // 2]


def told(met):
    return "met" if met else "missed"


if __name__ == "__main__":
    sys.exit(main())
