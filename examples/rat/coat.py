# SPDX-License-Identifier: Apache-2.0
"""What grows where: length, density, flow and colour of the coat as functions of the rest pose.

Every function takes a point of the skin, its normal and the body part ("ear_l", "foot_hind_r", ...).
The animal is symmetric, so all works on the left side and directions are mirrored back.
"""
import math

import vec
from cage import tail_centre
from eyes import CENTRE as EYE
from limbs import EAR_AXIS, EAR_FACING, EAR_ROOT

NOSE = (0.0, 4.50, 10.25)
MOUTH = [(0.0, 4.00, 10.05), (0.0, 3.42, 9.76), (0.40, 3.30, 9.62), (0.78, 3.20, 9.15), (0.98, 3.34, 8.65)]
WHISKER_PAD = (1.10, 4.10, 9.25)
TAIL_STARTS = -9.7
CHEEK = (2.0, 4.2, 4.9)
HIP, SHOULDER = (2.8, 2.6, -5.0), (2.0, 2.4, 2.0)

# Hair length, 1 = the longest, over z along the trunk and head
LENGTH_ALONG = [(-10.4, 0.30), (-9.0, 0.80), (-6.0, 1.00), (-2.0, 0.95), (1.5, 0.88), (3.5, 0.74), (5.0, 0.54),
                (6.5, 0.38), (8.0, 0.24), (9.5, 0.14), (10.4, 0.08)]
NAKED_HAIR = 0.13      # the short hair of hands, feet and tail
EAR_FUZZ = 0.16


def curve(knots, x):
    """Piecewise linear."""
    if x <= knots[0][0]:
        return knots[0][1]
    for (x0, y0), (x1, y1) in zip(knots, knots[1:]):
        if x <= x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return knots[-1][1]


def left(p):
    """A point or normal carried to the left side."""
    return (abs(p[0]), p[1], p[2])


def is_limb(part):
    return part.startswith(("leg", "foot"))


def hand(p, part):
    """1 on hands and feet, 0 up the leg."""
    if not is_limb(part):
        return 0.0
    return vec.smoothstep(1.05, 0.45, p[1])


def tail(p):
    """1 on the tail, 0 on the rump."""
    return vec.smoothstep(TAIL_STARTS + 0.35, TAIL_STARTS - 0.75, p[2])


def ear(p, n, part):
    """(how much ear, how much of it is the inside of the cup)."""
    if not part.startswith("ear"):
        return 0.0, 0.0
    height = vec.dot(vec.sub(p, EAR_ROOT), EAR_AXIS)
    inside = vec.smoothstep(-0.15, 0.35, vec.dot(n, EAR_FACING))
    return vec.smoothstep(-0.35, 0.35, height), inside


def nose(p):
    return vec.smoothstep(0.58, 0.36, vec.distance(p, NOSE))


def eyelid(p):
    return vec.smoothstep(0.58, 0.47, vec.distance(p, EYE))


def mouth(p):
    """1 on the line of the mouth and the groove under the nose."""
    nearest = min(to_segment(p, a, b) for a, b in zip(MOUTH, MOUTH[1:]))
    return vec.smoothstep(0.15, 0.05, nearest)


def to_segment(p, a, b):
    ab = vec.sub(b, a)
    t = min(max(vec.dot(vec.sub(p, a), ab) / vec.dot(ab, ab), 0.0), 1.0)
    return vec.distance(p, vec.along(a, ab, t))


def belly(p, n):
    return vec.smoothstep(-0.15, -0.75, n[1]) * vec.smoothstep(5.0, 3.0, p[1])


def length(p, n, part):
    p, n = left(p), left(n)
    value = curve(LENGTH_ALONG, p[2])
    value *= 1 - 0.30 * belly(p, n)
    value *= 1 + 0.45 * vec.bump(p, CHEEK, 1.5)
    if is_limb(part):
        value *= 0.30 + 0.70 * vec.smoothstep(0.8, 3.0, p[1])
    in_ear, inside = ear(p, n, part)
    value += in_ear * (EAR_FUZZ - 0.03 * inside - value)
    value += max(hand(p, part), tail(p)) * (NAKED_HAIR - value)
    near_eye = vec.smoothstep(0.95, 0.45, vec.distance(p, EYE))
    value *= 1 - 0.45 * near_eye
    value *= 1 - 0.5 * mouth(p)
    return value * (1 - max(nose(p), eyelid(p)))


