# SPDX-License-Identifier: Apache-2.0
"""Meshes as OBJ files, and strands as .hair files. Knows nothing of Blender."""
from __future__ import annotations

import struct

import numpy as np

from .cage import Creases


def _rows(pattern: str, values: np.ndarray) -> str:
    return pattern * len(values) % tuple(values.ravel().tolist())


def vertex_text(points: np.ndarray, colors: np.ndarray | None = None) -> str:
    """The v lines of an OBJ file for points (n, 3), with colours (n, 3)."""
    if colors is None:
        return _rows("v %.9g %.9g %.9g\n", points)
    return _rows("v %.9g %.9g %.9g %.6g %.6g %.6g\n", np.hstack([points, colors]))


def obj_text(points: np.ndarray, sizes: np.ndarray, corners: np.ndarray, uvs: np.ndarray | None = None,
             groups: list[tuple[str, np.ndarray]] | None = None, colors: np.ndarray | None = None,
             creases: Creases | None = None) -> str:
    """The text of an OBJ file.

    points (n, 3); sizes (f,) numbers of corners of the faces, and corners (sum of sizes,) their vertices; uvs (corners, 2);
    groups: names with the indices of their faces, each face in one of them; colors (n, 3) from 0 to 1.
    """
    parts = [vertex_text(points, colors)]
    tokens, corner = corners.astype(np.int64)[:, None] + 1, " %d"
    if uvs is not None:
        unique, places = np.unique(np.ascontiguousarray(uvs, np.float32), axis=0, return_inverse=True)
        parts.append(_rows("vt %.7g %.7g\n", unique))
        tokens, corner = np.hstack([tokens, places.reshape(-1, 1) + 1]), " %d/%d"
    starts = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
    for name, faces in groups or [("", np.arange(len(sizes)))]:
        if name:
            parts.append(f"usemtl {name}\n")
        for size in np.unique(sizes[faces]):
            chosen = faces[sizes[faces] == size]
            where = (starts[chosen][:, None] + np.arange(size)).ravel()
            parts.append(_rows("f" + corner * int(size) + "\n", tokens[where].reshape(len(chosen), -1)))
    if creases is not None:
        parts.append(crease_text(creases))
    return "".join(parts)


def crease_text(creases: Creases) -> str:
    """The t lines of an OBJ file, as OpenSubdiv's shapes have them: their vertices are counted from 0."""
    edges = np.hstack([creases.edges, creases.edge_sharpness[:, None]])
    corners = np.stack([creases.vertices, creases.vertex_sharpness], axis=1)
    return _rows("t crease 2/1/0 %d %d %.6g\n", edges) + _rows("t corner 1/1/0 %d %.6g\n", corners)


def hair_bytes(points: np.ndarray, widths: np.ndarray, counts: np.ndarray) -> bytes:
    """Strands as a .hair file of Cem Yuksel.

    points (p, 3), widths (p,) diameters, counts (n,) numbers of points of the strands, each from 2 to 65536.
    """
    same = int(counts[0]) if len(counts) and np.all(counts == counts[0]) else 0
    arrays = 2 | 4 | (0 if same else 1)  # points, thickness, and segments where they differ
    head = struct.pack("<4sIIIIff3f88s", b"HAIR", len(counts), len(points), arrays, same - 1 if same else 0,
                       0.0, 0.0, 0.5, 0.5, 0.5, b"Pelage for Blender")
    segments = b"" if same else (np.asarray(counts) - 1).astype("<u2").tobytes()
    return head + segments + np.asarray(points, "<f4").tobytes() + np.asarray(widths, "<f4").tobytes()
