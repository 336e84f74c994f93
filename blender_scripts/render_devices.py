"""What Cycles can render on, and which denoisers it has."""

import _cycles  # part of Blender
import bpy

_KINDS = ("CPU", "CUDA", "OPTIX", "HIP", "ONEAPI", "METAL")


def present():
    """Kind and name of each device."""
    found = {}
    for kind in _KINDS:
        for name, its_kind, identifier, *_ in _cycles.available_devices(kind):
            found[identifier] = (its_kind, name)
    return list(found.values())


def denoisers():
    names = ["OpenImageDenoise"] if getattr(_cycles, "with_openimagedenoise", False) else []
    return names + ["OptiX"] * any(kind == "OPTIX" for kind, _ in present())


def text_of(devices):
    return ", ".join(f"{kind} ({name})" for kind, name in devices)


def use(kind):
    """Renders on all devices of a kind, "cuda" and the like; what they are, empty if there are none."""
    if kind == "cpu":
        return "cpu"
    chosen = [device for device in present() if device[0] == kind.upper()]
    if chosen:
        preferences = bpy.context.preferences.addons["cycles"].preferences
        preferences.compute_device_type = kind.upper()
        preferences.refresh_devices()
        for device in preferences.devices:
            device.use = device.type == kind.upper()
    return text_of(chosen)
