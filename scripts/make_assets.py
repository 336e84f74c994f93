"""Models the built-in assets and writes them as OBJ files in millimetres.

Run by make_assets.sh: blender --background --factory-startup --python make_assets.py -- OUT [NAME...]
Every part ends centred on its bounding box, in triangles, with UVs of 100 mm a unit. Prints a line a
part: triangles, size, and the edges that do not join exactly two triangles (0: watertight).
"""

import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bmesh
from mathutils import Vector

import make_assets_parts as parts

MM_PER_UV_UNIT = 100.0


def box_uv(point, normal):
    """Projected along the axis that the face looks along most, not mirrored."""
    axis = max(range(3), key=lambda i: (round(abs(normal[i]), 4), i))
    sign = 1.0 if normal[axis] >= 0.0 else -1.0
    if axis == 0:
        return sign * point.y, point.z
    if axis == 1:
        return -sign * point.x, point.z
    return sign * point.x, point.y


def wrapped(map_point):
    """UVs around z: map_point(angle, point) for points whose angle follows the face over the seam."""
    def uv(point, normal, centre):
        if math.hypot(centre.x, centre.y) < 1e-9 or abs(normal.z) > 0.999:
            return box_uv(point, normal)
        middle = math.atan2(centre.y, centre.x)
        on_axis = math.hypot(point.x, point.y) < 1e-6
        angle = middle if on_axis else math.atan2(point.y, point.x)
        angle += 2.0 * math.pi * round((middle - angle) / (2.0 * math.pi))
        return map_point(angle, point)
    return uv


def on_cylinder(angle, point):
    return angle * 25.0, point.z


def on_sphere(angle, point):
    return angle * 25.0, 25.0 * math.asin(max(-1.0, min(1.0, point.z / 25.0)))


def project(point, normal, _centre):
    return box_uv(point, normal)


# Name, shape, UV projection.
ASSETS = [
    ('hex_bolt', parts.hex_bolt, project),
    ('hex_nut', parts.hex_nut, project),
    ('washer', parts.washer, project),
    ('bracket', parts.bracket, project),
    ('housing_cap', parts.housing_cap, project),
    ('pump_cover', parts.pump_cover, project),
    ('gear', parts.gear, project),
    ('bearing', parts.bearing, project),
    ('cube', parts.cube, project),
    ('sphere', parts.sphere, wrapped(on_sphere)),
    ('cylinder', parts.cylinder, wrapped(on_cylinder)),
    ('cone', parts.cone, wrapped(on_cylinder)),
    ('torus', parts.torus, project),
]


def centre(mesh):
    low = Vector(min(v.co[i] for v in mesh.verts) for i in range(3))
    high = Vector(max(v.co[i] for v in mesh.verts) for i in range(3))
    bmesh.ops.translate(mesh, verts=mesh.verts, vec=-(low + high) / 2.0)
    return high - low


def write_obj(path, mesh, uv_of):
    mesh.verts.index_update()
    lines = [f'v {v.co.x:.5f} {v.co.y:.5f} {v.co.z:.5f}' for v in mesh.verts]
    uv_numbers, faces = {}, []
    for face in mesh.faces:
        corners = []
        middle = face.calc_center_median()
        for vertex in face.verts:
            u, v = uv_of(vertex.co, face.normal, middle)
            uv = f'vt {u / MM_PER_UV_UNIT:.5f} {v / MM_PER_UV_UNIT:.5f}'
            number = uv_numbers.setdefault(uv, len(uv_numbers) + 1)
            corners.append(f'{vertex.index + 1}/{number}')
        faces.append('f ' + ' '.join(corners))
    with open(path, 'w', encoding='ascii') as out:
        out.write('\n'.join(lines + list(uv_numbers) + ['usemtl body'] + faces) + '\n')


def make(name, shape, uv_of, folder):
    mesh = shape()
    size = centre(mesh)
    bmesh.ops.triangulate(mesh, faces=mesh.faces, quad_method='BEAUTY', ngon_method='EAR_CLIP')
    mesh.normal_update()
    open_edges = sum(1 for edge in mesh.edges if len(edge.link_faces) != 2)
    volume = mesh.calc_volume(signed=True)
    write_obj(os.path.join(folder, name + '.obj'), mesh, uv_of)
    print(f'{name}: {len(mesh.faces)} triangles, {size.x:.2f} x {size.y:.2f} x {size.z:.2f} mm, '
          f'{volume / 1000.0:.2f} cm3, {open_edges} open edges', flush=True)
    if volume <= 0.0 or open_edges > 0:
        sys.exit(f'{name} is inside out or not closed')
    mesh.free()


def main():
    arguments = sys.argv[sys.argv.index('--') + 1:]
    folder, wanted = arguments[0], arguments[1:]
    for name, shape, uv_of in ASSETS:
        if not wanted or name in wanted:
            make(name, shape, uv_of, folder)


main()
