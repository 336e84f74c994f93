#!/usr/bin/python3
"""How does a campaign grow with the nodes of a cluster, and what does a task cost beside its frames?

Clusters of 1, 2, 4 and 8 nodes, all on this machine, so frames are made by a fake Blender that sleeps: it is not the
processors that are measured. Each node gets the same number of frames. When files of a submission appear tells what
a task waits for. Beside it, on paper, what these figures mean for 1,000 nodes.

    tests/slurm/scaling.py [--nodes N…] [--rounds 3] [--report results/scaling/slurm]
"""

import contextlib
import dataclasses
import json
import os
import pathlib
import resource
import statistics
import sys
import threading
import time

import cluster
import distributed
from distributed import CHECKED, Bench, report

FRAME_S = 0.25
BATCH_FRAMES = 24
TASKS_OF_A_NODE = 3
POLL_S = 0.005
MANY_NODES = 1000


@dataclasses.dataclass
class Task:
    """When what happened to a task, seconds of the clock; None: not seen."""
    node: str = ""
    ordered: float | None = None    # its submission was written, and sbatch called
    answered: float | None = None   # the job's id was known
    claimed: float | None = None    # it runs, and has its batch
    first: float | None = None      # its first frame was there
    ended: float | None = None
    fetched: float | None = None    # the head was through with it
    startup_s: float | None = None  # from its start to its first frame, by itself


class Watch(threading.Thread):
    """Looks at a campaign's submissions, as files of them come and go."""

    def __init__(self, campaign):
        super().__init__(daemon=True)
        self.campaign = campaign
        self.tasks = {}
        self.ending = threading.Event()
        self.seen = set()

    def run(self):
        while not self.ending.is_set():
            with contextlib.suppress(OSError):
                self._look()
            time.sleep(POLL_S)

    def end(self):
        self.ending.set()
        self.join()
        return list(self.tasks.values())

    def _look(self):
        for submission in (self.campaign / "slurm").iterdir():
            if not submission.name.isdigit():
                continue
            for entry in os.scandir(submission / "claims"):
                self._note(submission, entry)
            for batch in os.scandir(submission):
                if batch.is_dir() and batch.name.isdigit():
                    for entry in os.scandir(batch.path):
                        if entry.name.endswith(".json"):
                            self._note_result(self._task(submission, batch.name), entry)

    def _task(self, submission, batch):
        task = self.tasks.setdefault((submission.name, batch), Task())
        for name, field in (("submission.json", "ordered"), ("job", "answered")):
            if getattr(task, field) is None:
                with contextlib.suppress(OSError):
                    setattr(task, field, (submission / name).stat().st_mtime)
        return task

    def _note(self, submission, entry):
        if entry.path in self.seen:
            return
        batch, _, over = entry.name.partition(".")
        task = self._task(submission, batch)
        if over == "over":
            task.fetched = entry.stat().st_mtime
        elif not over:
            text = pathlib.Path(entry.path).read_text(encoding="utf-8")
            if not text:
                return  # not written yet
            task.claimed = entry.stat().st_mtime
            task.node = json.loads(text)["node"]
        self.seen.add(entry.path)

    def _note_result(self, task, entry):
        if entry.path in self.seen:
            return
        self.seen.add(entry.path)
        moment = entry.stat().st_mtime
        if entry.name == "end.json":
            task.ended = moment
        elif task.first is None or moment < task.first:
            task.first = moment
            record = json.loads(pathlib.Path(entry.path).read_text(encoding="utf-8"))
            task.startup_s = record.get("startup_s")


@dataclasses.dataclass
class Point:
    """One campaign on so many nodes."""
    nodes: int
    frames: int
    wall_s: float   # of the head, from its start to its end
    cpu_s: float    # of the head and of the programs of Slurm that it calls
    tasks: list

    def rate(self):
        return self.frames / self.wall_s

    def ideal(self):
        return self.nodes / FRAME_S


