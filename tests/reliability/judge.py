"""The judge of what a campaign's folder holds, and of which processes are left.

It reads everything by itself (json, hashlib, sqlite3), with none of the program's code. It never opens a
campaign's store but a copy of it: SQLite would repair the original, and what the program does about it would
then not be tested.
"""

import collections
import contextlib
import dataclasses
import hashlib
import json
import os
import pathlib
import re
import shutil
import signal
import sqlite3
import time

MARKER = "SEEDFRAME_RELIABILITY"  # in the environment of the program and, inherited, of its workers

# docs/formats/campaign.md: what there may be in a campaign that nobody works on.
LAYOUT = re.compile(
    r"campaign\.(yaml|lock|sqlite|sqlite-wal|sqlite-shm)|graphs\.jsonl|(provenance|nodes)\.json|logs/(serve\.log|worker-\d\d\.log(\.1)?|crash-\d{6,}-\d+\.log)"
    r"|frames/\d{3,}/\d{6,}/[a-z_.]+|rejected/\d{6,}/[a-z_.]+|exports/.*"
    r"|inputs/(inputs\.json|assets/[^/]+/(asset\.json|mesh\.drc))|report\.html|report_files/part-\d+\.js")

STORE_FILES = ("campaign.sqlite", "campaign.sqlite-wal", "campaign.sqlite-journal")


@dataclasses.dataclass
class Complaint:
    kind: str  # of KINDS_OF_COMPLAINT
    text: str


KINDS_OF_COMPLAINT = {
    "lost": "frames that were done and were not, or were rendered again",
    "duplicated": "frames with more than one committed attempt",
    "torn": "files that are not as their manifest says, missing, or not part of a campaign",
    "wrong done": "frames that the store calls done and whose folder does not verify",
    "integrity": "job stores that SQLite finds damaged",
    "hash": "datasets other than the undisturbed one",
    "conduct": "wrong exit codes or messages, hangs, surviving workers",
}


class Store:
    """What a job store says, read from a copy."""

    def __init__(self, connection):
        connection.row_factory = sqlite3.Row
        self.integrity = connection.execute("PRAGMA integrity_check").fetchone()[0]
        frames = connection.execute("SELECT * FROM frames ORDER BY frame")
        self.frames = {row["frame"]: dict(row) for row in frames}
        attempts = connection.execute("SELECT * FROM attempts ORDER BY frame, attempt")
        self.attempts = [dict(row) for row in attempts]
        self.committed = collections.Counter(
            row["frame"] for row in self.attempts if row["outcome"] == "done")

    @staticmethod
    def read(campaign, scratch):
        """None while there is no store, or none with tables."""
        copy = scratch / "store-copy"
        shutil.rmtree(copy, ignore_errors=True)
        copy.mkdir()
        for name in STORE_FILES:
            with contextlib.suppress(FileNotFoundError):
                shutil.copy(campaign / name, copy / name)
        if not (copy / STORE_FILES[0]).exists():
            return None
        with contextlib.closing(sqlite3.connect(copy / STORE_FILES[0])) as connection:
            try:
                return Store(connection)
            except sqlite3.OperationalError:  # no such table
                return None
            except sqlite3.DatabaseError as error:
                return DamagedStore(str(error))

    def done(self):
        """Frame to number of its last attempt, for the frames that are done."""
        return {frame: row["attempts"] for frame, row in self.frames.items() if row["state"] == "done"}


@dataclasses.dataclass
class DamagedStore:
    """In place of a Store that SQLite refuses to read."""
    integrity: str
    frames: dict = dataclasses.field(default_factory=dict)
    attempts: list = dataclasses.field(default_factory=list)
    committed: dict = dataclasses.field(default_factory=dict)

    def done(self):
        return {}


def lost_since(done_before, store):
    """Frames of `done_before` (Store.done) that are done no more, or were rendered once more."""
    now = store.done() if store else {}
    return [Complaint("lost", f"frame {frame}: attempt {attempt} was done, now {now.get(frame, 'none')}")
            for frame, attempt in done_before.items() if now.get(frame) != attempt]


def folder_of(campaign, frame):
    return campaign / "frames" / f"{frame // 1000:03}" / f"{frame:06}"


def fault_of_frame(folder, frame_id, pixel_hash):
    """Why a frame's folder is not complete and its own; empty if it is."""
    try:
        manifest = json.loads((folder / "manifest.json").read_bytes())
        if manifest["frame_id"] != frame_id:
            return "its manifest is of another frame"
        pixels = json.dumps(manifest["pixels"], sort_keys=True, separators=(",", ":"))
        if sha256(pixels.encode()) != pixel_hash:
            return "its pixel hash is not the store's"
        for name, file in manifest["files"].items():
            data = (folder / name).read_bytes()
            if len(data) != file["bytes"] or sha256(data) != file["sha256"]:
                return f"{name} is not as its manifest says"
        extra = {path.name for path in folder.iterdir()} - set(manifest["files"]) - {"manifest.json"}
        return f"there are also {sorted(extra)}" if extra else ""
    except (OSError, ValueError, KeyError) as error:
        return repr(error)


def stray_files(campaign):
    """Files and folders that a campaign at rest does not have."""
    found = []
    for path in campaign.rglob("*"):
        name = path.relative_to(campaign).as_posix()
        if name == "work" or (path.is_file() and not LAYOUT.fullmatch(name)):
            found.append(Complaint("torn", f"{name} should not be there"))
    return [each for each in found if not each.text.startswith("work/")]


def read_or_none(path):
    try:
        return path.read_bytes()
    except OSError:
        return None


def contents(folder):
    """Every file below it by its path, with its bytes."""
    return {path.relative_to(folder).as_posix(): path.read_bytes()
            for path in folder.rglob("*") if path.is_file()}


def sha256(data):
    return hashlib.sha256(data).hexdigest()


def marked_processes(marker):
    """Ids of living processes that were started, directly or not, with this marker."""
    wanted = f"{MARKER}={marker}".encode()
    found = []
    for folder in pathlib.Path("/proc").iterdir():
        with contextlib.suppress(OSError):
            if folder.name.isdigit() and wanted in (folder / "environ").read_bytes().split(b"\0"):
                found.append(int(folder.name))
    return found


def survivors(marker, patience_s=5):
    """Complaints about processes that are there after so long; ends them."""
    deadline = time.monotonic() + patience_s
    while (alive := marked_processes(marker)) and time.monotonic() < deadline:
        time.sleep(0.01)
    for pid in alive:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
    return [Complaint("conduct", f"process {pid} outlived its scheduler by {patience_s} s") for pid in alive]