def density(p, n, part):
    """Relative density of (undercoat, guard hair, down on bare skin)."""
    p, n = left(p), left(n)
    under = 0.55 + 0.45 * vec.smoothstep(3.0, 8.0, p[2])
    in_ear, inside = ear(p, n, part)
    furred = (1 - in_ear) * (1 - hand(p, part)) * (1 - tail(p)) * (1 - max(nose(p), eyelid(p)))
    guard = furred * under
    under *= (1 - in_ear) * (1 - hand(p, part)) * (1 - tail(p))
    down = max(in_ear, 0.35 * hand(p, part), 0.45 * tail(p), 0.4 * nose(p))
    bald = 1 - max(nose(p), eyelid(p))
    return under * bald, guard, down * (1 - 0.4 * inside)


def flow(p, n, part):
    """Unit direction in which the hair lies, in the skin's plane, rest object space."""
    side = -1.0 if p[0] < 0 else 1.0
    middle = min(abs(p[0]) / 0.15, 1.0)     # the mid-line has no sideways flow
    p, n = left(p), (n[0] * side, n[1], n[2])
    if part.startswith("ear"):
        up = vec.along(EAR_AXIS, vec.unit(vec.sub(p, EAR_ROOT)), 0.5)
        height = vec.dot(vec.sub(p, EAR_ROOT), EAR_AXIS)
        raw = vec.mix(trunk_flow(p, part), up, vec.smoothstep(-0.5, 0.3, height))
    elif tail(p) > 0:
        t = min(max((p[2] + 9.5) / -17.0, 0.0), 1.0)
        raw = vec.sub(tail_centre(t + 0.01), tail_centre(t - 0.01))
        raw = (0.0, raw[1], raw[2])
    else:
        raw = trunk_flow(p, part)
    raw = (raw[0] * middle, raw[1], raw[2])
    flat = vec.unit(vec.along(raw, n, -vec.dot(raw, n)))
    return (flat[0] * side, flat[1], flat[2])


def trunk_flow(p, part):
    back = (0.0, -0.28 * vec.smoothstep(8.4, 5.5, p[1]) * vec.smoothstep(-9.0, -6.0, p[2]), -1.0)
    from_nose = vec.unit(vec.sub(p, (0.0, 4.6, 10.6)))
    raw = vec.mix(back, from_nose, vec.smoothstep(8.2, 9.8, p[2]))
    to_tail = vec.unit(vec.sub((0.0, 3.2, -11.0), p))
    raw = vec.mix(raw, to_tail, vec.smoothstep(-7.0, -9.2, p[2]))
    # down the legs, toward the toes on the feet
    down = max(vec.bump(p, HIP, 1.9), vec.bump(p, SHOULDER, 1.4))
    if is_limb(part):
        down = max(down, vec.smoothstep(3.0, 1.4, p[1]))
    raw = vec.mix(raw, (0.08, -1.0, -0.45), 0.80 * down)
    raw = vec.mix(raw, (0.0, -0.25, 1.0), hand(p, part))
    # around the eyes and the roots of the ears
    for centre, radius, amount in ((EYE, 0.70, 0.9), (EAR_ROOT, 0.95, 0.8)):
        away = vec.unit(vec.sub(p, centre))
        raw = vec.along(raw, away, amount * vec.bump(p, centre, radius))
    return raw


# ---- whiskers ----

WHISKER_ROWS, WHISKERS_PER_ROW = 5, 6
WHISKER_DOT = 0.060


def whisker_roots():
    """Follicles of the left pad: five rows, each starting a little further back than the last."""
    for row in range(WHISKER_ROWS):
        for k in range(WHISKERS_PER_ROW - (row in (0, 4))):
            y = WHISKER_PAD[1] + 0.46 - 0.20 * row + 0.03 * k
            z = WHISKER_PAD[2] + 0.42 - 0.20 * k - 0.08 * abs(row - 2)
            yield (y, z, k)


ROOTS = list(whisker_roots())
BROW_WHISKERS = [(6.02, 7.30), (5.98, 7.02), (6.05, 6.78)]     # y and z
BROW_REACH = 0.42


def whiskers(p, part):
    """(density, relative length, 0): the rear ones are the longest."""
    p = left(p)
    if part != "head" or p[0] < 0.45:
        return 0.0, 0.0, 0.0
    if p[2] < 8.0:
        nearest, reach, share = min(math.hypot(p[1] - y, p[2] - z) for y, z in BROW_WHISKERS), BROW_REACH, 0.4
    else:
        nearest, k = min((math.hypot(p[1] - y, p[2] - z), k) for y, z, k in ROOTS)
        reach, share = 0.35 + 0.65 * k / (WHISKERS_PER_ROW - 1), 1.0
    return share * vec.smoothstep(1.6 * WHISKER_DOT, 0.6 * WHISKER_DOT, nearest), reach, 0.0


