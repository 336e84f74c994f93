#!/usr/bin/python3
"""The disk fills up, breaks or becomes read-only at every call that changes a file, and mends again.

From the Nth call on, all calls fail that would on such a disk (faulty_io.so). Either the program waits, the
cause goes away, and it goes on; or it stops at once (--pause-limit 0) and `resume` goes on later. A program
without --pause-limit always stops. Whichever way, no frame fails, the message names the cause, and what comes
of it is the undisturbed campaign, byte for byte.

Besides, with real causes: a file system that is too small until it grows (root only), and a limit on open
files.

    tests/reliability/fail_every_write.py [--kinds labels,fake] [--every K] [--report FILE]
"""

import contextlib
import ctypes
import os
import random
import resource
import subprocess
import sys
import time

import campaigns
import cases
import judge
import report

WRITES = "open,write,pwrite,writev,fsync,fdatasync,syncfs,ftruncate,rename,mkdir,link,symlink"
REMOVALS = "unlink,rmdir"
# Error to the calls that fail so, and how much thinner than --every they are tried.
ERRORS = {"ENOSPC": (WRITES, 1), "EIO": (f"{WRITES},{REMOVALS}", 1), "EROFS": (f"{WRITES},{REMOVALS}", 4),
          "EDQUOT": (WRITES, 8), "EMFILE": ("open,read-open", 2)}
CAUSES = ("No space left", "disk is full", "Input/output error", "I/O error", "Read-only file system",
          "readonly", "quota exceeded", "Too many open files", "unable to open")
NOT_LOADED = 127  # exit code of the dynamic linker
STOPPED = 4  # exit code: the system is not as needed
CLONE_NEWNS = 0x20000


