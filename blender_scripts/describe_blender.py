"""Prints what this Blender is and can do, as a line of JSON behind the word DESCRIPTION: for `seedframe doctor`."""

import json
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True

import bpy  # noqa: E402

import cpu_kernel  # noqa: E402
import render_devices  # noqa: E402


def main():
    print("DESCRIPTION " + json.dumps({
        "devices": render_devices.text_of(render_devices.present()),
        "denoisers": ", ".join(render_devices.denoisers()),
        "kernel": cpu_kernel.current(bpy.app.version),
        "embree": cpu_kernel.embree(),
    }), flush=True)


main()
