# SPDX-License-Identifier: Apache-2.0
"""Quad control cages: points, faces with groups and chart cells, Catmull-Clark, OBJ."""
from collections import namedtuple

import vec

# corners: for each vertex of the face its (column, row) in the chart's grid of cells
Face = namedtuple("Face", "vertices group chart corners")

UNIT_CELL = ((0, 0), (0, 1), (1, 1), (1, 0))


class Mesh:
    """A cage under construction. Faces wind counter-clockwise seen from outside."""

    def __init__(self):
        self.points = []
        self.faces = []

    def add_points(self, points):
        first = len(self.points)
        self.points.extend(tuple(map(float, p)) for p in points)
        return list(range(first, len(self.points)))

    def add_point(self, point):
        return self.add_points([point])[0]

    def add_face(self, vertices, group, chart, corners, flip=False):
        vertices, corners = tuple(vertices), tuple(corners)
        if flip:
            vertices, corners = vertices[::-1], corners[::-1]
        self.faces.append(Face(vertices, group, chart, corners))

    def bridge(self, lower, upper, group, chart, row, flip=False, first_column=0, skip=()):
        """Joins two loops of equal size by quads; `skip` names columns left open.

        Loops run clockwise seen from the tip, looking back at the base (or set `flip`).
        """
        count = len(lower)
        for c in range(count):
            if c in skip:
                continue
            d = (c + 1) % count
            column = (c + first_column) % count
            corners = ((column, row), (column, row + 1), (column + 1, row + 1), (column + 1, row))
            self.add_face((lower[c], upper[c], upper[d], lower[d]), group, chart, corners, flip)

    def groups(self):
        """Group names in order of first use."""
        return list(dict.fromkeys(face.group for face in self.faces))

    def group_vertices(self, group):
        return sorted({v for f in self.faces if f.group == group for v in f.vertices})


def subdivide(points, quads):
    """One Catmull-Clark step on a closed quad mesh.

    Returns (points, quads); the quads 4f .. 4f+3 lie in face f, at its corners in order, each
    starting with its corner.
    """
    face_points = [vec.mean(points[v] for v in quad) for quad in quads]
    edge_faces, vertex_faces, vertex_edges = {}, [[] for _ in points], [set() for _ in points]
    for f, quad in enumerate(quads):
        for a, b in zip(quad, quad[1:] + quad[:1]):
            edge_faces.setdefault((min(a, b), max(a, b)), []).append(f)
            vertex_faces[a].append(f)
            vertex_edges[a].add(b)
            vertex_edges[b].add(a)

    new_points = []
    for v, p in enumerate(points):
        n = len(vertex_faces[v])
        around = vec.mean(face_points[f] for f in vertex_faces[v])
        middles = vec.mean(vec.mix(p, points[w], 0.5) for w in sorted(vertex_edges[v]))
        new_points.append(vec.scale(vec.add(around, vec.scale(middles, 2), vec.scale(p, n - 3)), 1 / n))
    edge_index = {}
    for (a, b), faces in edge_faces.items():
        edge_index[a, b] = len(new_points)
        new_points.append(vec.mean([points[a], points[b]] + [face_points[f] for f in faces]))
    first_face_point = len(new_points)
    new_points.extend(face_points)

    new_quads = []
    for f, quad in enumerate(quads):
        edges = [edge_index[min(a, b), max(a, b)] for a, b in zip(quad, quad[1:] + quad[:1])]
        for i in range(4):
            new_quads.append((quad[i], edges[i], first_face_point + f, edges[i - 1]))
    return new_points, new_quads


def vertex_normals(points, quads):
    """Area-weighted unit normals, outward."""
    sums = [[0.0, 0.0, 0.0] for _ in points]
    for quad in quads:
        a, b, c, d = (points[v] for v in quad)
        n = vec.cross(vec.sub(c, a), vec.sub(d, b))
        for v in quad:
            total = sums[v]
            total[0] += n[0]
            total[1] += n[1]
            total[2] += n[2]
    return [vec.unit(s) for s in sums]


def write_obj(path, mesh, points, comment, uv=None):
    """Writes `mesh` with the given positions; `uv(chart, corner)` gives texture coordinates."""
    lines = ["# " + line for line in comment]
    lines += ["v %.4f %.4f %.4f" % tuple(p) for p in points]
    index = {}
    if uv:
        for face in mesh.faces:
            for corner in face.corners:
                index.setdefault((face.chart, corner), len(index) + 1)
        lines += ["vt %.6f %.6f" % uv(chart, corner) for chart, corner in index]
    for group in mesh.groups():
        lines.append("g " + group)
        for face in mesh.faces:
            if face.group == group:
                corners = [(str(v + 1), index.get((face.chart, c))) for v, c in zip(face.vertices, face.corners)]
                lines.append("f " + " ".join(v if t is None else "%s/%d" % (v, t) for v, t in corners))
    path.write_text("\n".join(lines) + "\n")
