# SPDX-License-Identifier: Apache-2.0
"""A mesh as arrays. Knows nothing of Blender's types."""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .limit_cage import LimitMap


@dataclass
class Creases:
    """Sharp edges and vertices of a cage, with sharpnesses as OpenSubdiv knows them: 0 is smooth, 10 is sharp."""
    edges: np.ndarray            # (e, 2) vertices at their ends
    edge_sharpness: np.ndarray   # (e,)
    vertices: np.ndarray         # (v,)
    vertex_sharpness: np.ndarray  # (v,)

    def arrays(self) -> list[np.ndarray]:
        return [self.edges, self.edge_sharpness, self.vertices, self.vertex_sharpness]

    def moved(self, new_vertex: np.ndarray) -> Creases:
        """The same creases where vertex i has become new_vertex[i]; -1: it is gone, with its creases."""
        edges, vertices = new_vertex[self.edges], new_vertex[self.vertices]
        kept, there = (edges >= 0).all(axis=1), vertices >= 0
        return Creases(edges[kept], self.edge_sharpness[kept], vertices[there], self.vertex_sharpness[there])


@dataclass
class Cage:
    """A mesh in the space of its object and with the axes of Blender."""
    points: np.ndarray                   # (n, 3)
    sizes: np.ndarray                    # (f,) number of corners of each face
    corners: np.ndarray                  # (c,) their vertices
    uvs: np.ndarray | None               # (c, 2)
    slots: np.ndarray                    # (f,) index of the material slot
    scheme: str = "none"
    boundary: str = "edge-and-corner"
    rest: np.ndarray | None = None       # (n, 3) before modifiers; None: the same as points
    vertices: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int64))  # (n,) vertex of Blender's mesh
    colors: np.ndarray | None = None     # (n, 3) vertex groups
    creases: Creases | None = None       # None: the cage is smooth everywhere
    limit: LimitMap | None = None        # of a cage that modifiers deform: finds it from the limit surface
    topology: tuple[int, int] = (0, 0)   # numbers of vertices and corners of the evaluated mesh that the poses are read from

    def used_slots(self) -> list[int]:
        return [int(slot) for slot in np.unique(self.slots)]


Placed = tuple[Cage, list[np.ndarray]]
"""A cage, and its points per motion key."""


def turned_over(cage: Cage) -> None:
    """Reverses the corners of each face: the object is mirrored, and its outer side stays outside."""
    starts = np.concatenate([[0], np.cumsum(cage.sizes)]).astype(np.int64)
    place = np.arange(len(cage.corners))
    face = np.repeat(np.arange(len(cage.sizes)), cage.sizes)
    order = starts[face] + starts[face + 1] - 1 - place
    cage.corners = cage.corners[order]
    if cage.uvs is not None:
        cage.uvs = cage.uvs[order]


def faces_of_slot(cage: Cage, slot: int) -> Cage:
    """The faces with one material, with the vertices that they need; `vertices` are those of `cage`."""
    chosen = cage.slots == slot
    of_corner = np.repeat(chosen, cage.sizes)
    used, corners = np.unique(cage.corners[of_corner], return_inverse=True)
    creases = None
    if cage.creases is not None:
        new_vertex = np.full(len(cage.points), -1)
        new_vertex[used] = np.arange(len(used))
        creases = cage.creases.moved(new_vertex)
    return Cage(cage.points[used], cage.sizes[chosen], corners.ravel(), None if cage.uvs is None else cage.uvs[of_corner],
                cage.slots[chosen], cage.scheme, cage.boundary, vertices=used, creases=creases)


def merged(parts: list[Placed]) -> Placed:
    """Several meshes as one, which has the scheme of the first."""
    cages = [cage for cage, _ in parts]
    first = np.cumsum([0] + [len(cage.points) for cage in cages])
    uvs = None
    if any(cage.uvs is not None for cage in cages):
        uvs = np.concatenate([cage.uvs if cage.uvs is not None else np.zeros((len(cage.corners), 2), np.float32)
                              for cage in cages])
    shifted = [cage.creases.moved(np.arange(len(cage.points)) + offset)
               for cage, offset in zip(cages, first) if cage.creases is not None]
    creases = Creases(*(np.concatenate(arrays) for arrays in zip(*(c.arrays() for c in shifted)))) if shifted else None
    cage = Cage(np.concatenate([cage.points for cage in cages]), np.concatenate([cage.sizes for cage in cages]),
                np.concatenate([cage.corners + offset for cage, offset in zip(cages, first)]), uvs,
                np.concatenate([cage.slots for cage in cages]), cages[0].scheme, cages[0].boundary, creases=creases)
    return cage, [np.concatenate([poses[k] for _, poses in parts]) for k in range(len(parts[0][1]))]
