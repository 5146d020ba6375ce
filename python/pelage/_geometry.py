# SPDX-License-Identifier: Apache-2.0
"""Meshes and their poses."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from . import _pelage
from ._arguments import path as file_path
from ._arrays import floats, integers

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


class Mesh:
    """A cage in memory, for `skins.NAME.mesh` of a scene in place of an OBJ file.

    points: (n, 3), positions of vertices in scene units.
    faces: (m, k), the vertices of m faces with k corners each, counted from 0; or, with `face_sizes`, (c,), the
        vertices of all corners, face by face.
    face_sizes: (m,), number of corners of each face, at least 3.
    uv: (t, 2), texture coordinates. face_uv: like `faces`, index into `uv` of each corner; not needed where every
        vertex has one texture coordinate.

    Raises TypeError or ValueError for wrong types, shapes and NaN, and pelage.Error for indices out of range and
    faces with fewer than 3 different vertices.
    """

    __slots__ = ("_data",)

    def __init__(
        self,
        points: ArrayLike,
        faces: ArrayLike,
        *,
        face_sizes: ArrayLike | None = None,
        uv: ArrayLike | None = None,
        face_uv: ArrayLike | None = None,
    ) -> None:
        import numpy as np

        places = floats(points, "points", (None, 3))
        if face_sizes is None:
            table = integers(faces, "faces", "uint32", (None, None))
            sizes = np.full(table.shape[0], table.shape[1], np.uint32)
        else:
            table = integers(faces, "faces", "uint32", (None,))
            sizes = integers(face_sizes, "face_sizes", "uint32", (None,))
        coordinates = floats(np.empty((0, 2), np.float32) if uv is None else uv, "uv", (None, 2))
        if face_uv is not None:
            corners = integers(face_uv, "face_uv", "uint32", table.shape)
        elif uv is not None:
            corners = table
        else:
            corners = np.empty(0, np.uint32)
        self._data: _pelage.MeshData = _pelage.make_mesh(places, sizes, table.ravel(), coordinates, corners.ravel())

    @staticmethod
    def read(path: str | os.PathLike[str]) -> Mesh:
        """Reads an OBJ file."""
        mesh = Mesh.__new__(Mesh)
        mesh._data = _pelage.read_mesh(file_path(path, "path"))
        return mesh

    @property
    def points(self) -> NDArray[np.float32]:
        """(n, 3), positions. Read-only, not a copy."""
        return self._data.points

    @property
    def face_sizes(self) -> NDArray[np.uint32]:
        """(m,), number of corners of each face. Read-only, not a copy."""
        return self._data.face_sizes

    @property
    def face_vertices(self) -> NDArray[np.uint32]:
        """(c,), vertex of each corner, face by face. Read-only, not a copy."""
        return self._data.face_vertices

    def __repr__(self) -> str:
        return f"<pelage.Mesh: {len(self.points)} points, {len(self.face_sizes)} faces>"


class Poses:
    """Posed positions of a mesh, for `poses.files` of a skin in place of OBJ files.

    points: (m, n, 3), m poses of the n vertices of the mesh, in scene units. In a scene, "poses": {"files": poses,
    "count": len(poses)} shows the first of them at frame 1 and interpolates between them.
    """

    __slots__ = ("_count", "_data")

    def __init__(self, points: ArrayLike) -> None:
        places = floats(points, "points", (None, None, 3))
        self._count: int = places.shape[0]
        self._data: _pelage.PoseData = _pelage.make_poses(places)

    def __len__(self) -> int:
        return self._count

    def __repr__(self) -> str:
        return f"<pelage.Poses: {self._count}>"
