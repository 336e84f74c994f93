"""What tests of the package share: the program, configs, processes to look for."""

from __future__ import annotations

import contextlib
import os
import pathlib
import sys
import tempfile
import time
import unittest

CHECKOUT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = CHECKOUT / "python" / "src"
sys.path.insert(0, str(SOURCES))

FAKE_BLENDER = str(CHECKOUT / "tests/fake_blender/fake_blender.py")
CONFIG = """seedframe: 1
name: line
seed: 4
scenes: 3
frames_per_scene: 2
categories: [gear]
render: {width: 48, height: 32, samples: 1, passes: [depth, normal]}
variables: {scene: {turn: {uniform: [0deg, 90deg]}, height: {uniform: [0.2m, 0.4m]}}}
objects:
  gears: {asset: gear, count: 2, rotation_deg: [0, 0, turn], scatter: {x: [-0.1, 0.1], y: [-0.1, 0.1]}, rest_on_ground: true}
camera: {position: [0m, -0.4m, height], target: [0, 0, 0], fov_deg: 50}
image: {ocio_config: /usr/share/blender/datafiles/colormanagement/config.ocio}
labels: {check: false}
"""
LABELS_ONLY = {"labels": "geometry"}


class ProgramTest(unittest.TestCase):
    """A test with a folder of its own that has a config in it."""

    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory(prefix="seedframe-python-")
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.config = self.folder / "line.yaml"
        self.config.write_text(CONFIG)
        self.environment(SEEDFRAME_CACHE="off", TMPDIR=str(self.folder))
        if "SEEDFRAME_TESTED" in os.environ:
            self.environment(SEEDFRAME=os.environ["SEEDFRAME_TESTED"])

    def environment(self, **values: str) -> None:
        for name, value in values.items():
            before = os.environ.get(name)
            os.environ[name] = value
            if before is None:
                self.addCleanup(os.environ.pop, name, None)
            else:
                self.addCleanup(os.environ.__setitem__, name, before)

    def script(self, text: str) -> pathlib.Path:
        """A program in Python that knows the package."""
        path = self.folder / "script.py"
        path.write_text(f"import sys\nsys.path.insert(0, {str(SOURCES)!r})\nimport seedframe\n{text}")
        return path


def is_running(process: int) -> bool:
    """Dead processes that nobody has reaped do not count."""
    try:
        stat = pathlib.Path(f"/proc/{process}/stat").read_text()
    except OSError:
        return False
    return ") Z" not in stat


def children_of(process: int) -> list[int]:
    """Of all its threads."""
    children = []
    for listed in pathlib.Path(f"/proc/{process}/task").glob("*/children"):
        with contextlib.suppress(OSError):  # the thread has ended
            children += [int(each) for each in listed.read_text().split()]
    return children


def wait_until(what, longest_s: float = 60.0) -> bool:
    end = time.monotonic() + longest_s
    while not what():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True
