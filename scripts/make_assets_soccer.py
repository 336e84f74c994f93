"""What robots play soccer with, in millimetres: the ball and the goal of the RoboCup Standard Platform League
(rules of 2017)."""

import math

import bmesh
from mathutils import Vector

from make_assets_forms import egg, grouped, painted, posed, spline, sweep, uv_layer
from make_assets_shapes import lathe, moved, turned

# ---- ball -----------------------------------------------------------------------------------------

WHITE, BLACK = range(2)
BALL_SLOTS = ('white', 'black')


def truncated_icosahedron():
    """Its faces as lists of corners on the unit sphere, counter-clockwise: 12 pentagons, 20 hexagons."""
    golden = (1.0 + math.sqrt(5.0)) / 2.0
    tips = [Vector(p) for a in (-1.0, 1.0) for b in (-golden, golden)
            for p in ((0.0, a, b), (a, b, 0.0), (b, 0.0, a))]

    def is_edge(a, b):
        return abs((a - b).length - 2.0) < 1e-6

    def around(normal, points):
        first = (points[0] - normal * points[0].dot(normal)).normalized()
        second = normal.cross(first)
        return sorted(points, key=lambda p: math.atan2(p.dot(second), p.dot(first)))

    faces = []
    for tip in tips:
        faces.append(around(tip.normalized(), [(2.0 * tip + other).normalized() for other in tips
                                               if is_edge(tip, other)]))
    for i, a in enumerate(tips):
        for j, b in enumerate(tips[i + 1:], i + 1):
            for c in tips[j + 1:]:
                if is_edge(a, b) and is_edge(b, c) and is_edge(a, c):
                    corners = [(2.0 * p + q).normalized() for p in (a, b, c) for q in (a, b, c) if p is not q]
                    faces.append(around((a + b + c).normalized(), corners))
    return faces


def spl_ball(radius=50.0, steps=8, seam=0.7):
    """Between its patches it is `seam` deep."""
    mesh = bmesh.new()
    layer = uv_layer(mesh)
    known = {}

    def vertex(direction, depth):
        key = tuple(round(x * 1e5) for x in direction)
        # Neighbours compute the points of their seam from other ends.
        if key not in known:
            near = [tuple(k + d for k, d in zip(key, step)) for step in
                    ((x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1))]
            known[key] = next((known[k] for k in near if k in known), None) or mesh.verts.new(
                direction * (radius - depth))
        return known[key]

    for corners in truncated_icosahedron():
        middle = sum(corners, Vector()).normalized()
        right = (corners[0] - middle * corners[0].dot(middle)).normalized()
        upward = middle.cross(right)
        for a, b in zip(corners, corners[1:] + corners[:1]):
            rows = [[vertex((middle + (a - middle) * ((i - k) / steps) + (b - middle) * (k / steps)).normalized(),
                            seam if i == steps else 0.0)
                     for k in range(i + 1)] for i in range(steps + 1)]
            triangles = [(rows[i][k], rows[i + 1][k], rows[i + 1][k + 1])
                         for i in range(steps) for k in range(i + 1)]
            triangles += [(rows[i][k], rows[i + 1][k + 1], rows[i][k + 1])
                          for i in range(1, steps) for k in range(i)]
            for triangle in triangles:
                face = mesh.faces.new(triangle)
                face.material_index = BLACK if len(corners) == 5 else WHITE
                for loop in face.loops:
                    loop[layer].uv = loop.vert.co.dot(right), loop.vert.co.dot(upward)
    # One black patch on top, as a ball is usually drawn.
    tip = Vector((0.0, 1.0, (1.0 + math.sqrt(5.0)) / 2.0)).normalized()
    return posed(mesh, tip.rotation_difference(Vector((0.0, 0.0, 1.0))).to_matrix().to_4x4())


# ---- goal -----------------------------------------------------------------------------------------

FRAME, NET = range(2)
GOAL_SLOTS = ('frame', 'net')
POST_RADIUS, GOAL_WIDTH, GOAL_HEIGHT, GOAL_DEPTH = 50.0, 1500.0, 800.0, 500.0


def spl_goal_post():
    """One post, its axis at the origin. The crossbar's end sits in the round corner on it."""
    top = GOAL_HEIGHT + POST_RADIUS
    post = lathe([(0.0, 0.0), (POST_RADIUS, 0.0), (POST_RADIUS, top), (0.0, top)], 48)
    corner = moved(egg(*[POST_RADIUS * 1.002] * 5, count=48), z=top)
    return grouped([painted(post, 0), painted(corner, 0)])


