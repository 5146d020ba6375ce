#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the small things: ground.obj, colony/floor.obj, patch.obj, pebble.obj and imported.hair. Needs only Python 3."""
import math
import pathlib
import random
import struct

HERE = pathlib.Path(__file__).resolve().parent


def write_grid(name, comment, columns, rows, place):
    """An open sheet of quads; place(s, t) with s, t in 0 .. 1; seen from the side where s runs right and t up."""
    lines = ["# Written by examples/make_props.py. " + comment]
    steps = [(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
    lines += ["v %.4f %.4f %.4f" % place(s, t) for s, t in steps]
    lines += ["vt %.5f %.5f" % step for step in steps]
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i + 1
            corners = (a, a + 1, a + columns + 2, a + columns + 1)
            lines.append("f " + " ".join("%d/%d" % (v, v) for v in corners))
    (HERE / name).write_text("\n".join(lines) + "\n")


# ---- the sweep under and behind the rat ----

SWEEP_HALF_WIDTH, SWEEP_FRONT, SWEEP_BACK, SWEEP_BEND, SWEEP_HEIGHT = 260.0, 120.0, -60.0, 70.0, 160.0


def sweep(s, t):
    """A floor along -z that turns up into a wall by a quarter circle."""
    floor = SWEEP_FRONT - SWEEP_BACK
    arc = SWEEP_BEND * math.pi / 2
    walk = t * (floor + arc + SWEEP_HEIGHT)
    x = SWEEP_HALF_WIDTH * (2 * s - 1)
    if walk <= floor:
        return (x, 0.0, SWEEP_FRONT - walk)
    if walk <= floor + arc:
        turn = (walk - floor) / SWEEP_BEND
        return (x, SWEEP_BEND * (1 - math.cos(turn)), SWEEP_BACK - SWEEP_BEND * math.sin(turn))
    return (x, SWEEP_BEND + walk - floor - arc, SWEEP_BACK - SWEEP_BEND)


# ---- the floor under the colonies ----

def floor(s, t):
    """Level ground, 40 m across."""
    return (4000 * (s - 0.5), 0.0, 4000 * (0.5 - t))


# ---- a small patch of skin for tuft.yaml ----

def patch(s, t):
    """A low mound, 4 cm across."""
    x, z = 4 * (s - 0.5), 4 * (0.5 - t)
    return (x, 0.6 * math.exp(-(x * x + z * z) / 2.5), z)


# ---- a pebble with hair of its own for imported.yaml ----

RADIUS = 2.0
STRANDS, POINTS = 4000, 6
SEGMENTS_FLAG, POINTS_FLAG, THICKNESS_FLAG, COLOR_FLAG = 1, 2, 4, 16


def cube_sphere(path, steps):
    """A closed ball of quads: a cube of steps x steps quads a side, blown up."""
    points, index, faces = [], {}, []

    def vertex(p):
        if p not in index:
            n = math.sqrt(sum(c * c for c in p))
            points.append(tuple(RADIUS * c / n for c in p))
            index[p] = len(points)
        return index[p]

    for axis in range(3):
        for sign in (-1, 1):
            u, v = ((axis + 1) % 3, (axis + 2) % 3) if sign > 0 else ((axis + 2) % 3, (axis + 1) % 3)
            for i in range(steps):
                for j in range(steps):
                    quad = []
                    for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        p = [0.0] * 3
                        p[axis], p[u], p[v] = float(sign), 2 * a / steps - 1, 2 * b / steps - 1
                        quad.append(vertex(tuple(p)))
                    faces.append(quad)
    lines = ["# Written by examples/make_props.py. A ball of radius %g for imported.hair." % RADIUS]
    lines += ["v %.5f %.5f %.5f" % p for p in points] + ["f %d %d %d %d" % tuple(f) for f in faces]
    path.write_text("\n".join(lines) + "\n")


def swirl(generator):
    """One strand of the ball: it stands up, then turns about the pole."""
    y = generator.uniform(-0.75, 1.0)
    turn = generator.uniform(0, 2 * math.pi)
    around = math.sqrt(1 - y * y)
    size = 0.9 + 0.5 * generator.random()
    points = []
    for k in range(POINTS):
        t = k / (POINTS - 1)
        angle = turn + 0.9 * t * t
        height = RADIUS * 0.985 + size * math.sin(1.2 * t) / 1.2
        sag = -0.55 * size * t * t
        points.append((height * around * math.cos(angle), height * y + sag, height * around * math.sin(angle)))
    return points


def write_hair(path):
    """Cem Yuksel's .hair: a 128-byte header, then segments, points, thickness (diameter), colours."""
    generator = random.Random(7)
    strands = [swirl(generator) for _ in range(STRANDS)]
    count = STRANDS * POINTS
    flags = POINTS_FLAG | THICKNESS_FLAG | COLOR_FLAG
    information = b"Pelage example: 4000 strands on a ball of radius 2".ljust(88, b"\0")
    header = struct.pack("<4sIIII", b"HAIR", STRANDS, count, flags, POINTS - 1)
    header += struct.pack("<ff3f", 0.016, 0.0, 0.4, 0.3, 0.2) + information
    assert len(header) == 128
    thickness = [0.030 * (1 - 0.8 * k / (POINTS - 1)) for _ in strands for k in range(POINTS)]
    shade = [0.75 + 0.5 * generator.random() for _ in strands]
    colors = [c * s * (0.5 + 0.5 * k / (POINTS - 1)) for s in shade for k in range(POINTS) for c in (0.55, 0.36, 0.2)]
    flat = [c for strand in strands for p in strand for c in p]
    with path.open("wb") as file:
        file.write(header)
        for values in (flat, thickness, colors):
            file.write(struct.pack("<%df" % len(values), *values))


def main():
    write_grid("ground.obj", "A sweep: floor and wall in one piece, centimetres, +y up, the wall toward -z.",
               8, 16, sweep)
    write_grid("colony/floor.obj", "Level ground, 40 m across, +y up.", 4, 4, floor)
    write_grid("patch.obj", "A low mound of skin, 4 cm across, +y up.", 6, 6, patch)
    cube_sphere(HERE / "pebble.obj", 6)
    write_hair(HERE / "imported.hair")


if __name__ == "__main__":
    main()
