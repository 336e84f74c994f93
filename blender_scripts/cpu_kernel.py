"""What computes the pixels: kernels of Cycles and Embree, and the CPU's approximate reciprocals.

Images differ in their last bits between any of them (docs/determinism.md).
"""

import ctypes
import os
import platform

import blender_versions


def choose(capabilities, environment, blender_version):
    """The kernel for a CPU that can so much. Cycles uses one only if all lesser ones are allowed."""
    best, kernels = blender_versions.kernels(blender_version)
    for name, capability, forbidding in kernels:
        if forbidding in environment or capability not in capabilities:
            break
        best = name
    return best


def capabilities_in(system_info):
    """Of what Cycles says of the system; none if it is silent about the CPU."""
    for line in system_info.splitlines():
        key, _, value = line.partition(":")
        if key.strip() == "CPU device capabilities":
            return set(value.split())
    return set()


def current(blender_version):
    import _cycles  # part of Blender

    return choose(capabilities_in(_cycles.system_info()), os.environ, blender_version)


def embree():
    """Embree's kernels; empty if they cannot be told, since Embree is no library of its own."""
    preloaded = ctypes.CDLL(None)
    if not hasattr(preloaded, "seedframe_embree_isa") or not _is_loaded("/libembree"):
        return ""
    preloaded.seedframe_embree_isa.restype = ctypes.c_char_p
    return preloaded.seedframe_embree_isa().decode("ascii")


def reciprocals():
    """A hash of the approximate reciprocals; empty if it cannot be told."""
    preloaded = ctypes.CDLL(None)
    if not hasattr(preloaded, "seedframe_reciprocals"):
        return ""
    preloaded.seedframe_reciprocals.restype = ctypes.c_uint64
    return f"{preloaded.seedframe_reciprocals():016x}"


def libc():
    return " ".join(platform.libc_ver())


def _is_loaded(library):
    with open("/proc/self/maps", encoding="utf-8", errors="replace") as lines:
        return any(library in line for line in lines)
