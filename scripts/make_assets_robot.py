"""A humanoid robot in three postures, in millimetres, as it plays in the RoboCup Standard Platform League."""

import math

from mathutils import Matrix

from make_assets_forms import boxed, egg, grouped, loft, painted, posed, spline, sweep
from make_assets_shapes import arc, common, extrude, lathe, moved, rounded_rectangle, turned

SHELL, JOINT, ACCENT, EYE, NUMBER = range(5)
UV_UNIT = 100.0  # make_assets.py's MM_PER_UV_UNIT
ROBOT_SLOTS = ('shell', 'joint', 'accent', 'eye', 'number')

# Distances between the joints, from the chest's origin between the shoulder blades.
NECK_Z = 126.0
SHOULDER = (0.0, 98.0, 100.0)
UPPER_ARM, FOREARM = 105.0, 64.0
HIP = (0.0, 50.0, -85.0)
THIGH, SHANK, ANKLE_HEIGHT = 100.0, 103.0, 45.0


def disc(radius, depth, edge, segments=28):
    """A flat round with a rounded rim, its face at +x and its back at x = 0."""
    profile = [(0.0, 0.0), (radius, 0.0)] + arc((radius - edge, depth - edge), edge, 0.0, 90.0, 3) + [(0.0, depth)]
    return turned(lathe(profile, segments), 90.0, 'Y')


def ring(inner, outer, depth, edge, segments=28):
    profile = [(inner, 0.0), (outer, 0.0)] + arc((outer - edge, depth - edge), edge, 0.0, 90.0, 3)
    profile += arc((inner + edge, depth - edge), edge, 90.0, 180.0, 2)
    return turned(lathe(profile, segments, closed=True), 90.0, 'Y')


def barrel(radius, length, edge):
    """A rod along y with rounded rims, its middle at the origin."""
    half = length / 2.0
    profile = [(0.0, -half)] + arc((radius - edge, -half + edge), edge, -90.0, 0.0, 3)
    profile += arc((radius - edge, half - edge), edge, 0.0, 90.0, 3) + [(0.0, half)]
    return turned(lathe(profile, 28), 90.0, 'X')


def at(x=0.0, y=0.0, z=0.0):
    return Matrix.Translation((x, y, z))


def turn(degrees, axis):
    return Matrix.Rotation(math.radians(degrees), 4, axis)


class Body:
    """Collects painted pieces, each put in its place by the frame of its limb."""

    def __init__(self):
        self.pieces = []

    def add(self, frame, slot, mesh, uv_of=boxed):
        self.pieces.append(posed(painted(mesh, slot, uv_of), frame))


def head(body, frame):
    middle = frame @ at(4.0, 0.0, 53.0)

    def skull(grow):
        return egg(56.0 + grow, 54.0 + grow, 63.0 + grow, 60.0 + grow, 55.0 + grow, 2.4, 2.3, 40, 24)

    body.add(middle, SHELL, skull(0.0))
    # The face: a dark mask with round ends across the eyes.
    front = turned(turned(extrude(rounded_rectangle(96.0, 40.0, 19.9), 8.0, 90.0), 90.0, 'X'), 90.0, 'Z')
    body.add(middle, JOINT, common(skull(1.2), moved(front, z=3.0)))
    for side in (1.0, -1.0):
        eye = middle @ at(52.3, side * 23.5, 3.0) @ turn(side * 11.0, 'Z')
        body.add(eye, SHELL, ring(12.4, 15.2, 4.2, 1.2, 36))
        dome = [(0.0, 0.0), (12.2, 0.0)] + arc((0.0, -24.0), 27.9, 64.0, 90.0, 5)
        body.add(eye, EYE, turned(lathe(dome, 36), 90.0, 'Y'))
        ear = middle @ at(0.0, side * 57.0, -1.0) @ turn(side * 90.0, 'Z')
        body.add(ear, SHELL, disc(25.0, 11.0, 4.0, 36))
        body.add(ear, ACCENT, ring(13.0, 19.5, 13.0, 1.5, 36))
        body.add(ear, JOINT, disc(13.5, 11.6, 1.0))
    # Two cameras: above the mask and at the mouth.
    for z, out, lean in ((37.5, 48.2, -31.0), (-29.0, 50.6, 24.0)):
        camera = middle @ at(out, 0.0, z) @ turn(lean, 'Y')
        plate = turned(turned(extrude(rounded_rectangle(24.0, 13.0, 6.4), 0.0, 3.4, 1.0), 90.0, 'X'), 90.0, 'Z')
        body.add(camera, JOINT, plate)
        body.add(camera, EYE, disc(3.6, 4.2, 1.2, 20))
    body.add(frame, JOINT, moved(lathe([(0.0, -22.0), (27.0, -22.0)] + arc((24.0, 5.0), 3.0, 0.0, 90.0, 4)
                                       + [(0.0, 8.0)], 28)))


