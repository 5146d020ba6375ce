# SPDX-License-Identifier: Apache-2.0
"""Ears, legs, feet and toes: tubes grown from loops of the body, described for the left side."""
import vec

SUFFIX = {1: "_l", -1: "_r"}


class Tube:
    """Grows ring after ring from a loop; mirrors and turns the winding for the right side."""

    def __init__(self, mesh, loop, side, flip):
        self.mesh, self.loop, self.side = mesh, loop, side
        self.flip = flip if side > 0 else not flip
        self.row = 0

    def grow(self, points, group, chart, skip=()):
        """Adds one ring; returns the loops of the columns left open."""
        ring = self.mesh.add_points((self.side * x, y, z) for x, y, z in points)
        self.mesh.bridge(self.loop, ring, group, chart, self.row, self.flip, skip=skip)
        lower, self.loop, self.row, n = self.loop, ring, self.row + 1, len(ring)
        return [(lower[c], ring[c], ring[(c + 1) % n], lower[(c + 1) % n]) for c in skip]

    def close(self, group, chart):
        """Caps a flat ring of 2n points by n - 1 quads between its front and back halves."""
        n = len(self.loop) // 2
        front, back = self.loop[:n], self.loop[:n - 1:-1]
        for i in range(n - 1):
            corners = ((i, self.row), (i, self.row + 1), (i + 1, self.row + 1), (i + 1, self.row))
            self.mesh.add_face((front[i], back[i], back[i + 1], front[i + 1]), group, chart, corners, self.flip)


# ---- ears ----

EAR_AXIS = vec.unit((0.56, 0.78, -0.32))     # from the root to the rim
EAR_FACING = vec.unit((0.64, 0.04, 0.77))    # where the cup opens
EAR_ROOT = (1.52, 6.02, 5.32)
# distance along the axis, half width, thickness, depth of the cup, how far the side rims lean forward
EAR_RINGS = [
    (0.20, 0.58, 0.38, 0.14, 0.02),
    (0.54, 0.88, 0.22, 0.38, 0.08),
    (0.98, 1.08, 0.15, 0.50, 0.12),
    (1.46, 1.06, 0.12, 0.44, 0.10),
    (1.86, 0.76, 0.10, 0.26, 0.04),
    (2.04, 0.38, 0.09, 0.08, -0.02),
]
EAR_COLUMNS = (-1.0, -0.42, 0.42, 1.0)


def ear(mesh, loop, side):
    across = vec.unit(vec.cross(EAR_AXIS, EAR_FACING))          # from the inner rim to the outer
    facing = vec.cross(across, EAR_AXIS)
    tube = Tube(mesh, loop, side, flip=True)
    name = "ear" + SUFFIX[side]
    for height, half, thickness, cup, lean in EAR_RINGS:
        def place(t, front):
            depth = front * thickness / 2 - cup * (1 - t * t) + lean * t * t
            at = vec.along(EAR_ROOT, EAR_AXIS, height - 0.12 * t)
            return vec.along(vec.along(at, across, half * t), facing, depth)
        front = [place(t, 1) for t in EAR_COLUMNS]
        back = [place(t, -1) for t in reversed(EAR_COLUMNS)]
        tube.grow(front + back, name, name)
    tube.close(name, name + "_rim")


# ---- legs ----