def main():
    parser = report.parser_of(__doc__)
    parser.add_argument("--kinds", default="labels,fake")
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    begin = time.monotonic()
    rows = []
    with campaigns.program_of(options, preload=True) as program:
        for name in options.kinds.split(","):
            kind = campaigns.KINDS[name]
            bench = campaigns.Bench(program, kind, scenes=1)
            for case in (cases.Submit(bench), cases.Resume(bench)):
                for error, (calls, thinner) in ERRORS.items():
                    rows += sweep(case, error, calls, options.every * thinner)
                rows.append(short_writes(case, options.every * 4))
            large = campaigns.Bench(program, kind, scenes=20, workers=2)
            rows += limited_files(large, random.Random(options.seed), 20 // options.every or 2)
            rows += small_disk(large)
    text = ["Made by `tests/reliability/fail_every_write.py`, which says how: *number* is how often the disk",
            "failed."]
    if not program.has_pause:
        text.append("This program cannot wait for a disk: it always stops, and `resume` goes on.")
    return report.finish(options, "Disks that fill up or break at every call", text, rows, begin)


def ways_of(program):
    """Name, and more arguments: does the program wait, or stop?"""
    return [("waits", ()), ("stops", ("--pause-limit", "0"))] if program.has_pause else [("stops", ())]


def sweep(case, error, calls, every):
    """The error from each call on; a Row for each way of the program."""
    program, bench = case.bench.program, case.bench
    log, broken, told = (program.folder / name for name in ("calls.txt", "broken", "told"))
    count = case.count(log, calls=calls)
    rows = []
    for way, more in ways_of(program):
        row = report.Row(f"{case.name}, {bench.kind.name}: {error}, {way}")
        row.notes["calls"] = count
        for number in range(1 + min(every, count) // 2, count + 1, every):
            case.prepare()
            log.unlink(missing_ok=True)
            told.unlink(missing_ok=True)
            broken.touch()
            faults = {"under": bench.campaign, "log": log, "calls": calls, "at": number, "do": error,
                      "until_file": broken, "tell_file": told}
            process = program.start(*case.command(), *more, faults=faults)
            if way == "waits":
                mend_when_told(process, told, broken)
            run = program.end(process)
            broken.unlink(missing_ok=True)
            if not told.exists():
                row.notes["ended before (threads)"] += 1
                continue
            row.number += 1
            row.blame(verdict(case, run, row), f"call {cases.line_of(log, number)}",
                      program.reproduce({**faults, "log": "calls.txt"}, *case.command(), *more))
        rows.append(row)
    return rows


def wait_until(process, happened, timeout=60):
    """Or until the process ends; whoever waits for its end finds one that hangs."""
    deadline = time.monotonic() + timeout
    while process.poll() is None and not happened() and time.monotonic() < deadline:
        time.sleep(0.002)


def mend_when_told(process, told, broken):
    wait_until(process, told.exists)
    time.sleep(0.1)  # so that more than one call fails
    broken.unlink()


def verdict(case, run, row):
    """Complaints about a run whose disk failed, and about what `resume` makes of it."""
    bench = case.bench
    store, complaints = bench.judge_now()
    exists = store is not None and len(store.frames) == bench.frames
    complaints += run.conduct(*((0, STOPPED) if exists else (2, STOPPED)))
    complaints += failed_frames(store)
    done = store.done() if store else {}
    if run.code == 0:
        # It may not have been able to tidy up; whatever runs next does.
        row.notes["went on"] += 1
        if len(done) != bench.frames:
            complaints.append(judge.Complaint("lost", f"it ended well, and only {sorted(done)} are done"))
    elif not any(cause in run.errors for cause in CAUSES) and str(bench.campaign) not in run.errors:
        complaints.append(judge.Complaint("conduct", f"no cause and no path in {run.errors!r}"))
    how, found = bench.recover()
    if run.code != 0:
        row.notes[f"stopped, {how}"] += 1
    now = judge.Store.read(bench.campaign, bench.program.folder)
    return complaints + found + judge.lost_since(done, now)


def failed_frames(store):
    """No frame is to blame for a disk."""
    states = {frame: row["state"] for frame, row in store.frames.items()} if store else {}
    bad = [frame for frame, state in states.items() if state in ("failed", "quarantined")]
    return [judge.Complaint("conduct", f"frames are marked as failed: {bad}")] if bad else []


def short_writes(case, every):
    """write() may write less than it was given at any time; nobody may notice."""
    program, bench = case.bench.program, case.bench
    log = program.folder / "calls.txt"
    calls = "write,pwrite,writev"
    row = report.Row(f"{case.name}, {bench.kind.name}: short write")
    row.notes["calls"] = case.count(log, calls=calls)
    for number in range(1, row.notes["calls"] + 1, every):
        case.prepare()
        faults = {"under": bench.campaign, "calls": calls, "at": number, "do": "short-write", "times": 1}
        run = program.run(*case.command(), faults=faults)
        row.number += 1
        row.blame(run.conduct(0) + bench.judge(), f"call {number}",
                  program.reproduce(faults, *case.command()))
    return row


# ---- Real causes ----

def limited_files(bench, rng, times):
    """From some moment on for half a second, the program cannot open a file more than it has."""
    program = bench.program
    rows = []
    for way, more in ways_of(program):
        row = report.Row(f"submit, {bench.kind.name}: limit on open files, {way}")
        for _ in range(times):
            bench.clear()
            process = program.start(*bench.submit(), *more)
            time.sleep(rng.uniform(0, bench.seconds))
            with contextlib.suppress(ProcessLookupError, FileNotFoundError):
                before = resource.prlimit(process.pid, resource.RLIMIT_NOFILE)
                now = len(os.listdir(f"/proc/{process.pid}/fd"))
                resource.prlimit(process.pid, resource.RLIMIT_NOFILE, (now, before[1]))
                time.sleep(0.5)
                resource.prlimit(process.pid, resource.RLIMIT_NOFILE, before)
            run = program.end(process)
            if run.code == NOT_LOADED and "shared libraries" in run.errors:
                row.notes["not even loaded"] += 1
                continue
            row.number += 1
            row.blame(verdict(cases.Submit(bench), run, row), "at a random time")
        rows.append(row)
    return rows


def small_disk(bench):
    """A file system that the campaign does not fit into, until it grows."""
    program = bench.program
    disk = program.folder / "disk"
    own_mounts = ctypes.CDLL(None, use_errno=True).unshare(CLONE_NEWNS) == 0
    if not own_mounts:
        row = report.Row(f"submit, {bench.kind.name}: small file system")
        row.notes["skipped: it takes root to mount one"] = 1
        return [row]
    subprocess.run(["mount", "--make-rprivate", "/"], check=True)
    disk.mkdir(exist_ok=True)
    usual, bench.campaign = bench.campaign, disk / "c"
    rows = []
    for way, more in ways_of(program):
        row = report.Row(f"submit, {bench.kind.name}: small file system, {way}")
        for kilobytes in (96, 160, 256, 512, 768, 1024, 1280, 1536, 2048):
            mount = ["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "none", str(disk)]
            subprocess.run(mount, check=True)
            try:
                # Or it would not even start.
                unchecked = ("--no-space-check",) if program.has_pause else ()
                process = program.start(*bench.submit(), *more, *unchecked)
                if way == "waits":
                    grow_when_paused(program, process, disk)
                run = program.end(process)
                subprocess.run(["mount", "-o", "remount,size=256m", str(disk)], check=True)
                row.number += 1
                row.blame(verdict(cases.Submit(bench), run, row), f"{kilobytes} kB")
            finally:
                subprocess.run(["umount", str(disk)], check=True)
        rows.append(row)
    bench.campaign = usual
    return rows


def grow_when_paused(program, process, disk):
    # Not when it is full: what the program removes before it waits makes room.
    wait_until(process, lambda: "paused" in (program.folder / "err.txt").read_text(encoding="utf-8"))
    time.sleep(0.5)
    subprocess.run(["mount", "-o", "remount,size=256m", str(disk)], check=True)


if __name__ == "__main__":
    sys.exit(main())