CHEST = [(-48.0, 2.0, 0.0, 42.0, 40.0, 45.0, 2.5), (-15.0, 2.0, 0.0, 46.0, 43.0, 51.0, 2.6),
         (35.0, 2.0, 0.0, 55.0, 48.0, 63.0, 2.7), (78.0, 0.0, 0.0, 55.0, 49.0, 71.0, 2.8),
         (104.0, -1.0, 0.0, 47.0, 44.0, 68.0, 2.7), (120.0, -2.0, 0.0, 33.0, 33.0, 50.0, 2.5)]
PELVIS = [(-122.0, 0.0, 0.0, 22.0, 24.0, 17.0, 2.3), (-104.0, 0.0, 0.0, 35.0, 36.0, 38.0, 2.5),
          (-82.0, 0.0, 0.0, 43.0, 43.0, 56.0, 2.6), (-56.0, 1.0, 0.0, 44.0, 42.0, 56.0, 2.5)]


def torso(body, frame):
    body.add(frame, SHELL, loft(CHEST, (6.0, 10.0), 40))
    # The jersey covers all but a collar and the waist, and has its number on the chest and on the back.
    body.add(frame, ACCENT, jersey(2.4))
    number(body, frame, 1.0, 62.0, 11.0)
    number(body, frame, -1.0, 80.0, 40.0)
    waist = [(-64.0, 1.0, 0.0, 38.0, 36.0, 44.0, 2.4), (-40.0, 2.0, 0.0, 38.0, 36.0, 40.0, 2.4)]
    body.add(frame, JOINT, loft(waist, (2.0, 2.0), 28))
    body.add(frame, SHELL, loft(PELVIS, (8.0, 7.0), 36))
    collar = frame @ at(-2.0, 0.0, 116.0)
    body.add(collar, JOINT, lathe([(0.0, -6.0), (32.0, -6.0)] + arc((29.0, 3.0), 3.0, 0.0, 90.0, 4)
                                  + [(0.0, 6.0)], 28))
    button = frame @ at(54.0, 0.0, 62.0)
    body.add(button, SHELL, ring(8.0, 12.5, 6.5, 2.0))
    body.add(button, EYE, disc(8.2, 5.0, 1.5))


def jersey(grow):
    return loft(CHEST, (2.5, 2.5), 40, grow=grow, between=(-34.0, 106.0))


def number(body, frame, facing, side, z):
    """A square of cloth on the jersey, which one image of a material covers. facing: 1 chest, -1 back."""
    plate = turned(turned(extrude(rounded_rectangle(side, side, 9.0), 30.0, 90.0), 90.0, 'X'), facing * 90.0, 'Z')

    def uv_of(point, _normal, _middle):
        return tuple(UV_UNIT * (0.5 + across / side) for across in (facing * point.y, point.z - z))

    body.add(frame, NUMBER, common(jersey(3.2), moved(plate, z=z)), uv_of)


