#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the example bear: meshes and the maps of its coat, into examples/bear. Needs only Python 3."""
import math
import pathlib
import random
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE / "bear"), str(HERE / "rat")]

import coat  # noqa: E402
import eyes  # noqa: E402
import mesh as meshes  # noqa: E402
import png  # noqa: E402
import shape  # noqa: E402
import vec  # noqa: E402

COMMENT = ["Written by examples/make_bear.py. Centimetres, +y up, the nose toward +z, the animal's left is +x.",
           "Catmull-Clark control cages, counter-clockwise seen from outside."]
SIZE = 256                  # texels of a side of the maps
HEAD = 0.8                  # v from 0 to here is the head; discs of ears and eyelids lie above
DISC = 1 / 12               # radius of their place
ROWS, COLUMNS = 53, 48      # rings of the head, points of a ring
LIDS = (0.90, 0.97, 1.0, 1.05, 1.14, 1.3, 1.6, 2.0, 2.5)    # `grow` of the rings of an eyelid
MAX_GROW = LIDS[-1]


def ear_surface(front):
    return lambda r, turn: shape.ear(r, turn, front)


# Discs: name of their part, surface over (radius, turn), radii of their rings, points of a ring
PARTS = [("ear_front", ear_surface(True), (0, 0.2, 0.4, 0.6, 0.8, 0.93, 1.0), 24),
         ("ear_back", ear_surface(False), (0, 0.2, 0.4, 0.6, 0.8, 0.93, 1.0), 24),
         ("lid", lambda r, turn: shape.lid(r * MAX_GROW, turn), tuple(g / MAX_GROW for g in LIDS), 32)]


class Cage:
    """Points with texture coordinates, and faces in groups."""

    def __init__(self):
        self.points, self.coordinates, self.groups = [], [], {}

    def grid(self, rows, columns, place, group, flip=False):
        """Rings of `columns` points, closed around; place(row, column) gives a point and its texture coordinates."""
        first, first_uv = len(self.points), len(self.coordinates)
        self.points += [place(r, c)[0] for r in range(rows) for c in range(columns)]
        self.coordinates += [place(r, c)[1] for r in range(rows) for c in range(columns + 1)]
        for r in range(rows - 1):
            for c in range(columns):
                corners = [(first + (r + i) * columns + (c + j) % columns, first_uv + (r + i) * (columns + 1) + c + j)
                           for i, j in ((0, 0), (0, 1), (1, 1), (1, 0))]
                self.groups.setdefault(group(r, c), []).append(corners[::-1] if flip else corners)

    def write(self, path):
        lines = ["# " + line for line in COMMENT]
        lines += ["v %.3f %.3f %.3f" % tuple(p) for p in self.points]
        lines += ["vt %.4f %.4f" % tuple(t) for t in self.coordinates]
        for name, faces in self.groups.items():
            lines.append("g " + name)
            lines += ["f " + " ".join("%d/%d" % (v + 1, t + 1) for v, t in face) for face in faces]
        path.write_text("\n".join(lines) + "\n")


def head_point(row, turn):
    """The point of the head at a row of its rings; the first rings close the muzzle."""
    if row >= 3:
        return shape.head((row - 3) / (ROWS - 4), turn)
    middle = (0.0, -0.4, shape.head(0, 0.25)[2] + 0.35)
    return vec.mix(middle, shape.head(0, turn), (0.02, 0.45, 0.8)[row])


def disc_center(part, side):
    return ((2 * part + side + 0.5) / 6, 0.9)


def surface(part, side):
    """A disc's surface on the left (0) or right (1) side of the animal."""
    place = PARTS[part][1]
    return place if side == 0 else lambda r, turn: shape.mirror(place(r, turn))


def build_skin():
    cage = Cage()
    cage.grid(ROWS, COLUMNS, lambda r, c: (head_point(r, c / COLUMNS), (c / COLUMNS, HEAD * r / (ROWS - 1))),
              lambda r, c: "head", flip=True)
    for part, (name, _, radii, count) in enumerate(PARTS):
        for side in (0, 1):
            u, v = disc_center(part, side)

            def place(r, c, at=surface(part, side), u=u, v=v):
                radius, angle = radii[r], 2 * math.pi * c / count
                reach = DISC * 0.94 * radius
                return at(max(radius, 0.01), c / count), (u + reach * math.cos(angle), v + reach * math.sin(angle))

            def group(r, c):
                if name != "lid":
                    return name
                upper = 0.08 < c / count < 0.46
                return "rim" if r < 2 else ("lash" if upper else "rim") if r == 2 else "lid"

            cage.grid(len(radii), count, place, group, flip=(side == 0) != (name == "ear_back"))
    return cage


def build_nose():
    cage, rows, columns = Cage(), 26, 72
    noise = random.Random(5)
    bumps = [[noise.uniform(-0.012, 0.012) for _ in range(columns)] for _ in range(rows)]
    radii = [0.01 + 1.19 * r / (rows - 1) for r in range(rows)]

    def place(r, c):
        x, y, z = shape.nose(radii[r], c / columns)
        return (x, y, z + bumps[r][c % columns]), (c / columns, r / (rows - 1))

    cage.grid(rows, columns, place, lambda r, c: "nose", flip=True)
    return cage


def build_stage():
    """A wall far behind the animal."""
    cage = Cage()
    cage.points = [(-400, -200, -320), (400, -200, -320), (400, 250, -320), (-400, 250, -320)]
    cage.coordinates = [(0, 0), (1, 0), (1, 1), (0, 1)]
    cage.groups["wall"] = [[(i, i) for i in range(4)]]
    return cage


def write_eyes(path):
    mesh = meshes.Mesh()
    centre = shape.eye_centre()
    for name, place in (("eye_l", centre), ("eye_r", shape.mirror(centre))):
        eyes.ball(mesh, place, shape.EYE_RADIUS, name)
    meshes.write_obj(path, mesh, mesh.points, COMMENT)


def skin_at(u, v):
    """Point and part of the skin at texture coordinates; None between the discs."""
    if v <= HEAD:
        row = v / HEAD * (ROWS - 1)
        low = min(int(row), ROWS - 2)
        return vec.mix(head_point(low, u), head_point(low + 1, u), row - low), "head"
    index = min(int(u * 6), 5)
    part, side = divmod(index, 2)
    centre = disc_center(part, side)
    x, y = (u - centre[0]) / (DISC * 0.94), (v - centre[1]) / (DISC * 0.94)
    radius = min(max(math.hypot(x, y), LIDS[0] / MAX_GROW if PARTS[part][0] == "lid" else 0.01), 1.0)
    return surface(part, side)(radius, (math.atan2(y, x) / (2 * math.pi)) % 1), PARTS[part][0]


def write_maps(folder):
    pelt, flow = bytearray(), bytearray()
    for y in range(SIZE - 1, -1, -1):
        for x in range(SIZE):
            for pixels, values in zip((pelt, flow), coat.texel(*skin_at((x + 0.5) / SIZE, (y + 0.5) / SIZE))):
                pixels += bytes(min(max(round(255 * value), 0), 255) for value in values)
    png.write(folder / "pelt.png", SIZE, SIZE, 3, bytes(pelt))
    png.write(folder / "flow.png", SIZE, SIZE, 3, bytes(flow))


def write_meshes(folder):
    build_skin().write(folder / "skin.obj")
    build_nose().write(folder / "nose.obj")
    build_stage().write(folder / "stage.obj")
    write_eyes(folder / "eyes.obj")


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    write_meshes(folder)
    write_maps(folder)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "bear")
