"""Free forms for make_assets.py: lofts, sweeps and rounded boxes, with a material slot and UVs a piece.

Millimetres, as in make_assets_shapes.py. A piece gets its slot and its UVs from painted() while it still
lies in its own axes; grouped() puts painted pieces into one mesh.
"""

import math

import bmesh
from mathutils import Vector

from make_assets_shapes import cleaned, inset, shell


# ---- UVs and slots --------------------------------------------------------------------------------

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


def around(radius):
    """For wrapped(): the surface of a cylinder of this radius, unrolled."""
    return wrapped(lambda angle, point: (angle * radius, point.z))


def boxed(point, normal, _centre):
    return box_uv(point, normal)


def uv_layer(mesh):
    return mesh.loops.layers.uv.get('uv') or mesh.loops.layers.uv.new('uv')


def painted(mesh, slot, uv_of=boxed):
    """All faces in one slot; slot may also be a function of a face."""
    layer = uv_layer(mesh)
    mesh.normal_update()
    for face in mesh.faces:
        face.material_index = slot(face) if callable(slot) else slot
        middle = face.calc_center_median()
        for loop in face.loops:
            loop[layer].uv = uv_of(loop.vert.co, face.normal, middle)
    return mesh


def posed(mesh, matrix):
    mesh.transform(matrix)
    if matrix.determinant() < 0.0:
        bmesh.ops.reverse_faces(mesh, faces=mesh.faces)
    return mesh


def grouped(pieces):
    """The pieces as one mesh; they may run through each other."""
    out = bmesh.new()
    layer = uv_layer(out)
    for piece in pieces:
        own_layer = uv_layer(piece)
        vertices = {vertex: out.verts.new(vertex.co) for vertex in piece.verts}
        for face in piece.faces:
            made = out.faces.new([vertices[vertex] for vertex in face.verts])
            made.material_index = face.material_index
            for loop, own in zip(made.loops, face.loops):
                loop[layer].uv = own[own_layer].uv
        piece.free()
    return out


# ---- curves ---------------------------------------------------------------------------------------

def spline(points, steps):
    """A smooth curve through the points (Catmull-Rom); tuples of any length."""
    result = []
    for i in range(len(points) - 1):
        b, c = points[i], points[i + 1]
        a = points[i - 1] if i > 0 else [2 * x - y for x, y in zip(b, c)]
        d = points[i + 2] if i + 2 < len(points) else [2 * y - x for x, y in zip(b, c)]
        for k in range(steps):
            t = k / steps
            result.append(tuple(
                0.5 * (2 * q + (r - p) * t + (2 * p - 5 * q + 4 * r - s) * t * t
                       + (3 * q - p - 3 * r + s) * t ** 3) for p, q, r, s in zip(a, b, c, d)))
    return result + [tuple(points[-1])]


def monotone(xs, ys):
    """A smooth function through (xs, ys), xs ascending, that never overshoots (Fritsch-Carlson)."""
    count = len(xs)
    slopes = [(ys[i + 1] - ys[i]) / (xs[i + 1] - xs[i]) for i in range(count - 1)]
    tangents = [slopes[0]]
    for before, after in zip(slopes, slopes[1:]):
        tangents.append(0.0 if before * after <= 0.0 else 2.0 * before * after / (before + after))
    tangents.append(slopes[-1])

    def at(x):
        x = max(xs[0], min(xs[-1], x))
        i = max(0, min(count - 2, sum(1 for other in xs if other <= x) - 1))
        width = xs[i + 1] - xs[i]
        t = (x - xs[i]) / width
        return ((2 * t ** 3 - 3 * t * t + 1) * ys[i] + (t ** 3 - 2 * t * t + t) * width * tangents[i]
                + (3 * t * t - 2 * t ** 3) * ys[i + 1] + (t ** 3 - t * t) * width * tangents[i + 1])
    return at


def superellipse(front, back, side, power, count):
    """Counter-clockwise from +x; points are dense where it is long and where it bends. front and back:
    half axes towards +x and -x."""
    fine = 720

    def point(angle):
        c, s = math.cos(angle), math.sin(angle)
        x = math.copysign(abs(c) ** (2.0 / power), c)
        y = math.copysign(abs(s) ** (2.0 / power), s)
        return (front if x >= 0.0 else back) * x, side * y

    dense = [point(2.0 * math.pi * i / fine) for i in range(fine + 1)]
    lengths, turns, before = [0.0], [0.0], None
    for (x0, y0), (x1, y1) in zip(dense, dense[1:]):
        direction = math.atan2(y1 - y0, x1 - x0)
        bend = 0.0 if before is None else abs((direction - before + math.pi) % (2 * math.pi) - math.pi)
        lengths.append(lengths[-1] + math.hypot(x1 - x0, y1 - y0))
        turns.append(turns[-1] + bend)
        before = direction
    weights = [0.5 * a / lengths[-1] + 0.5 * b / turns[-1] for a, b in zip(lengths, turns)]
    points, k = [], 0
    for i in range(count):
        wanted = i / count
        while weights[k + 1] < wanted:
            k += 1
        share = (wanted - weights[k]) / max(1e-12, weights[k + 1] - weights[k])
        points.append(tuple(p + (q - p) * share for p, q in zip(dense[k], dense[k + 1])))
    return points