def arm(body, chest, side, shoulder_pitch, shoulder_roll, elbow_yaw, elbow):
    frame = chest @ at(SHOULDER[0], side * SHOULDER[1], SHOULDER[2])
    inner = frame @ at(0.0, -side * 16.0, 0.0)
    body.add(inner, JOINT, barrel(26.0, 44.0, 4.0))
    frame = frame @ turn(shoulder_pitch, 'Y') @ turn(side * shoulder_roll, 'X')
    body.add(frame, SHELL, egg(34.0, 34.0, 29.0, 35.0, 30.0, 2.3, 2.2, 32, 16))
    body.add(frame @ at(0.0, side * 24.0, 2.0) @ turn(side * 90.0, 'Z'), JOINT, disc(15.0, 6.5, 2.0))
    upper = [(-UPPER_ARM + 12.0, 0.0, 0.0, 22.0, 22.0, 21.0, 2.4), (-68.0, 0.0, 0.0, 25.0, 25.0, 23.5, 2.4),
             (-35.0, 0.0, 0.0, 28.0, 28.0, 25.0, 2.4), (-8.0, 0.0, 0.0, 27.0, 27.0, 24.0, 2.4)]
    body.add(frame, SHELL, loft(upper, (6.0, 6.0), 28))
    body.add(frame, ACCENT, loft(upper, (2.5, 8.0), 28, grow=2.2, between=(-62.0, -8.0)))
    frame = frame @ at(0.0, 0.0, -UPPER_ARM) @ turn(side * elbow_yaw, 'Z')
    body.add(frame, JOINT, barrel(21.0, 36.0, 5.0))
    for end in (1.0, -1.0):
        body.add(frame @ at(0.0, end * 16.5, 0.0) @ turn(end * 90.0, 'Z'), SHELL, disc(13.0, 4.0, 1.5, 24))
    frame = frame @ turn(-elbow, 'Y')
    fore = [(-FOREARM - 2.0, 0.0, 0.0, 20.0, 20.0, 19.0, 2.4), (-40.0, 0.0, 0.0, 26.0, 25.0, 24.0, 2.4),
            (-8.0, 0.0, 0.0, 23.0, 23.0, 22.0, 2.4)]
    body.add(frame, SHELL, loft(fore, (5.0, 7.0), 28))
    body.add(frame, ACCENT, loft(fore, (1.5, 1.5), 28, grow=1.3, between=(-54.0, -46.0)))
    hand(body, frame @ at(0.0, 0.0, -FOREARM), side)


def hand(body, frame, side):
    """Thumb forwards, three fingers bent a little inwards."""
    body.add(frame, JOINT, moved(lathe([(0.0, -9.0), (15.0, -9.0), (15.0, 4.0), (0.0, 4.0)], 24)))
    palm = [(-40.0, 0.0, 0.0, 19.0, 20.0, 11.0, 2.8), (-22.0, 0.0, 0.0, 22.0, 22.0, 14.5, 2.7),
            (-5.0, 0.0, 0.0, 16.0, 16.0, 13.0, 2.5)]
    body.add(frame, SHELL, loft(palm, (5.0, 4.0), 28))
    for x, reach in ((-13.0, 0.92), (0.0, 1.0), (13.0, 0.94)):
        path = spline([(x, 0.0, -34.0), (x * 1.05, -side * 1.0, -50.0 * reach),
                       (x * 1.05, -side * 7.0, -66.0 * reach), (x, -side * 16.0, -76.0 * reach)], 3)
        body.add(frame, JOINT, sweep(path, 6.3, 12, up=(1.0, 0.0, 0.0)))
    path = spline([(16.0, -side * 2.0, -18.0), (27.0, -side * 8.0, -28.0), (30.0, -side * 15.0, -42.0)], 4)
    body.add(frame, JOINT, sweep(path, 6.6, 12, up=(0.0, 1.0, 0.0)))


