#!/usr/bin/python3
"""What the twin costs, beside Blender's own rendering of labels, and as a share of a campaign.

    tests/bench/twin.py [--rounds 5] [--report FILE]

Each round measures, one after the other on one core: bench_twin (Google Benchmark, CPU time) over the demo config's
frames; Blender's labels of the same config (one sample, no passes but the index, 640 x 480: what a worker takes to build and
render a frame); and the demo campaign as it is (a frame's wall time). Medians of rounds and of their ratios go into the table.
Exits with 1 if a target is missed.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

HOME = pathlib.Path(__file__).resolve().parents[2]
BUILD = HOME / "build" / "release"
CONFIG = HOME / "configs" / "parts.yaml"
LABEL_FRAMES = 8
NOTE = """
The demo's parts have 108,000 triangles, several to a pixel at 128 × 128, where neighbouring rays go separate ways: Embree itself takes
more than four fifths of the time. Tried: packets of 1, 4, 8 and 16 rays (4 × 4 is best, single rays take twice as long), trees of high quality (no difference beyond
the noise of this machine). AVX-512 is left out on purpose ([twin.md](../../docs/twin.md#what-it-is)).
"""
DEMO_FRAMES = 4


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--report", type=pathlib.Path, help="write the table there too")
    options = parser.parse_args()
    rounds = [measure() for _ in range(options.rounds)]
    text, met = table(rounds)
    print(text)
    if options.report:
        options.report.write_text(text, encoding="utf-8")
    return not met


def measure():
    """One round: milliseconds by name, and the counters of bench_twin."""
    output = subprocess.run([str(BUILD / "tests" / "bench_twin"), "--benchmark_format=json", "--benchmark_min_time=0.3"],
                            capture_output=True, text=True, check=True).stdout
    times, counters = {}, {}
    for run in json.loads(output)["benchmarks"]:
        times[run["name"]] = run["cpu_time"]
        counters[run["name"]] = run
    with tempfile.TemporaryDirectory(prefix="seedframe-bench-") as folder:
        times["blender_labels"] = blender_labels_ms(pathlib.Path(folder) / "labels")
        times["demo_frame"] = demo_frame_ms(pathlib.Path(folder) / "demo")
    return times, counters


def submit(folder, *more):
    begin = time.time()
    subprocess.run([str(BUILD / "seedframe"), "submit", str(CONFIG), "-o", str(folder), "--quiet", *more],
                   check=True, stdout=subprocess.DEVNULL)
    return time.time() - begin


def blender_labels_ms(folder):
    submit(folder, "--frames", str(LABEL_FRAMES), "--workers", "1", "--threads", "1", "--set", "render.samples=1",
           "--set", "render.max_bounces=0", "--set", "render.passes=[]", "--set", "render.width=640",
           "--set", "render.height=480")
    status = subprocess.run([str(BUILD / "seedframe"), "status", str(folder), "--json"], check=True, capture_output=True,
                            text=True).stdout
    seconds = json.loads(status)["mean_seconds"]
    return 1e3 * (seconds["build"] + seconds["render"])


def demo_frame_ms(folder):
    """Wall time of a frame of the demo campaign, without what a campaign takes to start."""
    start = submit(folder / "one", "--frames", "1")
    all_frames = submit(folder / "all", "--frames", str(1 + DEMO_FRAMES))
    return 1e3 * (all_frames - start) / DEMO_FRAMES


def table(rounds):
    times = [each for each, _ in rounds]
    counters = rounds[0][1]

    def median(name):
        return statistics.median(each[name] for each in times)

    def ratio(above, below):
        return statistics.median(each[above] / each[below] for each in times)

    faster = ratio("blender_labels", "ids/640/480")
    faster_first = ratio("blender_labels", "first_frame/640/480")
    silhouettes = ratio("silhouettes/640/480", "fullest_ids/640/480")
    share = ratio("check/320/240", "demo_frame")
    memory = {name.split("/")[1]: counters[name] for name in counters if name.startswith("memory/")}
    triangles = [2 * int(n) ** 2 for n in memory]
    per_triangle = [each["bytes_per_triangle"] for each in memory.values()]
    instances = counters["silhouettes/640/480"]["instances"]
    rows = [
        ("twin of a frame of the demo config, mean of all, 640 × 480 (ids; the instances' tree is built, those of the meshes are there)",
         f"{median('ids/640/480'):.1f} ms", "≤ 25 ms", median("ids/640/480") <= 25),
        ("the same at 128 × 128", f"{median('ids/128/128'):.2f} ms", "≤ 1.5 ms", median("ids/128/128") <= 1.5),
        ("the same with every mesh's tree built, as for a campaign's first frame, 640 × 480",
         f"{median('first_frame/640/480'):.0f} ms", "", None),
        ("the same, 128 × 128", f"{median('first_frame/128/128'):.0f} ms", "", None),
        (f"the frame with the most instances ({instances:.0f}), 640 × 480", f"{median('fullest_ids/640/480'):.1f} ms", "", None),
        ("the same, 128 × 128", f"{median('fullest_ids/128/128'):.2f} ms", "", None),
        ("with depth and normals, 640 × 480", f"{median('ids_depth_normals/640/480'):.1f} ms", "", None),
        ("Blender's own label rendering, 640 × 480, one sample, one thread", f"{median('blender_labels'):.0f} ms", "", None),
        ("Blender's / the twin's", f"{faster:.0f} ×", "≥ 20 ×", faster >= 20),
        ("Blender's / the twin's with every mesh's tree built", f"{faster_first:.1f} ×", "", None),
        (f"all silhouettes of those {instances:.0f} instances / their id image, 640 × 480", f"{silhouettes:.2f}", "≤ 3", silhouettes <= 3),
        ("twin, comparison and silhouettes / a frame's wall time in the demo campaign (320 × 240, 32 samples)",
         f"{100 * share:.2f} %", "≤ 3 %", share <= 0.03),
        (f"Embree's bytes per triangle, meshes of {', '.join(f'{t:,}' for t in triangles)} triangles",
         ", ".join(f"{b:.0f}" for b in per_triangle), "linear", max(per_triangle[1:]) / min(per_triangle[1:]) <= 1.25),
        ("Embree's bytes per instance", f"{list(memory.values())[-1]['bytes_per_instance']:.0f}", "", None),
    ]
    lines = ["# The twin", "", "Made by `scripts/bench.sh` (`tests/bench/twin.py`): one core, CPU time, medians of "
             f"{len(rounds)} rounds; ratios are medians", "of the ratios within a round.", "",
             "| what | measured | target | |", "|---|---:|---:|---|"]
    lines += [f"| {what} | {value} | {target} | {'' if met is None else 'met' if met else 'missed'} |"
              for what, value, target, met in rows]
    return "\n".join(lines) + "\n" + NOTE, all(met is not False for _, _, _, met in rows)


if __name__ == "__main__":
    sys.exit(main())
