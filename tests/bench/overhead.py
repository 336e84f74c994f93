#!/usr/bin/python3
"""What does a frame cost, all told, beside the loop that a user would write who knows Blender well?

`seedframe submit` as it comes against bare_loop.py over the same frames, in one warm Blender with all cores
("one process") and in as many Blenders of one thread as there are cores ("many"). Time runs from the start of the
first frame to the end of the last, so Blender's start-up counts on no side; for `submit` the end is when the
program has ended: each frame is checked, labelled, hashed, on disk and in the store. Runs alternate, since
machines drift: judge the ratio of neighbours, not the times.

    tests/bench/overhead.py [--case NAME…] [--pairs N] [--blender BLENDER] [--report FILE]

Prints tables, also into the report; exits with 1 if a median ratio is above its goal.
"""

import argparse
import contextlib
import dataclasses
import hashlib
import json
import os
import pathlib
import resource
import shutil
import sqlite3
import statistics
import subprocess
import sys
import tempfile
import time

HOME = pathlib.Path(__file__).resolve().parents[2]
IDLE = 0.2  # cores
TICK_S = 1 / os.sysconf("SC_CLK_TCK")


@dataclasses.dataclass
class Case:
    name: str
    what: str
    config: str  # of configs/, or the text of one
    settings: tuple = ()
    frames: int = 100
    rounds: int = 5
    goal: float | None = None  # of submit / one process


ONLY_ONE = tuple(f"objects.{name}.count=0" for name in ("brackets", "gears", "bolts", "nuts", "washers"))
THOUSAND = """
seedframe: 1
name: thousand
scenes: 4
categories: [hex_nut]
render: {width: 640, height: 480, samples: 1}
objects:
  nuts:
    asset: hex_nut
    grid: {counts: [40, 25, 1], spacing_m: [0.03, 0.03, 0.03]}
    rest_on_ground: true
    material: {choice: [zinc, black_oxide, brass]}
ground: {width_m: 4, depth_m: 4, material: plastic}
lights: {key: {type: area, position: [0, -0.5, 1.2], power: {uniform: [9, 16]}, width_m: 0.4, height_m: 0.4}}
camera: {fov_deg: 50, distance_m: 1.2, elevation_deg: 60, azimuth_deg: {uniform: [0, 360]}}
"""
CASES = (
    Case("small", "128 × 128, 1 sample, 6 to 14 objects", "bench_small.yaml", rounds=15, goal=0.90),
    Case("hdri", "the same under an environment map of 2,048 × 1,024", "bench_small.yaml",
         ("world.hdri=large", "material_folders=[library]"), frames=12, goal=0.25),
    Case("one", "128 × 128, 1 sample, one object", "bench_small.yaml", ONLY_ONE),
    Case("demo", "`configs/parts.yaml` as shipped: 320 × 240, 32 samples, 26 objects", "parts.yaml", frames=6,
         goal=0.85),
    Case("study", "`configs/parts_study.yaml`: 640 × 480, 16 samples, 200 objects, textures, environment map",
         "parts_study.yaml", ("render.samples=16",), frames=4, rounds=3, goal=0.75),
    Case("thousand", "640 × 480, 1 sample, 1,000 objects of one mesh", THOUSAND, frames=4, rounds=3),
)


@dataclasses.dataclass
class Round:
    submit_s: float
    cpu_s: float  # of seedframe itself, in these seconds
    one_s: float
    one_cpu_s: float
    many_s: float
    many_cpu_s: float
    others: float  # cores that were busy with something else meanwhile


class Submit:
    """Runs of `seedframe submit`."""

    def __init__(self, options, case, folder):
        config = HOME / "configs" / case.config
        if case.config.startswith("\n") or case.name == "hdri":
            config = folder / "config.yaml"
            text = case.config if case.config.startswith("\n") else (HOME / "configs" / case.config).read_text()
            config.write_text(text, encoding="utf-8")
        if case.name == "hdri":
            write_environment_map(folder / "library" / "hdri" / "large.hdr", 2048, 1024)
        self.command = [str(options.program), "submit", str(config), "--quiet", "--blender", options.blender,
                        "--frames", str(case.frames)]
        for setting in case.settings:
            self.command += ["--set", setting]
        self.campaign = folder / "campaign"
        self.meshes = folder / "meshes"
        self.meshes.mkdir()

    def run(self, keep_meshes=False):
        """Seconds from the first frame's start to the end of the program; its own CPU seconds till then."""
        shutil.rmtree(self.campaign, ignore_errors=True)
        process = subprocess.Popen([*self.command, "-o", str(self.campaign)], stdout=subprocess.DEVNULL)
        # What it used before the first frame (the config, the parts) is start-up too.
        before_frames, cpu_s = None, 0.0
        while process.poll() is None:
            cpu_s = cpu_seconds(process.pid) or cpu_s
            if before_frames is None and any(self.campaign.glob("work/attempts/*")):
                before_frames = cpu_s
            if keep_meshes:
                self._keep_meshes()
            time.sleep(0.002 if keep_meshes else 0.02)
        end = time.time()
        if process.returncode != 0:
            sys.exit(f"submit ended with {process.returncode}")
        with contextlib.closing(sqlite3.connect(self.campaign / "campaign.sqlite")) as store:
            begin = store.execute("SELECT min(started) FROM attempts").fetchone()[0]
        return end - begin, cpu_s - (before_frames or 0.0)

    def _keep_meshes(self):
        """The mesh buffers go with the campaign's scratch space at its end; links to them stay."""
        for mesh in self.campaign.glob("work/meshes/*.mesh"):
            link = self.meshes / mesh.name
            if not link.exists():
                os.link(mesh, link)


