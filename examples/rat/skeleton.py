# SPDX-License-Identifier: Apache-2.0
"""Bones at rest, smooth weights of the skin, and linear blend skinning."""
import math

import vec

# Trunk: name, pivot, and the z where the bone holds the skin alone (blends run between neighbours)
TRUNK = [
    ("pelvis", (0, 5.0, -6.0), -6.6),
    ("loin", (0, 5.8, -4.0), -3.2),
    ("chest", (0, 5.4, -0.6), 1.2),
    ("neck", (0, 5.0, 3.2), 3.8),
    ("head", (0, 4.8, 4.6), 5.4),
]
TAIL_PIVOTS = [-9.2, -10.6, -12.2, -14.0, -16.0, -18.2, -20.6, -23.2]    # z
# Legs, left side: joints from the trunk down, and the bone of the trunk they hang on
LEGS = {
    "hind": {"joints": ((2.60, 4.00, -5.00), (2.85, 2.00, -3.50), (2.70, 0.70, -5.85), (2.86, 0.25, -3.70)),
             "parent": "pelvis", "bend": 1, "muscle": ((2.9, 3.2, -4.9), 1.55), "thick": (1.3, 2.3)},
    "fore": {"joints": ((1.90, 3.90, 2.60), (1.90, 2.00, 1.20), (1.66, 0.50, 2.50), (1.72, 0.20, 3.40)),
             "parent": "chest", "bend": -1, "muscle": ((2.0, 2.8, 2.0), 1.25), "thick": (1.0, 1.9)},
}
SEGMENTS = ("upper", "lower", "foot", "toes")


# ---- rigid motions: (rows of the rotation, translation) ----

IDENTITY = (((1, 0, 0), (0, 1, 0), (0, 0, 1)), (0, 0, 0))


def rotation(axis, degrees, pivot):
    """Turns about a coordinate axis (0, 1, 2) through `pivot`."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    rows = [[1.0 if i == j else 0.0 for j in range(3)] for i in range(3)]
    j, k = (axis + 1) % 3, (axis + 2) % 3
    rows[j][j], rows[j][k], rows[k][j], rows[k][k] = c, -s, s, c
    turned = tuple(vec.dot(row, pivot) for row in rows)
    return (tuple(map(tuple, rows)), vec.sub(pivot, turned))


def translation(offset):
    return (IDENTITY[0], offset)


def apply(motion, p):
    rows, offset = motion
    return vec.add(tuple(vec.dot(row, p) for row in rows), offset)


def chain(*motions):
    """The motion that applies the last one first."""
    result = motions[-1]
    for motion in reversed(motions[:-1]):
        columns = list(zip(*result[0]))
        rows = tuple(tuple(vec.dot(row, column) for column in columns) for row in motion[0])
        result = (rows, apply(motion, result[1]))
    return result


# ---- weights ----

def chain_weights(places, x):
    """Blends between the two neighbours of `x` in an ascending list of places."""
    weights = [0.0] * len(places)
    if x <= places[0]:
        weights[0] = 1.0
    elif x >= places[-1]:
        weights[-1] = 1.0
    else:
        i = next(i for i in range(len(places) - 1) if x < places[i + 1])
        weights[i + 1] = vec.smoothstep(places[i], places[i + 1], x)
        weights[i] = 1 - weights[i + 1]
    return weights


def trunk_weights(p):
    weights = dict(zip((name for name, _, _ in TRUNK), chain_weights([z for _, _, z in TRUNK], p[2])))
    if p[2] < TAIL_PIVOTS[0] + 0.4:
        behind = [-z for z in TAIL_PIVOTS]
        middles = [behind[0] - 0.4] + [(a + b) / 2 for a, b in zip(behind, behind[1:])] + [behind[-1] + 1.0]
        names = ["pelvis"] + ["tail%d" % i for i in range(len(TAIL_PIVOTS))]
        return dict(zip(names, chain_weights(middles, -p[2])))
    return weights


def leg_share(p, pair, side, part):
    """How much of a point of the skin follows a leg rather than the trunk."""
    data = LEGS[pair]
    if part.startswith(("leg", "foot")):
        if pair not in part or not part.endswith("_l" if side > 0 else "_r"):
            return 0.0
        low, high = data["thick"]
        grown = vec.smoothstep(high, low, p[1])
    else:
        grown = 0.0
    centre, radius = data["muscle"]
    swell = 0.62 * vec.bump(p, (side * centre[0],) + centre[1:], radius)
    return max(grown, swell)


def leg_weights(p, pair):
    _, _, ankle, ball = LEGS[pair]["joints"]
    lower = vec.smoothstep(2.0, 1.1, p[1])
    foot = vec.smoothstep(1.15, 0.65, p[1])
    toes = vec.smoothstep(ball[2] - 0.25, ball[2] + 0.15, p[2]) * foot
    return {"upper": 1 - lower, "lower": lower - foot, "foot": foot - toes, "toes": toes}


def skin_weights(p, part):
    """Bone name -> weight of one point; the weights sum to 1."""
    weights = trunk_weights(p)
    for pair in LEGS:
        for side, suffix in ((1, "_l"), (-1, "_r")):
            share = leg_share(p, pair, side, part)
            if share < 0.01:
                continue
            weights = {bone: w * (1 - share) for bone, w in weights.items()}
            for segment, w in leg_weights(p, pair).items():
                weights["%s_%s%s" % (segment, pair, suffix)] = w * share
    return {bone: w for bone, w in weights.items() if w > 0}


def mesh_weights(mesh):
    parts = [""] * len(mesh.points)
    for face in mesh.faces:
        for v in face.vertices:
            if not parts[v].startswith(("leg", "foot")):
                parts[v] = face.group
    return [skin_weights(p, part) for p, part in zip(mesh.points, parts)]


def deform(points, weights, motions):
    deformed = []
    for p, w in zip(points, weights):
        total = (0.0, 0.0, 0.0)
        for bone, share in w.items():
            total = vec.along(total, apply(motions[bone], p), share)
        deformed.append(total)
    return deformed
