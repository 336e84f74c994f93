#!/usr/bin/python3
"""What a frame costs the program itself, apart from Blender, by stage.

    tests/bench/frame.py [--rounds 3] [--report FILE]

Runs bench_frame (Google Benchmark, CPU time of one core), which makes its own passes of frames with 1, 26, 200 and 1,000 objects
and of the parts study. Medians of rounds go into the table. Exits with 1 if a target is missed.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys

HOME = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = HOME / "build" / "release" / "tests" / "bench_frame"
STUDY = "0"  # what bench_frame calls the parts study
SCENES = {"1": "1 object", "26": "26 objects", "200": "200 objects", "1000": "1,000 objects",
          STUDY: "parts study, 200 objects among which the camera is"}
SIZES = {"128/128": "128 × 128", "640/480": "640 × 480"}
STAGES = ["twin", "silhouettes", "passes", "colour", "png", "hashes", "labels", "files"]
LIMIT_MS = 150  # the parts study at 640 x 480


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--report", type=pathlib.Path, help="write the table there too")
    options = parser.parse_args()
    rounds = [measure() for _ in range(options.rounds)]
    times = {name: statistics.median(each[name] for each in rounds) for name in rounds[0]}
    study_ms = times[f"whole/{STUDY}/640/480"]
    text = table(times, options.rounds, study_ms)
    print(text)
    if options.report:
        options.report.write_text(text, encoding="utf-8")
    return study_ms > LIMIT_MS


def measure():
    """Milliseconds by name."""
    output = subprocess.run([str(PROGRAM), "--benchmark_format=json", "--benchmark_min_time=0.2"], capture_output=True,
                            text=True, check=True).stdout
    return {run["name"]: run["cpu_time"] for run in json.loads(output)["benchmarks"]}


def stages(times, case):
    """Milliseconds by stage; silhouettes are apart from the other labels, files are what is left."""
    of_case = {stage: times[f"{stage}/{case}"] for stage in STAGES if stage != "files"}
    of_case["labels"] = max(0.0, of_case["labels"] - of_case["silhouettes"])
    of_case["files"] = max(0.0, times[f"whole/{case}"] - sum(of_case.values()))
    return of_case


def table(times, rounds, study_ms):
    lines = ["# What a frame costs the program itself", "",
             "Made by `scripts/bench.sh frame` (`tests/bench/frame.py`): CPU milliseconds of one core from the worker's file to the",
             f"files of the frame, Blender apart; medians of {rounds} round{'s' if rounds > 1 else ''}. Trees of the meshes are there. `passes` reads the",
             "worker's file and hashes its pixels; `files` is what the others leave of the whole: the copy of the passes, writing,",
             "and folders.", "",
             "| scene | size | all | " + " | ".join(STAGES) + " |", "|---|---|" + "---:|" * (len(STAGES) + 1)]
    for objects, scene in SCENES.items():
        for size, name in SIZES.items():
            case = f"{objects}/{size}"
            split = stages(times, case)
            lines.append(f"| {scene} | {name} | **{times[f'whole/{case}']:.1f}** | "
                         + " | ".join(f"{split[stage]:.2f}" for stage in STAGES) + " |")
    verdict = "met" if study_ms <= LIMIT_MS else "missed"
    lines += ["", f"The parts study at 640 × 480: {study_ms:.0f} ms; target ≤ {LIMIT_MS} ms: {verdict}.", ""]
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
