#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes head.obj, a dummy's head with neck and shoulders for mane.yaml, in centimetres. Needs only Python 3."""
import math
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
COLUMNS = 28
# Rings from below: height, half width across, half depth, forward shift.
RINGS = [(-27.0, 17.5, 8.6, 0.0), (-24.5, 17.2, 8.4, 0.0), (-22.5, 14.5, 7.6, 0.0), (-20.8, 9.4, 6.5, 0.0),
         (-18.6, 6.2, 5.8, 0.1), (-15.5, 5.6, 5.6, 0.5), (-12.8, 5.7, 6.0, 1.0), (-11.0, 5.9, 7.4, 1.8),
         (-9.2, 6.4, 8.7, 1.5), (-6.8, 6.9, 9.4, 0.9), (-4.0, 7.3, 9.8, 0.4), (-1.0, 7.6, 10.0, 0.0),
         (2.0, 7.7, 10.1, -0.2), (4.8, 7.4, 9.7, -0.3), (7.2, 6.5, 8.6, -0.3), (9.1, 5.0, 6.7, -0.2),
         (10.4, 2.9, 3.9, 0.0)]
TOP = (0.0, 10.9, 0.0)


def face(height, x, z):
    """Moves points of the front: a nose, a chin and hollows of the eyes."""
    def bump(y, width, across, amount):
        return amount * math.exp(-((height - y) / width) ** 2 - (x / across) ** 2)
    if z <= 0:
        return z
    z += bump(-3.2, 2.0, 1.6, 1.9) + bump(-9.6, 1.6, 2.4, 0.7)
    return z - 0.9 * math.exp(-((height - 0.2) / 1.3) ** 2) * math.exp(-((abs(x) - 3.2) / 1.6) ** 2)


def main():
    lines = ["# Written by examples/make_mane.py. A dummy's head; y up, facing z, centimetres"]
    for height, across, deep, shift in RINGS:
        for i in range(COLUMNS):
            turn = 2 * math.pi * i / COLUMNS
            x, z = across * math.sin(turn), deep * math.cos(turn)
            z = face(height, x, z) if height > -12 else z
            lines.append("v %.3f %.3f %.3f" % (x, height, z + shift))
    lines.append("v %.3f %.3f %.3f" % TOP)
    lines.append("v 0 %.3f 0" % RINGS[0][0])
    top, bottom = len(RINGS) * COLUMNS + 1, len(RINGS) * COLUMNS + 2
    for row in range(len(RINGS) - 1):
        for i in range(COLUMNS):
            a, b = row * COLUMNS + i + 1, row * COLUMNS + (i + 1) % COLUMNS + 1
            lines.append("f %d %d %d %d" % (a, b, b + COLUMNS, a + COLUMNS))
    last = (len(RINGS) - 1) * COLUMNS
    for i in range(COLUMNS):
        j = (i + 1) % COLUMNS
        lines.append("f %d %d %d" % (last + i + 1, last + j + 1, top))
        lines.append("f %d %d %d" % (j + 1, i + 1, bottom))
    (HERE / "head.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
