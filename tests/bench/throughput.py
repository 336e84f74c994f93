#!/usr/bin/python3
"""How many frames an hour does all of it make, beside BlenderProc, and what of that does the scheduler cost?

Three measurements of configs/bench_small.yaml, 128 × 128 at 1 sample, with everything that is on by default (labels, the
comparison with the twin) and an export as COCO:

- many frames: `seedframe submit` and `seedframe export`, each from the command to its end;
- beside BlenderProc (blenderproc_loop.py), the same frames in turns, both in Blender 4.2: from the first frame's start
  to the annotations of the last, so that start-up counts on no side;
- with a Blender that takes 17 ms for a frame without using a processor: what of the time is not those frames.

    tests/bench/throughput.py [--frames 10000] [--blender BLENDER…] [--only PART…] [--report FILE]

Prints tables, also into the report; exits with 1 if a goal is missed.
"""

import argparse
import dataclasses
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from overhead import IDLE, Case, OtherLoad, Submit, spread, version_of

HOME = pathlib.Path(__file__).resolve().parents[2]
BLENDER_4_2 = f"python:{HOME}/venv/blender-4.2"
PEER = HOME / "venv" / "blenderproc" / "bin" / "python"
FAKE_BLENDER = HOME / "tests" / "fake_blender" / "fake_blender.py"
COLORS = "/usr/share/blender/datafiles/colormanagement/config.ocio"  # the fake has none of its own
PARTS = ("many", "peer", "scheduler")
LEAST_RATIO = 2.0       # frames an hour, against BlenderProc
FRAME_S = 0.017
MOST_SCHEDULING = 0.03  # of the wall time


@dataclasses.dataclass
class Many:
    blender: str
    submit_s: float
    export_s: float
    annotations: int
    others: float


@dataclasses.dataclass
class Scheduling:
    wall_s: float
    cpu_s: float  # of Seedframe's process
    others: float


class Peer:
    """Runs of blenderproc_loop.py in some processes at once, over the frames of a finished campaign."""

    def __init__(self, folder, specs, meshes, processes):
        threads = os.cpu_count() // processes
        self.name = f"BlenderProc, {processes} × {threads} threads"
        self._jobs = []
        for worker in range(processes):
            output = folder / f"peer-{processes}-{worker}"
            job = output.with_suffix(".json")
            job.write_text(json.dumps({"scripts": str(HOME / "blender_scripts"), "frames": specs[worker::processes],
                                       "meshes": meshes, "threads": threads, "output": str(output)}))
            self._jobs.append((job, output))

    def run(self):
        """Seconds from the first frame's start to the end of the annotations, and how many of these there are."""
        processes = []
        for job, output in self._jobs:
            shutil.rmtree(output, ignore_errors=True)
            with job.with_suffix(".log").open("w", encoding="utf-8") as log:
                processes.append(subprocess.Popen(
                    [PEER, pathlib.Path(__file__).with_name("blenderproc_loop.py"), job],
                    stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT))
        times, annotations = [], 0
        for process, (job, output) in zip(processes, self._jobs):
            process.wait()
            log = job.with_suffix(".log").read_text(encoding="utf-8", errors="replace")
            lines = [line for line in log.splitlines() if line.startswith("blenderproc-loop ")]
            if process.returncode != 0 or not lines:
                sys.exit(f"blenderproc_loop.py ended with {process.returncode}:\n{log[-2000:]}")
            times.append(json.loads(lines[0].removeprefix("blenderproc-loop ")))
            annotations += labelled(output / "coco_annotations.json")
        return max(t["end"] for t in times) - min(t["begin"] for t in times), annotations


def export(options, campaign):
    """Seconds, and how many annotations."""
    begin = time.monotonic()
    subprocess.run([options.program, "export", campaign, "--format", "coco"], check=True, stdout=subprocess.DEVNULL)
    seconds = time.monotonic() - begin
    return seconds, sum(labelled(file) for file in (campaign / "exports/coco/annotations").glob("*.json"))


def labelled(file):
    return len(json.loads(file.read_text(encoding="utf-8"))["annotations"])


