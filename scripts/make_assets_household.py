"""Household objects in millimetres, standing on z = 0; none looks the same from two sides."""

import math

import bmesh

from make_assets_forms import around, grouped, loft, painted, pillow, rounded_box, spline, sweep
from make_assets_shapes import (arc, circle, cleaned, common, cut, extrude, filleted, lathe, moved,
                                rounded_rectangle, turned)


def upright(outline, y0, y1):
    """A plate from an outline in (x, z), between y0 and y1."""
    return moved(turned(extrude(outline, -y1, -y0), 90.0, 'X'))


def facing_x(outline, x0, x1, chamfer=0.0):
    """A plate from an outline in (y, z), between x0 and x1."""
    return turned(turned(extrude(outline, x0, x1, chamfer), 90.0, 'X'), 90.0, 'Z')


def ribbed(radius, depth, count, z0, z1):
    """A round with grip ribs, rounded at the top, as caps have."""
    outline = []
    for i in range(count * 6):
        phase = i % 6 / 6.0
        out = radius - depth * (0.5 - 0.5 * math.cos(2.0 * math.pi * phase)) ** 2
        angle = 2.0 * math.pi * i / (count * 6)
        outline.append((out * math.cos(angle), out * math.sin(angle)))
    grip = extrude(outline, z0, z1 - 1.2)
    inner = radius - depth
    top = lathe([(0.0, z0 + 0.5), (inner + 0.3, z0 + 0.5)] + arc((inner - 1.2, z1 - 1.5), 1.5, 0.0, 90.0, 4)
                + [(0.0, z1)], 64)
    return [grip, top]


# ---- mug ------------------------------------------------------------------------------------------

MUG_SLOTS = ('body', 'inside', 'handle', 'band')


def mug():
    """0.3 l; the handle points towards +x."""
    wall, height, radius = 4.0, 98.0, 41.0
    outside = [(0.0, 1.5), (26.0, 1.5), (27.0, 0.0), (31.0, 0.0)]
    outside += arc((33.0, 8.0), 8.0, -90.0, 0.0, 8)[1:] + [(radius, 11.0 + 6.0), (radius, 30.0)]
    outside += [(radius, z) for z in (58.0, 76.0)]
    outside = [(r, z) for r, z in outside]
    rim = arc((radius - wall / 2, height - wall / 2), wall / 2, 0.0, 180.0, 10)
    inside = [(radius - wall, 60.0), (radius - wall, 20.0)]
    inside += arc((radius - wall - 14.0, 20.0), 14.0, 0.0, -90.0, 8)[1:] + [(0.0, 6.0)]

    def slot(face):
        c = face.calc_center_median()
        r = math.hypot(c.x, c.y)
        if r < radius - wall + 0.3 and c.z > 5.5:
            return 1
        return 3 if 58.0 < c.z < 76.0 else 0

    cup = painted(lathe(outside + rim + inside, 96), slot, around(radius))
    path = spline([(38.6, 0.0, 79.0), (50.0, 0.0, 81.5), (65.0, 0.0, 76.0), (71.5, 0.0, 60.0),
                   (69.0, 0.0, 43.0), (58.0, 0.0, 29.0), (45.0, 0.0, 23.0), (38.6, 0.0, 21.0)], 7)
    handle = sweep(path, [8.5 - 1.8 * math.sin(math.pi * i / (len(path) - 1)) for i in range(len(path))],
                   28, flat=0.62, rounded=False, up=(0.0, 1.0, 0.0))
    return grouped([cup, painted(handle, 2)])


# ---- teapot ---------------------------------------------------------------------------------------

TEAPOT_SLOTS = ('body', 'lid', 'handle', 'trim')