# ---- colours ----

BACK, FLANK, BELLY = (0.70, 0.66, 0.62), (1.14, 1.11, 1.06), (1.80, 1.85, 1.90)
WARM = (1.22, 1.08, 0.92)
MUZZLE, PAW = (1.10, 1.04, 1.00), (1.60, 1.55, 1.50)
SKIN_UNDER_FUR, SKIN_PINK, SKIN_NOSE = (0.22, 0.16, 0.13), (0.66, 0.39, 0.33), (0.60, 0.33, 0.29)
SKIN_TAIL, SKIN_RIM = (0.40, 0.28, 0.25), (0.56, 0.33, 0.27)
SKIN_EAR, SKIN_INNER_EAR = (0.33, 0.22, 0.19), (0.38, 0.21, 0.18)
SKIN_EYELID = (0.06, 0.045, 0.04)
TAIL_RING = 0.26       # centimetres from scale ring to scale ring


def tint(p, n, part):
    """Multiplies the hair's colour; 1 = as it is."""
    p, n = left(p), left(n)
    height = vec.smoothstep(5.2, 8.2, p[1] + 1.6 * vec.smoothstep(3.0, 8.0, p[2]))
    color = vec.mix(FLANK, BACK, height)
    color = vec.mix(color, MUZZLE, vec.smoothstep(7.5, 9.5, p[2]))
    low = vec.smoothstep(0.30, -0.45, n[1]) * vec.smoothstep(5.0, 2.8, p[1])
    chin = vec.smoothstep(3.45, 3.10, p[1]) * vec.smoothstep(8.0, 9.0, p[2])
    color = vec.mix(color, WARM, 0.8 * vec.bump(p, CHEEK, 1.7))
    color = vec.mix(color, BELLY, max(low, chin))
    color = vec.mix(color, PAW, ear(p, n, part)[0])
    color = vec.mix(color, vec.scale(color, 0.35), mouth(p))
    if is_limb(part):
        color = vec.mix(color, PAW, hand(p, part))
    color = vec.mix(color, PAW, tail(p))
    return color


def ear_skin(p, inside):
    """Paler and thinner toward the rim, veins from the root, darker down in the cup."""
    from_root = vec.sub(p, EAR_ROOT)
    height = vec.dot(from_root, EAR_AXIS)
    across = vec.dot(from_root, vec.unit(vec.cross(EAR_AXIS, EAR_FACING)))
    color = vec.mix(SKIN_EAR, SKIN_INNER_EAR, inside)
    rim = vec.smoothstep(0.55, 1.10, math.hypot(across, height - 1.0))
    color = vec.mix(color, SKIN_RIM, 0.8 * rim)
    color = vec.scale(color, 1 - 0.65 * inside * vec.smoothstep(1.3, 0.2, height))
    spoke = 7.0 * math.atan2(across, height + 0.5) + 0.7 * math.sin(4.0 * height) + 1.1
    vein = vec.smoothstep(0.75, 1.0, math.cos(spoke)) * vec.smoothstep(1.9, 0.8, height)
    return vec.mix(color, (0.70 * color[0], 0.56 * color[1], 0.56 * color[2]), 0.7 * vein)


def tail_skin(p):
    """Rings of scales, grey toward the tip and on top."""
    along = TAIL_STARTS - p[2]
    groove = 0.5 + 0.5 * math.cos(2 * math.pi * along / TAIL_RING)
    top = vec.smoothstep(-0.2, 0.4, p[1] - tail_centre((p[2] + 9.5) / -17.0)[1])
    color = vec.scale(SKIN_TAIL, 1 - 0.22 * top)
    return vec.scale(color, 1 - 0.34 * groove ** 2)


def skin(p, n, part):
    """Colour of the bare hide."""
    p, n = left(p), left(n)
    color = SKIN_UNDER_FUR
    in_ear, inside = ear(p, n, part)
    if in_ear > 0:
        color = vec.mix(color, ear_skin(p, inside), in_ear)
    color = vec.mix(color, SKIN_PINK, hand(p, part))
    if tail(p) > 0:
        color = vec.mix(color, tail_skin(p), tail(p))
    color = vec.mix(color, SKIN_NOSE, nose(p))
    return vec.mix(color, SKIN_EYELID, vec.smoothstep(0.85, 0.60, vec.distance(p, EYE)))
