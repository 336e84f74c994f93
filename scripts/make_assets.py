"""Models the built-in assets and writes them as OBJ files in millimetres.

Run by make_assets.sh: blender --background --factory-startup --python make_assets.py -- OUT [NAME...]
Every asset ends centred on its bounding box, in triangles, with UVs of 100 mm a unit and a usemtl group
for each of its material slots. Prints a line an asset: triangles of each slot, size, connected pieces,
and the edges that do not join exactly two triangles (0: watertight).
"""

import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bmesh
from mathutils import Vector

import make_assets_field as field
import make_assets_household as household
import make_assets_parts as parts
import make_assets_robot as robot
import make_assets_soccer as soccer
from make_assets_forms import box_uv, uv_layer, wrapped

MM_PER_UV_UNIT = 100.0


def on_cylinder(angle, point):
    return angle * 25.0, point.z


def on_sphere(angle, point):
    return angle * 25.0, 25.0 * math.asin(max(-1.0, min(1.0, point.z / 25.0)))


def project(point, normal, _centre):
    return box_uv(point, normal)


# Name, shape, UV projection. None: the shape has UVs of its own.
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
] + [(name, shape, None)
     for name, shape in robot.ASSETS + soccer.ASSETS + field.ASSETS + household.ASSETS]

# The material slots, in the order of the faces' material_index. All others: ONE_SLOT.
ONE_SLOT = ('body',)
SLOTS = {**robot.SLOTS, **soccer.SLOTS, **field.SLOTS, **household.SLOTS}


def centre(mesh):
    low = Vector(min(v.co[i] for v in mesh.verts) for i in range(3))
    high = Vector(max(v.co[i] for v in mesh.verts) for i in range(3))
    bmesh.ops.translate(mesh, verts=mesh.verts, vec=-(low + high) / 2.0)
    return high - low


def corner_uvs(mesh, face, uv_of):
    if uv_of is None:
        layer = uv_layer(mesh)
        return [loop[layer].uv for loop in face.loops]
    middle = face.calc_center_median()
    return [uv_of(vertex.co, face.normal, middle) for vertex in face.verts]


def write_obj(path, mesh, uv_of, slots):
    mesh.verts.index_update()
    lines = [f'v {v.co.x:.5f} {v.co.y:.5f} {v.co.z:.5f}' for v in mesh.verts]
    uv_numbers, groups = {}, [[f'usemtl {slot}'] for slot in slots]
    for face in mesh.faces:
        corners = []
        for vertex, (u, v) in zip(face.verts, corner_uvs(mesh, face, uv_of)):
            uv = f'vt {u / MM_PER_UV_UNIT:.5f} {v / MM_PER_UV_UNIT:.5f}'
            number = uv_numbers.setdefault(uv, len(uv_numbers) + 1)
            corners.append(f'{vertex.index + 1}/{number}')
        groups[face.material_index].append('f ' + ' '.join(corners))
    with open(path, 'w', encoding='ascii') as out:
        out.write('\n'.join(lines + list(uv_numbers) + sum(groups, [])) + '\n')


def piece_volumes(mesh):
    """The signed volume of each connected piece of a triangulated mesh."""
    mesh.faces.index_update()
    volumes, seen = [], set()
    for first in mesh.faces:
        if first.index in seen:
            continue
        seen.add(first.index)
        volume, waiting = 0.0, [first]
        while waiting:
            face = waiting.pop()
            a, b, c = (vertex.co for vertex in face.verts)
            volume += a.dot(b.cross(c)) / 6.0
            for edge in face.edges:
                for other in edge.link_faces:
                    if other.index not in seen:
                        seen.add(other.index)
                        waiting.append(other)
        volumes.append(volume)
    return volumes


def make(name, shape, uv_of, folder):
    mesh = shape()
    slots = SLOTS.get(name, ONE_SLOT)
    if slots == ONE_SLOT:
        for face in mesh.faces:
            face.material_index = 0
    size = centre(mesh)
    bmesh.ops.triangulate(mesh, faces=mesh.faces, quad_method='BEAUTY', ngon_method='EAR_CLIP')
    mesh.normal_update()
    bad_edges = sum(1 for edge in mesh.edges if not edge.is_contiguous or len(edge.link_faces) != 2)
    volumes = piece_volumes(mesh)
    write_obj(os.path.join(folder, name + '.obj'), mesh, uv_of, slots)
    counts = [sum(1 for face in mesh.faces if face.material_index == i) for i in range(len(slots))]
    print(f'{name}: {len(mesh.faces)} triangles ({", ".join(map("{} {}".format, slots, counts))}), '
          f'{size.x:.2f} x {size.y:.2f} x {size.z:.2f} mm, {sum(volumes) / 1000.0:.2f} cm3, '
          f'{len(volumes)} pieces, {bad_edges} bad edges', flush=True)
    if min(volumes) <= 0.0 or bad_edges > 0:
        sys.exit(f'{name} is inside out or not closed')
    mesh.free()


def main():
    arguments = sys.argv[sys.argv.index('--') + 1:]
    folder, wanted = arguments[0], arguments[1:]
    for name, shape, uv_of in ASSETS:
        if not wanted or name in wanted:
            make(name, shape, uv_of, folder)


main()
