#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""make_hamster.py FOLDER: writes the meshes of docs/TUTORIAL.md: body.obj, bare.obj, eyes.obj and stage.obj.

Control cages for Catmull-Clark, without texture coordinates. Centimetres, +y up, the nose toward +z. Needs only
Python 3."""
import math
import pathlib
import sys

AROUND = 12
# Rings of the body from tail to nose: z, height of the centre, half width, half height.
BODY = [(-4.9, 2.2, 1.4, 1.2), (-4.3, 2.4, 2.6, 2.1), (-3.0, 2.7, 3.4, 2.6), (-1.2, 2.9, 3.6, 2.9),
        (0.6, 2.95, 3.2, 2.85), (1.9, 3.15, 2.75, 2.65), (3.0, 3.5, 2.7, 2.5), (4.1, 3.6, 2.6, 2.3),
        (5.1, 3.3, 2.15, 1.8), (5.8, 3.0, 1.35, 1.1), (6.2, 2.9, 0.75, 0.65)]


class Mesh:
    def __init__(self):
        self.points, self.faces = [], []

    def tube(self, rings, tail, nose):
        """A closed tube through rings of AROUND points each, from the point `tail` to the point `nose`."""
        first = len(self.points)
        for ring in rings:
            self.points += ring
        self.points += [tail, nose]
        last = first + AROUND * (len(rings) - 1)
        tip = first + AROUND * len(rings)
        for k in range(AROUND):
            n = (k + 1) % AROUND
            for start in range(first, last, AROUND):
                self.faces.append((start + k, start + n, start + AROUND + n, start + AROUND + k))
            self.faces.append((tip, first + n, first + k))
            self.faces.append((tip + 1, last + k, last + n))

    def body(self):
        rings = [[(w * math.cos(a), y + h * math.sin(a), z) for a in angles()] for z, y, w, h in BODY]
        self.tube(rings, (0, BODY[0][1], BODY[0][0] - 0.3), (0, BODY[-1][1], BODY[-1][0] + 0.15))

    def ellipsoid(self, center, radii, yaw=0.0, roll=0.0):
        """Rings along z; then turned about z by `roll` and about y by `yaw`, in degrees."""
        def place(x, y, z):
            x, y, z = x * radii[0], y * radii[1], z * radii[2]
            c, s = math.cos(math.radians(roll)), math.sin(math.radians(roll))
            x, y = c * x - s * y, s * x + c * y
            c, s = math.cos(math.radians(yaw)), math.sin(math.radians(yaw))
            x, z = c * x + s * z, c * z - s * x
            return center[0] + x, center[1] + y, center[2] + z
        rings = []
        for step in range(1, 6):
            turn = math.pi * step / 6
            r, z = math.sin(turn), -math.cos(turn)
            rings.append([place(r * math.cos(a), r * math.sin(a), z) for a in angles()])
        self.tube(rings, place(0, 0, -1), place(0, 0, 1))

    def both_sides(self, center, radii, yaw=0.0, roll=0.0):
        self.ellipsoid(center, radii, yaw, roll)
        self.ellipsoid((-center[0], center[1], center[2]), radii, -yaw, -roll)

    def sheet(self, profile, half_width):
        """A sheet of paper: its `profile` of (y, z), swept along x."""
        for y, z in profile:
            n = len(self.points)
            self.points += [(-half_width, y, z), (half_width, y, z)]
            if n:
                self.faces.append((n - 2, n - 1, n + 1, n))

    def write(self, path):
        lines = ["# Written by examples/make_hamster.py. Centimetres, +y up, nose toward +z. No texture coordinates."]
        lines += ["v %.4f %.4f %.4f" % point for point in self.points]
        lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in self.faces]
        path.write_text("\n".join(lines) + "\n")


def angles():
    return [2 * math.pi * k / AROUND for k in range(AROUND)]


def main(folder):
    body, bare, eyes, stage = Mesh(), Mesh(), Mesh(), Mesh()
    body.body()
    body.both_sides((1.9, 5.95, 2.7), (0.85, 1.05, 0.22), yaw=30, roll=-28)   # ears
    bare.ellipsoid((0, 3.25, 6.35), (0.3, 0.2, 0.2))                          # nose
    bare.both_sides((1.3, 0.4, 3.1), (0.42, 0.34, 0.95), yaw=14)              # forefeet
    bare.both_sides((2.45, 0.35, -0.6), (0.5, 0.34, 1.3), yaw=18)             # hind feet
    eyes.both_sides((1.82, 4.35, 4.85), (0.46, 0.46, 0.46))
    stage.sheet([(0, 60), (0, -10), (0, -40), (30, -40), (80, -40)], 60)
    folder.mkdir(parents=True, exist_ok=True)
    for name, mesh in (("body", body), ("bare", bare), ("eyes", eyes), ("stage", stage)):
        mesh.write(folder / (name + ".obj"))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: make_hamster.py FOLDER")
    main(pathlib.Path(sys.argv[1]))
