"""Campaigns that are made on a cluster, and judged by what one machine makes of them (../reliability)."""

import contextlib
import os
import pathlib
import shutil
import signal
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "reliability"))

import campaigns  # noqa: E402 - found by the line above
import judge  # noqa: E402
import report  # noqa: E402,F401
from campaigns import CHECKED, GEARS, LABELS, Kind  # noqa: E402,F401
from judge import Complaint  # noqa: E402

# Six frames of three instances at most, for the real Blender.
SMALL = Kind("real", ("--blender", "/usr/bin/blender"),
             GEARS.replace("width: 32, height: 24, samples: 1", "width: 64, height: 48, samples: 4"))
PATIENCE_S = 600
TITLE = "Clusters that break"


class Program(campaigns.Program):
    """The program as it is, with nothing preloaded."""

    def __init__(self, build, folder):  # instead of the other's, which wants faulty_io.so
        self.program = build / "seedframe"
        self.preload = None
        self.folder = folder
        self.more_environment = {}
        if "--executor" not in self.run("submit", "--help").output:
            sys.exit(f"{self.program} knows no --executor: ninja -C {build} seedframe")

    def environment(self, faults=None, fake=None):
        return {**super().environment(faults, fake), **self.more_environment}


class Bench(campaigns.Bench):
    """A kind of campaign that one machine has made, to be made again by tasks of a cluster."""

    def __init__(self, program, kind, scenes, cluster, batch_frames=3, more=()):
        for earlier in program.folder.glob("undisturbed-*"):
            shutil.rmtree(earlier)
        super().__init__(program, kind, scenes, workers=2)
        self.cluster = cluster
        self.distribute = ["--executor", "slurm", "--batch-frames", batch_frames, "--poll", 0.3, "--cpus-per-task", 1,
                           *more]

    def submit_to_cluster(self):
        return ["submit", self.config, "-o", self.campaign, "--quiet", *self.kind.arguments, *self.distribute]

    def resume_on_cluster(self):
        blender = self.kind.arguments if "--blender" in self.kind.arguments else ()
        return ["resume", self.campaign, "--quiet", *blender]

    # ---- What there is of it ----

    def claims(self):
        """Batches that a task has begun, as paths."""
        return [path for path in self.campaign.glob("slurm/*/claims/*") if path.suffix != ".over"]

    def records(self):
        """Frames that tasks have finished and the head has not fetched yet, as paths."""
        return [path for path in self.campaign.glob("slurm/*/*/*.json") if path.stem.isdigit()]

    def frames_there(self):
        """Frames that are in their places."""
        return list(self.campaign.glob("frames/*/*"))

    def wait_for(self, condition, process, patience_s=60):
        """Whether the condition came true while the process ran."""
        deadline = time.monotonic() + patience_s
        while process.poll() is None and time.monotonic() < deadline:
            if condition():
                return True
            time.sleep(0.02)
        return False

    # ---- Judging ----

    def finish(self, run, allowed=(), most_resumes=4, patience_s=PATIENCE_S):
        """(resumes, complaints) of a campaign whose head has ended with `run`: it is resumed until it is complete.

        `allowed`: the exit codes with which a head may end before, if it says that resume goes on.
        """
        complaints = []
        resumes = 0
        while run.code != 0 and resumes < most_resumes:
            complaints += run.conduct(*allowed)
            if run.code > 0 and "seedframe resume" not in run.output + run.errors:
                said = (run.output + run.errors).strip()[-300:]
                complaints.append(Complaint("conduct", f"it ended with {run.code} and told no way on: {said!r}"))
            store, found = self.judge_now()
            done = store.done() if store else {}
            run = self.program.run(*self.resume_on_cluster(), timeout=patience_s)
            complaints += found + judge.lost_since(done, judge.Store.read(self.campaign, self.program.folder))
            resumes += 1
        return resumes, complaints + run.conduct(0) + self.judge() + self.left_running()

    def _unfinished_jobs(self):
        """Those of a node that was lost are COMPLETING until the controller has heard of it again."""
        jobs = self.cluster.jobs()
        return "not known: no answer" if jobs is None else [job for job in jobs if job[1] != "COMPLETING"]

    def judge(self, campaign=None, repaired=False):
        """As ever; what tasks have printed may stay when something was lost."""
        return [each for each in super().judge(campaign, repaired)
                if not each.text.startswith(("slurm/logs/", "slurm/state.json "))]

    def left_running(self, patience_s=20):
        """Complaints about jobs and processes of a campaign that is over."""
        deadline = time.monotonic() + patience_s
        while (left := self._unfinished_jobs()) and time.monotonic() < deadline:
            time.sleep(0.1)
        complaints = [Complaint("conduct", f"jobs are left: {left}")] if left else []
        return complaints + judge.survivors(self.program.folder, patience_s)


@contextlib.contextmanager
def program_of(options):
    with tempfile.TemporaryDirectory(prefix="seedframe-slurm-", dir=options.scratch) as name:
        os.environ.setdefault("SEEDFRAME_BLENDER", "blender")
        yield Program(options.build.resolve(), pathlib.Path(name).resolve())


def end_process(pid):
    with contextlib.suppress(ProcessLookupError):
        os.kill(pid, signal.SIGKILL)


def write_section(file, title, heading, lines):
    """Puts a section into a report in Markdown, in place of the one of the same heading; the others stay."""
    text = file.read_text(encoding="utf-8") if file.exists() else f"# {title}\n"
    first, *sections = text.split("\n## ")
    own = heading + "\n\n" + "\n".join(lines).strip() + "\n"
    at = next((i for i, section in enumerate(sections) if section.splitlines()[0] == heading), None)
    if at is None:
        sections.append(own)
    else:
        sections[at] = own
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("\n## ".join([first, *sections]).rstrip() + "\n", encoding="utf-8")
