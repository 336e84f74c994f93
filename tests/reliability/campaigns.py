"""Small campaigns and the program, as the scripts beside this one disturb them."""

import contextlib
import dataclasses
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import judge
from judge import Complaint

HOME = pathlib.Path(__file__).resolve().parents[2]
FAKE_BLENDER = HOME / "tests" / "fake_blender" / "fake_blender.py"

# The fake Blender brings no colour config. It draws a square of 0.2 m for each instance.
HEADER = """seedframe: 1
name: reliability
scenes: {scenes}
frames_per_scene: 3
image: {{ocio_config: /usr/share/blender/datafiles/colormanagement/config.ocio}}
"""
GEARS = HEADER + """categories: [gear]
render: {{width: 32, height: 24, samples: 1, passes: [depth, normal]}}
objects:
  gears: {{asset: gear, count: {{integer: [1, 3]}}, position: [{{uniform: [-0.1, 0.1]}}, 0, 0]}}
camera: {{distance_m: {{uniform: [0.2, 0.5]}}}}
"""
# From afar a cube is a square: the twin agrees with the fake, edges apart, and would not about another frame.
CUBES = HEADER + """categories: [cube]
render: {{width: 64, height: 48, samples: 1}}
labels: {{edge_tolerance: 1}}
variables: {{frame: {{turn: 2.4 * (3 * scene_index + frame_index)}}}}
objects:
  cubes: {{asset: cube, scale: 4, position: ["0.25 * cos(turn)", 0, "0.15 * sin(turn)"]}}
camera: {{distance_m: 4, elevation_deg: 0, fov_deg: 12}}
"""

BAD_PLAN = 125  # with which faulty_io.so ends a program


@dataclasses.dataclass(frozen=True)
class Kind:
    """A sort of campaign, by where its pictures come from."""
    name: str
    arguments: tuple
    config: str


LABELS = Kind("labels", ("--set", "labels=geometry"), GEARS)
FAKE = Kind("fake", ("--blender", str(FAKE_BLENDER)), GEARS + "labels: {{check: false}}\n")
CHECKED = Kind("checked", ("--blender", str(FAKE_BLENDER)), CUBES)  # against the twin
REAL = Kind("real", ("--blender", "/usr/bin/blender"), GEARS)
KINDS = {kind.name: kind for kind in (LABELS, FAKE, CHECKED, REAL)}


@dataclasses.dataclass
class Run:
    """A run of the program that has ended; a negative code is a signal, as in subprocess."""
    code: int
    output: str
    errors: str

    def conduct(self, *allowed):
        """Complaints unless it ended with one of these codes, and never with an internal error."""
        if self.code in allowed and "internal error" not in self.errors:
            return []
        said = self.errors.strip()[-400:]
        return [Complaint("conduct", f"exit code {self.code}, not of {allowed}: {said!r}")]


class Program:
    """Starts seedframe in a scratch folder of its own."""

    def __init__(self, build, folder):
        self.program = build / "seedframe"
        self.preload = build / "tests" / "faulty_io.so"
        self.folder = folder
        self.has_pause = "--pause-limit" in self.run("submit", "--help").output
        if not self.preload.exists():
            sys.exit(f"{self.preload} is missing: ninja -C {build} seedframe faulty_io")
        # A sanitizer's runtime must be the first library of a process: nothing can be preloaded before it.
        self.can_fail = self.run("--version", faults={"no-such": "key"}).code == BAD_PLAN

    def environment(self, faults=None, fake=None):
        environment = {**os.environ, "SEEDFRAME_HOME": str(HOME), "SEEDFRAME_CACHE": "off", judge.MARKER: str(self.folder)}
        if fake:
            environment["SEEDFRAME_FAKE"] = json.dumps(fake)
        if faults:
            environment["FAULTY_IO"] = faults_text(faults)
            environment["LD_PRELOAD"] = str(self.preload)
        return environment

    def start(self, *arguments, faults=None, fake=None):
        """A Popen whose output goes to files beside the campaigns, for `end`."""
        command = [str(self.program), *map(str, arguments)]
        with (self.folder / "out.txt").open("w") as out, (self.folder / "err.txt").open("w") as err:
            return subprocess.Popen(command, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=out,
                                    stderr=err, env=self.environment(faults, fake))

    def end(self, process, timeout=120):
        try:
            code = process.wait(timeout)
            tail = ""
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            code, tail = -signal.SIGALRM, f"\nit did not end within {timeout} s"
        output, errors = ((self.folder / name).read_text(encoding="utf-8", errors="replace")
                          for name in ("out.txt", "err.txt"))
        return Run(code, output, errors + tail)

    def run(self, *arguments, faults=None, fake=None, timeout=120):
        return self.end(self.start(*arguments, faults=faults, fake=fake), timeout)

    def reproduce(self, faults, *arguments):
        """The command line for a person."""
        environment = [f"FAULTY_IO='{faults_text(faults)}'", f"LD_PRELOAD={self.preload}"]
        return " ".join([*environment, str(self.program), *map(str, arguments)])


def faults_text(faults):
    return ";".join(f"{key.replace('_', '-')}={value}" for key, value in faults.items())


