"""The built-in parts: one function a part, in millimetres, lying as it would on a table."""

import math

from make_assets_shapes import (arc, around_z, ball, box, cast, circle, common, cut, drill, extrude,
                                filleted, inset, joined, lathe, moved, rounded_rectangle, shell,
                                thread, together, tube, turned)

# M12 coarse thread (ISO 261, ISO 724) and hexagon across flats (ISO 272).
M12_RADIUS = 6.0
M12_PITCH = 1.75
M12_DEPTH = 0.6134 * M12_PITCH
M12_FLATS = 18.0


def hexagon(flats):
    return circle(flats / math.sqrt(3.0), 6)


def chamfered_hexagon(flats, z0, z1, lower, upper):
    """A hexagonal prism whose corners a cone of 30 degrees has turned off, below, above or both."""
    corner = flats / math.sqrt(3.0)
    face = 0.475 * flats
    fall = (corner + 1.0 - face) * math.tan(math.radians(30.0))
    profile = [(0.0, z0)]
    profile += [(face, z0), (corner + 1.0, z0 + fall)] if lower else [(corner + 1.0, z0)]
    profile += [(corner + 1.0, z1 - fall), (face, z1)] if upper else [(corner + 1.0, z1)]
    profile += [(0.0, z1)]
    return common(extrude(hexagon(flats), z0 - 1.0, z1 + 1.0), lathe(profile, 96))


def hex_bolt():
    """M12 x 50 (ISO 4014): standing on its head."""
    head, length, threaded = 7.5, 50.0, 30.0
    tip = head + length

    def radius_at(z):
        chamfer = M12_RADIUS - M12_DEPTH * 1.15 + (tip - z) * 1.0
        runout = max(0.0, min(1.0, (z - (tip - threaded)) / (1.5 * M12_PITCH)))
        crest = min(M12_RADIUS, chamfer)
        at_tip = max(0.0, min(1.0, (tip - z) / (M12_DEPTH * 1.15)))
        return crest, runout * at_tip

    shank = joined(
        thread(radius_at, M12_PITCH, M12_DEPTH, tip - threaded - 1.0, tip),
        lathe([(0.0, head - 1.0)] +
              filleted([(8.0, head - 1.0), (8.0, head), (M12_RADIUS, head + 0.05, 0.8),
                        (M12_RADIUS, tip - threaded - 1.0)], closed=False) +
              [(0.0, tip - threaded - 1.0)], 64))
    washer_face = lathe([(0.0, head - 1.0), (8.3, head - 1.0), (8.3, head + 0.4), (0.0, head + 0.4)], 96)
    hexagonal = chamfered_hexagon(M12_FLATS, 0.0, head, lower=True, upper=False)
    return joined(hexagonal, washer_face, shank)


def hex_nut():
    """M12 (ISO 4032), flat on its face."""
    height = 10.8

    def radius_at(z):
        # No thread at the ends of the tap, which stick out of the nut, so that it closes.
        beyond = max(-z, z - height)
        return M12_RADIUS + 0.05, max(0.0, min(1.0, 2.0 - beyond))

    body = chamfered_hexagon(M12_FLATS, 0.0, height, lower=True, upper=True)
    solid = cut(body, thread(radius_at, M12_PITCH, M12_DEPTH, -2.0, height + 2.0))
    wide = M12_RADIUS + 0.6
    countersink = lathe([(0.0, -1.0), (wide + 1.0, -1.0), (wide - 2.0, 2.0), (0.0, 2.0)], 64)
    other = moved(turned(lathe([(0.0, -1.0), (wide + 1.0, -1.0), (wide - 2.0, 2.0), (0.0, 2.0)], 64),
                         180.0, 'X'), z=height)
    return cut(solid, countersink, other)


def washer():
    """For M12 (ISO 7089)."""
    inner, outer, thickness, chamfer = 6.5, 12.0, 2.5, 0.5
    return lathe([(inner, 0.25), (inner + 0.25, 0.0), (outer - chamfer, 0.0), (outer, chamfer),
                  (outer, thickness - chamfer), (outer - chamfer, thickness),
                  (inner + 0.25, thickness), (inner, thickness - 0.25)], 96, closed=True)


