#!/usr/bin/python3
"""Workers that are killed, hang, talk nonsense or lie, and whose frames are checked against their twins.

Each fault meets a share of the frames of a campaign, at their first attempt. The campaign must end well by
itself, be the undisturbed one, and say of each faulty attempt that it failed. The delay is from the moment
when the fault can be seen (a worker that hangs: when its time is up) to the start of the next attempt, by the
job store.

    tests/reliability/worker_faults.py [--faults N] [--seed S] [--report FILE]
"""

import contextlib
import importlib.util
import math
import os
import pathlib
import random
import signal
import statistics
import sys
import time

import campaigns
import judge
import report

SCENES = 20
POISONED_SCENES = 334  # of three frames
POISONED_SCENES_QUICK = 19  # another number than SCENES: benches have folders by it
TIMEOUT_S = 2.0
LOG_BYTES = 1_000_000  # a frame
LARGEST_LOG = 10_000_000
# Fault of the fake to what it is, and the seconds after which it can be seen.
FAULTS = {
    "crash": ("segmentation fault", 0.0),
    "hang": ("hangs", TIMEOUT_S),
    "ignore_term": ("hangs and ignores SIGTERM", TIMEOUT_S),
    "garbage": ("garbage on the channel", 0.0),
    "no_file": ("says 'done' without a file", 0.0),
    "half_exr": ("says 'done' after half a file", 0.0),
    "other_frame": ("the picture of another frame", 0.0),
    "nan": ("NaN in a pixel", 0.0),
}
TICK_S = 1 / os.sysconf("SC_CLK_TCK")


def main():
    parser = report.parser_of(__doc__)
    parser.add_argument("--faults", type=int, default=200, help="in all, at least")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    begin = time.monotonic()
    rng = random.Random(options.seed)
    rows, delays = [], {}
    with campaigns.program_of(options) as program:
        bench = campaigns.Bench(program, campaigns.CHECKED, SCENES, workers=2)
        known = faults_of_the_fake()
        share = math.ceil(options.faults / (len(known) + 2))
        for fault in FAULTS:
            row = report.Row(FAULTS[fault][0])
            rows.append(row)
            if fault in known:
                delays[row.what] = meet(bench, row, fault, share, rng)
            else:
                row.notes["skipped: this fake Blender does not know it"] = 1
        rows.append(report.Row("SIGKILL from outside"))
        delays[rows[-1].what] = kill_workers(bench, rows[-1], share, rng)
        rows.append(report.Row("a log of 1 MB a frame"))
        flood(bench, rows[-1])
        rows.append(poison(program, POISONED_SCENES if options.faults >= 200 else POISONED_SCENES_QUICK))
    command = f"tests/reliability/worker_faults.py --seed {options.seed}"
    text = [f"Made by `{command}`, which says how: *number* is how many attempts met the fault.",
            f"Campaigns of {bench.frames} frames by 2 fake Blenders.", "", *delay_table(delays)]
    return report.finish(options, "Workers that misbehave", text, rows, begin)


def faults_of_the_fake():
    spec = importlib.util.spec_from_file_location("fake_blender", campaigns.FAKE_BLENDER)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return [fault for fault in FAULTS if fault in module.FAULTS]


def run(bench, fake, during=lambda process: None):
    """A campaign with these wishes to the fake: (Store, Run)."""
    bench.clear()
    process = bench.program.start(*bench.submit(), "--frame-timeout", TIMEOUT_S, fake=fake)
    during(process)
    ended = bench.program.end(process)
    return judge.Store.read(bench.campaign, bench.program.folder), ended


