"""Runs of the program to be disturbed: how to prepare them, and how to bring the campaign back."""

import shutil
import sys

import judge


def lines_of(log):
    return log.read_text(encoding="utf-8").splitlines() if log.exists() else []


def line_of(log, number):
    return next((line for line in lines_of(log) if line.split()[0] == str(number)), str(number))


class Submit:
    """A new campaign."""
    name = "submit"

    def __init__(self, bench):
        self.bench = bench

    def prepare(self):
        self.bench.clear()

    def command(self):
        return self.bench.submit()

    def count(self, log, **faults):
        """How many calls an undisturbed run makes; `faults` may say which ones."""
        log.unlink(missing_ok=True)
        self.prepare()
        faults = {"under": self.bench.campaign, "log": log, **faults}
        run = self.bench.program.run(*self.command(), faults=faults)
        if run.code != 0:
            sys.exit(f"the undisturbed {self.name} ended with {run.code}: {run.errors}")
        return len(lines_of(log))

    def bring_back(self, row):
        store, complaints = self.bench.judge_now()
        done = store.done() if store else {}
        how, found = self.bench.recover()
        row.notes[how] += 1
        lost = judge.lost_since(done, judge.Store.read(self.bench.campaign, self.bench.program.folder))
        return complaints + found + lost


class Resume(Submit):
    """A campaign of which one frame is done, one was under way, and one has a folder without a row."""
    name = "resume"

    def __init__(self, bench):
        super().__init__(bench)
        self.half = bench.program.folder / f"half-{bench.kind.name}"
        log = bench.program.folder / "calls.txt"
        submit = Submit(bench)
        submit.count(log)
        placed = [int(line.split()[0]) for line in lines_of(log) if " rename " in line and "/frames/" in line]
        submit.prepare()
        faults = {"under": bench.campaign, "at": placed[1], "do": "kill-after"}
        bench.program.run(*bench.submit(), faults=faults)
        shutil.move(bench.campaign, self.half)

    def prepare(self):
        self.bench.clear()
        shutil.copytree(self.half, self.bench.campaign)

    def command(self):
        return self.bench.resume()


class Export(Submit):
    """COCO and YOLO from a complete campaign, in place of an earlier, amodal export."""
    name = "export"

    def __init__(self, bench):
        super().__init__(bench)
        self.older = bench.program.folder / "exported"
        bench.copy_undisturbed()
        self._export("--amodal")
        shutil.move(bench.campaign, self.older)
        bench.copy_undisturbed()
        self._export()
        self.expected = self._contents()

    def _export(self, *more):
        run = self.bench.program.run(*self.command(), *more)
        if run.code != 0:
            sys.exit(f"the undisturbed export ended with {run.code}: {run.errors}")

    def prepare(self):
        self.bench.clear()
        shutil.copytree(self.older, self.bench.campaign)

    def command(self):
        return ["export", self.bench.campaign, "--format", "coco", "--format", "yolo-segment"]

    def bring_back(self, row):
        _, complaints = self.bench.judge_now()
        complaints += self.bench.program.run(*self.command()).conduct(0)
        differing = sorted(dict(set(self._contents().items()) ^ set(self.expected.items())))
        if differing:
            complaints.append(judge.Complaint("hash", f"exports differ in {differing[:6]}"))
        row.notes["exported again"] += 1
        return complaints + self.bench.judge()

    def _contents(self):
        return judge.contents(self.bench.campaign / "exports")