def bracket():
    """An angle of 5 mm steel with a gusset, two round holes below and two slots in the upright."""
    width, foot, height, sheet = 60.0, 50.0, 56.0, 5.0
    side = filleted([(0.0, 0.0, 6.0), (foot, 0.0), (foot, sheet), (sheet, sheet, 3.0),
                     (sheet, height), (0.0, height)])
    # Drawn in (y, z) and extruded along x.
    angle = turned(turned(extrude(side, -width / 2, width / 2, 0.6), 90.0, 'X'), 90.0, 'Z')
    plan = rounded_rectangle(width, foot + 40.0, 9.0)
    front = rounded_rectangle(width, height + 40.0, 9.0)
    angle = common(angle, moved(extrude(plan, -1.0, height + 1.0), y=(foot - 40.0) / 2))
    angle = common(angle, moved(turned(extrude(front, -foot - 1.0, 1.0), 90.0, 'X'),
                                z=(height - 40.0) / 2))
    rib = filleted([(sheet - 0.5, sheet - 0.5), (36.0, sheet - 0.5), (36.0, sheet + 2.0, 1.5),
                    (sheet + 2.0, 40.0, 1.5), (sheet - 0.5, 40.0)])
    gusset = turned(turned(extrude(rib, -2.5, 2.5, 0.6), 90.0, 'X'), 90.0, 'Z')
    solid = joined(angle, gusset)
    for x in (-18.0, 18.0):
        solid = cut(solid, moved(drill(4.5, 0.0, sheet, 0.6), x=x, y=34.0))
        slot = rounded_rectangle(7.0, 18.0, 3.499)
        tool = moved(turned(extrude(slot, -sheet - 1.0, 1.0), 90.0, 'X'), x=x, z=34.0)
        solid = cut(solid, tool)
    return solid


def gear():
    """Spur gear, module 2.5, 24 teeth, face 14 mm, with a web, six holes, a hub and a keyway."""
    outline = involute_outline(module=2.5, teeth=24)
    solid = extrude(outline, 0.0, 14.0, 0.5)
    groove = filleted([(15.0, 4.5, 1.5), (23.5, 4.5, 1.5), (24.6, -1.0), (14.2, -1.0)], step_deg=15.0)
    solid = cut(solid, lathe(groove, 96, closed=True))
    solid = cut(solid, moved(turned(lathe(groove, 96, closed=True), 180.0, 'X'), z=14.0))
    hub = lathe([(0.0, 12.0)] + [(13.4, 12.0), (13.4, 21.2), (12.6, 22.0)] + [(0.0, 22.0)], 96)
    solid = joined(solid, hub)
    solid = cut(solid, drill(7.0, 0.0, 22.0, 0.6, 64), box(-2.5, 2.5, 0.0, 9.6, -1.0, 23.0))
    for hole in around_z(lambda: moved(drill(3.2, 4.5, 9.5, 0.4), x=19.25), 6, 30.0):
        solid = cut(solid, hole)
    return solid


def involute_outline(module, teeth, pressure_deg=20.0, flank_steps=7):
    """Counter-clockwise; involute flanks above the base circle, radial below, filleted roots."""
    pitch_radius = module * teeth / 2.0
    base = pitch_radius * math.cos(math.radians(pressure_deg))
    tip, root = pitch_radius + module, pitch_radius - 1.25 * module

    def involute(angle):
        return math.tan(angle) - angle

    def half_thickness(radius):
        flank = math.acos(min(1.0, base / radius))
        return math.pi / (2.0 * teeth) + involute(math.radians(pressure_deg)) - involute(flank)

    lowest = max(base, root)
    radii = [lowest + (tip - lowest) * i / flank_steps for i in range(flank_steps + 1)]
    corners = []
    for tooth in range(teeth):
        centre = 2.0 * math.pi * tooth / teeth
        foot = half_thickness(lowest)
        half = [(root, -foot, 0.35 * module)] + [(r, -half_thickness(r), 0.0) for r in radii]
        crest = [(tip, 0.0, 0.0)]
        mirrored = [(r, -angle, fillet) for r, angle, fillet in reversed(half)]
        # The root circle's middle keeps the space between two teeth round.
        space = [(root, math.pi / teeth, 0.0)]
        for radius, angle, fillet in half + crest + mirrored + space:
            corners.append((radius * math.cos(centre + angle), radius * math.sin(centre + angle),
                            fillet))
    return filleted(corners, step_deg=20.0)


