# SPDX-License-Identifier: Apache-2.0
"""The rat's control cage: a lofted body; legs, ears and tail grown out of it as one manifold.

Centimetres, +y up, nose toward +z, the animal's left is +x, feet on y = 0.
"""
import math

import vec
from limbs import ear, leg
from mesh import Mesh, UNIT_CELL

ROWS = 14  # points of a body ring: 0 = back line, then down the left side, 7 = belly line, up the right

# Body rings from rump to nose: z, top, bottom, half width, height of the widest place (0 bottom .. 1 top),
# lean (how far the lower half is set back per unit of height), squareness of the section.
RINGS = [
    # z      top   bottom  half  wide  lean  square
    (-9.30, 4.75, 2.75, 1.00, 0.50, -0.30, 0.00),
    (-8.60, 5.95, 2.10, 1.90, 0.42, -0.25, 0.00),
    (-7.55, 7.05, 1.70, 2.65, 0.38, -0.15, 0.00),
    (-6.30, 7.90, 1.50, 3.10, 0.36, 0.00, 0.01),
    (-3.90, 8.60, 1.40, 3.25, 0.35, 0.00, 0.01),
    (-1.40, 8.45, 1.40, 2.95, 0.37, 0.00, 0.01),
    (1.20, 7.65, 1.50, 2.60, 0.40, 0.00, 0.01),
    (2.80, 7.05, 1.80, 2.35, 0.43, 0.00, 0.01),
    (4.00, 6.80, 2.25, 2.08, 0.45, 0.05, 0.01),
    (4.95, 6.80, 2.50, 2.04, 0.44, 0.10, 0.01),
    (5.65, 6.74, 2.58, 2.08, 0.43, 0.15, 0.01),
    (6.45, 6.50, 2.62, 1.98, 0.43, 0.20, 0.01),
    (7.25, 6.06, 2.68, 1.70, 0.44, 0.25, 0.01),
    (8.00, 5.62, 2.76, 1.42, 0.45, 0.25, 0.02),
    (8.75, 5.28, 2.84, 1.24, 0.46, 0.30, 0.03),
    (9.45, 5.00, 2.92, 1.04, 0.48, 0.22, 0.05),
]
LEG_SEGMENTS = {"hind": 3, "fore": 6}   # ring segment that carries each pair of legs
EAR_SEGMENT = 9
EYE_SEGMENT, EYE_ROW = 11, 2

# Degrees down from the back line of the points 0 .. 7 of a ring, at some z; linear between
ANGLES = [
    (2.0, (0, 26, 51, 77, 103, 128, 154, 180)),
    (5.0, (0, 19, 37, 56, 76, 108, 145, 180)),
    (5.7, (0, 19, 38, 58, 78, 108, 145, 180)),
    (7.0, (0, 22, 42, 68, 92, 119, 150, 180)),
    (9.0, (0, 24, 46, 72, 100, 124, 150, 180)),
]

# Soft swellings: centre on the left side, radius, how far the skin moves out
SWELLINGS = [
    ((3.0, 3.4, -5.0), 2.00, 0.40),    # haunch
    ((2.9, 2.6, -3.6), 1.10, 0.20),    # knee
    ((2.8, 4.6, -1.2), 1.30, -0.22),   # hollow of the flank
    ((2.3, 3.4, 2.0), 1.30, 0.28),     # shoulder
    ((1.9, 4.6, 4.1), 0.90, -0.12),    # behind the ear
    ((1.7, 4.1, 5.9), 0.80, 0.22),     # cheek
    ((0.8, 5.9, 7.1), 0.60, 0.08),     # brow
    ((1.2, 4.2, 9.2), 0.55, 0.16),     # whisker pad
    ((0.9, 3.25, 9.45), 0.35, -0.16),   # line of the mouth
    ((1.0, 3.10, 8.6), 0.35, -0.12),
]


def superellipse(angle, squareness):
    """Unit section point at `angle` from the top, swollen toward its corners."""
    x, y = math.sin(angle), math.cos(angle)
    swell = 1 + squareness * (1 - math.cos(4 * angle)) * 2
    return x * swell, y * swell


def angles_at(z):
    (low, angles), above = ANGLES[0], ANGLES[1:]
    for high, upper in above:
        if z <= high:
            return vec.mix(angles, upper, max(0.0, (z - low) / (high - low)))
        low, angles = high, upper
    return angles


