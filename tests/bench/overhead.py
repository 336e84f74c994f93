#!/usr/bin/python3
"""What does `seedframe submit` cost above Blender? It against a bare loop over the same frames in Blender.

Both render configs/bench_small.yaml with the same number of Blender processes of one thread. Time runs from the
start of the first frame to the end of the last, so Blender's start-up counts on neither side; for `submit` the
end is when the program has ended: each frame is checked, labelled, hashed, on disk and in the store. Runs
alternate (submit, bare, submit, bare, …), since machines drift: judge the ratio of neighbours, not the times.

    tests/bench/overhead.py [--pairs 15] [--frames 100] [--workers CORES] [--report FILE]

Prints a table, also into the report; exits with 1 if the median ratio is above 1.15.
"""

import argparse
import contextlib
import dataclasses
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
CONFIG = HOME / "configs" / "bench_small.yaml"
LIMIT = 1.15
IDLE = 0.2  # cores
TICK_S = 1 / os.sysconf("SC_CLK_TCK")


@dataclasses.dataclass
class Pair:
    submit_s: float
    cpu_s: float  # of seedframe itself, in these seconds
    bare_s: float
    bare_cpu_s: float
    others: float  # cores that were busy with something else meanwhile

    @property
    def ratio(self):
        return self.submit_s / self.bare_s

    @property
    def cpu_share(self):
        return self.cpu_s / self.bare_cpu_s


class Submit:
    """Runs of `seedframe submit`."""

    def __init__(self, options, folder):
        self.command = [str(options.program), "submit", str(CONFIG), "--quiet", "--blender", options.blender,
                        "--frames", str(options.frames), "--workers", str(options.workers), "--threads", "1"]
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
    """Runs of bare_loop.py in several processes at once, over the frames of a finished campaign."""

    def __init__(self, options, folder, submit):
        specs = sorted(submit.campaign.glob("frames/*/*/frame.json"))
        meshes = {mesh.stem: str(mesh) for mesh in submit.meshes.iterdir()}
        self.jobs = []
        for worker in range(options.workers):
            # The outputs of a process are as many files as a campaign has: nothing is overwritten.
            outputs = folder / f"bare-{worker}"
            frames = []
            for spec in specs[worker::options.workers]:
                kept = folder / "specs" / f"{spec.parent.name}.json"
                kept.parent.mkdir(exist_ok=True)
                shutil.copy(spec, kept)
                frames.append([str(kept), str(outputs / f"{spec.parent.name}.exr")])
            job = folder / f"job-{worker}.json"
            job.write_text(json.dumps({"scripts": str(HOME / "blender_scripts"), "frames": frames,
                                       "meshes": meshes}), encoding="utf-8")
            self.jobs.append((outputs, [
                options.blender, "--background", "--factory-startup", "--disable-autoexec", "-noaudio", "--threads",
                "1", "--python-exit-code", "3", "--python", str(pathlib.Path(__file__).with_name("bare_loop.py")),
                "--", str(job)]))

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


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=15)
    parser.add_argument("--frames", type=int, default=100)
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    parser.add_argument("--blender", default="/usr/bin/blender")
    parser.add_argument("--program", type=pathlib.Path, default=HOME / "build" / "release" / "seedframe")
    parser.add_argument("--report", type=pathlib.Path, help="write the table there too")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="seedframe-bench-") as name:
        folder = pathlib.Path(name)
        submit = Submit(options, folder)
        submit.run(keep_meshes=True)  # the warm-up
        bare = BareLoop(options, folder, submit)
        bare.run()
        pairs = []
        for _ in range(options.pairs):
            watch = OtherLoad()
            pairs.append(Pair(*submit.run(), *bare.run(), watch.cores()))
            print(pairs[-1], file=sys.stderr, flush=True)
    ratios = [pair.ratio for pair in pairs]
    text = report(options, pairs, ratios)
    print(text)
    if options.report:
        options.report.write_text(text, encoding="utf-8")
    return statistics.median(ratios) > LIMIT


def report(options, pairs, ratios):
    share = statistics.median(pair.cpu_share for pair in pairs)
    median = statistics.median(ratios)
    lines = [
        "# What `submit` costs above Blender", "",
        "Made by `scripts/bench.sh`; `tests/bench/overhead.py` says how, and `tests/bench/bare_loop.py` is the",
        "other side. The bare loop builds its scenes with the workers' own code, so the ratio is about all the",
        "rest: expansion, protocol, checking, colour, PNGs, labels, hashes, files and the store.", "",
        f"{options.frames} frames of `configs/bench_small.yaml` (128 × 128, 1 sample) on {os.cpu_count()} cores by "
        f"{options.workers} Blender",
        f"processes of one thread; {version_of(options.blender)}; "
        f"{version_of(options.program)}. Other load: how many",
        "cores were busy with anything else meanwhile; it falls on either side of a pair by chance.", "",
        "| pair | submit, s | bare loop, s | ratio | CPU of seedframe, ms a frame | CPU of Blender in the bare loop | "
        "other load, cores |",
        "|---:|---:|---:|---:|---:|---:|---:|"]
    for number, pair in enumerate(pairs, 1):
        lines.append(f"| {number} | {pair.submit_s:.2f} | {pair.bare_s:.2f} | {pair.ratio:.3f} | "
                     f"{1000 * pair.cpu_s / options.frames:.1f} | "
                     f"{1000 * pair.bare_cpu_s / options.frames:.1f} | {pair.others:.2f} |")
    lines += ["", f"Ratio: smallest {min(ratios):.3f}, **median {median:.3f}**, largest {max(ratios):.3f}; target "
              f"≤ {LIMIT}: {'met' if median <= LIMIT else 'missed'}.",
              f"CPU time of seedframe itself is {100 * share:.1f} % of that of Blender in the bare loop (median): where",
              "Blender keeps all cores busy, that is what the ratio is made of; the rest is waiting and chance.", ""]
    others = statistics.median(pair.others for pair in pairs)
    if others > IDLE:
        lines += [f"The machine was not idle: other programs kept {others:.1f} of its cores busy. Measure again when it "
                  "is.", ""]
    return "\n".join(lines)


def version_of(program):
    return subprocess.run([str(program), "--version"], capture_output=True, text=True,
                          check=True).stdout.splitlines()[0].strip()


if __name__ == "__main__":
    sys.exit(main())