def housing_cap():
    """A moulded cap of 80 x 52 x 24 mm, open below, with four latches, slots and a raised rim."""
    length, depth, height, wall, corner = 80.0, 52.0, 20.0, 2.2, 9.0

    def rounded_box(shrink, z0, z1, edge):
        """Rounded rectangles, smaller towards the top by a quarter circle of radius `edge`."""
        rings = [(0.0, z0)]
        for x, z in arc((0.0, 0.0), edge, 0.0, 90.0, 9):
            rings.append((edge - x, z1 - edge + z))
        return shell([[(x, y, z) for x, y in
                       rounded_rectangle(length - 2 * (shrink + s), depth - 2 * (shrink + s),
                                         max(0.5, corner - shrink - s), 7.5)] for s, z in rings])

    solid = cut(rounded_box(0.0, 0.0, height, 4.0), rounded_box(wall, -1.0, height - wall, 2.5))
    # A lip around the opening, and the step of the panel on top.
    lip_outer = rounded_rectangle(length + 3.0, depth + 3.0, corner + 1.5, 7.5)
    lip_inner = rounded_rectangle(length - 2 * wall + 1.0, depth - 2 * wall + 1.0, corner - wall, 7.5)
    lip = cut(extrude(lip_outer, 0.0, 3.0, 0.5), extrude(lip_inner, -1.0, 4.0))
    solid = joined(solid, lip)
    panel = rounded_rectangle(52.0, 28.0, 5.0, 7.5)
    solid = cut(solid, extrude(panel, height - 0.7, height + 1.0))
    for i in range(5):
        slot = rounded_rectangle(2.6, 20.0, 1.29, 15.0)
        solid = cut(solid, moved(extrude(slot, height - wall - 2.0, height + 2.0), x=-14.0 + 7.0 * i))
    for x in (-22.0, 22.0):
        for side in (0.0, 180.0):
            solid = joined(solid, turned(moved(latch(), x=x, y=-depth / 2), side, 'Z'))
    for x in (-32.0, 32.0):
        post = lathe([(3.2, 3.0), (3.2, height - 1.0), (1.5, height - 1.0), (1.5, 3.0)], 40, closed=True)
        solid = joined(solid, moved(post, x=x))
    return solid


def latch():
    """A snap hook that hangs from the wall at y = 0, its nose outwards (-y)."""
    side = filleted([(1.8, 6.0), (0.0, 6.0), (0.0, -4.2), (-2.0, -4.9, 0.4), (-2.0, -6.2, 0.4),
                     (0.3, -9.0, 0.6), (1.8, -9.0, 0.5)])
    # Drawn in (y, z) and extruded along x.
    return turned(turned(extrude(side, -4.5, 4.5, 0.35), 90.0, 'X'), 90.0, 'Z')


def pump_cover():
    """A cast water pump cover: flange with six lugs, volute with an outlet, inlet boss and ribs."""
    flange, lug_circle = 54.0, 56.0
    # Five steps of 50 degrees leave a gap for the outlet.
    lug_angles = [105.0 + 50.0 * i for i in range(5)] + [5.0]
    rough = lathe([(0.0, -2.0), (flange, -2.0), (flange, 9.0), (0.0, 9.0)], 128)
    for angle in lug_angles:
        rough = joined(rough, turned(moved(drill(9.0, -1.0, 8.0), x=lug_circle), angle, 'Z'))
    dome = filleted([(0.0, 6.0), (44.0, 6.0), (40.0, 20.0, 9.0), (0.0, 27.0)], closed=False)
    rough = joined(rough, lathe(dome, 128), volute())
    boss = lathe([(0.0, 10.0), (21.0, 10.0), (18.5, 40.0), (0.0, 40.0)], 96)
    rough = joined(rough, boss)
    for angle in (30.0, 90.0, 150.0, 210.0, 270.0):
        rib = filleted([(10.0, 8.0), (51.0, 8.0), (51.0, 11.0), (17.0, 34.0), (10.0, 34.0)])
        plate = turned(extrude(rib, -2.2, 2.2), 90.0, 'X')
        rough = joined(rough, turned(plate, angle, 'Z'))
    solid = cast(rough, voxel_mm=0.8, rounds=8, triangles=34000)
    # What the mill and the drill do afterwards is sharp.
    solid = cut(solid, box(-100.0, 100.0, -100.0, 100.0, -20.0, 0.0),
                box(-100.0, 100.0, -100.0, 100.0, 39.0, 60.0),
                box(-100.0, 100.0, 84.0, 120.0, -1.0, 60.0))
    cavity = filleted([(0.0, -1.0), (37.0, -1.0), (36.0, 13.0, 6.0), (0.0, 17.0)], closed=False)
    groove = [(44.5, -1.0), (47.0, -1.0), (47.0, 1.8), (44.5, 1.8)]
    solid = cut(solid, lathe(cavity, 96), lathe(groove, 120, closed=True))
    solid = cut(solid, lathe([(0.0, 10.0), (12.0, 10.0), (12.0, 38.0), (14.0, 40.0), (0.0, 40.0)], 64))
    outlet = lathe([(0.0, 0.0), (9.5, 0.0), (9.5, 53.0), (11.5, 55.0), (0.0, 55.0)], 64)
    solid = cut(solid, moved(turned(outlet, -90.0, 'X'), x=33.0, y=30.0, z=16.0))
    for angle in lug_angles:
        solid = cut(solid, turned(moved(spotfaced_hole(), x=lug_circle), angle, 'Z'))
    return solid


