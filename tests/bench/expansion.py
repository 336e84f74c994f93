#!/usr/bin/python3
"""How fast configs become frame specs and frame ids on one core, and in how much memory.

    tests/bench/expansion.py [--report FILE]

Speed is bench_expansion's (Google Benchmark, CPU time, median of 7); memory is the peak of `seedframe check` over
100,000 and 1,000,000 frames. Prints a table, also into the report; exits with 1 if a target is missed.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

HOME = pathlib.Path(__file__).resolve().parents[2]
BUILD = HOME / "build" / "release"
# Benchmark, what it is, least frames a second (none: only told).
SPEEDS = [
    ("simple_config", "one object, one light, a camera around it", 50_000),
    ("robocup_without_visibility_test", "`configs/robocup_spl.yaml` without its constraint", 5_000),
    ("robocup_with_visibility_test", "the same with it: the ball at least half visible", None),
]
MOST_GROWTH = 1.1  # of memory, from 100,000 to 1,000,000 frames
SIMPLE = """seedframe: 1
categories: [gear]
objects: {part: {asset: gear, rotation_deg: [0, 0, {uniform: [0, 360]}], rest_on_ground: true, material: aluminium}}
lights: {key: {position: [{uniform: [-1, 1]}, -1, 2], power: {uniform: [50, 100]}}}
ground: {width_m: {uniform: [1, 3]}}
camera: {target: [0, 0, 0], distance_m: {uniform: [0.3, 0.6]}, azimuth_deg: {uniform: [0, 360]}}
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--report", type=pathlib.Path, help="write the table there too")
    options = parser.parse_args()
    speeds = measure_speeds()
    peaks = [peak_mib(frames) for frames in (100_000, 1_000_000)]
    lines = ["# Expanding configs", "",
             "Made by `scripts/bench.sh` (`tests/bench/expansion.py`). One core; a frame is drawn, placed, written as canonical",
             "JSON and hashed to its frame id. CPU time, median of 7 runs.", "",
             "| config | µs a frame | frames/s | target | |", "|---|---:|---:|---:|---|"]
    met = True
    for name, what, target in SPEEDS:
        rate = 1e9 / speeds[name]
        verdict = "" if target is None else "met" if rate >= target else "missed"
        met = met and verdict != "missed"
        lines.append(f"| {what} | {speeds[name] / 1e3:.1f} | {rate:,.0f} | "
                     f"{f'≥ {target:,}' if target else ''} | {verdict} |")
    growth = peaks[1] / peaks[0]
    met = met and growth <= MOST_GROWTH
    lines += ["", f"Peak memory of `seedframe check` on such a simple config with a ground of another size in each scene: "
              f"{peaks[0]:.0f} MiB over",
              f"100,000 frames, {peaks[1]:.0f} MiB over 1,000,000: × {growth:.3f} (target: constant, ≤ {MOST_GROWTH}): "
              f"{'met' if growth <= MOST_GROWTH else 'missed'}.", ""]
    text = "\n".join(lines)
    print(text)
    if options.report:
        options.report.write_text(text, encoding="utf-8")
    return not met


def measure_speeds():
    """CPU nanoseconds a frame, by benchmark."""
    output = subprocess.run([str(BUILD / "tests" / "bench_expansion"), "--benchmark_format=json",
                             "--benchmark_repetitions=7", "--benchmark_min_time=0.5"],
                            capture_output=True, text=True, check=True).stdout
    return {run["run_name"]: run["cpu_time"] for run in json.loads(output)["benchmarks"]
            if run.get("aggregate_name") == "median"}


def peak_mib(frames):
    with tempfile.TemporaryDirectory(prefix="seedframe-bench-") as folder:
        config = pathlib.Path(folder) / "simple.yaml"
        config.write_text(SIMPLE + f"scenes: {frames}\n", encoding="utf-8")
        process = subprocess.Popen([str(BUILD / "seedframe"), "check", str(config)], stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            sys.exit(f"check ended with {process.returncode}")
        return usage.ru_maxrss / 1024


if __name__ == "__main__":
    sys.exit(main())
