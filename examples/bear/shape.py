# SPDX-License-Identifier: Apache-2.0
"""The shape of the bear: head and shoulders, ears, eyelids, nose and eyes as surfaces over two parameters.

Centimetres, +y up, nose toward +z, the animal's left is +x. A surface takes parameters and returns a point.
"""
import math

import vec

# Sections from nose to shoulders: z, top, bottom, half width, height of the widest place (0 bottom .. 1 top),
# how far the lower half is set back per unit of height, squareness.
SECTIONS = [
    # z      top   bottom  half  wide  lean  square
    (20.6, 3.0, -3.6, 3.5, 0.50, 0.42, 0.05),
    (19.2, 3.5, -4.3, 4.3, 0.46, 0.42, 0.05),
    (17.0, 3.9, -5.0, 5.0, 0.45, 0.38, 0.05),
    (14.0, 4.2, -5.9, 5.4, 0.46, 0.28, 0.05),
    (11.0, 4.9, -6.8, 5.9, 0.47, 0.16, 0.04),
    (8.5, 6.7, -7.5, 6.9, 0.50, 0.08, 0.03),
    (6.0, 8.5, -8.2, 8.5, 0.50, 0.00, 0.02),
    (3.0, 10.0, -9.0, 10.3, 0.47, 0.00, 0.01),
    (-1.0, 11.3, -10.0, 11.8, 0.46, 0.00, 0.00),
    (-6.0, 12.2, -11.5, 12.8, 0.45, 0.00, 0.00),
    (-12.0, 12.2, -14.0, 13.0, 0.45, 0.00, 0.00),
    (-20.0, 12.0, -18.0, 14.5, 0.42, 0.00, 0.00),
    (-30.0, 14.5, -23.0, 18.5, 0.42, 0.00, 0.00),
    (-42.0, 17.0, -27.0, 22.5, 0.42, 0.00, 0.00),
]
NOSE = (0.0, 1.15, 20.9)    # middle of the nose pad

# Soft swellings: centre on the left side, radius, how far the skin moves out
SWELLINGS = [
    ((4.3, 7.6, 6.6), 2.2, 0.75),     # brow
    ((3.7, 5.0, 9.6), 1.7, -0.55),    # hollow before the eye
    ((9.6, 1.6, 1.5), 4.0, 0.80),     # cheekbone
    ((0.0, 9.0, 4.0), 2.2, -0.45),    # furrow of the forehead
    ((0.0, 5.2, 11.0), 2.2, 0.25),    # bridge of the nose
    ((4.3, -0.9, 17.4), 2.2, 0.55),   # whisker pad
    ((5.4, -3.6, 12.0), 1.8, -0.25),  # corner of the mouth
    ((1.2, -5.6, 14.6), 2.4, 0.35),   # chin
    ((9.0, -6.0, -1.0), 4.0, 0.60),   # jaw
]
EYE_RADIUS = 1.42
GAZE = vec.unit((0.50, 0.10, 0.86))
EAR_BASE = (9.3, 11.0, -6.0)


def mirror(p):
    return (-p[0], p[1], p[2])


def section(t):
    """The row of SECTIONS at t in 0 .. 1 from nose to shoulders, by a Catmull-Rom spline."""
    last = len(SECTIONS) - 1
    k = min(int(t * last), last - 1)
    f = t * last - k
    a, b, c, d = (SECTIONS[min(max(k + i, 0), last)] for i in (-1, 0, 1, 2))
    return [0.5 * (2 * q + (r - p) * f + (2 * p - 5 * q + 4 * r - s) * f * f + (3 * q - p - 3 * r + s) * f ** 3)
            for p, q, r, s in zip(a, b, c, d)]


def mouth_height(z):
    """Height of the line between the lips."""
    return -2.55 - 1.1 * vec.smoothstep(19.5, 9.0, z)