def volute():
    """The spiral casing: a tube that widens over 300 degrees and leaves along +y at x = 33."""
    steps, path, radii = 60, [], []
    for i in range(steps + 1):
        share = i / steps
        angle = math.radians(-300.0 * (1.0 - share))
        path.append((33.0 * math.cos(angle), 33.0 * math.sin(angle), 16.0))
        radii.append(5.0 + 9.0 * share)
    for y in (4.0, 20.0, 40.0, 60.0, 74.0, 75.0):
        path.append((33.0, y, 16.0))
        radii.append(14.0)
    for y, radius in ((76.5, 17.0), (86.0, 17.0)):
        path.append((33.0, y, 16.0))
        radii.append(radius)
    return tube(path, radii, 48)


def spotfaced_hole():
    """Through 8 mm of flange, the screw head's seat milled flat."""
    return lathe([(0.0, -1.0), (4.4, -1.0), (3.4, 0.0), (3.4, 7.6), (6.8, 7.6), (6.8, 30.0), (0.0, 30.0)],
                 48)


def bearing():
    """Deep-groove ball bearing 6203: 17 x 40 x 12 mm, open, with a riveted cage."""
    width, balls, ball_radius, circle_radius = 12.0, 8, 3.37, 14.25
    groove = arc((circle_radius, width / 2), 3.5, 180.0 - 42.0, 180.0 + 42.0, 12)
    low, high = groove[-1], groove[0]
    inner = [(8.5, 0.6), (9.1, 0.0), (low[0] - 0.3, 0.0), (low[0], 0.3)] + groove[::-1] + [
        (high[0], width - 0.3), (high[0] - 0.3, width), (9.1, width), (8.5, width - 0.6)]
    groove = arc((circle_radius, width / 2), 3.5, -42.0, 42.0, 12)
    low, high = groove[0], groove[-1]
    outer = [(20.0, 0.6), (20.0, width - 0.6), (19.4, width), (high[0] + 0.3, width),
             (high[0], width - 0.3)] + groove[::-1] + [(low[0], 0.3), (low[0] + 0.3, 0.0), (19.4, 0.0)]
    shells = [lathe(inner, 96, closed=True), lathe(outer, 96, closed=True)]
    shells += around_z(lambda: moved(ball(ball_radius, 16, 24), x=circle_radius, z=width / 2), balls)
    return together(*shells, cage(balls, ball_radius, circle_radius, width))


def cage(balls, ball_radius, circle_radius, width):
    """A ribbon between the races with a pocket around each ball."""
    ribbon = lathe([(circle_radius - 1.1, 1.8), (circle_radius + 1.1, 1.8),
                    (circle_radius + 1.1, 10.2), (circle_radius - 1.1, 10.2)], 128, closed=True)
    for pocket in around_z(lambda: moved(ball(ball_radius + 0.12, 16, 24), x=circle_radius,
                                         z=width / 2), balls):
        ribbon = cut(ribbon, pocket)
    return ribbon


def cube():
    half = 25.0
    return box(-half, half, -half, half, 0.0, 50.0, 1.0)


def sphere():
    return ball(25.0, 48, 96)


def cylinder():
    return lathe([(0.0, 0.0)] + filleted([(0.0, 0.0), (25.0, 0.0, 1.0), (25.0, 50.0, 1.0), (0.0, 50.0)],
                                         closed=False)[1:-1] + [(0.0, 50.0)], 128)


def cone():
    return lathe([(0.0, 0.0), (24.6, 0.0), (25.0, 0.4), (24.85, 0.9), (1.2, 49.6), (0.7, 49.92), (0.0, 50.0)],
                 128)


def torus():
    return lathe(circle(8.0, 48, (17.0, 8.0)), 128, closed=True)
