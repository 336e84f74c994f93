"""Solid modelling for make_assets.py: closed shells in millimetres, joined by Blender's exact booleans.

A shape is a bmesh.types.BMesh. Profiles and outlines are lists of (x, y); a profile's x is the radius
and its y the height. Nothing is random: the same Blender makes the same shapes.
"""

import math

import bmesh
import bpy
from mathutils import Matrix, Vector

MERGE_DISTANCE_MM = 1e-4


# ---- outlines and profiles ------------------------------------------------------------------------

def arc(centre, radius, start_deg, end_deg, steps):
    """Points of a circular arc, both ends included."""
    points = []
    for i in range(steps + 1):
        angle = math.radians(start_deg + (end_deg - start_deg) * i / steps)
        points.append((centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)))
    return points


def circle(radius, steps, centre=(0.0, 0.0)):
    return arc(centre, radius, 0.0, 360.0, steps)[:-1]


def filleted(corners, closed=True, step_deg=10.0):
    """A polyline of (x, y) or (x, y, radius): corners that have a radius become arcs."""
    points = []
    count = len(corners)
    for i, corner in enumerate(corners):
        radius = corner[2] if len(corner) > 2 else 0.0
        if radius == 0.0 or (not closed and i in (0, count - 1)):
            points.append((corner[0], corner[1]))
            continue
        here = Vector(corner[:2])
        to_before = (Vector(corners[i - 1][:2]) - here).normalized()
        to_after = (Vector(corners[(i + 1) % count][:2]) - here).normalized()
        half = math.acos(max(-1.0, min(1.0, to_before.dot(to_after)))) / 2.0
        centre = here + (to_before + to_after).normalized() * (radius / math.sin(half))
        first = here + to_before * (radius / math.tan(half)) - centre
        sweep = math.pi - 2.0 * half
        turn = 1.0 if to_after.x * to_before.y - to_after.y * to_before.x > 0.0 else -1.0
        steps = max(2, math.ceil(math.degrees(sweep) / step_deg))
        start = math.atan2(first.y, first.x)
        for k in range(steps + 1):
            angle = start + turn * sweep * k / steps
            points.append((centre.x + radius * math.cos(angle), centre.y + radius * math.sin(angle)))
    return points


def rounded_rectangle(width, height, radius, step_deg=10.0):
    x, y = width / 2.0, height / 2.0
    return filleted([(-x, -y, radius), (x, -y, radius), (x, y, radius), (-x, y, radius)],
                    step_deg=step_deg)


def inset(outline, distance):
    """Moves every edge of a counter-clockwise outline inwards; for distances smaller than its details."""
    points = []
    for i, here in enumerate(outline):
        here = Vector(here)
        along_1 = (here - Vector(outline[i - 1])).normalized()
        along_2 = (Vector(outline[(i + 1) % len(outline)]) - here).normalized()
        normal_1 = Vector((-along_1.y, along_1.x))
        normal_2 = Vector((-along_2.y, along_2.x))
        bisector = normal_1 + normal_2
        moved = here + bisector * (2.0 * distance / bisector.length_squared)
        points.append((moved.x, moved.y))
    return points


# ---- shells ---------------------------------------------------------------------------------------

def shell(rings, closed=False, caps=True):
    """Quads between rings of equally many (x, y, z); closed: the last ring meets the first."""
    mesh = bmesh.new()
    rows = [[mesh.verts.new(point) for point in ring] for ring in rings]
    pairs = list(zip(rows, rows[1:]))
    if closed:
        pairs.append((rows[-1], rows[0]))
    for lower, upper in pairs:
        for i in range(len(lower)):
            j = (i + 1) % len(lower)
            mesh.faces.new((lower[i], lower[j], upper[j], upper[i]))
    if caps and not closed:
        mesh.faces.new(rows[0][::-1])
        mesh.faces.new(rows[-1])
    return cleaned(mesh)


def cleaned(mesh):
    """Merges points that coincide, drops what that collapses and turns all faces outwards."""
    bmesh.ops.remove_doubles(mesh, verts=mesh.verts, dist=MERGE_DISTANCE_MM)
    bmesh.ops.dissolve_degenerate(mesh, edges=mesh.edges, dist=MERGE_DISTANCE_MM)
    wires = [edge for edge in mesh.edges if not edge.link_faces]
    bmesh.ops.delete(mesh, geom=wires, context='EDGES')
    bmesh.ops.recalc_face_normals(mesh, faces=mesh.faces)
    return mesh


def lathe(profile, segments, closed=False):
    """Turns a profile around z. An open profile begins and ends on the axis; a closed one is a ring."""
    rings = []
    for radius, z in profile:
        ring = []
        for i in range(segments):
            angle = 2.0 * math.pi * i / segments
            ring.append((radius * math.cos(angle), radius * math.sin(angle), z))
        rings.append(ring)
    # A ring of radius 0 merges into the pole.
    return shell(rings, closed=closed, caps=False)


def extrude(outline, z0, z1, chamfer=0.0):
    """A plate from a counter-clockwise outline, its edges chamfered at 45 degrees."""
    def ring(points, z):
        return [(x, y, z) for x, y in points]

    if chamfer == 0.0:
        return shell([ring(outline, z0), ring(outline, z1)])
    small = inset(outline, chamfer)
    return shell([ring(small, z0), ring(outline, z0 + chamfer), ring(outline, z1 - chamfer),
                  ring(small, z1)])


def drill(radius, z0, z1, chamfer=0.0, segments=48):
    """What a drill takes away between z0 and z1, with a countersink of 45 degrees at both ends."""
    beyond = 1.0
    wide = radius + chamfer + (beyond if chamfer > 0.0 else 0.0)
    return lathe([(0.0, z0 - beyond), (wide, z0 - beyond), (radius, z0 + chamfer),
                  (radius, z1 - chamfer), (wide, z1 + beyond), (0.0, z1 + beyond)], segments)


