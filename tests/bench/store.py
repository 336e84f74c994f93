#!/usr/bin/python3
"""What a scheduler asks of the store of a large campaign, and how long that takes.

    tests/bench/store.py [--report FILE]

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
PROGRAM = HOME / "build" / "release" / "seedframe"
BENCH = HOME / "build" / "release" / "tests" / "bench_store"
FRAMES = 100_000
MANY_FRAMES = 1_000_000
CLAIMS = 20_000
MOST_RESUME_S = 2.0
MOST_CLAIM_S = 0.005
MOST_STATUS_S = 5.0
ROUNDS = 5
CONFIG = """seedframe: 1
name: large
scenes: {frames}
categories: [hex_nut]
render: {{width: 32, height: 24}}
labels: geometry
objects:
  nut: {{asset: hex_nut, position: [{{uniform: [-0.1, 0.1]}}, 0, 0]}}
camera: {{distance_m: 0.5}}
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--report", type=pathlib.Path, help="write the table there too")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="seedframe-bench-", dir=HOME / "build") as folder:
        folder = pathlib.Path(folder)
        large = campaign(folder / "large", FRAMES, "fill")
        seconds("resume", large)  # the disk's cache is warm from here on
        resumes = sorted(seconds("resume", large) for _ in range(ROUNDS))
        verify = seconds("resume", large, "--verify")
        claims = json.loads(call(BENCH, "claims", large, str(CLAIMS)))
        huge = campaign(folder / "huge", MANY_FRAMES, "fill-rows")
        statuses = sorted(seconds("status", huge) for _ in range(ROUNDS))
    resume, status = resumes[ROUNDS // 2], statuses[ROUNDS // 2]
    verdicts = [resume <= MOST_RESUME_S, claims["p99_s"] <= MOST_CLAIM_S, status <= MOST_STATUS_S]
    told = ["met" if verdict else "missed" for verdict in verdicts]
    text = "\n".join([
        "# Large campaigns", "",
        "Made by `scripts/bench.sh store` (`tests/bench/store.py`), the whole program each time; frames of nine",
        f"files, of a few bytes. Medians of {ROUNDS} runs and the longest of them.", "",
        "| | measured | longest | target | |", "|---|---:|---:|---:|---|",
        f"| `resume` of {FRAMES:,} frames that are done: every file's size and time looked at | {resume:.2f} s | "
        f"{resumes[-1]:.2f} s | ≤ {MOST_RESUME_S:g} s | {told[0]} |",
        f"| a claim in that store (which frame next, and the row of its attempt), 99th of 100, of {claims['claims']:,} | "
        f"{1e3 * claims['p99_s']:.2f} ms | {1e3 * claims['longest_s']:.2f} ms | ≤ {1e3 * MOST_CLAIM_S:g} ms | {told[1]} |",
        f"| `status` of {MANY_FRAMES:,} frames, all done, with the dataset hash | {status:.2f} s | {statuses[-1]:.2f} s | "
        f"≤ {MOST_STATUS_S:g} s | {told[2]} |",
        "", f"A median claim takes {1e3 * claims['median_s']:.3f} ms. `resume --verify`, which reads and hashes every file and checks "
        f"the store, took {verify:.1f} s for the same {FRAMES:,} frames.", ""])
    print(text)
    if options.report:
        options.report.write_text(text, encoding="utf-8")
    return not all(verdicts)


def campaign(folder, frames, how):
    """A campaign that looks finished."""
    config = folder.with_suffix(".yaml")
    config.write_text(CONFIG.format(frames=frames), encoding="utf-8")
    call(PROGRAM, "submit", config, "-o", folder, "--frames", "1", "--quiet", "--no-space-check")
    call(BENCH, how, folder)
    return folder


def seconds(*arguments):
    begin = time.perf_counter()
    output = call(PROGRAM, *arguments)
    taken = time.perf_counter() - begin
    if "dataset hash" not in output:
        sys.exit(f"store.py: not complete: {output}")
    return taken


def call(*command):
    return subprocess.run([str(part) for part in command], check=True, stdout=subprocess.PIPE, text=True).stdout


if __name__ == "__main__":
    sys.exit(main())