# ---- forms ----------------------------------------------------------------------------------------

def loft(sections, caps=(6.0, 6.0), count=40, step=13.0, grow=0.0, between=None):
    """A smooth body along z through superellipses (z, x, y, front, back, side, power), z ascending.

    caps: radii of the roundings at the bottom and at the top. grow: that much thicker all round, for a
    cover over the same sections; between: from one z to another only."""
    zs = [section[0] for section in sections]
    curves = [monotone(zs, [section[i] for section in sections]) for i in range(1, 7)]
    low, high = between or (zs[0], zs[-1])
    heights = [(low + caps[0] * (1.0 - math.cos(a)), caps[0] * (1.0 - math.sin(a)))
               for a in (math.radians(30.0 * i) for i in range(4))]
    spans = max(1, math.ceil((high - caps[1] - low - caps[0]) / step))
    heights += [(low + caps[0] + (high - caps[1] - low - caps[0]) * i / spans, 0.0)
                for i in range(1, spans)]
    heights += [(high - caps[1] * (1.0 - math.cos(a)), caps[1] * (1.0 - math.sin(a)))
                for a in (math.radians(30.0 * i) for i in range(3, -1, -1))]
    rings = []
    for z, shrink in heights:
        x, y, front, back, side, power = [curve(z) for curve in curves]
        outline = superellipse(*(max(0.3, axis + grow - shrink) for axis in (front, back, side)),
                               power, count)
        rings.append([(x + px, y + py, z) for px, py in outline])
    return shell(rings)


def egg(front, back, side, up, down, power=2.0, power_z=2.0, count=40, rows=24):
    """A superellipsoid around the origin with half axes of its own towards each side."""
    rings = []
    for i in range(rows + 1):
        angle = math.radians(-90.0 + 180.0 * i / rows)
        across = max(1e-3, math.cos(angle)) ** (2.0 / power_z)
        z = math.copysign(abs(math.sin(angle)) ** (2.0 / power_z), angle)
        outline = superellipse(front, back, side, power, count)
        rings.append([(x * across, y * across, z * (up if z > 0.0 else down)) for x, y in outline])
    return shell(rings)


def sweep(path, radii, segments=20, flat=1.0, rounded=True, up=(0.0, 0.0, 1.0)):
    """A tube along a path in space. radii: one for each point, or one for all. flat: half axis across
    `up` as a share of the one along it. rounded: the ends are domes, not discs."""
    points = [Vector(point) for point in path]
    if not hasattr(radii, '__len__'):
        radii = [radii] * len(points)
    along = []
    for i in range(len(points)):
        along.append((points[min(i + 1, len(points) - 1)] - points[max(i - 1, 0)]).normalized())
    upward = Vector(up)
    rings = []

    def ring(centre, direction, radius):
        nonlocal upward
        side = direction.cross(upward).normalized()
        upward = side.cross(direction).normalized()
        rings.append([centre + (upward * math.cos(a) + side * (flat * math.sin(a))) * radius
                      for a in (2.0 * math.pi * k / segments for k in range(segments))])

    dome = [math.radians(30.0 * i) for i in range(3)] if rounded else []
    for a in dome:
        a = math.radians(90.0) - a
        ring(points[0] - along[0] * (radii[0] * math.sin(a)), along[0], max(0.02, radii[0] * math.cos(a)))
    for point, direction, radius in zip(points, along, radii):
        ring(point, direction, radius)
    for a in reversed(dome):
        a = math.radians(90.0) - a
        ring(points[-1] + along[-1] * (radii[-1] * math.sin(a)), along[-1],
             max(0.02, radii[-1] * math.cos(a)))
    return shell(rings)


def rounded_box(x0, x1, y0, y1, z0, z1, radius, segments=3):
    mesh = bmesh.new()
    made = bmesh.ops.create_cube(mesh, size=1.0)
    for vertex in made['verts']:
        vertex.co = Vector((x0 if vertex.co.x < 0 else x1, y0 if vertex.co.y < 0 else y1,
                            z0 if vertex.co.z < 0 else z1))
    bmesh.ops.bevel(mesh, geom=mesh.edges[:], offset=radius, offset_type='OFFSET', segments=segments,
                    profile=0.5, affect='EDGES', clamp_overlap=True)
    return cleaned(mesh)


def pillow(outline, z0, z1, radius, steps=4):
    """A plate from a counter-clockwise outline with round edges; its convex corners must be rounder."""
    angles = [math.radians(90.0 * i / steps) for i in range(steps + 1)]
    levels = [(radius * (1.0 - math.sin(a)), z0 + radius * (1.0 - math.cos(a))) for a in angles]
    levels += [(shrink, z1 - (z - z0)) for shrink, z in reversed(levels)]
    return shell([[(x, y, z) for x, y in (inset(outline, shrink) if shrink > 1e-6 else outline)]
                  for shrink, z in levels])
