#!/usr/bin/python3
"""SIGKILL, and a full disk, at every call by which `seedframe stream --keep` changes a file of its campaign.

Killed before a call, in the middle of what it writes, and after it: whatever was answered as kept is in the
campaign, `resume` makes it whole, and a stream that is asked the same again keeps each frame once. With a disk
that fails from a call on and mends when a client has been told: the stream goes on, and keeps what it is asked
for again. In the end every frame is, byte for byte, that of an undisturbed stream.

    tests/reliability/kill_stream.py [--every K] [--report FILE]

--every K takes every Kth call only, another one for each way.
"""

import json
import shutil
import signal
import subprocess
import sys
import time

import campaigns
import cases
import judge
import report
from judge import Complaint

WAYS = ("kill", "kill-within", "kill-after")
WRITES = "open,write,pwrite,writev,fsync,fdatasync,syncfs,ftruncate,rename,mkdir,link,symlink"
CONFIG = """seedframe: 1
name: kept
categories: [gear]
render: {width: 32, height: 24, samples: 1, passes: [depth]}
image: {ocio_config: /usr/share/blender/datafiles/colormanagement/config.ocio}
labels: {check: false}
variables: {scene: {turn: {uniform: [0deg, 90deg]}}}
objects:
  gears: {asset: gear, count: {integer: [1, 3]}, rotation_deg: [0, 0, turn], position: [{uniform: [-0.1, 0.1]}, 0, 0]}
camera: {distance_m: {uniform: [0.2, 0.5]}}
"""
REQUESTS = [{"scene": 0}, {"scene": 1, "values": {"turn": 30}}, {"scene": 1, "samples": 4}, {"scene": 0}]
NOT_READY = (2, 4)  # exit codes: there is no campaign yet, or its disk does not take one


def main():
    parser = report.parser_of(__doc__)
    parser.add_argument("--every", type=int, default=1)
    options = parser.parse_args()
    begin = time.monotonic()
    with campaigns.program_of(options, preload=True) as program:
        bench = Bench(program)
        rows = [kills(bench, options.every), full_disks(bench, options.every)]
    text = ["Made by `tests/reliability/kill_stream.py`, which says how: *number* is how often the stream was",
            "killed, or its disk was full." + (f" Here at every {options.every}th call." if options.every > 1 else "")]
    return report.finish(options, "Streams that keep their frames", text, rows, begin)


class Bench:
    """The stream, its campaign, and what comes of it undisturbed."""

    def __init__(self, program):
        self.program = program
        self.campaign = program.folder / "kept"
        self.config = program.folder / "kept.yaml"
        self.log = program.folder / "calls.txt"
        self.broken, self.told = program.folder / "broken", program.folder / "told"
        self.config.write_text(CONFIG, encoding="utf-8")
        code, answers = self.stream(faults={"under": self.campaign, "log": self.log})
        self.calls = len(cases.lines_of(self.log))
        self.writes = self.count_writes()
        if code != 0 or len({answer.get("kept") for answer in answers.values()} - {None}) != len(REQUESTS) - 1:
            sys.exit(f"the undisturbed stream ended with {code}: {answers}")
        self.expected = self.manifests()

    def count_writes(self):
        self.clear()
        self.log.unlink(missing_ok=True)
        self.stream(faults={"under": self.campaign, "log": self.log, "calls": WRITES})
        return len(cases.lines_of(self.log))

    def clear(self):
        shutil.rmtree(self.campaign, ignore_errors=True)

    def stream(self, faults=None, on_error=None):
        """Its exit code, and its answers by id. `on_error` is called at the first answer that is one; then all is asked again."""
        process = self.start(faults)
        answers = {}
        try:
            if process.stdout.readline():
                answers = talk(process)
                if on_error and any("error" in answer for answer in answers.values()):
                    on_error(answers)
                    answers = talk(process)
        except (BrokenPipeError, ConnectionResetError):
            pass
        finally:
            code = end(process)
        return code, answers

    def start(self, faults):
        with (self.program.folder / "err.txt").open("w") as errors:
            return subprocess.Popen(
                [str(self.program.program), "stream", str(self.config), "--keep", str(self.campaign), "--fidelity", "render",
                 "--workers", "1", "--blender", str(campaigns.FAKE_BLENDER)],
                cwd=self.program.folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors, text=True,
                env={**self.program.environment(faults), "TMPDIR": str(self.program.folder)})

    def manifests(self):
        """By frame id; the frame's number is not in them."""
        found = {}
        for path in self.campaign.glob("frames/*/*/manifest.json"):
            found[json.loads(path.read_bytes())["frame_id"]] = path.read_bytes()
        return found

    def recover(self, row, answered):
        """Complaints about what is there, about `resume`, and about a stream that is asked the same again."""
        store = judge.Store.read(self.campaign, self.program.folder)
        complaints = self.judge(store) + missing(store, answered)
        run = self.program.run("resume", self.campaign, "--quiet", "--blender", campaigns.FAKE_BLENDER)
        complaints += run.conduct(*((0,) if store else (0, *NOT_READY)))
        if run.code == 0:
            row.notes["resumed"] += 1
            store = judge.Store.read(self.campaign, self.program.folder)
            complaints += self.judge(store, whole=True) + missing(store, answered)
        code, answers = self.stream()
        if code != 0:
            errors = (self.program.folder / "err.txt").read_text()
            return [*complaints, Complaint("conduct", f"the next stream ended with {code}: {errors[-300:]!r}")]
        store = judge.Store.read(self.campaign, self.program.folder)
        complaints += self.judge(store, whole=True) + missing(store, answers) + missing(store, answered)
        if self.manifests() != self.expected:
            complaints.append(Complaint("hash", "other frames than those of an undisturbed stream"))
        return complaints + judge.survivors(self.program.folder)

    def judge(self, store, whole=False):
        complaints = []
        if store is None:
            return complaints
        if store.integrity != "ok":
            complaints.append(Complaint("integrity", store.integrity))
        for frame, row in store.frames.items():
            if row["state"] != "done":
                complaints += [Complaint("lost", f"frame {frame} is {row['state']}")] if whole else []
                continue
            why = judge.fault_of_frame(judge.folder_of(self.campaign, frame), row["frame_id"], row["pixel_hash"])
            complaints += [Complaint("wrong done", f"frame {frame}: {why}")] if why else []
        complaints += [Complaint("duplicated", f"frame {frame}: {count} attempts are done")
                       for frame, count in store.committed.items() if count > 1]
        ids = [row["frame_id"] for row in store.frames.values()]
        if len(set(ids)) != len(ids):
            complaints.append(Complaint("duplicated", "a frame has two numbers"))
        if whole:
            lines = (self.campaign / "graphs.jsonl").read_bytes().count(b"\n")
            if lines != len(ids):
                complaints.append(Complaint("torn", f"{lines} lines of graphs for {len(ids)} frames"))
            complaints += judge.stray_files(self.campaign)
        return complaints


