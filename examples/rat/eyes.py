# SPDX-License-Identifier: Apache-2.0
"""The eyes: two closed balls of quads, a little out of their sockets."""
import vec
from mesh import Mesh

CENTRE = (1.40, 5.36, 6.88)
RADIUS = 0.47
CAGE_GAIN = 1.10     # Catmull-Clark shrinks a ball of this cage by about this much


def ball(mesh, centre, radius, group):
    """A cube of 2 x 2 quads a side, blown up to a ball."""
    steps = (-1, 0, 1)
    index = {}
    for x in steps:
        for y in steps:
            for z in steps:
                if (x, y, z) != (0, 0, 0):
                    index[x, y, z] = mesh.add_point(vec.along(centre, vec.unit((x, y, z)), radius * CAGE_GAIN))
    for side, axis in enumerate((0, 1, 2, 0, 1, 2)):
        sign = 1 if side < 3 else -1
        u, v = [0, 0, 0], [0, 0, 0]
        u[(axis + 1) % 3], v[(axis + 2) % 3] = 1, sign
        for i in (-1, 0):
            for j in (-1, 0):
                corners = ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
                vertices = []
                for a, b in corners:
                    key = [a * s + b * t for s, t in zip(u, v)]
                    key[axis] = sign
                    vertices.append(index[tuple(key)])
                mesh.add_face(vertices, group, "%s_%d" % (group, side), [(a + 1, b + 1) for a, b in corners])


def build():
    mesh = Mesh()
    x, y, z = CENTRE
    ball(mesh, (x, y, z), RADIUS, "eye_l")
    ball(mesh, (-x, y, z), RADIUS, "eye_r")
    return mesh
