#!/usr/bin/python3
"""A campaign of many small frames with the real Blender, watched from outside: does anything grow, and what
does the scheduler cost?

    tests/reliability/soak.py [--frames N] [--report FILE]

Memory is resident, CPU time that of threads, both from /proc, every second. Exits with 1 if the scheduler's
memory grows by more than a tenth from the first fifth of the run to the last, if a worker's passes its limit,
or if the campaign is not complete.
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import time

import report

HOME = pathlib.Path(__file__).resolve().parents[2]
CONFIG = """seedframe: 1
name: soak
scenes: {frames}
categories: [gear, hex_nut]
render: {{width: 64, height: 48, samples: 1}}
objects:
  gears: {{asset: gear, count: {{integer: [1, 3]}}, position: [{{uniform: [-0.1, 0.1]}}, {{uniform: [-0.1, 0.1]}}, {{uniform: [0, 0.03]}}]}}
  nut: {{asset: hex_nut, position: [{{uniform: [-0.1, 0.1]}}, 0, 0.05]}}
camera: {{distance_m: {{uniform: [0.3, 0.5]}}}}
"""
MOST_GROWTH = 1.1
MOST_OWN_SHARE = 0.01
FRAMES_PER_WORKER = 1000
TICKS = os.sysconf("SC_CLK_TCK")


def main():
    parser = report.parser_of(__doc__)
    parser.add_argument("--frames", type=int, default=5000)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="seedframe-soak-") as folder:
        folder = pathlib.Path(folder)
        (folder / "soak.yaml").write_text(CONFIG.format(frames=options.frames), encoding="utf-8")
        soak = Campaign(options, folder, folder / "soak.yaml", ["--frames-per-worker", str(FRAMES_PER_WORKER)])
        demo = Campaign(options, folder, HOME / "configs" / "parts.yaml", [])
    fifth = max(1, len(soak.memory) // 5)
    first, last = (sum(part) / len(part) for part in (soak.memory[fifth:2 * fifth], soak.memory[-fifth:]))
    complete = soak.complete and demo.complete
    flat = last <= MOST_GROWTH * first
    frames = options.frames
    finish = soak.cpu.get("finish", 0.0)
    text = "\n".join([
        "# A long campaign", "",
        f"Made by `tests/reliability/soak.py`: {frames:,} frames of 64 × 48 at one sample with the real Blender, workers replaced after",
        f"{FRAMES_PER_WORKER:,} frames; then the demo (`configs/parts.yaml`). Watched from outside, every second.", "",
        "| | measured | target | |", "|---|---:|---:|---|",
        f"| both are complete | {'yes' if complete else 'no'} | yes | {told(complete)} |",
        f"| the scheduler's memory, from the second fifth of the run to the last ({mib(first)} to {mib(last)} MiB) | × {last / first:.3f} | "
        f"≤ {MOST_GROWTH} | {told(flat)} |",
        own_share("the demo", demo), own_share("the long campaign of tiny frames", soak),
        "", f"The long one took {soak.wall:.0f} s: {frames / soak.wall:.1f} frames/s, {1e3 * soak.own / frames:.2f} ms of the scheduler's own time for each. The largest "
        f"worker had {mib(max(soak.worker_memory, default=0))} MiB. Finishing frames (reading passes, the twin, PNGs, labels) took "
        f"{100 * finish / soak.wall:.1f} % of the wall time, {1e3 * finish / frames:.2f} ms a frame.", ""])
    print(text)
    if options.report:
        options.report.parent.mkdir(parents=True, exist_ok=True)
        options.report.write_text(text, encoding="utf-8")
    return not (complete and flat)


def own_share(what, campaign):
    share = campaign.own / campaign.wall
    return (f"| the scheduler's own CPU time (event loop with expansion, and store) over the wall time of {what} | {100 * share:.2f} % | "
            f"≤ {100 * MOST_OWN_SHARE:g} % | {told(share <= MOST_OWN_SHARE)} |")


class Campaign:
    """One that is submitted, watched and gone."""

    def __init__(self, options, folder, config, more):
        begin = time.monotonic()
        process = subprocess.Popen([str(options.build.resolve() / "seedframe"), "submit", str(config), "-o", config.stem] + more,
                                   cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                   env={**os.environ, "SEEDFRAME_HOME": str(HOME), "SEEDFRAME_CACHE": "off"}, text=True)
        self.memory, self.worker_memory, self.cpu = watch(process)
        output = process.communicate()[0]
        self.wall = time.monotonic() - begin
        self.own = self.cpu.get("seedframe", 0.0) + self.cpu.get("store", 0.0)
        self.complete = process.returncode == 0 and "dataset hash" in output


def watch(process):
    """Resident bytes of the scheduler, one a second; the largest of the workers, likewise; seconds of CPU by
    name of thread."""
    memory, worker_memory, cpu = [], [], {}
    while process.poll() is None:
        try:
            memory.append(resident(process.pid))
            cpu = thread_seconds(process.pid) or cpu
            worker_memory.append(max(map(resident, children(process.pid)), default=0))
        except OSError:
            pass
        time.sleep(1)
    return memory, worker_memory, cpu


def resident(pid):
    try:
        pages = int(pathlib.Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[1])
    except OSError:
        return 0
    return pages * os.sysconf("SC_PAGE_SIZE")


def children(pid):
    listing = pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii")
    return [int(child) for child in listing.split()]


def thread_seconds(pid):
    seconds = {}
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        name, fields = (task / "stat").read_text(encoding="ascii").split("(", 1)[1].rsplit(")", 1)
        times = fields.split()[11:13]
        seconds[name] = seconds.get(name, 0.0) + sum(map(int, times)) / TICKS
    return seconds


def mib(count):
    return f"{count / 2**20:.0f}"


def told(verdict):
    return "met" if verdict else "missed"


if __name__ == "__main__":
    sys.exit(main())