class BareLoop:
    """Runs of bare_loop.py in some processes at once, over the frames of a finished campaign."""

    def __init__(self, options, folder, submit, processes):
        specs = sorted(submit.campaign.glob("frames/*/*/frame.json"))
        meshes = {mesh.stem: str(mesh) for mesh in submit.meshes.iterdir()}
        textures = {hashlib.sha256(image.read_bytes()).hexdigest(): str(image)
                    for home in (HOME / "materials", folder / "library") for image in home.rglob("*.*")}
        self.jobs = []
        for worker in range(processes):
            # The outputs of a process are as many files as a campaign has: nothing is overwritten.
            outputs = folder / f"bare-{processes}-{worker}"
            frames = []
            for spec in specs[worker::processes]:
                kept = folder / "specs" / f"{spec.parent.name}.json"
                kept.parent.mkdir(exist_ok=True)
                shutil.copy(spec, kept)
                frames.append([str(kept), str(outputs / f"{spec.parent.name}.exr")])
            job = folder / f"job-{processes}-{worker}.json"
            job.write_text(json.dumps({"scripts": str(HOME / "blender_scripts"), "frames": frames,
                                       "meshes": meshes, "textures": textures}), encoding="utf-8")
            self.jobs.append((outputs, [
                options.blender, "--background", "--factory-startup", "--disable-autoexec", "-noaudio", "--threads",
                str(os.cpu_count() // processes), "--python-exit-code", "3", "--python",
                str(pathlib.Path(__file__).with_name("bare_loop.py")), "--", str(job)]))

    def run(self):
        """Seconds from the first frame's start to the last one's end; CPU seconds of Blender in them."""
        for outputs, _ in self.jobs:
            shutil.rmtree(outputs, ignore_errors=True)
            outputs.mkdir()
        environment = {**os.environ, "PATH": "/usr/bin:/bin"}  # as the scheduler does
        # Into files: Blender prints a lot, and a process whose pipe nobody reads stands still.
        logs = [outputs / "log.txt" for outputs, _ in self.jobs]
        processes = []
        for log, (_, command) in zip(logs, self.jobs):
            with log.open("w", encoding="utf-8") as stdout:
                processes.append(subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL, stdout=stdout))
        for process in processes:
            process.wait()
        outputs = [log.read_text(encoding="utf-8") for log in logs]
        times = []
        for process, output in zip(processes, outputs):
            lines = [line for line in output.splitlines() if line.startswith("bare-loop ")]
            if process.returncode != 0 or not lines:
                sys.exit(f"the bare loop ended with {process.returncode}:\n{output[-2000:]}")
            times.append(json.loads(lines[0].removeprefix("bare-loop ")))
        elapsed = max(t["end"] for t in times) - min(t["begin"] for t in times)
        return elapsed, sum(t["cpu_s"] for t in times)


class OtherLoad:
    """How many cores were busy on average, apart from our own processes, since this was made."""

    def __init__(self):
        self._begin = self._now()

    def cores(self):
        elapsed, busy = (now - then for now, then in zip(self._now(), self._begin))
        return max(0.0, busy / elapsed)

    @staticmethod
    def _now():
        ticks = [int(n) for n in pathlib.Path("/proc/stat").read_text(encoding="ascii").split("\n")[0].split()[1:9]]
        idle = ticks[3] + ticks[4]
        ours = sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
        return time.monotonic(), (sum(ticks) - idle) * TICK_S - ours


def cpu_seconds(pid):
    """User and system time of a process, without its children; None when it is gone."""
    try:
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    except OSError:
        return None
    return (int(fields[11]) + int(fields[12])) * TICK_S