def box(x0, x1, y0, y1, z0, z1, chamfer=0.0):
    return extrude([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], z0, z1, chamfer)


def ball(radius, rings=16, segments=32):
    return lathe(arc((0.0, 0.0), radius, -90.0, 90.0, rings), segments)


def tube(path, radii, segments):
    """Circles of the given radii across a path of points in a plane z = constant; ends capped."""
    rings = []
    for i, here in enumerate(path):
        along = Vector(path[min(i + 1, len(path) - 1)]) - Vector(path[max(i - 1, 0)])
        along.normalize()
        side = Vector((-along.y, along.x, 0.0))
        ring = []
        for k in range(segments):
            angle = 2.0 * math.pi * k / segments
            offset = side * math.cos(angle) + Vector((0.0, 0.0, 1.0)) * math.sin(angle)
            ring.append(Vector(here) + offset * radii[i])
        rings.append(ring)
    return shell(rings)


def thread(radius_at, pitch, depth, z0, z1, segments=64):
    """A rod with a helical ISO thread: at each height, `radius_at(z)` gives the crest's radius and how
    much of the depth there is (0 to 1). Rows of points follow the helix, so crests stay sharp lines."""
    # ISO 68-1: crest P/8, root P/4, flanks 5P/16 each; the root is rounded a little.
    section = [(0.0, 0.0), (0.125, 0.0), (0.4375, 1.0), (0.5625, 1.06), (0.6875, 1.0)]
    turns = math.ceil((z1 - z0) / pitch) + 2
    rings = []
    for turn in range(-1, turns):
        for phase, share in section:
            ring = []
            for i in range(segments + 1):
                lift = i / segments
                z = z0 + pitch * (turn + phase + lift)
                z = max(z0, min(z1, z))
                crest, amount = radius_at(z)
                radius = crest - depth * amount * share
                angle = 2.0 * math.pi * lift
                ring.append((radius * math.cos(angle), radius * math.sin(angle), z))
            rings.append(ring)
    mesh = bmesh.new()
    rows = [[mesh.verts.new(point) for point in ring] for ring in rings]
    for lower, upper in zip(rows, rows[1:]):
        for i in range(segments):
            mesh.faces.new((lower[i], lower[i + 1], upper[i + 1], upper[i]))
    bmesh.ops.remove_doubles(mesh, verts=mesh.verts, dist=MERGE_DISTANCE_MM)
    bmesh.ops.dissolve_degenerate(mesh, edges=mesh.edges, dist=MERGE_DISTANCE_MM)
    bmesh.ops.holes_fill(mesh, edges=[e for e in mesh.edges if e.is_boundary])
    return cleaned(mesh)


# ---- operations -----------------------------------------------------------------------------------

def moved(mesh, x=0.0, y=0.0, z=0.0):
    bmesh.ops.translate(mesh, verts=mesh.verts, vec=(x, y, z))
    return mesh


def turned(mesh, degrees, axis):
    bmesh.ops.rotate(mesh, verts=mesh.verts, cent=(0.0, 0.0, 0.0),
                     matrix=Matrix.Rotation(math.radians(degrees), 3, axis))
    return mesh


def around_z(make, count, start_deg=0.0):
    """Copies of a shape, turned around z in equal steps."""
    return [turned(make(), start_deg + 360.0 * i / count, 'Z') for i in range(count)]


def as_object(mesh, name='part'):
    data = bpy.data.meshes.new(name)
    mesh.to_mesh(data)
    made = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(made)
    return made


def take_object(made):
    """The object's mesh with its modifiers applied; the object is gone afterwards."""
    graph = bpy.context.evaluated_depsgraph_get()
    mesh = bmesh.new()
    mesh.from_object(made, graph)
    data = made.data
    bpy.data.objects.remove(made)
    bpy.data.meshes.remove(data)
    return mesh


def boolean(first, second, operation):
    target, tool = as_object(first), as_object(second)
    modifier = target.modifiers.new('boolean', 'BOOLEAN')
    modifier.operation = operation
    modifier.solver = 'EXACT'
    modifier.object = tool
    result = take_object(target)
    data = tool.data
    bpy.data.objects.remove(tool)
    bpy.data.meshes.remove(data)
    first.free()
    second.free()
    return cleaned(result)


def joined(first, *others):
    for other in others:
        first = boolean(first, other, 'UNION')
    return first


def cut(first, *others):
    for other in others:
        first = boolean(first, other, 'DIFFERENCE')
    return first


def common(first, second):
    return boolean(first, second, 'INTERSECT')


def together(*meshes):
    """Shells that do not touch, as one mesh."""
    data = bpy.data.meshes.new('together')
    out = bmesh.new()
    for mesh in meshes:
        mesh.to_mesh(data)
        out.from_mesh(data)
        mesh.free()
    bpy.data.meshes.remove(data)
    return out


def cast(mesh, voxel_mm, rounds, triangles):
    """The look of a casting: every edge rounded by remeshing and smoothing, then thinned out."""
    made = as_object(mesh)
    mesh.free()
    remesh = made.modifiers.new('remesh', 'REMESH')
    remesh.mode = 'VOXEL'
    remesh.voxel_size = voxel_mm
    smooth = made.modifiers.new('smooth', 'SMOOTH')
    smooth.factor = 0.5
    smooth.iterations = rounds
    result = take_object(made)
    bmesh.ops.triangulate(result, faces=result.faces)
    made = as_object(result)
    decimate = made.modifiers.new('decimate', 'DECIMATE')
    decimate.ratio = min(1.0, triangles / len(result.faces))
    result.free()
    return cleaned(take_object(made))
