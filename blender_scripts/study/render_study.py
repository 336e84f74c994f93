"""Renders what a plan says, one picture after another in this process: for `seedframe bench determinism`.

    blender … --python render_study.py -- PLAN.json

The plan is a JSON object: "renders" is a list of objects with "scene", "frame", "samples", "width", "height",
"adaptive" and "output"; "persistent_data" and "cpus" (the CPUs to go on with, or null) hold for all. What
Blender it is goes into the file "made_with".
"""

import json
import os
import pathlib
import sys

FOLDER = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(FOLDER), str(FOLDER.parent)]
sys.dont_write_bytecode = True

import bpy  # noqa: E402

import cpu_kernel  # noqa: E402
import study_scenes  # noqa: E402
from passes import PassRenderer  # noqa: E402

BOUNCES = 8
ADAPTIVE = {"threshold": 0.05, "min_samples": 0}  # 0: Cycles chooses


def main():
    plan = json.loads(pathlib.Path(sys.argv[-1]).read_text(encoding="utf-8"))
    if plan["cpus"]:
        os.sched_setaffinity(0, plan["cpus"])
    version = bpy.app.version
    pathlib.Path(plan["made_with"]).write_text(
        f"Blender {'.'.join(map(str, version))}, Cycles' kernel {cpu_kernel.current(version)}, Embree's "
        f"{cpu_kernel.embree()}, {os.cpu_count()} CPUs", encoding="utf-8")
    name, scene, renderer = None, None, None
    for render in plan["renders"]:
        if render["scene"] != name:  # frames of one scene follow each other without a new start
            name = render["scene"]
            scene = study_scenes.build(name)
            blur = scene.render.use_motion_blur
            renderer = PassRenderer(scene, plan["persistent_data"])
            scene.render.use_motion_blur = blur
        study_scenes.move(scene, render["frame"])
        renderer.render({"width": render["width"], "height": render["height"], "samples": render["samples"],
                         "seed": 1, "adaptive": ADAPTIVE if render["adaptive"] else None, "denoise": "off",
                         "filter_width_px": 1.5, "clamp_indirect": 0.0, "max_bounces": BOUNCES,
                         "depth": True, "normal": True}, render["output"], "study")


main()