def measure_many(options, blender):
    watch = OtherLoad()
    with tempfile.TemporaryDirectory(prefix="seedframe-bench-") as name:
        campaign = pathlib.Path(name) / "campaign"
        command = [options.program, "submit", HOME / "configs/bench_small.yaml", "-o", campaign, "--quiet",
                   "--set", f"scenes={options.frames}"]
        begin = time.monotonic()
        subprocess.run([*command, *(["--blender", blender] if blender else [])], check=True, stdout=subprocess.DEVNULL)
        submit_s = time.monotonic() - begin
        export_s, annotations = export(options, campaign)
        versions = {each["blender"] for each in json.loads((campaign / "provenance.json").read_text())["attempts"]}
    many = Many(", ".join(versions), submit_s, export_s, annotations, watch.cores())
    print(many, file=sys.stderr, flush=True)
    return many


def measure_peer(options):
    """Of each round: seconds and annotations of Seedframe and of each of the peers; and the peers' names."""
    subprocess.run([HOME / "scripts/blenderproc_wheels.sh"], check=True)
    case = Case("peer", "", "bench_small.yaml", (f"scenes={options.peer_frames}",), options.peer_frames)
    with tempfile.TemporaryDirectory(prefix="seedframe-bench-") as name:
        folder = pathlib.Path(name)
        submit = Submit(argparse.Namespace(program=options.program, blender=BLENDER_4_2), case, folder)
        submit.run(keep_meshes=True)  # the warm-up
        shutil.copytree(submit.campaign / "frames", folder / "frames")
        specs = [str(spec) for spec in sorted((folder / "frames").glob("*/*/frame.json"))]
        meshes = {mesh.stem: str(mesh) for mesh in submit.meshes.iterdir()}
        peers = [Peer(folder, specs, meshes, processes) for processes in (1, os.cpu_count())]
        rounds = []
        for _ in range(options.rounds):
            watch = OtherLoad()
            submit_s, _ = submit.run()
            export_s, annotations = export(options, submit.campaign)
            rounds.append(([(submit_s + export_s, annotations)] + [peer.run() for peer in peers], watch.cores()))
            print(rounds[-1], file=sys.stderr, flush=True)
    return ["Seedframe"] + [peer.name for peer in peers], rounds


def measure_scheduler(options):
    frames = options.scheduler_frames
    case = Case("scheduler", "", "bench_small.yaml",
                (f"scenes={frames}", "labels.check=false", f"image.ocio_config={COLORS}"), frames)
    os.environ["SEEDFRAME_FAKE"] = json.dumps({"frame_s": FRAME_S})
    with tempfile.TemporaryDirectory(prefix="seedframe-bench-") as name:
        submit = Submit(argparse.Namespace(program=options.program, blender=str(FAKE_BLENDER)), case, pathlib.Path(name))
        submit.command += ["--workers", str(os.cpu_count()), "--threads", "1"]
        runs = []
        for _ in range(options.rounds):
            watch = OtherLoad()
            runs.append(Scheduling(*submit.run(), watch.cores()))
            print(runs[-1], file=sys.stderr, flush=True)
    return runs


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=10_000, help="of the long run")
    parser.add_argument("--peer-frames", type=int, default=200, help="of each round beside BlenderProc")
    parser.add_argument("--scheduler-frames", type=int, default=2000, help="of each round with the fake Blender")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--blender", action="append", help="of the long runs (default: Blender 4.2, and the default)")
    parser.add_argument("--only", action="append", choices=PARTS, help="measure this part only")
    parser.add_argument("--program", type=pathlib.Path, default=HOME / "build" / "release" / "seedframe")
    parser.add_argument("--report", type=pathlib.Path, help="write the tables there too")
    options = parser.parse_args()
    os.environ["SEEDFRAME_CACHE"] = "off"
    parts = options.only or PARTS
    lines, met, others = [], [], []
    if "peer" in parts:
        names, rounds = measure_peer(options)
        others += [each for _, each in rounds]
        lines += tell_peer(options, names, [times for times, _ in rounds], met)
    if "scheduler" in parts:
        runs = measure_scheduler(options)
        others += [run.others for run in runs]
        lines += tell_scheduler(options, runs, met)
    if "many" in parts:
        subprocess.run([HOME / "scripts/blender_wheels.sh", "4.2"], check=True)
        many = [measure_many(options, blender) for blender in options.blender or (BLENDER_4_2, "")]
        others += [run.others for run in many]
        lines[:0] = tell_many(options, many)
    text = "\n".join([
        "# Frames an hour", "",
        "Made by `scripts/bench.sh throughput`; `tests/bench/throughput.py` says how. `configs/bench_small.yaml`: 128 × 128,",
        f"1 sample, 6 to 14 objects. {os.cpu_count()} cores; {version_of(options.program)}, which chooses workers and threads",
        "itself, with all that is on by default: labels, hashes, the comparison with the twin.", "", *lines])
    if max(others) > IDLE:
        text += f"\nThe machine was not idle: other programs kept up to {max(others):.1f} of its cores busy meanwhile.\n"
    print(text)
    if options.report:
        options.report.write_text(text, encoding="utf-8")
    return 0 if all(met) else 1


