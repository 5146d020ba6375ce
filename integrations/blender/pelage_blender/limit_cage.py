# SPDX-License-Identifier: Apache-2.0
"""Finds the cage of a Catmull-Clark surface from limit positions of its vertices.

Blender shows the result of all modifiers together. Where the last one subdivides a deformed cage, Pelage needs this cage: the
first vertices of the subdivided mesh are those of the cage, moved to the limit surface [Halstead93, appendix A], and the
map from cage to limit is linear with eigenvalues from 1/9 to 1, so that a relaxed iteration inverts it. Knows nothing of Blender.
"""
from __future__ import annotations

import numpy as np

RELAXATION = 1.6
MAX_STEPS = 200


class LimitMap:
    """The map from the vertices of a cage to their limit positions, without creases.

    sizes (f,): corners of each face; corners: their vertices; count: number of vertices; keep_corners: boundary vertices with one
    face stay where they are, as with the boundary rule edge-and-corner.
    """

    def __init__(self, sizes: np.ndarray, corners: np.ndarray, count: int, keep_corners: bool) -> None:
        self.count, self.sizes = count, sizes.astype(np.float64)
        self.face = np.repeat(np.arange(len(sizes)), sizes)
        self.corner = corners.astype(np.int64)
        starts = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
        follower = np.arange(len(corners)) + 1
        follower[starts[1:] - 1] = starts[:-1]
        pairs = np.sort(np.stack([self.corner, self.corner[follower]], axis=1), axis=1)
        self.edges, of_side = np.unique(pairs, axis=0, return_inverse=True)
        self.side = of_side.ravel()
        self.faces_of_edge = np.bincount(self.side, minlength=len(self.edges))
        self.valence = np.bincount(self.edges.ravel(), minlength=count).astype(np.float64)
        self.faces_of_vertex = np.bincount(self.corner, minlength=count)
        border = self.faces_of_edge != 2
        self.border_edges = self.edges[border]
        on_border = np.bincount(self.border_edges.ravel(), minlength=count)
        self.smooth = (on_border == 0) & (self.valence > 0)
        self.on_border = on_border == 2
        if keep_corners:
            self.on_border &= self.faces_of_vertex > 1

    def _sum(self, index: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
        return np.stack([np.bincount(index, values[:, i], count) for i in range(3)], axis=1)

    def _at_ends(self, edges: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
        """Sum over the edges of each vertex: `first` at the first ends, `second` at the second ends."""
        return self._sum(edges[:, 0], first, self.count) + self._sum(edges[:, 1], second, self.count)

    def limit(self, points: np.ndarray) -> np.ndarray:
        """Limit positions (n, 3) of the vertices of a cage (n, 3)."""
        faces = self._sum(self.face, points[self.corner], len(self.sizes)) / self.sizes[:, None]
        ends = points[self.edges[:, 0]], points[self.edges[:, 1]]
        middle = 0.5 * (ends[0] + ends[1])
        beside = self._sum(self.side, faces[self.face], len(self.edges))
        edge_points = 0.25 * (ends[0] + ends[1] + beside)
        n = np.maximum(self.valence, 1)[:, None]
        face_sum = self._sum(self.corner, faces[self.face], self.count)
        moved = (face_sum / n + 2 * self._at_ends(self.edges, middle, middle) / n + (n - 3) * points) / n
        inner = (n**2 * moved + 4 * self._at_ends(self.edges, edge_points, edge_points) + face_sum) / (n * (n + 5))
        # On the border: the cubic B-spline through the border's vertices, (a + 4 b + c) / 6.
        a, b = points[self.border_edges[:, 0]], points[self.border_edges[:, 1]]
        spline = (4 * points + self._at_ends(self.border_edges, b, a)) / 6
        return np.where(self.smooth[:, None], inner, np.where(self.on_border[:, None], spline, points))

    def cage(self, limits: np.ndarray) -> np.ndarray:
        """The cage (n, 3) whose limit positions are given, to a millionth of its size."""
        points = limits.astype(np.float64)
        close = 1e-6 * max(float(np.ptp(points, axis=0).max(initial=0)), 1e-12)
        for _ in range(MAX_STEPS):
            error = limits - self.limit(points)
            if float(np.abs(error).max(initial=0)) < close:
                break
            points += RELAXATION * error
        return points