def talk(process):
    """Asks for everything; the answers by id, as far as they come."""
    answers = {}
    for number, each in enumerate(REQUESTS):
        process.stdin.write(json.dumps({"id": number, **each}) + "\n")
    process.stdin.flush()
    while len(answers) < len(REQUESTS) and (line := process.stdout.readline()):
        answer = json.loads(line)
        if "alive" not in answer:
            answers[answer["id"]] = answer
    return answers


def end(process, timeout=60):
    try:
        process.stdin.close()
    except BrokenPipeError:
        pass
    try:
        code = process.wait(timeout)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        code = -signal.SIGALRM
    process.stdout.close()
    return code


def missing(store, answered):
    """Of those that were answered as kept."""
    complaints = []
    for answer in answered.values():
        if "kept" not in answer:
            continue
        row = store.frames.get(answer["kept"]) if store else None
        if row is None or row["state"] != "done" or row["frame_id"] != answer["frame_id"]:
            complaints.append(Complaint("lost", f"frame {answer['kept']} was answered as kept, and is {row and row['state']}"))
    return complaints


def kills(bench, every):
    row = report.Row("killed")
    row.notes["calls"] = bench.calls
    for number in range(1, bench.calls + 1):
        for phase, way in enumerate(WAYS):
            if (number + phase * every // len(WAYS)) % every != 0:
                continue
            bench.clear()
            bench.log.unlink(missing_ok=True)
            code, answered = bench.stream({"under": bench.campaign, "log": bench.log, "at": number, "do": way})
            row.number += code == -signal.SIGKILL
            row.notes["ended before (threads)"] += code == 0
            complaints = [] if code in (0, -signal.SIGKILL) else [Complaint("conduct", f"exit code {code}")]
            row.blame(complaints + bench.recover(row, answered), f"{way} at call {cases.line_of(bench.log, number)}")
    return row


def full_disks(bench, every):
    row = report.Row("no room on the disk")
    row.notes["calls"] = bench.writes

    def mend(answers):
        bench.broken.unlink(missing_ok=True)
        row.notes["went on"] += 1
        for answer in answers.values():
            if "error" in answer and answer["error"]["kind"] != "environment":
                row.blame([Complaint("conduct", f"a full disk was told as {answer['error']}")], "its answer")

    for number in range(1 + min(every, bench.writes) // 2, bench.writes + 1, every):
        bench.clear()
        bench.log.unlink(missing_ok=True)
        bench.told.unlink(missing_ok=True)
        bench.broken.touch()
        code, answered = bench.stream({"under": bench.campaign, "log": bench.log, "calls": WRITES, "at": number, "do": "ENOSPC",
                                       "until_file": bench.broken, "tell_file": bench.told}, mend)
        bench.broken.unlink(missing_ok=True)
        row.number += bench.told.exists()
        row.notes["not begun"] += code in NOT_READY
        complaints = [] if code in (0, *NOT_READY) else [Complaint("conduct", f"exit code {code}")]
        if code == 0 and bench.told.exists() and not all("kept" in answer for answer in answered.values()):
            complaints.append(Complaint("lost", f"it did not go on: {answered}"))
        row.blame(complaints + bench.recover(row, answered), f"call {cases.line_of(bench.log, number)}")
    return row


if __name__ == "__main__":
    sys.exit(main())