def leg(body, chest, side, hip_roll, hip_pitch, knee, ankle, ankle_roll):
    frame = chest @ at(HIP[0], side * HIP[1], HIP[2])
    frame = frame @ turn(side * hip_roll, 'X') @ turn(hip_pitch, 'Y')
    body.add(frame, JOINT, egg(37.0, 37.0, 35.0, 36.0, 36.0, 2.1, 2.1, 28, 14))
    body.add(frame @ at(0.0, side * 30.0, 0.0) @ turn(side * 90.0, 'Z'), SHELL, disc(19.0, 10.0, 3.0))
    thigh = [(-THIGH + 7.0, 1.0, 0.0, 30.0, 28.0, 31.0, 2.6), (-70.0, 2.0, 0.0, 35.0, 32.0, 35.0, 2.6),
             (-35.0, 2.0, 0.0, 42.0, 36.0, 39.5, 2.6), (-4.0, 0.0, 0.0, 38.0, 35.0, 37.0, 2.5)]
    body.add(frame, SHELL, loft(thigh, (7.0, 12.0), 32))
    frame = frame @ at(0.0, 0.0, -THIGH)
    body.add(frame, JOINT, barrel(27.0, 60.0, 5.0))
    for end in (1.0, -1.0):
        body.add(frame @ at(0.0, end * 28.0, 0.0) @ turn(end * 90.0, 'Z'), SHELL, disc(18.0, 5.5, 2.0))
    frame = frame @ turn(knee, 'Y')
    shank = [(-SHANK + 9.0, 0.0, 0.0, 28.0, 27.0, 31.0, 2.6), (-66.0, 1.0, 0.0, 34.0, 36.0, 36.0, 2.6),
             (-34.0, 2.0, 0.0, 38.0, 37.0, 38.0, 2.6), (-8.0, 4.0, 0.0, 30.0, 26.0, 33.0, 2.5)]
    body.add(frame, SHELL, loft(shank, (6.0, 8.0), 32))
    body.add(frame, ACCENT, loft(shank, (2.0, 2.0), 32, grow=1.6, between=(-62.0, -38.0)))
    body.add(frame @ at(20.0, 0.0, -1.0), SHELL, egg(15.0, 15.0, 25.0, 24.0, 24.0, 2.3, 2.3, 24, 14))
    frame = frame @ at(0.0, 0.0, -SHANK)
    body.add(frame, JOINT, egg(27.0, 27.0, 27.0, 26.0, 24.0, 2.2, 2.2, 28, 12))
    frame = frame @ turn(ankle, 'Y') @ turn(side * ankle_roll, 'X')
    foot = [(-ANKLE_HEIGHT + 5.0, 22.0, side * 2.0, 80.0, 72.0, 43.0, 2.7),
            (-28.0, 20.0, side * 2.0, 77.0, 70.0, 42.0, 2.6), (-14.0, 10.0, side * 1.0, 58.0, 56.0, 38.0, 2.4),
            (0.0, 2.0, 0.0, 34.0, 40.0, 33.0, 2.3)]
    body.add(frame, SHELL, loft(foot, (2.0, 7.0), 40, 6.0))
    sole = [(-ANKLE_HEIGHT, 22.0, side * 2.0, 80.0, 72.0, 43.0, 2.7),
            (-ANKLE_HEIGHT + 9.0, 22.0, side * 2.0, 82.0, 74.0, 45.0, 2.7)]
    body.add(frame, JOINT, loft(sole, (2.5, 1.5), 40))
    # Bumper at the toes.
    bumper = [(x, y, -24.0) for x, y in arc((22.0, side * 2.0), 1.0, -42.0, 42.0, 14)]
    bumper = [(22.0 + (x - 22.0) * 79.0, side * 2.0 + (y - side * 2.0) * 43.0, z) for x, y, z in bumper]
    body.add(frame, JOINT, sweep(bumper, 5.0, 10))


# Degrees. head: yaw, pitch. Arms: shoulder pitch and roll, elbow yaw and bend. Legs: hip roll and pitch,
# knee, ankle pitch and roll. Left, then right; a right limb mirrors a left one.
STANDING = {'torso': 0.0, 'head': (0.0, 2.0),
            'arms': ((4.0, 7.0, -14.0, 26.0), (4.0, 7.0, -14.0, 26.0)),
            'legs': ((0.0, -13.0, 26.0, -13.0, 0.0), (0.0, -13.0, 26.0, -13.0, 0.0))}
SITTING = {'torso': -7.0, 'head': (8.0, 0.0),
           'arms': ((-6.0, 16.0, -20.0, 62.0), (-6.0, 16.0, -20.0, 62.0)),
           'legs': ((9.0, -90.0, 22.0, -16.0, 0.0), (9.0, -88.0, 18.0, -14.0, 0.0))}
LYING = {'torso': 0.0, 'head': (-14.0, 0.0),
         'arms': ((14.0, 34.0, -10.0, 42.0), (10.0, 22.0, -25.0, 58.0)),
         'legs': ((7.0, -16.0, 34.0, 10.0, 0.0), (5.0, 4.0, 6.0, 14.0, 4.0))}


def robot(posture, root):
    body = Body()
    chest = root @ turn(posture['torso'], 'Y')
    torso(body, chest)
    yaw, pitch = posture['head']
    head(body, chest @ at(0.0, 0.0, NECK_Z) @ turn(yaw, 'Z') @ turn(pitch, 'Y'))
    for side, angles in zip((1.0, -1.0), posture['arms']):
        arm(body, chest, side, *angles)
    for side, angles in zip((1.0, -1.0), posture['legs']):
        leg(body, chest, side, *angles)
    return grouped(body.pieces)


def robot_standing():
    return robot(STANDING, Matrix.Identity(4))


def robot_sitting():
    return robot(SITTING, Matrix.Identity(4))


def robot_lying():
    """On its back, the head towards +x."""
    return robot(LYING, turn(180.0, 'Z') @ turn(-90.0, 'Y'))


ASSETS = [('robot_standing', robot_standing), ('robot_sitting', robot_sitting), ('robot_lying', robot_lying)]
SLOTS = {name: ROBOT_SLOTS for name, _ in ASSETS}
