#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the furball that renderers are compared on: furball.hair, furball.obj and furball.yaml.

  make_furball.py [--strands N] [FOLDER]

A bumpy ball of radius about 1 with strands of 8 points, combed by smooth noise, drooping, frizzy, and pulled into
about 2,500 clumps, between two rectangle lights under a constant sky. The radius of the strands shrinks with
their number, so that coverage stays the same. 100,000 strands take about 25 s and 14 MB. Needs only Python 3.
"""
import argparse
import array
import math
import pathlib
import random
import struct

POINTS, CLUMPS = 8, 2500

SCENE = """pelage: 1
# Written by examples/make_furball.py: {strands} strands of 8 points, in {clumps} clumps.
units: {{meters_per_unit: 1}}
camera: {{position: [0, 0, 4.7], look_at: [0, 0, 0], fov: 36}}
image: {{width: 960, height: 540}}

skins:
  ball: {{mesh: furball.obj, scheme: none}}
grooms:
  fur: {{strands_file: furball.hair}}
materials:
  skin: {{model: lambert, color: [0.45, 0.30, 0.22]}}
  fur: {{model: chiang, absorption: [0.10, 0.18, 0.38], beta_m: 0.3, beta_n: 0.3, alpha: 2}}
characters:
  ball: {{parts: [{{skin: ball, material: skin, grooms: {{fur: fur}}}}]}}

lights:
  key: {{type: rectangle, position: [2.4, 2.2, 2.3], look_at: [0, 0, 0], size: [2, 2], radiance: [14, 13, 12]}}
  rim: {{type: rectangle, position: [-2.2, 1.8, -2.8], look_at: [0, 0, 0], size: [1.5, 1.4], radiance: [16, 18, 22]}}
  sky: {{type: environment, radiance: [0.25, 0.28, 0.33]}}

render: {{samples: 64, bounces: 12, lod: {{enabled: false}}}}
"""


def smooth_noise(waves, p, frequency):
    """A few plane waves for each component."""
    return [sum(math.sin(frequency * 2.5 * (d[0] * p[0] + d[1] * p[1] + d[2] * p[2]) + d[3]) for d in axis) / 3
            for axis in waves]


def make_waves(rng):
    return [[(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-math.pi, math.pi))
             for _ in range(6)] for _ in range(3)]


def surface(d):
    bump = (1 + 0.06 * math.sin(7 * d[0] + 1) * math.sin(6 * d[1]) + 0.05 * math.sin(9 * d[2] + 5 * d[0]))
    return (d[0] * bump * 1.05, d[1] * bump * 0.95, d[2] * bump)


def normalized(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


def normal(d):
    """Of the surface, by finite differences."""
    helper = (1, 0, 0) if abs(d[0]) < 0.6 else (0, 1, 0)
    a = normalized((d[1] * helper[2] - d[2] * helper[1], d[2] * helper[0] - d[0] * helper[2],
                    d[0] * helper[1] - d[1] * helper[0]))
    b = (d[1] * a[2] - d[2] * a[1], d[2] * a[0] - d[0] * a[2], d[0] * a[1] - d[1] * a[0])
    p = surface(d)
    u, v = [[q - r for q, r in zip(surface(normalized([x + 1e-3 * y for x, y in zip(d, along)])), p)]
            for along in (a, b)]
    n = normalized((u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]))
    return n if sum(x * y for x, y in zip(n, d)) > 0 else [-x for x in n]


def random_direction(rng):
    z, phi = rng.uniform(-1, 1), rng.uniform(0, 2 * math.pi)
    s = math.sqrt(max(0.0, 1 - z * z))
    return (s * math.cos(phi), s * math.sin(phi), z)


def grow(rng, lie, frizz, index):
    """Points of a strand before it is pulled to its clump."""
    d = random_direction(rng)
    root = surface(d)
    n, comb, wild = normal(d), smooth_noise(lie, root, 1.2), random_direction(rng)
    along = normalized([a + 0.45 * b + 0.18 * c for a, b, c in zip(n, comb, wild)])
    length = 0.30 * rng.uniform(0.75, 1.25)
    points = []
    for k in range(POINTS):
        v = k / (POINTS - 1)
        f = smooth_noise(frizz, (index % 4096, 12 * v, index // 4096), 1.0)
        p = [r + v * length * a + 0.02 * v * w for r, a, w in zip(root, along, f)]
        p[1] -= 0.13 * v * v
        points.append(p)
    return points


class Clumps:
    """Centre strands, found by the cell of their roots."""

    def __init__(self, rng, lie, frizz):
        self.cells = {}
        for i in range(CLUMPS):
            centre = grow(rng, lie, frizz, i)
            self.cells.setdefault(self.cell(centre[0]), []).append(centre)

    @staticmethod
    def cell(p):
        return tuple(int((x + 1.6) * 7.5) for x in p)

    def nearest(self, p):
        x, y, z = self.cell(p)
        near = [c for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)
                for c in self.cells.get((x + i, y + j, z + k), ())]
        return min(near, key=lambda c: sum((a - b) ** 2 for a, b in zip(c[0], p)), default=None)


def write_hair(path, strands):
    """Cem Yuksel's .hair: points, and a thickness (diameter) for each."""
    rng = random.Random(1)
    lie, frizz = make_waves(rng), make_waves(rng)
    clumps = Clumps(rng, lie, frizz)
    radius = 0.0011 * math.sqrt(1e5 / strands)
    positions, thickness = array.array("f"), array.array("f")
    taper = [2 * radius * (1 - 0.85 * k / (POINTS - 1)) for k in range(POINTS)]
    for i in range(strands):
        points = grow(rng, lie, frizz, i)
        centre = clumps.nearest(points[0])
        for k, p in enumerate(points):
            pull = 0.65 * k / (POINTS - 1) if centre else 0
            positions.extend(a + pull * (c - a) for a, c in zip(p, centre[k] if centre else p))
        thickness.extend(taper)
    with open(path, "wb") as out:
        has_points, has_thickness = 2, 4
        out.write(struct.pack("<4s4I2f3f88s", b"HAIR", strands, strands * POINTS, has_points | has_thickness,
                              POINTS - 1, 2 * radius, 0.0, 0.0, 0.0, 0.0, b"furball"))
        for values in (positions, thickness):
            values.tofile(out)


def write_ball(path, rows=96, columns=192):
    lines = ["# Written by examples/make_furball.py."]
    for i in range(rows + 1):
        for j in range(columns):
            theta, phi = math.pi * i / rows, 2 * math.pi * j / columns
            d = (math.sin(theta) * math.cos(phi), math.cos(theta), math.sin(theta) * math.sin(phi))
            lines.append("v %.6f %.6f %.6f" % surface(d))
    for i in range(rows):
        for j in range(columns):
            a, b = i * columns + j + 1, i * columns + (j + 1) % columns + 1
            if i > 0:
                lines.append("f %d %d %d" % (a, b, a + columns))
            if i < rows - 1:
                lines.append("f %d %d %d" % (b, b + columns, a + columns))
    path.write_text("\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--strands", type=int, default=100000)
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=pathlib.Path("."))
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    write_hair(arguments.folder / "furball.hair", arguments.strands)
    write_ball(arguments.folder / "furball.obj")
    (arguments.folder / "furball.yaml").write_text(SCENE.format(strands=arguments.strands, clumps=CLUMPS))


if __name__ == "__main__":
    main()
