# SPDX-License-Identifier: Apache-2.0
"""Lays the charts of a cage out in the unit square without overlap."""
import vec

SIZE = 512            # texels a side, for which the gutters are reckoned
TEXELS_PER_CM = 18
CELL_TEXELS = (6, 36)  # least and most texels of a cell's side
GUTTER = 4            # texels around every chart


class Atlas:
    """Maps (chart, corner) to texture coordinates; u to the right, v up."""

    def __init__(self, mesh, texels_per_cm=TEXELS_PER_CM):
        self.charts = {}
        for name, faces in faces_by_chart(mesh).items():
            corners = [c for f in faces for c in f.corners]
            low = (min(c[0] for c in corners), min(c[1] for c in corners))
            high = (max(c[0] for c in corners), max(c[1] for c in corners))
            self.charts[name] = {"low": low, "cells": (high[0] - low[0], high[1] - low[1]),
                                 "texels": cell_size(mesh, faces, texels_per_cm)}
        self.pack()

    def pack(self):
        """Columns from left to right, widest charts first."""
        def size(chart):
            return tuple(c * t + 2 * GUTTER for c, t in zip(chart["cells"], chart["texels"]))

        columns = []       # [left, width, next free row]
        for name in sorted(self.charts, key=lambda n: (-size(self.charts[n])[0], n)):
            chart = self.charts[name]
            width, height = size(chart)
            column = next((c for c in columns if c[1] >= width and c[2] + height <= SIZE), None)
            if column is None:
                column = [sum(c[1] for c in columns), width, 0]
                columns.append(column)
            chart["origin"] = (column[0] + GUTTER, column[2] + GUTTER)
            column[2] += height
        used = sum(c[1] for c in columns)
        if used > SIZE:
            raise ValueError("the charts need %d texels of %d" % (used, SIZE))

    def texel(self, chart, corner):
        """Position in texels, from the left and from the bottom."""
        c = self.charts[chart]
        return tuple(c["origin"][i] + (corner[i] - c["low"][i]) * c["texels"][i] for i in (0, 1))

    def uv(self, chart, corner):
        x, y = self.texel(chart, corner)
        return (x / SIZE, y / SIZE)


def faces_by_chart(mesh):
    charts = {}
    for face in mesh.faces:
        charts.setdefault(face.chart, []).append(face)
    return charts


def cell_size(mesh, faces, texels_per_cm):
    """Texels along a cell's two sides, from the mean lengths of its edges in space."""
    lengths = ([], [])
    for face in faces:
        for i in range(4):
            j = (i + 1) % 4
            step = [abs(a - b) for a, b in zip(face.corners[i], face.corners[j])]
            edge = vec.distance(mesh.points[face.vertices[i]], mesh.points[face.vertices[j]])
            axis = 0 if step[0] >= step[1] else 1
            lengths[axis].append(edge / step[axis])
    low, high = CELL_TEXELS
    return tuple(min(max(round(texels_per_cm * sum(l) / len(l)), low), high) for l in lengths)