# Rings of each leg: centre, half width across, half depth, direction of the front (which becomes the top of the foot)
LEGS = {
    "hind": [
        ((2.72, 1.72, -4.70), 0.95, 1.40, (0, 0.20, 0.98)),
        ((2.72, 1.06, -5.25), 0.60, 0.80, (0, 0.40, 0.92)),
        ((2.70, 0.60, -5.72), 0.46, 0.58, (0, 0.75, 0.66)),
        ((2.74, 0.40, -4.70), 0.48, 0.36, (0, 1.00, 0.12)),
        ((2.88, 0.28, -3.65), 0.60, 0.25, (0, 1.00, 0.00)),
    ],
    "fore": [
        ((1.78, 1.75, 2.00), 0.56, 0.66, (0, 0.10, 1.00)),
        ((1.72, 1.10, 2.20), 0.37, 0.40, (0, 0.10, 1.00)),
        ((1.66, 0.56, 2.45), 0.29, 0.32, (0, 0.60, 0.80)),
        ((1.68, 0.28, 2.95), 0.40, 0.24, (0, 1.00, 0.15)),
        ((1.72, 0.22, 3.38), 0.44, 0.19, (0, 1.00, 0.00)),
    ],
}
SECTION = {8: ((1.0, 0.55), (0.42, 1.0), (-0.42, 1.0), (-1.0, 0.55)), 6: ((1.0, 0.5), (0.0, 1.0), (-1.0, 0.5))}
TOE_LENGTH = {"hind": 1.10, "fore": 0.90}
TOE_SPREAD = {"hind": (0.30, 0.02, -0.26), "fore": (0.20, -0.22)}    # sideways slope of the foremost toes
SIDE_TOES = {"hind": (0.62, 0.72), "fore": (0.70, 0.70)}             # length of the outer and the inner one


def leg(mesh, loop, side, pair):
    suffix = SUFFIX[side]
    name, foot = "leg_" + pair + suffix, "foot_" + pair + suffix
    tube = Tube(mesh, loop, side, flip=True)
    section = SECTION[len(loop)]
    columns = len(section)
    toes = []
    for k, (centre, half, depth, front) in enumerate(LEGS[pair]):
        front = vec.unit(front)

        def place(x, y):
            return vec.along(vec.add(centre, (half * x, 0, 0)), front, depth * y)
        ring = [place(x, y) for x, y in section] + [place(x, -y) for x, y in reversed(section)]
        last = k == len(LEGS[pair]) - 1
        group = foot if k >= 3 else name
        toes += tube.grow(ring, group, name, skip=(columns - 1, 2 * columns - 1) if last else ())

    inner, outer = toes
    toe_loops = [(outer, (0.75, 0, 0.66), SIDE_TOES[pair][0]), (inner, (-0.75, 0, 0.66), SIDE_TOES[pair][1])]
    top, sole = tube.loop[:columns], tube.loop[:columns - 1:-1]
    for i, slope in enumerate(TOE_SPREAD[pair]):
        quad = (top[i], sole[i], sole[i + 1], top[i + 1])
        toe_loops.append((quad, (slope, 0, 1), TOE_LENGTH[pair]))
    for i, (quad, direction, size) in enumerate(toe_loops):
        toe(mesh, quad, direction, size, side, foot, "%s_toe%d" % (foot, i))


def toe(mesh, quad, direction, size, side, group, chart):
    """A knuckle, a joint and a pointed end, low over the ground."""
    mirrored = [(side * mesh.points[v][0],) + mesh.points[v][1:] for v in quad]
    direction = vec.unit(direction)
    root = vec.mean(mirrored)
    if abs(direction[0]) > 0.5:      # a side toe starts at the front of its long quad
        root = vec.add(root, (0, 0, 0.16))
    across = vec.cross((0, 1, 0), direction)
    tube = Tube(mesh, list(quad), side, flip=winds_backward(mesh, quad, direction, side) == (side > 0))
    # the four corners keep their places around the direction of the toe
    signs = [(1 if vec.dot(vec.sub(p, root), across) > 0 else -1, 1 if p[1] > root[1] else -1) for p in mirrored]
    for reach, height, radius in ((0.42, 0.26, 0.18), (1.00, 0.14, 0.12)):
        centre = vec.along((root[0], height * (0.8 if size < 0.8 else 1.0), root[2]), direction, reach * size)
        tube.grow([vec.add(centre, vec.scale(across, radius * a), (0, radius * b * 0.9, 0)) for a, b in signs],
                  group, chart)
    a, b, c, d = tube.loop
    corners = ((0, tube.row), (0, tube.row + 1), (1, tube.row + 1), (1, tube.row))
    mesh.add_face((a, d, c, b), group, chart, corners, tube.flip)


def winds_backward(mesh, quad, direction, side):
    """Whether the quad runs counter-clockwise seen against `direction`."""
    a, b, c, d = (mesh.points[v] for v in quad)
    normal = vec.cross(vec.sub(c, a), vec.sub(d, b))
    return vec.dot(normal, (side * direction[0], direction[1], direction[2])) > 0
