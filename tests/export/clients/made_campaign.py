"""A small campaign of a fake Blender, and its exports, for programs that read them."""

import os
import pathlib
import re
import subprocess

HOME = pathlib.Path(__file__).resolve().parents[3]
PARTS = """seedframe: 1
name: parts
scenes: 3
frames_per_scene: 4
categories: [gear, hex_bolt, never_seen, washer]
render: {width: 160, height: 120, samples: 1, passes: [depth]}
objects:
  gears: {asset: gear, count: 3, position: [{uniform: [-0.1, 0.1]}, {uniform: [-0.1, 0.1]}, 0]}
  bolts: {asset: hex_bolt, count: 4, position: [{uniform: [-0.15, 0.15]}, {uniform: [-0.1, 0.1]}, 0.02]}
  washers: {asset: washer, count: 2, position: [{uniform: [-0.1, 0.1]}, 0, 0.03]}
  stones: {asset: cube, category: none, count: 2, scale: 0.3,
           position: [{uniform: [-0.1, 0.1]}, {uniform: [-0.1, 0.1]}, 0.05]}
camera: {target: [0, 0, 0], distance_m: {uniform: [0.3, 0.5]}}
labels: {check: false}
image: {ocio_config: /usr/share/blender/datafiles/colormanagement/config.ocio}
"""


def export(program, folder, formats, *options, scenes=3):
    """The campaign in `folder`/c, its exports in `folder`/out."""

    def seedframe(*arguments):
        environment = dict(os.environ, SEEDFRAME_CACHE="off")
        subprocess.run([program, *arguments], cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)

    (folder / "parts.yaml").write_text(PARTS)
    blender = str(HOME / "tests" / "fake_blender" / "fake_blender.py")
    seedframe("submit", "parts.yaml", "-o", "c", "--blender", blender, "--quiet", "--set", f"scenes={scenes}")
    seedframe("export", "c", "-o", "out", *options, *(word for name in formats for word in ("--format", name)))


def code_of(page, block=0):
    """A block of Python of a page of docs/formats, the first unless told otherwise: what users are told to write."""
    text = (HOME / "docs" / "formats" / page).read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```", text, re.S | re.M)[block]