def tell_many(options, many):
    lines = [f"## {options.frames:,} frames", "",
             "From the command to its end: start-up, expansion and the store's closing are in it.", "",
             "| Blender | submit | export as COCO | annotations | ms a frame | frames an hour |",
             "|---|---:|---:|---:|---:|---:|"]
    for run in many:
        seconds = run.submit_s + run.export_s
        lines.append(f"| {run.blender} | {run.submit_s:.1f} s | {run.export_s:.2f} s | {run.annotations:,} | "
                     f"{1e3 * seconds / options.frames:.1f} | **{3600 * options.frames / seconds:,.0f}** |")
    return lines + [""]


def tell_peer(options, names, rounds, met):
    seconds = [[times[side][0] for times in rounds] for side in range(len(names))]
    fastest = min(range(1, len(names)), key=lambda side: statistics.median(seconds[side]))
    ratio = statistics.median(theirs / ours for ours, theirs in zip(seconds[0], seconds[fastest]))
    met.append(ratio >= LEAST_RATIO)
    lines = ["## Beside BlenderProc 2.8", "",
             f"{options.peer_frames} frames of the same specs in turns, both sides with Blender 4.2, warm: from the first",
             "frame's start to the COCO annotations of the last. BlenderProc's script is `tests/bench/blenderproc_loop.py`,",
             f"medians (smallest to largest) of {len(rounds)} rounds.", "",
             "| | ms a frame | frames an hour | annotations | Seedframe is faster by |", "|---|---|---:|---:|---:|"]
    for side, name in enumerate(names):
        factor = "" if side == 0 else f"{statistics.median(t / o for o, t in zip(seconds[0], seconds[side])):.2f} ×"
        lines.append(
            f"| {name} | {spread((1e3 * s / options.peer_frames for s in seconds[side]), 1)} | "
            f"{3600 * options.peer_frames / statistics.median(seconds[side]):,.0f} | {rounds[0][side][1]:,} | {factor} |")
    return lines + ["", f"Goal: ≥ {LEAST_RATIO:g} × the fastest of these: {told(met[-1])} ({ratio:.2f} ×).", ""]


def tell_scheduler(options, runs, met):
    ideal = options.scheduler_frames * FRAME_S / os.cpu_count()
    shares = [(run.wall_s - ideal) / run.wall_s for run in runs]
    met.append(statistics.median(shares) <= MOST_SCHEDULING)
    return ["## The scheduler's own time", "",
            f"{options.scheduler_frames:,} frames, {os.cpu_count()} workers that take {1e3 * FRAME_S:.0f} ms for each, asleep but for drawing",
            "a few rectangles (`tests/fake_blender`); from the first frame's start to the end of the program.", "",
            "| wall time | ideal | above it, of the wall time | goal | own CPU, ms a frame | rounds |",
            "|---|---:|---|---|---:|---:|",
            f"| {spread(run.wall_s for run in runs)} s | {ideal:.2f} s | {spread((100 * s for s in shares), 1)} % | "
            f"≤ {100 * MOST_SCHEDULING:.0f} %: {told(met[-1])} | "
            f"{1e3 * statistics.median(run.cpu_s for run in runs) / options.scheduler_frames:.1f} | {len(runs)} |", ""]


def told(met):
    return "met" if met else "missed"


if __name__ == "__main__":
    sys.exit(main())
