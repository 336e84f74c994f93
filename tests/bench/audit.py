#!/usr/bin/python3
"""How fast an audit reads a campaign's files.

    tests/bench/audit.py [--report FILE]

1,000 frames of 320 × 240 with depth and normals, labels by geometry; `seedframe audit --frames 0`, the whole
program, on one core and on all, side by side in turns, with the disk's cache warm; beside it `sha256sum` of
the same files. Prints a table, also into the report; exits with 1 if the target is missed.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

HOME = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = HOME / "build" / "release" / "seedframe"
FRAMES = 1000
LEAST_MB_S = 200.0
ROUNDS = 5
CONFIG = f"""seedframe: 1
name: audited
scenes: {FRAMES}
categories: [gear, hex_nut]
render: {{width: 320, height: 240, passes: [depth, normal]}}
labels: geometry
objects:
  gears: {{asset: gear, count: 4, position: [{{uniform: [-0.1, 0.1]}}, {{uniform: [-0.1, 0.1]}}, {{uniform: [0, 0.1]}}]}}
  nut: {{asset: hex_nut, position: [{{uniform: [-0.1, 0.1]}}, 0, 0.2]}}
ground: {{width_m: 2, depth_m: 2}}
camera: {{distance_m: {{uniform: [0.4, 0.6]}}, azimuth_deg: {{uniform: [0, 360]}}}}
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--report", type=pathlib.Path, help="write the table there too")
    options = parser.parse_args()
    cpus = sorted(os.sched_getaffinity(0))
    with tempfile.TemporaryDirectory(prefix="seedframe-bench-", dir=HOME / "build") as folder:
        folder = pathlib.Path(folder)
        (folder / "audited.yaml").write_text(CONFIG, encoding="utf-8")
        subprocess.run([PROGRAM, "submit", "audited.yaml", "-o", "c", "--quiet"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        audit = [PROGRAM, "audit", "c", "--frames", "0", "--quiet"]
        hashing = ["sh", "-c", "find c/frames -type f -print0 | xargs -0 sha256sum >/dev/null"]
        times = {"one": [], "all": [], "sum": []}
        for _ in range(ROUNDS + 1):  # the first one warms the cache
            times["one"].append(seconds(audit, folder, cpus[:1]))
            times["all"].append(seconds(audit, folder, cpus))
            times["sum"].append(seconds(hashing, folder, cpus[:1]))
        megabytes = json.loads((folder / "c/audit/report.json").read_text(encoding="utf-8"))["files"]["bytes"] / 1e6
    medians = {name: sorted(some[1:])[ROUNDS // 2] for name, some in times.items()}
    rate = megabytes / medians["one"]
    met = rate >= LEAST_MB_S
    text = "\n".join([
        "# An audit without rendering", "",
        f"Made by `scripts/bench.sh audit` (`tests/bench/audit.py`), the whole program each time: {FRAMES:,} frames of seven files,",
        f"{megabytes:.0f} MB, which the disk's cache holds. Medians of {ROUNDS} runs in turns.", "",
        "| | s | MB/s | target | |", "|---|---:|---:|---:|---|",
        f"| `seedframe audit --frames 0` on one core | {medians['one']:.2f} | {rate:.0f} | ≥ {LEAST_MB_S:.0f} | {'met' if met else 'missed'} |",
        f"| on {len(cpus)} cores | {medians['all']:.2f} | {megabytes / medians['all']:.0f} | | |",
        f"| for comparison: `sha256sum` on one core | {medians['sum']:.2f} | {megabytes / medians['sum']:.0f} | | |", ""])
    print(text)
    if options.report:
        options.report.write_text(text, encoding="utf-8")
    return not met


def seconds(command, folder, cpus):
    begin = time.monotonic()
    subprocess.run(["taskset", "-c", ",".join(map(str, cpus)), *command], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return time.monotonic() - begin


if __name__ == "__main__":
    sys.exit(main())