def body_ring(ring):
    z, top, bottom, half, wide, lean, squareness = ring
    widest = bottom + (top - bottom) * wide
    angles = map(math.radians, angles_at(z))
    left = []
    for angle in angles:
        x, y = superellipse(angle, squareness)
        height = top - widest if y > 0 else widest - bottom
        p = (half * x, widest + height * y, z + lean * min(0.0, height * y))
        left.append(swell(p))
    left[0], left[-1] = (0.0,) + left[0][1:], (0.0,) + left[-1][1:]
    return left + [mirror(p) for p in left[-2:0:-1]]


def swell(p):
    outward = vec.unit((p[0], 0.35 * (p[1] - 4.0), 0.0))
    for centre, radius, amount in SWELLINGS:
        p = vec.along(p, outward, amount * vec.bump(p, centre, radius))
    return p


def mirror(p):
    return (-p[0], p[1], p[2])


class Body:
    """The trunk and head, with holes where limbs are to grow; keeps its rings of vertex numbers."""

    def __init__(self, mesh):
        self.mesh = mesh
        self.rings = [mesh.add_points(body_ring(r)) for r in RINGS]
        open_rows = {
            LEG_SEGMENTS["hind"]: (3, 4, 5),
            LEG_SEGMENTS["fore"]: (4, 5),
            EAR_SEGMENT: (1, 2, 3),
            EYE_SEGMENT: (EYE_ROW,),
        }
        for k in range(len(RINGS) - 1):
            rows = open_rows.get(k, ())
            skip = set(rows) | {ROWS - 1 - r for r in rows}
            group = "head" if RINGS[k][0] >= 3.9 else "body"
            mesh.bridge(self.rings[k], self.rings[k + 1], group, "body", k,
                        first_column=ROWS // 2, skip=skip)

    def loop(self, segment, rows, side):
        """The boundary of a hole: its rows on the front ring going down, then back up on the rear ring."""
        front, back = self.rings[segment + 1], self.rings[segment]
        at = [r if side > 0 else (ROWS - r) % ROWS for r in rows]
        return [front[r] for r in at] + [back[r] for r in reversed(at)]


def pinch(mesh, loop, top, bottom, group, chart):
    """Closes the top and bottom of a loop by two quads each; returns the loop left, four points shorter."""
    n, half = len(loop), len(loop) // 2
    x, y = mesh.add_points([top, bottom])
    for row, (middle, centre, step) in enumerate(((0, x, 1), (half, y, -1))):
        a, b = loop[(middle + step) % n], loop[(middle + 2 * step) % n]
        c, d = loop[(middle - step) % n], loop[(middle - 2 * step) % n]
        flip = step < 0
        mesh.add_face((loop[middle], centre, b, a), group, chart,
                      ((1, 2 * row + 1), (1, 2 * row), (2, 2 * row), (2, 2 * row + 1)), flip)
        mesh.add_face((loop[middle], c, d, centre), group, chart,
                      ((1, 2 * row + 1), (0, 2 * row + 1), (0, 2 * row), (1, 2 * row)), flip)
    return [x] + loop[2:half - 1] + [y] + loop[half + 2:n - 1]


def nose(mesh, body):
    """Closes the snout: the upper lip below a small nose pad with two nostrils."""
    loop = pinch(mesh, body.rings[-1], (0, 4.92, 9.86), (0, 2.98, 9.28), "head", "muzzle")
    pad = [(0, 4.80, 10.18), (0.32, 4.74, 10.14), (0.44, 4.44, 10.14), (0.34, 4.10, 10.04), (0.46, 3.48, 9.92),
           (0, 3.30, 9.80)]
    pad += [mirror(p) for p in pad[4:0:-1]]
    tip = mesh.add_points(pad)
    mesh.bridge(loop, tip, "head", "nose_side", 0)
    upper, lower = mesh.add_points([(0, 4.56, 10.36), (0, 4.12, 10.16)])
    columns = {tip[0]: (1, 3), tip[1]: (2, 3), tip[2]: (2, 2), tip[3]: (2, 1), tip[4]: (2, 0), tip[5]: (1, 0),
               tip[6]: (0, 0), tip[7]: (0, 1), tip[8]: (0, 2), tip[9]: (0, 3), upper: (1, 2), lower: (1, 1)}

    def quad(group, vertices):
        mesh.add_face(vertices, group, "nose_tip", [columns[v] for v in vertices])

    quad("nose", (tip[0], upper, tip[2], tip[1]))
    quad("nose", (tip[0], tip[9], tip[8], upper))
    quad("head", (lower, tip[5], tip[4], tip[3]))
    quad("head", (lower, tip[7], tip[6], tip[5]))
    for name, corners in (("nostril_l", (upper, lower, tip[3], tip[2])), ("nostril_r", (upper, tip[8], tip[7], lower))):
        dent(mesh, corners, "nose", name, inset=0.45, depth=0.12)


def dent(mesh, corners, group, chart, inset, depth):
    """Replaces a quad by a sunken smaller one and four walls."""
    points = [mesh.points[v] for v in corners]
    centre = vec.mean(points)
    inward = vec.unit(vec.cross(vec.sub(points[3], points[1]), vec.sub(points[2], points[0])))
    floor = mesh.add_points(vec.along(vec.mix(p, centre, inset), inward, depth) for p in points)
    outer, inner = ((0, 0), (0, 3), (3, 3), (3, 0)), ((1, 1), (1, 2), (2, 2), (2, 1))
    mesh.add_face(floor, group, chart, inner)
    for i in range(4):
        j = (i + 1) % 4
        mesh.add_face((corners[i], corners[j], floor[j], floor[i]), group, chart,
                      (outer[i], outer[j], inner[j], inner[i]))


def eye_sockets(mesh, body):
    for side, name in ((1, "socket_l"), (-1, "socket_r")):
        front_top, front_low, back_low, back_top = body.loop(EYE_SEGMENT, (EYE_ROW, EYE_ROW + 1), side)
        corners = (front_top, front_low, back_low, back_top)
        dent(mesh, corners if side > 0 else corners[::-1], "head", name, inset=0.40, depth=0.22)


def tail_centre(t):
    """The tail's axis at rest, t = 0 at the root, 1 at the tip: down to the ground and gently aside."""
    z = -9.5 - 17.0 * t
    y = 0.45 + 3.10 * (1 - vec.smoothstep(-0.25, 0.62, t)) / (1 - vec.smoothstep(-0.25, 0.62, 0.0))
    return (1.1 * math.sin(3.6 * t) * t, y - 0.25 * t, z)


def tail(mesh, body):
    first = body.rings[0]
    ring = [first[0]] + first[:0:-1]     # seen from behind
    ring = pinch(mesh, ring, (0, 4.50, -9.75), (0, 3.00, -9.75), "body", "rump")
    root = [(0, 4.30, -10.1), (-0.42, 4.10, -10.1), (-0.62, 3.80, -10.1), (-0.62, 3.46, -10.1), (-0.42, 3.14, -10.1),
            (0, 2.94, -10.1)]
    root += [mirror(p) for p in root[4:0:-1]]
    loop = mesh.add_points(root)
    mesh.bridge(ring, loop, "tail", "tail_root", 0)
    loop = pinch(mesh, loop, (0, 4.08, -10.5), (0, 2.90, -10.5), "tail", "tail_pinch")
    steps = 9
    for k in range(steps):
        t = 0.09 + 0.91 * (k / (steps - 1)) ** 0.9
        centre = tail_centre(t)
        axis = vec.unit(vec.sub(tail_centre(t + 0.01), tail_centre(t - 0.01)))
        across = vec.unit(vec.cross((0, 1, 0), axis))
        up = vec.cross(axis, across)
        radius = 0.60 * (1 - t) ** 0.8 + 0.13
        points = []
        for i in range(6):
            angle = math.radians(60 * i)
            points.append(vec.add(centre, vec.scale(up, radius * math.cos(angle)),
                                  vec.scale(across, radius * math.sin(angle))))
        upper = mesh.add_points(points)
        mesh.bridge(loop, upper, "tail", "tail", k)
        loop = upper
    top, r1, r2, bottom, l2, l1 = loop
    mesh.add_face((top, bottom, r2, r1), "tail", "tail_tip", UNIT_CELL)
    mesh.add_face((top, l1, l2, bottom), "tail", "tail_tip", ((0, 0), (-1, 0), (-1, 1), (0, 1)))


def build():
    mesh = Mesh()
    body = Body(mesh)
    nose(mesh, body)
    eye_sockets(mesh, body)
    tail(mesh, body)
    for side in (1, -1):
        ear(mesh, body.loop(EAR_SEGMENT, (1, 2, 3, 4), side), side)
        leg(mesh, body.loop(LEG_SEGMENTS["hind"], (3, 4, 5, 6), side), side, "hind")
        leg(mesh, body.loop(LEG_SEGMENTS["fore"], (4, 5, 6), side), side, "fore")
    return mesh
