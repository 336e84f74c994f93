"""Prints what this Blender is and can do, as a line of JSON behind the word DESCRIPTION: for `seedframe doctor`."""

import json
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True

import _cycles  # noqa: E402
import bpy  # noqa: E402

import cpu_kernel  # noqa: E402

_DEVICE_TYPES = ("CPU", "CUDA", "OPTIX", "HIP", "METAL", "ONEAPI")


def devices():
    """Kind and name of each, as Cycles gives them."""
    found = {}
    for kind in _DEVICE_TYPES:
        for name, its_kind, identifier, *_ in _cycles.available_devices(kind):
            found[identifier] = {"kind": its_kind, "name": name}
    return list(found.values())


def denoisers(present):
    names = ["OpenImageDenoise"] if _cycles.with_openimagedenoise else []
    return names + ["OptiX"] * any(device["kind"] == "OPTIX" for device in present)


def main():
    present = devices()
    print("DESCRIPTION " + json.dumps({
        "devices": present,
        "denoisers": denoisers(present),
        "kernel": cpu_kernel.current(bpy.app.version),
        "embree": cpu_kernel.embree(),
    }), flush=True)


main()