def measure(program, nodes, count):
    bench = Bench(program, CHECKED, count * TASKS_OF_A_NODE * BATCH_FRAMES // 3, nodes, batch_frames=BATCH_FRAMES)
    bench.clear()
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    watch = Watch(bench.campaign)
    watch.start()
    begin = time.monotonic()
    run = program.run(*bench.submit_to_cluster(), fake={"frame_s": FRAME_S}, timeout=600)
    wall_s = time.monotonic() - begin
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    tasks = watch.end()
    resumes, complaints = bench.finish(run)
    if resumes or complaints:
        sys.exit(f"a campaign on {count} nodes is not as it should be: {complaints}")
    cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    point = Point(count, bench.frames, wall_s, cpu_s, tasks)
    print(f"{count} nodes: {point.frames} frames, {wall_s:.2f} s, {cpu_s:.2f} s of the head's", file=sys.stderr, flush=True)
    return point


def steps(points):
    """What a task waits for, by name: lists of seconds."""
    found = {name: [] for name in STEPS}
    for point in points:
        for task in point.tasks:
            first_wave = task.answered and task.claimed and task.claimed - task.answered < BATCH_FRAMES * FRAME_S / 2
            note(found, "sbatch", task.ordered, task.answered)
            if first_wave:
                note(found, "start", task.answered, task.claimed)
            if task.startup_s is not None:
                found["startup"].append(task.startup_s)
            note(found, "fetch", task.ended, task.fetched)
        for node in {task.node for task in point.tasks}:
            own = sorted((task for task in point.tasks if task.node == node and task.claimed), key=lambda task: task.claimed)
            for before, after in zip(own, own[1:]):
                note(found, "gap", before.ended, after.claimed)
    return found


STEPS = {"sbatch": "sbatch: from the submission's file to the id of its job",
         "start": "Slurm: from then until a task of the first ones has its batch",
         "startup": "a task's start-up: from its start to its first frame (config, meshes, a fake Blender)",
         "gap": "a node between two tasks: from the end of one until the next has its batch",
         "fetch": "from a task's end until the head is through with it"}


def note(found, name, begin, end):
    if begin is not None and end is not None:
        found[name].append(max(0.0, end - begin))


def by_nodes(points):
    """By number of nodes, the points of all rounds."""
    counts = sorted({point.nodes for point in points})
    return [(count, [point for point in points if point.nodes == count]) for count in counts]


@dataclasses.dataclass
class Figures:
    """What a reader wants to calculate with."""
    nodes: list
    waits: dict             # of STEPS: median and longest, seconds
    head_frame_s: float     # processor time of the head for one more frame
    head_fixed_s: float

    @staticmethod
    def of(points):
        rows = []
        for count, own in by_nodes(points):
            rates = [point.rate() for point in own]
            rows.append({"nodes": count, "frames": own[0].frames, "wall_s": statistics.median(point.wall_s for point in own),
                         "frames_per_s": statistics.median(rates), "least": min(rates), "most": max(rates),
                         "ideal": own[0].ideal(), "head_cpu_s": statistics.median(point.cpu_s for point in own)})
        waits = {name: {"median": statistics.median(seconds), "longest": max(seconds), "number": len(seconds)}
                 for name, seconds in steps(points).items() if seconds}
        first, last = rows[0], rows[-1]
        frame_s = (last["head_cpu_s"] - first["head_cpu_s"]) / max(1, last["frames"] - first["frames"])
        return Figures(rows, waits, frame_s, first["head_cpu_s"] - frame_s * first["frames"])


def on_paper(figures):
    """Rows for MANY_NODES nodes: a frame's seconds, a task's frames, …"""
    lost_s = figures.waits["gap"]["median"] + figures.waits["startup"]["median"]
    for frame_s in (0.5, 2.0, 10.0, 60.0):
        frames = max(1, round(lost_s * 49 / frame_s))  # start-up and gap are 2 % of a task's time
        task_s = frames * frame_s + lost_s
        rate = MANY_NODES * frames / task_s
        yield {"frame_s": frame_s, "frames_of_a_task": frames, "task_s": task_s, "frames_per_s": rate,
               "tasks_per_s": MANY_NODES / task_s, "share": rate * frame_s / MANY_NODES,
               "head_cores": rate * figures.head_frame_s}


def text_of(figures, options):
    lines = ["# A campaign on many nodes", "",
             f"Made by `scripts/bench.sh slurm`; `tests/slurm/scaling.py` says how. All nodes are on one machine of {os.cpu_count()} "
             f"cores, and frames are made by a fake Blender", f"that sleeps: {FRAME_S:g} s a frame, one after the other on each node, "
             f"{BATCH_FRAMES} a task, {TASKS_OF_A_NODE} tasks for each node. From the head's start to its end, medians of "
             f"{options.rounds}.", "", "![frames a second against nodes](scaling.svg)", "",
             "| nodes | frames | seconds | frames/s | least and most | without any cost | share of it | the head's processor time, s |",
             "|---:|---:|---:|---:|---:|---:|---:|---:|"]
    for row in figures.nodes:
        lines.append(f"| {row['nodes']} | {row['frames']:,} | {row['wall_s']:.1f} | **{row['frames_per_s']:.2f}** | {row['least']:.2f}, "
                     f"{row['most']:.2f} | {row['ideal']:.0f} | {100 * row['frames_per_s'] / row['ideal']:.0f} % | "
                     f"{row['head_cpu_s']:.2f} |")
    lines += ["", "What a task costs beside its frames, seconds:", "", "| | number | median | longest |", "|---|---:|---:|---:|"]
    lines += [f"| {STEPS[name]} | {wait['number']} | {wait['median']:.2f} | {wait['longest']:.2f} |"
              for name, wait in figures.waits.items()]
    lines += ["", f"The head took {figures.head_fixed_s:.2f} s of a processor for a campaign and {1e3 * figures.head_frame_s:.2f} ms for "
              "each frame, calls of Slurm's programs among", "it.", "", f"## {MANY_NODES:,} nodes, on paper", "",
              "With these figures: a node loses its start-up and its gap with each task, so tasks are made long enough that both are 2 % "
              "of them; the head spends its", "time by the frame. Nobody has measured this: a real controller is busier, and a real file "
              "system farther away.", "",
              "| seconds a frame, on a node | frames a task | seconds a task | frames/s | of the ideal | tasks/s that Slurm starts | "
              "the head's cores |", "|---:|---:|---:|---:|---:|---:|---:|"]
    for row in on_paper(figures):
        lines.append(f"| {row['frame_s']:g} | {row['frames_of_a_task']} | {row['task_s']:.0f} | {row['frames_per_s']:.0f} | "
                     f"{100 * row['share']:.0f} % | {row['tasks_per_s']:.1f} | {row['head_cores']:.2f} |")
    lines += ["", f"With one core the head fetches {1 / figures.head_frame_s:,.0f} frames/s: it keeps up with {MANY_NODES:,} nodes as long as "
              f"each of them takes more than {MANY_NODES * figures.head_frame_s:.2f} s for a frame.", ""]
    return "\n".join(lines)


WIDTH, HEIGHT = 560, 300


def chart(figures):
    """Frames a second against nodes, as SVG."""
    left, top, right, bottom = 60, 30, WIDTH - 20, HEIGHT - 45
    rows = figures.nodes
    most_nodes = rows[-1]["nodes"]
    high = rows[-1]["ideal"]
    x_of = lambda nodes: left + (right - left) * (nodes / most_nodes)
    y_of = lambda rate: bottom - (bottom - top) * rate / high
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">'
             f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>', f'<text x="{left}" y="18" font-size="14">Frames a second</text>',
             f'<text x="{right}" y="{HEIGHT - 8}" text-anchor="end" fill="#555">nodes</text>']
    for rate in range(0, int(high) + 1, max(1, int(high) // 4)):
        parts.append(f'<line x1="{left}" x2="{right}" y1="{y_of(rate):.1f}" y2="{y_of(rate):.1f}" stroke="#ddd"/>'
                     f'<text x="{left - 6}" y="{y_of(rate) + 4:.1f}" text-anchor="end" fill="#555">{rate}</text>')
    for row in rows:
        parts.append(f'<text x="{x_of(row["nodes"]):.1f}" y="{bottom + 18}" text-anchor="middle" fill="#555">{row["nodes"]}</text>')
    for key, colour, dash in (("ideal", "#999999", "4 4"), ("frames_per_s", "#c2410c", "none")):
        line = " ".join(f'{x_of(row["nodes"]):.1f},{y_of(row[key]):.1f}' for row in rows)
        parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2" stroke-dasharray="{dash}"/>')
    parts += [f'<circle cx="{x_of(row["nodes"]):.1f}" cy="{y_of(row["frames_per_s"]):.1f}" r="3" fill="#c2410c"/>' for row in rows]
    parts += [f'<text x="{left + 12}" y="{top + 14}" fill="#999999">without any cost</text>',
              f'<text x="{left + 12}" y="{top + 30}" fill="#c2410c">measured</text>']
    return "\n".join([*parts, "</svg>\n"])


def main():
    parser = report.parser_of(__doc__)  # --report is a folder here
    parser.add_argument("--nodes", type=int, action="append", help="this many only; may be repeated")
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    missing = cluster.missing_programs()
    if missing:
        sys.exit(f"there is no {', '.join(missing)} here; scripts/slurm-dev.sh install brings them")
    points = []
    with distributed.program_of(options) as program:
        for count in sorted(options.nodes or (1, 2, 4, 8)):
            with cluster.Cluster(nodes=count, cpus=1) as nodes:
                points += [measure(program, nodes, count) for _ in range(options.rounds)]
    figures = Figures.of(points)
    text = text_of(figures, options)
    print(text)
    if options.report:
        options.report.mkdir(parents=True, exist_ok=True)
        (options.report / "README.md").write_text(text, encoding="utf-8")
        (options.report / "scaling.svg").write_text(chart(figures), encoding="utf-8")
        (options.report / "figures.json").write_text(json.dumps(dataclasses.asdict(figures), indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