def write_environment_map(path, width, height):
    """A sky with a small sun, as Radiance writes it, uncompressed."""
    path.parent.mkdir(parents=True)
    pixels = bytearray()
    for row in range(height):
        sky = bytes((80 + 60 * row // height, 90 + 50 * row // height, 120, 128))
        pixels += sky * width
    sun = 4 * (width * (height // 4) + width // 3)
    pixels[sun:sun + 16] = bytes((250, 240, 200, 140)) * 4
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
    path.write_bytes(header.encode("ascii") + bytes(pixels))


def measure(options, case):
    with tempfile.TemporaryDirectory(prefix="seedframe-bench-") as name:
        folder = pathlib.Path(name)
        submit = Submit(options, case, folder)
        submit.run(keep_meshes=True)  # the warm-up
        one, many = (BareLoop(options, folder, submit, processes) for processes in (1, os.cpu_count()))
        one.run()
        rounds = []
        for _ in range(options.pairs or case.rounds):
            watch = OtherLoad()
            rounds.append(Round(*submit.run(), *one.run(), *many.run(), watch.cores()))
            print(case.name, rounds[-1], file=sys.stderr, flush=True)
        return rounds


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", action="append", choices=[case.name for case in CASES])
    parser.add_argument("--pairs", type=int, help="rounds of each case (default: 3 to 15)")
    parser.add_argument("--blender", default="/usr/bin/blender")
    parser.add_argument("--program", type=pathlib.Path, default=HOME / "build" / "release" / "seedframe")
    parser.add_argument("--report", type=pathlib.Path, help="write the tables there too")
    options = parser.parse_args()
    measured = []
    for case in CASES:
        if options.case and case.name not in options.case:
            continue
        measured.append((case, measure(options, case)))
        text = report(options, measured)
        if options.report:  # after each case: the later ones take long
            options.report.write_text(text, encoding="utf-8")
    print(text)
    return any(case.goal and statistics.median(r.submit_s / r.one_s for r in rounds) > case.goal
               for case, rounds in measured)


def spread(values, digits=2):
    values = list(values)
    return (f"**{statistics.median(values):.{digits}f}** ({min(values):.{digits}f} to {max(values):.{digits}f})")


def report(options, measured):
    lines = [
        "# What a frame costs, beside a loop of one's own", "",
        "Made by `scripts/bench.sh overhead`; `tests/bench/overhead.py` says how, and `tests/bench/bare_scene.py` is the",
        "other side: what somebody writes who knows Blender well, without any of Seedframe's levers. `submit` does",
        "the rest too: expansion, protocol, checking against the twin, colour, PNGs, labels, hashes, files, store.", "",
        f"{os.cpu_count()} cores; {version_of(options.blender)}; {version_of(options.program)}, which chooses workers and",
        "threads itself. Medians (smallest to largest) of rounds in turns. Own CPU: of Seedframe's process.", "",
        "| case | submit / one process | goal | submit / many processes | submit, ms a frame | own CPU, ms a frame | "
        "own CPU / Blender's in the loop | rounds |",
        "|---|---|---:|---|---:|---:|---:|---:|"]
    for case, rounds in measured:
        def milliseconds(values):
            return f"{1000 * statistics.median(values) / case.frames:.1f}"
        ratio = statistics.median(r.submit_s / r.one_s for r in rounds)
        goal = "" if case.goal is None else f"≤ {case.goal:.2f}: {'met' if ratio <= case.goal else 'missed'}"
        lines.append(
            f"| {case.name} | {spread(r.submit_s / r.one_s for r in rounds)} | {goal} | "
            f"{spread(r.submit_s / r.many_s for r in rounds)} | {milliseconds(r.submit_s for r in rounds)} | "
            f"{milliseconds(r.cpu_s for r in rounds)} | "
            f"{100 * statistics.median(r.cpu_s / r.many_cpu_s for r in rounds):.1f} % | {len(rounds)} |")
    lines += ["", "| case | what |", "|---|---|"]
    lines += [f"| {case.name} | {case.what}; {case.frames} frames |" for case, _ in measured]
    others = statistics.median(r.others for _, rounds in measured for r in rounds)
    if others > IDLE:
        lines += ["", f"The machine was not idle: other programs kept {others:.1f} of its cores busy. Measure again "
                  "when it is."]
    return "\n".join(lines) + "\n"


def version_of(program):
    """Of a program, or of a Blender that is a module of a Python ("python:VENV")."""
    command = [str(program), "--version"]
    if str(program).startswith("python:"):
        python = pathlib.Path(str(program).removeprefix("python:")) / "bin" / "python"
        command = [str(python), "-I", "-B", "-c", "import bpy; print('Blender', bpy.app.version_string)"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()[0].strip()


if __name__ == "__main__":
    sys.exit(main())
