# SPDX-License-Identifier: Apache-2.0
"""A rat that stays where it is, in twelve poses: it looks about, rises to sniff the air, and comes down again.

Slow: show a pose for every eight frames.
"""
import math

import skeleton
import vec
from cage import tail_centre
from skeleton import apply, chain, rotation, translation
from walk import bend

POSES = 12
# Where the feet stand against their rest places, (x, z), so that the legs are no pairs.
STAND = {("hind", 1): (0.15, 0.5), ("hind", -1): (-0.1, -0.3), ("fore", 1): (0.0, -0.35), ("fore", -1): (0.1, 0.45)}
TAIL_YAW = (10.0, 16.0, 20.0, 24.0, 26.0, 27.0, 26.0, 22.0)   # lays it around the animal's right side
CROUCH = 0.25
RISE = 0.56           # phase at which it stands highest


def wave(t, amplitude, delay=0.0, rate=1):
    return amplitude * math.sin(2 * math.pi * rate * (t - delay))


def risen(t):
    """0: all feet on the ground; 1: as high as it gets."""
    away = abs((t - RISE + 0.5) % 1.0 - 0.5)
    return vec.smoothstep(0.24, 0.05, away)


def cycle(skins):
    """Yields, for each pose, the points of every skin."""
    weights = {name: skeleton.mesh_weights(mesh) for name, mesh in skins.items()}
    weights["eyes"] = [{"head": 1.0}] * len(skins["eyes"].points)
    for pose in range(POSES):
        motions = motions_at(pose / POSES)
        yield {name: skeleton.deform(mesh.points, weights[name], motions) for name, mesh in skins.items()}


def motions_at(t):
    """Bone name -> motion from the rest pose, at phase t of the cycle."""
    motions = trunk_motions(t)
    for (pair, side) in STAND:
        motions.update(leg_motions(t, pair, side, motions[skeleton.LEGS[pair]["parent"]]))
    return motions


def trunk_motions(t):
    up = risen(t)
    look = wave(t, 1.0, 0.05)
    turns = {                     # yaw, pitch, roll in degrees
        "pelvis": (look * 2.0, -10.0 * up, 0.0),
        "loin": (look * 5.0, -13.0 * up, look * 1.5),
        "chest": (look * 7.0, -9.0 * up, look * 2.0),
        "neck": (look * 8.0, 4.0 + wave(t, 3.0, 0.0, 2) + 4.0 * up, look * 2.0),
        "head": (look * 12.0, 5.0 + wave(t, 5.0, 0.1, 2) + 6.0 * up, look * 4.0),
    }
    motions = {}
    parent = translation((0.0, -CROUCH * (1 - up), 0.0))
    for name, pivot, _ in skeleton.TRUNK:
        yaw, pitch, roll = turns[name]
        parent = chain(parent, rotation(1, yaw, pivot), rotation(0, pitch, pivot), rotation(2, roll, pivot))
        motions[name] = parent
    motions.update(tail_motions(t, turns["pelvis"][0]))
    return motions


def tail_motions(t, pelvis_yaw):
    """Lies on the ground; its tip moves a little."""
    motions = {}
    parent = rotation(1, pelvis_yaw, skeleton.TRUNK[0][1])
    for i, z in enumerate(skeleton.TAIL_PIVOTS):
        yaw = TAIL_YAW[i] + wave(t, 0.5 + 0.6 * i, 0.1 * i)
        parent = chain(parent, rotation(1, yaw, tail_centre((z + 9.5) / -17.0)))
        motions["tail%d" % i] = chain(translation((0.0, -CROUCH * vec.smoothstep(4.0, 0.0, i), 0.0)), parent)
    return motions


def leg_motions(t, pair, side, parent):
    hip, knee, ankle, ball = ((side * x, y, z) for x, y, z in skeleton.LEGS[pair]["joints"])
    x, z = STAND[pair, side]
    up = risen(t) if pair == "fore" else 0.0
    # Raised paws hang in front of the chest, which carries them.
    hang = chain(parent, translation((0.0, 0.9, 0.4)), rotation(0, 38.0, ankle))
    stand = translation((x, 0.0, z))
    foot = mix(stand, hang, up)
    toes = chain(foot, rotation(0, 18.0 * up, ball))
    new_hip, new_ankle = apply(parent, hip), apply(foot, ankle)
    upper_turn, lower_turn = bend(hip, knee, ankle, new_hip, new_ankle, skeleton.LEGS[pair]["bend"])
    upper = chain(translation(vec.sub(new_hip, hip)), rotation(0, upper_turn, hip))
    lower = chain(translation(vec.sub(new_ankle, ankle)), rotation(0, lower_turn, ankle))
    suffix = "_%s_%s" % (pair, "l" if side > 0 else "r")
    return dict(zip((s + suffix for s in skeleton.SEGMENTS), (upper, lower, foot, toes)))


def mix(a, b, t):
    """Between two motions: good enough for the small turns of a foot."""
    rows = tuple(tuple(p * (1 - t) + q * t for p, q in zip(x, y)) for x, y in zip(a[0], b[0]))
    return rows, tuple(p * (1 - t) + q * t for p, q in zip(a[1], b[1]))