def head(t, turn):
    """Point of the head: t from nose (0) to shoulders (1), turn from the chin (0) over the left side and the top (0.5)."""
    z, top, bottom, half, wide, lean, square = section(t)
    widest = bottom + (top - bottom) * wide
    angle = 2 * math.pi * turn
    swell = 1 + square * (1 - math.cos(4 * angle)) * 2
    x, y = half * math.sin(angle) * swell, -math.cos(angle) * swell
    p = (x, widest + y * ((top - widest) if y > 0 else (widest - bottom)), z)
    p = (p[0], p[1], p[2] - lean * max(0.0, 2.0 - p[1]))
    outward = vec.unit((p[0], p[1] - widest, 0.35 * half if z > 4 else 0.0))
    side = (abs(p[0]), p[1], p[2])
    move = sum(amount * vec.bump(side, centre, radius) for centre, radius, amount in SWELLINGS)
    lips = math.exp(-((p[1] - mouth_height(p[2])) / 0.6) ** 2) * vec.smoothstep(7.5, 10.5, p[2])
    return vec.along(p, outward, move - 0.6 * lips)


def frame(axis):
    """Two unit vectors across `axis`: to its right side and up."""
    right = vec.unit(vec.cross((0, 1, 0), axis))
    return right, vec.cross(axis, right)


def eye_centre():
    """Middle of the left eyeball, a little below the skin."""
    return vec.along((4.75, 5.6, 8.35), GAZE, -0.45 * EYE_RADIUS)


def lid(grow, turn):
    """Point of the left eyelids: `grow` is 1 at their rim and more outward, below 1 inside; turn as a clock's hand."""
    right, up = frame(GAZE)
    angle = 2 * math.pi * turn
    s = math.sin(angle)
    x = 1.14 * math.cos(angle) * grow
    y = (0.90 if s > 0 else 0.76) * math.copysign(abs(s) ** 1.15, s) * (0.25 + 0.75 * grow)
    y += 0.10 * math.cos(angle) * grow       # the outer corner is higher
    radius = math.hypot(x, y)
    shell = EYE_RADIUS * (1.10 if grow > 1.02 else 1.05 if grow > 0.99 else 0.99)
    rim = min(radius, 0.98)
    depth = math.sqrt(shell ** 2 - rim ** 2) - 0.95 * (radius - rim)
    return vec.add(eye_centre(), vec.scale(GAZE, depth), vec.scale(right, x), vec.scale(up, y))


def ear(radius, turn, front):
    """Point of the left ear's front or back: radius 0 in its middle, 1 at its rim."""
    up = vec.unit((0.56, 0.80, -0.10))
    face = vec.unit((0.42, 0.10, 0.90))
    side = vec.unit(vec.cross(up, face))
    up = vec.cross(face, side)
    angle = 2 * math.pi * turn
    x, y = 3.5 * radius * math.cos(angle), 4.0 * radius * math.sin(angle)
    cup = 1.9 * (radius ** 2 - 1) if front else 2.6 * (radius ** 2 - 1) - 0.25 * (1 - radius ** 8)
    depth = cup + 0.05 * x * x       # the sides curl forward
    return vec.add(EAR_BASE, vec.scale(up, 2.2 + y), vec.scale(side, x), vec.scale(face, depth))


def nose(radius, turn):
    """Point of the nose pad, 0 in its middle, 1 at its border, 1.2 behind it."""
    angle = 2 * math.pi * turn
    c, s = math.cos(angle), math.sin(angle)
    wide = 2.75 * (1 - 0.30 * vec.smoothstep(0.1, -1.0, s))
    tall = 1.75 if s > 0 else 2.05
    square = (abs(c) ** 3 + abs(s) ** 3) ** (-1 / 3)
    reach = min(radius, 1.0) * square
    x, y = wide * reach * c, tall * reach * s
    depth = 1.75 * (1 - min(radius, 1.0) ** 2.6) - 0.075 * x * x - (0.16 * y if y > 0 else -0.22 * y)
    depth -= 4.5 * max(0.0, radius - 1)      # tucks into the muzzle
    # Nostrils: a round hole whose slit runs outward and back
    for px, py, rx, ry, deep in ((1.28, 0.12, 0.50, 0.40, 1.15), (1.95, -0.22, 0.42, 0.17, 0.8), (2.45, -0.12, 0.5, 0.13, 0.5)):
        depth -= deep * math.exp(-(((abs(x) - px) / rx) ** 2 + ((y - py) / ry) ** 2) ** 1.5)
    depth += 0.16 * math.exp(-(((abs(x) - 1.35) / 0.75) ** 2 + ((y - 0.75) / 0.3) ** 2))     # wing above the nostril
    depth -= 0.22 * math.exp(-(x / 0.16) ** 2) * vec.smoothstep(0.5, -0.6, y)                # groove in the middle
    return (NOSE[0] + x, NOSE[1] + y, NOSE[2] + depth)