def spl_goal():
    """All but the posts, whose axes stand at x = 0: the crossbar, and the net towards -x. Width and height are
    the opening's."""
    y, top = GOAL_WIDTH / 2.0 + POST_RADIUS, GOAL_HEIGHT + POST_RADIUS
    pieces = []
    bar = lathe([(0.0, -y), (POST_RADIUS, -y), (POST_RADIUS, y), (0.0, y)], 48)
    pieces.append(painted(moved(turned(bar, 90.0, 'X'), z=top), FRAME))

    # The side of the net, from the crossbar over the stay's end down to the bar on the ground.
    shoulder = 190.0
    side_line = [(0.0, top + 20.0), (-shoulder, top - 10.0), (-GOAL_DEPTH, 14.0)]
    stay_radius = 11.0
    corner = spline([(-shoulder + 60.0, top + 1.0), (-shoulder, top - 14.0), (-shoulder - 22.0, top - 70.0)], 6)
    for side in (-y, y):
        stay = [(x, side, z) for x, z in [(0.0, top + 12.0)] + corner + [(-GOAL_DEPTH, 14.0)]]
        pieces.append(painted(sweep(stay, stay_radius, 16, up=(0.0, 1.0, 0.0)), NET))
        pieces.append(painted(sweep([(0.0, side, 12.0), (-GOAL_DEPTH, side, 12.0)], 12.0, 16, up=(0.0, 1.0, 0.0)), NET))
    pieces.append(painted(sweep([(-GOAL_DEPTH, -y, 12.0), (-GOAL_DEPTH, y, 12.0)], 12.0, 16), NET))
    pieces.append(painted(sweep([(-shoulder, -y, top - 14.0), (-shoulder, y, top - 14.0)], 9.0, 16), NET))
    pieces += net(y, side_line)
    return grouped(pieces)


def net(y, side_line, mesh_size=60.0, radius=2.2):
    """Strands of three sides over the back and both sides, slack between their frames."""
    lengths = [math.dist(a, b) for a, b in zip(side_line, side_line[1:])]
    total = sum(lengths)

    def along(share):
        rest = share * total
        for (a, b), length in zip(zip(side_line, side_line[1:]), lengths):
            if rest <= length or (a, b) == (side_line[-2], side_line[-1]):
                t = min(1.0, rest / length)
                return a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t
            rest -= length

    def back(s, t):
        x, z = along(s)
        # Between the frames it hangs in and down; at the shoulder it lies on the bar.
        first = lengths[0] / total
        part = s / first if s < first else (s - first) / (1.0 - first)
        hollow = math.sin(math.pi * part) * math.sin(math.pi * t) ** 0.7
        slack = 18.0 if s < first else 34.0
        return Vector((x + (hollow * slack if s > first else 0.0), y * (2.0 * t - 1.0), z - hollow * slack * 0.8))

    def strand(points):
        return painted(sweep(points, radius, 4, rounded=False, up=(0.3, 0.5, 0.8)), NET)

    pieces = []
    columns, rows = round(2.0 * y / mesh_size), round(total / mesh_size)
    for i in range(1, columns):
        pieces.append(strand([back(k / 22.0, i / columns) for k in range(23)]))
    for k in range(1, rows):
        pieces.append(strand([back(k / rows, i / 26.0) for i in range(27)]))
    for side in (-y, y):
        inward = -math.copysign(22.0, side)

        def wall(x, z):
            bulge = math.sin(math.pi * min(1.0, -x / GOAL_DEPTH)) * math.sin(math.pi * min(1.0, z / side_line[0][1]))
            return Vector((x, side + inward * bulge, z))

        (x0, z0), (x1, z1), (x2, z2) = side_line
        for i in range(1, int(GOAL_DEPTH / mesh_size) + 1):
            x = -i * mesh_size
            z = z0 + (z1 - z0) * x / x1 if x > x1 else z1 + (z2 - z1) * (x - x1) / (x2 - x1)
            if z > 60.0:
                pieces.append(strand([wall(x, 12.0 + (z - 12.0) * k / 12.0) for k in range(13)]))
        for i in range(1, int(z0 / mesh_size)):
            z = 12.0 + i * mesh_size
            x = x1 + (x2 - x1) * (z1 - z) / (z1 - z2)
            pieces.append(strand([wall(x * k / 12.0, z) for k in range(13)]))
    return pieces


ASSETS = [('spl_ball', spl_ball), ('spl_goal_post', spl_goal_post), ('spl_goal', spl_goal)]
SLOTS = {'spl_ball': BALL_SLOTS, 'spl_goal_post': ('post',), 'spl_goal': GOAL_SLOTS}
