"""Mesh buffers (docs/formats/mesh-buffer.md) as Blender meshes, read once and kept."""

import math
import os

import bpy
import numpy

import blender_versions
from bounded_cache import BoundedCache

MAX_TRIANGLES = 20_000_000  # of all cached meshes; about 100 bytes each
_MAGIC = b"SFMESH01"
_HEADER_BYTES = 24


class MeshCache:
    def __init__(self, max_triangles=MAX_TRIANGLES):
        self._cache = BoundedCache(max_triangles, bpy.data.meshes.remove)
        self._origins = {}  # sha256 -> what is at 0 in Blender's mesh, where that is not the mesh's 0

    def next_frame(self):
        self._cache.next_frame()

    def trim(self):
        self._cache.trim()

    def get(self, sha256, paths):
        return self._cache.get(sha256, lambda: self._load(sha256, paths))

    def origin(self, sha256):
        """The point of a mesh's own space, metres, that is at 0 in Blender's mesh."""
        return self._origins.get(sha256, (0.0, 0.0, 0.0))

    def _load(self, sha256, paths):
        if sha256 not in paths:
            raise ValueError(f"mesh {sha256} is in the frame spec but not in the request's table")
        buffer = read_buffer(paths[sha256])
        origin = far_middle(buffer["positions"])
        if origin.any():
            buffer["positions"] = (buffer["positions"].reshape(-1, 3) - origin).ravel()
            self._origins[sha256] = tuple(float(x) for x in origin)
        return _make(sha256, buffer)


def far_middle(positions):
    """The middle of a mesh that is far from its origin, whose float32 coordinates tell little but that; else 0. Such
    coordinates minus the middle are without rounding (Sterbenz). The twin does the same."""
    points = positions.reshape(-1, 3)
    low, high = points.min(axis=0), points.max(axis=0)
    middle = (low + high) / numpy.float32(2)
    return numpy.where(abs(middle) > 8 * (high - low).max(), middle, numpy.float32(0))


def _make(sha256, buffer):
    mesh = bpy.data.meshes.new(sha256[:16])
    try:
        _fill(mesh, buffer)
    except Exception:
        bpy.data.meshes.remove(mesh)
        raise
    return mesh, len(buffer["corners"])


def read_buffer(path):
    """The arrays of a mesh buffer; ValueError for anything that Blender could trip over."""
    data = numpy.fromfile(path, dtype=numpy.uint8)
    if len(data) < _HEADER_BYTES or data[:8].tobytes() != _MAGIC:
        raise ValueError(f"{path}: no mesh buffer (it does not begin with {_MAGIC.decode()})")
    vertices, triangles, slots = (int(n) for n in data[8:20].view("<u4"))
    smooth_angle = float(data[20:24].view("<f4")[0])
    expected = _HEADER_BYTES + 12 * vertices + 40 * triangles
    if len(data) != expected:
        raise ValueError(f"{path}: {len(data)} bytes, but its header asks for {expected}")
    if vertices == 0 or triangles == 0 or slots == 0:
        raise ValueError(f"{path}: {vertices} vertices, {triangles} triangles, {slots} slots")

    rest = data[_HEADER_BYTES:]
    positions, rest = rest[:12 * vertices].view("<f4"), rest[12 * vertices:]
    corners, rest = rest[:12 * triangles].view("<u4"), rest[12 * triangles:]
    uvs, material_slots = rest[:24 * triangles].view("<f4"), rest[24 * triangles:].view("<u4")
    if not numpy.isfinite(positions).all() or not numpy.isfinite(uvs).all():
        raise ValueError(f"{path}: a position or UV is not finite")
    if int(corners.max()) >= vertices:
        raise ValueError(f"{path}: a corner names vertex {corners.max()} of {vertices}")
    if int(material_slots.max()) >= slots:
        raise ValueError(f"{path}: a triangle names slot {material_slots.max()} of {slots}")
    if not math.isfinite(smooth_angle) or smooth_angle < 0:
        raise ValueError(f"{path}: smoothing angle {smooth_angle}")
    return {
        "positions": positions,
        "corners": corners.astype(numpy.int32).reshape(-1, 3),
        "uvs": uvs,
        "material_slots": material_slots.astype(numpy.int32),
        "slots": slots,
        "smooth_angle": smooth_angle,
    }


def _fill(mesh, buffer):
    triangles = len(buffer["corners"])
    mesh.vertices.add(len(buffer["positions"]) // 3)
    mesh.loops.add(3 * triangles)
    mesh.polygons.add(triangles)
    mesh.vertices.foreach_set("co", buffer["positions"])
    mesh.loops.foreach_set("vertex_index", buffer["corners"].ravel())
    mesh.polygons.foreach_set("loop_start", numpy.arange(0, 3 * triangles, 3, dtype=numpy.int32))
    blender_versions.set_loop_totals(mesh, numpy.full(triangles, 3, dtype=numpy.int32))
    mesh.uv_layers.new(name="UVMap", do_init=False).data.foreach_set("uv", buffer["uvs"])
    for _ in range(buffer["slots"]):
        mesh.materials.append(None)  # each frame sets its own
    mesh.polygons.foreach_set("material_index", buffer["material_slots"])
    smooth = buffer["smooth_angle"] > 0
    mesh.polygons.foreach_set("use_smooth", numpy.full(triangles, smooth, dtype=bool))
    mesh.update(calc_edges=True)
    if 0 < buffer["smooth_angle"] < math.pi:
        blender_versions.sharpen(mesh, buffer["smooth_angle"])