def meet(bench, row, fault, count, rng):
    """`count` frames meet the fault; the delays to their next attempts."""
    delays = []
    while row.number < count:
        frames = sorted(rng.sample(range(bench.frames), min(count - row.number, bench.frames // 2)))
        store, ended = run(bench, {f"{fault}_frames": frames})
        complaints = ended.conduct(0) + bench.judge() + judge.survivors(bench.program.folder)
        failed = {attempt["frame"] for attempt in store.attempts if attempt["outcome"] != "done"}
        unseen = set(frames) - failed
        if unseen:
            text = f"the fault went unseen in frames {sorted(unseen)}"
            complaints.append(judge.Complaint("wrong done", text))
        row.blame(complaints, f"frames {frames}", f"SEEDFRAME_FAKE='{{\"{fault}_frames\": {frames}}}'")
        row.number += len(frames)
        delays += [start - FAULTS[fault][1] for start in waits(store).values()]
    return delays


def waits(store):
    """Frame to the seconds between the starts of its first two attempts."""
    starts = {(attempt["frame"], attempt["attempt"]): attempt["started"] for attempt in store.attempts}
    return {frame: starts[frame, 2] - starts[frame, 1] for frame, attempt in starts if attempt == 2}


def kill_workers(bench, row, count, rng):
    """SIGKILL of workers that are at work; the delays from a kill to the next attempt of the frame."""
    delays = []
    while row.number < count:
        kills = []

        def kill_some(process):
            while process.poll() is None and row.number + len(kills) < count:
                time.sleep(rng.uniform(0.1, 0.4))
                # One that has just started may be about to try again a frame that lost its worker already.
                grown = [pid for pid in judge.marked_processes(bench.program.folder)
                         if pid != process.pid and age_s(pid) > 0.6]
                if grown:
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(rng.choice(grown), signal.SIGKILL)
                        kills.append(time.time())

        store, ended = run(bench, {"delay_s": 0.1}, kill_some)
        row.blame(ended.conduct(0) + bench.judge(), f"{len(kills)} kills")
        row.number += len(kills)
        delays += delays_after(kills, store)
        if not kills:
            row.notes["campaigns that were too short"] += 1
    return delays


def delays_after(kills, store):
    starts = {(attempt["frame"], attempt["attempt"]): attempt["started"] for attempt in store.attempts}
    for (frame, attempt), start in starts.items():
        before = [kill for kill in kills if starts.get((frame, attempt - 1), math.inf) < kill < start]
        if before:
            yield start - before[-1]


def age_s(pid):
    try:
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    except OSError:
        return 0.0
    return time.clock_gettime(time.CLOCK_BOOTTIME) - int(fields[19]) * TICK_S


def flood(bench, row):
    """Logs stay small, and nothing else happens."""
    store, ended = run(bench, {"chatty_log_bytes": LOG_BYTES})
    complaints = ended.conduct(0) + bench.judge()
    sizes = {path.name: path.stat().st_size for path in bench.campaign.glob("logs/*")}
    row.number = len(store.attempts)
    row.notes["bytes of logs are left"] = sum(sizes.values())
    if sum(sizes.values()) > LARGEST_LOG * bench.workers:
        complaints.append(judge.Complaint("conduct", f"logs are too large: {sizes}"))
    row.blame(complaints, "a flood of log")


def poison(program, scenes):
    """One frame that kills every worker: it is quarantined, and all others are done."""
    bench = campaigns.Bench(program, campaigns.CHECKED, scenes, workers=2)
    poisoned = bench.frames // 2
    row = report.Row(f"1 poison frame in {bench.frames:,}", number=1)
    store, ended = run(bench, {"crash_frames": [poisoned], "crash_attempts": 99})
    complaints = ended.conduct(3)
    states = {frame: each["state"] for frame, each in store.frames.items()}
    crashes = [attempt for attempt in store.attempts if attempt["outcome"] == "crash"]
    row.notes["workers lost"] = len(crashes)
    row.notes["frames done"] = sum(state == "done" for state in states.values())
    if states.pop(poisoned) != "quarantined" or set(states.values()) != {"done"}:
        complaints.append(judge.Complaint("conduct", f"states are {set(states.values())}"))
    if len(crashes) > 3 or {attempt["frame"] for attempt in crashes} != {poisoned}:
        complaints.append(judge.Complaint("conduct", f"crashes are charged to {crashes}"))
    row.blame(complaints, f"frame {poisoned}")
    return row


def delay_table(delays):
    yield "| fault | next attempts | seconds until they start, median | longest |"
    yield "|---|---:|---:|---:|"
    for what, seconds in delays.items():
        if seconds:
            yield f"| {what} | {len(seconds)} | {statistics.median(seconds):.3f} | {max(seconds):.3f} |"


if __name__ == "__main__":
    sys.exit(main())
