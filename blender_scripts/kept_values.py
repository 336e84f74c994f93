"""Values that Blender keeps as they are given. Beyond a property's limits it takes the limit, without a word."""

import struct


def put(owner, **values):
    """Sets numbers of `owner`; ValueError when Blender does not keep one, rounded to a float32."""
    for name, value in values.items():
        setattr(owner, name, value)
        kept = getattr(owner, name)
        if kept != _as_float32(value):
            raise ValueError(f"Blender cannot render {name} = {value:g}: it makes {kept:g} of it")


def _as_float32(value):
    try:
        return struct.unpack("f", struct.pack("f", value))[0]
    except OverflowError:
        return float("inf")
