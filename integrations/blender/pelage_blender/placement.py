# SPDX-License-Identifier: Apache-2.0
"""Matrices of objects as a stretch of their meshes and a `transform` of characters, so that instances share a mesh."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import mathutils
import numpy as np

from .axes import numbers, place, to_pelage
from .shutter import moving

ROUNDING = 1e-5
"""Largest error of a shared mesh, relative to its size. Blender stores the matrices of instances as single floats."""
AXES = to_pelage(np.eye(3)).T.astype(np.float64)
"""The matrix that turns points of Blender into those of Pelage."""


@dataclass
class Placement:
    """A mesh and its place: its points times `stretch`, then rotated and moved by `transform`, are in the scene."""
    stretch: np.ndarray        # (3, 3) on points with the axes of Pelage
    transform: dict[str, Any]  # block of a character
    shape: tuple[float, ...]   # what meshes of the same asset must have in common so that one serves for all

    def points(self, local: np.ndarray) -> np.ndarray:
        """Points (n, 3) of an object, in its space and with the axes of Blender, as the mesh has them."""
        return np.asarray(to_pelage(local).astype(np.float64) @ self.stretch.T, np.float32)


def signed_scale(matrix: mathutils.Matrix) -> np.ndarray:
    """Scale of an object (3,); negative x: the object is mirrored.

    Which axis is mirrored makes no difference, because the directions of operators are mirrored too.
    """
    scale = np.abs(np.array(matrix.to_scale(), np.float64))  # of a mirrored matrix, Blender's are all negative
    return scale * mirror(matrix)


def mirror(matrix: mathutils.Matrix) -> np.ndarray:
    """Signs (3,) that turn a direction of the object into one of its rest pose."""
    return np.array([-1.0 if matrix.determinant() < 0 else 1.0, 1.0, 1.0])


def _rotation_and_stretch(matrix: mathutils.Matrix) -> tuple[np.ndarray, np.ndarray] | None:
    """The factors (3, 3) of a matrix without its translation; None if it makes a mesh flat."""
    m, scale = np.array(matrix, np.float64)[:3, :3], signed_scale(matrix)
    if not np.isfinite(m).all() or np.abs(scale).min() <= 1e-6 * np.abs(scale).max():
        return None
    rotation = m / scale
    if np.abs(rotation.T @ rotation - np.eye(3)).max() < ROUNDING:
        return rotation, np.diag(scale)
    # A sheared object: polar decomposition.
    u, values, vt = np.linalg.svd(m)
    if values[2] <= 1e-6 * values[0]:
        return None
    sign = math.copysign(1.0, np.linalg.det(m))
    return sign * (u @ vt), sign * (vt.T * values) @ vt


def placement_of(matrices: list[mathutils.Matrix], sized: bool) -> Placement | None:
    """The placement of an object with a matrix per motion key; None if its mesh changes its shape or is flat.

    sized: the mesh has the size of the object in the scene, as fur needs it; otherwise the transform scales it.
    """
    blocks: list[dict[str, Any]] = []
    first, euler = None, None
    for matrix in matrices:
        factors = _rotation_and_stretch(matrix)
        if factors is None:
            return None
        rotation, stretch = factors
        size = abs(np.linalg.det(stretch)) ** (1 / 3)
        if first is None:
            first = stretch if sized else stretch / size
        elif np.abs((stretch if sized else stretch / size) - first).max() > ROUNDING * np.abs(first).max():
            return None
        turn = mathutils.Matrix(AXES @ rotation @ AXES.T)
        euler = turn.to_euler("XYZ", euler) if euler is not None else turn.to_euler("XYZ")
        block = {"translate": place(matrix.translation), "rotate": numbers([math.degrees(angle) for angle in euler])}
        blocks.append(block if sized else block | {"scale": numbers([size])[0]})
    assert first is not None
    length = abs(np.linalg.det(first)) ** (1 / 3)
    shape = (float(f"{length:.5g}"), *(np.round(first / length, 5) + 0.0).ravel().tolist())
    return Placement(AXES @ first @ AXES.T, moving(blocks, ("translate", "rotate", "scale")), shape)
