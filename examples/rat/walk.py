# SPDX-License-Identifier: Apache-2.0
"""A walk on the spot in twelve poses: diagonal feet together, the ground runs backward under them.

A foot on the ground moves back by STRIDE / POSES per pose; carry the animal forward by as much and it stands.
"""
import math

import skeleton
import vec
from cage import tail_centre
from skeleton import apply, chain, rotation, translation

POSES = 12
STRIDE = 6.0          # centimetres per cycle
STANCE = 0.62         # share of the cycle a foot is on the ground
LIFT = {"hind": 0.60, "fore": 0.85}
HEEL = 24.0           # degrees the heel has risen when the toes leave the ground
PHASE = {("hind", 1): 0.00, ("fore", -1): 0.05, ("hind", -1): 0.50, ("fore", 1): 0.55}
REACH_AHEAD = {"hind": 0.55, "fore": 0.25}    # how far the middle of the step lies ahead of the rest pose
TAIL_YAW = (-18.0, -24.0, -26.0, -26.0, -24.0, -20.0, -14.0, -8.0)   # lays it aside in an arc
SINK = 0.12           # the walking animal stands a little lower than at rest


def wave(t, amplitude, delay=0.0, rate=1):
    return amplitude * math.sin(2 * math.pi * rate * (t - delay))


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
    for (pair, side), phase in PHASE.items():
        motions.update(leg_motions(pair, side, (t - phase) % 1.0, motions[skeleton.LEGS[pair]["parent"]]))
    return motions


def trunk_motions(t):
    bob = wave(t, 0.10, 0.10, rate=2) - SINK
    turns = {                     # yaw, pitch, roll in degrees
        "pelvis": (wave(t, 5.0), wave(t, 1.2, 0.1, 2), wave(t, 3.0, 0.05)),
        "loin": (wave(t, -4.0, 0.02), wave(t, -1.0, 0.1, 2), wave(t, -2.0, 0.05)),
        "chest": (wave(t, -4.0, 0.05), wave(t, -1.0, 0.15, 2), wave(t, -2.5, 0.05)),
        "neck": (wave(t, 2.0, 0.08), -3.0 + wave(t, 1.5, 0.2, 2), wave(t, 1.0)),
        "head": (wave(t, 2.0, 0.12), 4.0 + wave(t, 1.5, 0.25, 2), wave(t, 0.8)),
    }
    motions = {}
    sway = wave(t, 0.16, 0.05)
    parent = translation((sway, bob, 0.0))
    for name, pivot, _ in skeleton.TRUNK:
        yaw, pitch, roll = turns[name]
        parent = chain(parent, rotation(1, yaw, pivot), rotation(0, pitch, pivot), rotation(2, roll, pivot))
        motions[name] = parent
    motions.update(tail_motions(t, sway, bob, turns["pelvis"][0]))
    return motions


def tail_motions(t, sway, bob, pelvis_yaw):
    """Follows the rump at its root, and slides over the ground further on."""
    motions = {}
    parent = chain(translation((sway, 0.0, 0.0)), rotation(1, pelvis_yaw, skeleton.TRUNK[0][1]))
    for i, z in enumerate(skeleton.TAIL_PIVOTS):
        yaw = TAIL_YAW[i] + wave(t, 1.6 + 0.35 * i, 0.10 + 0.075 * i)
        parent = chain(parent, rotation(1, yaw, tail_centre((z + 9.5) / -17.0)))
        motions["tail%d" % i] = chain(translation((0.0, bob * vec.smoothstep(4.0, 0.0, i), 0.0)), parent)
    return motions


def foot_path(pair, phase):
    """(height and z of the ball of the foot against its rest place, pitch of the heel in degrees)."""
    half = STRIDE * STANCE / 2
    if phase < STANCE:
        s = phase / STANCE
        heel = HEEL * vec.smoothstep(0.62, 1.0, s)
        return 0.0, half - STRIDE * phase + REACH_AHEAD[pair], heel
    s = (phase - STANCE) / (1 - STANCE)
    slope = -STRIDE * (1 - STANCE)           # leaves and meets the ground at the ground's speed
    z = hermite(-half, half, slope, slope, s)
    lift = LIFT[pair] * math.sin(math.pi * s) ** 2 * (1.15 - 0.3 * s)
    heel = HEEL * (1 - vec.smoothstep(0.05, 0.75, s))
    return lift, z + REACH_AHEAD[pair], heel


def hermite(a, b, slope_a, slope_b, s):
    return ((2 * s ** 3 - 3 * s ** 2 + 1) * a + (s ** 3 - 2 * s ** 2 + s) * slope_a
            + (3 * s ** 2 - 2 * s ** 3) * b + (s ** 3 - s ** 2) * slope_b)


def leg_motions(pair, side, phase, parent):
    hip, knee, ankle, ball = ((side * x, y, z) for x, y, z in skeleton.LEGS[pair]["joints"])
    lift, z, heel = foot_path(pair, phase)
    toes = translation((0.0, lift, z))
    if phase > STANCE:      # toes hang while they swing
        s = (phase - STANCE) / (1 - STANCE)
        toes = chain(toes, rotation(0, 20.0 * math.sin(math.pi * s) ** 2, ball))
    foot = chain(translation((0.0, lift, z)), rotation(0, heel, ball))
    new_hip, new_ankle = apply(parent, hip), apply(foot, ankle)
    upper_turn, lower_turn = bend(hip, knee, ankle, new_hip, new_ankle, skeleton.LEGS[pair]["bend"])
    upper = chain(translation(vec.sub(new_hip, hip)), rotation(0, upper_turn, hip))
    lower = chain(translation(vec.sub(new_ankle, ankle)), rotation(0, lower_turn, ankle))
    suffix = "_%s_%s" % (pair, "l" if side > 0 else "r")
    return dict(zip((s + suffix for s in skeleton.SEGMENTS), (upper, lower, foot, toes)))


def angle(a, b):
    """Direction from a to b in the side view, in degrees, as rotations about x count."""
    return math.degrees(math.atan2(b[2] - a[2], b[1] - a[1]))


def bend(hip, knee, ankle, new_hip, new_ankle, forward):
    """Two-bone inverse kinematics in the side view: how far the upper and lower bones turn."""
    def flat(a, b):
        return math.hypot(b[1] - a[1], b[2] - a[2])

    upper, lower = flat(hip, knee), flat(knee, ankle)
    reach = min(flat(new_hip, new_ankle), 0.995 * (upper + lower))
    cosine = (upper ** 2 + reach ** 2 - lower ** 2) / (2 * upper * reach)
    at_hip = math.degrees(math.acos(min(max(cosine, -1.0), 1.0)))
    new_upper = angle(new_hip, new_ankle) - forward * at_hip
    y = new_hip[1] + upper * math.cos(math.radians(new_upper))
    z = new_hip[2] + upper * math.sin(math.radians(new_upper))
    new_knee = (0.0, y, z)
    return new_upper - angle(hip, knee), angle(new_knee, new_ankle) - angle(knee, ankle)