def teapot():
    """Spout towards +x, handle towards -x."""
    belly = [(46.0, 0.0), (46.5, 5.0), (57.0, 16.0), (70.0, 36.0), (73.5, 55.0), (68.0, 76.0), (54.0, 92.0),
             (41.5, 99.0)]
    profile = [(0.0, 2.5), (40.0, 2.5), (42.0, 0.0)] + spline(belly, 6) + [(40.0, 101.0), (0.0, 101.0)]
    body = painted(lathe(profile, 96), 0, around(60.0))
    path = spline([(42.0, 0.0, 36.0), (66.0, 0.0, 40.0), (86.0, 0.0, 56.0), (99.0, 0.0, 82.0),
                   (118.0, 0.0, 104.0), (124.0, 0.0, 108.5)], 6)
    count = len(path)
    widths = [21.0 - 12.5 * min(1.0, i / (count - 1) * 1.15) ** 0.8 for i in range(count)]
    spout = sweep(path, widths, 36, rounded=False, up=(0.0, 1.0, 0.0))
    bore = path[count // 2:] + [(132.0, 0.0, 114.0)]
    spout = cut(spout, sweep(bore, [w - 2.4 for w in widths[count // 2:]] + [6.4], 36, rounded=False,
                             up=(0.0, 1.0, 0.0)))
    end = path[-1]
    lip = lathe(circle(1.7, 12, (8.1, 0.0)), 48, closed=True)
    lip = moved(turned(lip, 52.0, 'Y'), *end)
    ear = spline([(-54.0, 0.0, 88.0), (-78.0, 0.0, 97.0), (-103.0, 0.0, 88.0), (-112.0, 0.0, 66.0),
                  (-103.0, 0.0, 44.0), (-84.0, 0.0, 31.0), (-62.0, 0.0, 28.0)], 8)
    handle = sweep(ear, [8.0 - 1.5 * math.sin(math.pi * i / (len(ear) - 1)) for i in range(len(ear))],
                   28, flat=0.72, up=(0.0, 1.0, 0.0))
    cover = [(0.0, 98.0), (43.0, 98.0)] + arc((42.5, 101.0), 2.0, -60.0, 90.0, 8)
    cover += spline([(40.5, 103.6), (32.0, 110.0), (18.0, 116.0), (7.0, 118.0)], 6) + [(0.0, 118.2)]
    lid = lathe(cover, 96)
    knob = spline([(6.0, 116.0), (5.0, 120.0), (7.0, 124.0), (11.5, 129.0), (11.0, 135.0), (6.0, 138.8)], 5)
    knob = lathe([(0.0, 116.0)] + knob + [(0.0, 139.6)], 48)
    # Gilt lines lie a little proud of the glaze.
    ring_1 = lathe(circle(1.3, 12, (44.6, 97.2)), 96, closed=True)
    ring_2 = lathe(circle(1.2, 12, (46.7, 4.5)), 96, closed=True)
    return grouped([body, painted(spout, 0), painted(lid, 1, around(40.0)), painted(handle, 2)]
                   + [painted(mesh, 3) for mesh in (knob, ring_1, ring_2, lip)])


# ---- spray bottle ---------------------------------------------------------------------------------

SPRAY_SLOTS = ('body', 'label', 'cap', 'trigger')


def spray_bottle():
    """The nozzle points towards +x."""
    sections = [(0.0, 0.0, 0.0, 40.0, 40.0, 28.0, 3.0), (30.0, 0.0, 0.0, 41.0, 41.0, 29.0, 3.0),
                (118.0, 0.0, 0.0, 40.0, 40.0, 28.0, 2.9), (140.0, 0.0, 0.0, 34.0, 36.0, 26.5, 2.7),
                (158.0, -1.0, 0.0, 22.0, 26.0, 20.0, 2.3), (172.0, -2.0, 0.0, 15.0, 15.5, 15.0, 2.0),
                (188.0, -2.0, 0.0, 13.5, 13.5, 13.5, 2.0)]
    body = painted(loft(sections, (6.0, 1.0), 64, 4.0), 0)
    label = painted(loft(sections, (0.4, 0.4), 64, 6.0, grow=0.45, between=(26.0, 112.0)), 1)
    ridge = painted(loft(sections, (1.0, 1.0), 64, 6.0, grow=1.0, between=(118.5, 121.5)), 0)
    collar = [painted(moved(mesh, x=-2.0), 2) for mesh in ribbed(18.0, 1.1, 28, 176.0, 194.0)]
    side = filleted([(-16.0, 192.0, 4.0), (12.0, 192.0, 4.0), (14.0, 206.0, 4.0), (38.0, 212.0, 6.0),
                     (51.0, 213.0, 4.0), (51.0, 231.0, 4.0), (22.0, 237.0, 20.0), (-12.0, 236.0, 14.0),
                     (-38.0, 219.0, 7.0), (-30.0, 208.0, 6.0), (-17.0, 207.0, 5.0)], step_deg=12.0)
    head = painted(turned(pillow(side, -11.5, 11.5, 3.2), 90.0, 'X'), 2)
    hollow = [(-22.0, 216.0), (16.0, 216.0), (30.0, 219.0), (24.0, 229.5), (-6.0, 229.5)]
    panels = [painted(turned(pillow(filleted([(x, z, 3.0) for x, z in hollow]), z0, z1, 0.6, 2), 90.0, 'X'), 3)
              for z0, z1 in ((-12.3, -9.0), (9.0, 12.3))]
    nozzle = lathe([(0.0, 0.0), (9.0, 0.0)] + arc((8.0, 8.0), 1.5, 0.0, 90.0, 4)
                   + [(3.0, 9.5), (2.2, 7.0), (0.0, 7.0)], 6 * 8)
    nozzle = painted(moved(turned(nozzle, 90.0, 'Y'), 48.0, 0.0, 221.5), 3)
    lever = spline([(27.0, 0.0, 216.0), (35.0, 0.0, 205.0), (36.0, 0.0, 192.0), (32.5, 0.0, 178.0),
                    (36.0, 0.0, 164.0), (41.0, 0.0, 158.0)], 6)
    lever = painted(sweep(lever, 8.2, 24, flat=0.42, up=(0.0, 1.0, 0.0)), 3)
    return grouped([body, label, ridge, head, nozzle, lever] + collar + panels)


# ---- toy car --------------------------------------------------------------------------------------

CAR_SLOTS = ('body', 'window', 'wheel', 'trim')


def toy_car():
    """Drives towards +x."""
    sections = [(11.0, 0.0, 0.0, 70.0, 68.0, 29.0, 4.5), (20.0, 0.0, 0.0, 74.0, 71.0, 33.0, 4.5),
                (30.0, -1.0, 0.0, 71.0, 70.0, 32.5, 4.2), (38.0, -4.0, 0.0, 62.0, 63.0, 30.0, 3.8),
                (43.0, -8.0, 0.0, 46.0, 54.0, 26.0, 3.4)]
    hull = loft(sections, (3.0, 3.0), 88, 3.5)
    axles, wheel = (44.0, -44.0), 16.0
    for x in axles:
        for y in (-34.0, 34.0):
            well = lathe([(0.0, -14.0), (wheel + 2.5, -14.0), (wheel + 2.5, 14.0), (0.0, 14.0)], 56)
            hull = cut(hull, moved(turned(well, 90.0, 'X'), x, y, wheel - 0.5))
    cabin = [(36.0, -14.0, 0.0, 46.0, 44.0, 27.5, 3.6), (46.0, -14.0, 0.0, 39.0, 41.0, 26.0, 3.5),
             (58.0, -15.0, 0.0, 29.0, 34.0, 23.0, 3.3), (66.0, -16.0, 0.0, 20.0, 25.0, 18.0, 3.0)]
    pieces = [painted(hull, 0), painted(loft(cabin, (1.0, 5.0), 72, 3.0), 0)]

    def glass():
        return loft(cabin, (1.0, 5.0), 72, 3.0, grow=0.5)

    def pane(outline, y0, y1):
        return upright(filleted([(x, z, 2.5) for x, z in outline]), y0, y1)

    for y0, y1 in ((12.0, 40.0), (-40.0, -12.0)):
        pieces.append(painted(common(glass(), pane([(-12.0, 45.5), (15.5, 45.5), (6.5, 58.0), (-12.0, 58.0)],
                                                   y0, y1)), 1))
        pieces.append(painted(common(glass(), pane([(-45.0, 45.5), (-17.0, 45.5), (-17.0, 58.0), (-40.0, 58.0)],
                                                   y0, y1)), 1))
    screen = [(-18.5, 45.5), (18.5, 45.5), (15.5, 59.0), (-15.5, 59.0)]
    screen = [(y, z, 3.0) for y, z in screen]
    pieces.append(painted(common(glass(), facing_x(filleted(screen), 4.0, 40.0)), 1))
    pieces.append(painted(common(glass(), facing_x(filleted(screen), -70.0, -36.0)), 1))
    for x in axles:
        for side in (-1.0, 1.0):
            tyre = filleted([(7.0, -6.0), (wheel, -6.0, 2.5), (wheel, 6.0, 2.5), (7.0, 6.0)])
            tyre = turned(lathe(tyre, 56, closed=True), 90.0, 'X')
            hub = [(0.0, -4.0), (9.8, -4.0), (9.8, 5.0), (8.6, 6.2), (7.4, 5.0), (4.2, 4.4), (3.8, 6.4), (3.0, 7.2),
                   (0.0, 7.4)]
            hub = turned(lathe(hub, 40), -90.0 * side, 'X')
            pieces.append(painted(moved(tyre, x, side * 27.0, wheel), 2))
            pieces.append(painted(moved(hub, x, side * 27.0, wheel), 3))
    axle = [painted(moved(turned(lathe([(0.0, -26.0), (2.5, -26.0), (2.5, 26.0), (0.0, 26.0)], 20), 90.0, 'X'),
                          x, 0.0, wheel), 2) for x in axles]
    for side in (-1.0, 1.0):
        lamp = lathe([(0.0, -5.0), (6.2, -5.0), (6.2, 2.0), (5.2, 3.0), (4.6, 2.4), (0.0, 3.4)], 36)
        pieces.append(painted(moved(turned(lamp, 78.0, 'Y'), 67.4, side * 19.5, 29.0), 3))
    bumpers = [painted(rounded_box(x0, x1, -27.0, 27.0, 13.5, 20.0, 2.4), 3)
               for x0, x1 in ((68.0, 76.5), (-74.0, -66.0))]
    # A spoiler tells the back from the front.
    wing = filleted([(-75.0, 50.5, 1.2), (-58.0, 47.0, 1.2), (-57.0, 49.2, 1.0), (-74.5, 53.5, 1.0)])
    rear = [painted(upright(wing, -27.0, 27.0), 3)]
    rear += [painted(rounded_box(-67.0, -61.0, y - 1.8, y + 1.8, 36.0, 50.0, 1.0, 2), 3) for y in (-19.0, 19.0)]
    return grouped(pieces + axle + bumpers + rear)


# ---- carton ---------------------------------------------------------------------------------------

CARTON_SLOTS = ('body', 'label', 'cap', 'stripe')


def carton():
    """A milk carton with a gable; the large label and the cap look towards +x."""
    half, eaves, ridge = 36.0, 172.0, 206.0
    mesh = bmesh.new()
    low = [mesh.verts.new((x, y, 0.0)) for x, y in ((-half, -half), (half, -half), (half, half), (-half, half))]
    high = [mesh.verts.new((v.co.x, v.co.y, eaves)) for v in low]
    ends = [mesh.verts.new((0.0, y, ridge)) for y in (-half, half)]
    folds = [mesh.verts.new((0.0, y, ridge - 4.0)) for y in (-14.0, 14.0)]
    mesh.faces.new(low[::-1])
    for i in range(4):
        mesh.faces.new((low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]))
    mesh.faces.new((high[1], high[2], ends[1], ends[0]))
    mesh.faces.new((high[3], high[0], ends[0], ends[1]))
    for right, left, end, fold in ((high[1], high[0], ends[0], folds[0]), (high[3], high[2], ends[1], folds[1])):
        mesh.faces.new((left, right, fold))
        mesh.faces.new((right, end, fold))
        mesh.faces.new((left, fold, end))
    bmesh.ops.recalc_face_normals(mesh, faces=mesh.faces)
    upright_edges = [e for e in mesh.edges if all(v.co.z <= eaves for v in e.verts)]
    bmesh.ops.bevel(mesh, geom=upright_edges, offset=1.4, offset_type='OFFSET', segments=3, profile=0.5,
                    affect='EDGES', clamp_overlap=True)
    pieces = [painted(cleaned(mesh), 0)]
    pieces.append(painted(rounded_box(-1.6, 1.6, -half + 0.3, half - 0.3, ridge - 5.0, ridge + 19.0, 0.7, 2), 0))
    # Printed areas: sheets of a quarter of a millimetre.
    out = half + 0.25
    band = rounded_rectangle(2 * out, 2 * out, 1.6)
    pieces.append(painted(extrude(band, 14.0, 30.0), 3))
    pieces.append(painted(extrude(band, 33.0, 36.0), 3))
    front = [(y, z + 102.0) for y, z in rounded_rectangle(60.0, 112.0, 8.0)]
    pieces.append(painted(facing_x(front, half - 1.0, out), 1))
    emblem = [(y, z + 122.0) for y, z in circle(21.0, 64)]
    pieces.append(painted(facing_x(emblem, half - 1.0, out + 0.2), 0))
    # A drop on the emblem, and two lines of print.
    drop = [(0.0, 138.0)] + arc((0.0, 117.0), 10.5, 160.0, 380.0, 28)
    pieces.append(painted(facing_x(drop, half - 1.0, out + 0.4), 3))
    for z, width in ((84.0, 44.0), (72.0, 32.0), (60.0, 38.0)):
        line = [(y, z + dz) for y, dz in rounded_rectangle(width, 6.0, 2.9)]
        pieces.append(painted(facing_x(line, half - 1.0, out + 0.2), 0))
    side = [(x, z + 98.0) for x, z in rounded_rectangle(50.0, 76.0, 5.0)]
    pieces.append(painted(upright(side, half - 1.0, out), 3))
    # The screw cap on the slope of the roof.
    slope = math.degrees(math.atan2(ridge - eaves, half))
    for part in ribbed(14.0, 0.8, 32, 1.5, 13.0) + [lathe([(0.0, -2.0), (16.5, -2.0), (16.5, 1.2), (16.0, 1.8),
                                                           (0.0, 1.8)], 48)]:
        pieces.append(painted(moved(turned(part, slope, 'Y'), half / 2 + 1.0, 0.0,
                                    (eaves + ridge) / 2 - 1.0), 2))
    return grouped(pieces)


ASSETS = [('mug', mug), ('teapot', teapot), ('spray_bottle', spray_bottle), ('toy_car', toy_car),
          ('carton', carton)]
SLOTS = {'mug': MUG_SLOTS, 'teapot': TEAPOT_SLOTS, 'spray_bottle': SPRAY_SLOTS, 'toy_car': CAR_SLOTS,
         'carton': CARTON_SLOTS}