class Bench:
    """One kind of campaign on one program: makes it, knows it undisturbed, brings it back, judges it."""

    def __init__(self, program, kind, scenes, workers=1):
        self.program = program
        self.kind = kind
        self.workers = workers
        self.config = program.folder / f"{kind.name}-{scenes}.yaml"
        self.config.write_text(kind.config.format(scenes=scenes), encoding="utf-8")
        self.frames = 3 * scenes
        self.campaign = program.folder / "c"
        self.undisturbed = program.folder / f"undisturbed-{kind.name}-{scenes}"
        begin = time.monotonic()
        made = program.run(*self.submit(self.undisturbed))
        self.seconds = time.monotonic() - begin
        if made.code != 0:
            sys.exit(f"the undisturbed campaign ended with {made.code}: {made.errors[-1000:]}")
        self.hash = self._hash_of(self.undisturbed)
        self.manifests = {int(path.parent.name): path.read_bytes()
                          for path in self.undisturbed.glob("frames/*/*/manifest.json")}
        found = self.judge(self.undisturbed)
        if found or len(self.manifests) != self.frames:
            sys.exit(f"the undisturbed campaign is not as it should be: {found}")

    # ---- Commands ----

    def submit(self, campaign=None):
        return ["submit", self.config, "-o", campaign or self.campaign, "--quiet", "--workers", self.workers,
                *self.kind.arguments]

    def resume(self, *more):
        blender = self.kind.arguments if "--blender" in self.kind.arguments else ()
        return ["resume", self.campaign, "--quiet", "--workers", self.workers, *blender, *more]

    def clear(self):
        shutil.rmtree(self.campaign, ignore_errors=True)

    def copy_undisturbed(self):
        self.clear()
        shutil.copytree(self.undisturbed, self.campaign)

    # ---- Bringing back ----

    def recover(self):
        """What a user does after a crash: ("resumed", complaints), or how it was made anew."""
        store = judge.Store.read(self.campaign, self.program.folder)
        run = self.program.run(*self.resume())
        if run.code == 0 or (store and len(store.frames) == self.frames):
            return "resumed", run.conduct(0) + self.judge()
        # It never came to be a campaign. There must be a way on, and a message that tells it.
        complaints = run.conduct(2, 4, 5)
        again = self.program.run(*self.submit())
        if again.code == 0:
            return "submitted again", complaints + self.judge()
        complaints += again.conduct(2)
        self.clear()
        return "removed by hand", complaints + self.program.run(*self.submit()).conduct(0) + self.judge()

    # ---- Judging ----

    def judge_now(self):
        """(Store or None, complaints), right after a crash: what is called done is done."""
        store = judge.Store.read(self.campaign, self.program.folder)
        if store is None:
            return None, []
        return store, self._judge_store(self.campaign, store)

    def judge(self, campaign=None, repaired=False):
        """Complaints about a campaign that should be complete, the undisturbed one, and nothing else.

        `repaired`: finished frames were damaged, so there was reason to render some again.
        """
        campaign = campaign or self.campaign
        store = judge.Store.read(campaign, self.program.folder)
        if store is None:
            return [Complaint("lost", "there is no job store that could be read")]
        complaints = [each for each in self._judge_store(campaign, store)
                      if not (repaired and each.kind == "duplicated")]
        missing = [frame for frame, row in store.frames.items() if row["state"] != "done"]
        if missing or len(store.frames) != self.frames:
            complaints.append(Complaint("lost", f"{len(store.frames)} frames, not done: {missing}"))
        found = self._hash_of(campaign)
        if found != self.hash:
            complaints.append(Complaint("hash", f"dataset hash {found or 'none'} instead of {self.hash}"))
        differing = [frame for frame, expected in self.manifests.items()
                     if judge.read_or_none(judge.folder_of(campaign, frame) / "manifest.json") != expected]
        if differing:
            complaints.append(Complaint("hash", f"other manifests than undisturbed: frames {differing}"))
        return complaints + judge.stray_files(campaign)

    def _judge_store(self, campaign, store):
        complaints = []
        if store.integrity != "ok":
            complaints.append(Complaint("integrity", store.integrity))
        for frame, row in store.frames.items():
            if row["state"] == "done":
                folder = judge.folder_of(campaign, frame)
                why = judge.fault_of_frame(folder, row["frame_id"], row["pixel_hash"])
                complaints += [Complaint("wrong done", f"frame {frame}: {why}")] if why else []
        for frame, committed in store.committed.items():
            if committed > 1:
                complaints.append(Complaint("duplicated", f"frame {frame}: {committed} attempts are done"))
        return complaints

    def _hash_of(self, campaign):
        run = self.program.run("status", campaign, "--json")
        return json.loads(run.output)["dataset_hash"] if run.code == 0 else f"status ended with {run.code}"


@contextlib.contextmanager
def program_of(options, preload=False):
    """`preload`: the script is nothing without faulty_io.so."""
    with tempfile.TemporaryDirectory(prefix="seedframe-reliability-", dir=options.scratch) as name:
        program = Program(options.build.resolve(), pathlib.Path(name).resolve())
        if preload and not program.can_fail:
            print(f"skipped: {program.preload} cannot be preloaded into {program.program}")
            sys.exit(0)
        yield program
