# SPDX-License-Identifier: Apache-2.0
"""Hair Curves as strands."""
from __future__ import annotations

import bpy
import numpy as np

from .axes import transformed
from .hair_particles import HairStrands

DEFAULT_RADIUS = 0.005
"""Radius that Cycles gives to curves without an attribute for it."""


def read_curves(curves: bpy.types.Curves, matrix: object) -> HairStrands | None:
    """The strands of hair Curves, moved by a matrix (4, 4); None if there are none."""
    count = len(curves.position_data)
    if count == 0 or len(curves.curves) == 0:
        return None
    points = np.empty(count * 3, np.float32)
    curves.position_data.foreach_get("vector", points)
    offsets = np.empty(len(curves.curves) + 1, np.int32)
    curves.curve_offset_data.foreach_get("value", offsets)
    widths = np.full(count, 2 * DEFAULT_RADIUS, np.float32)
    radius = curves.attributes.get("radius")
    if radius is not None and radius.domain == "POINT" and radius.data_type == "FLOAT":
        radius.data.foreach_get("value", widths)
        widths *= 2
    scale = abs(float(np.linalg.det(np.asarray(matrix, np.float64)[:3, :3]))) ** (1 / 3)
    counts = np.diff(offsets)
    inside = np.repeat(counts > 1, counts)
    moved = transformed(points.reshape(-1, 3), matrix)
    counts = counts[counts > 1]
    if len(counts) == 0:
        return None
    return HairStrands(moved[inside], widths[inside] * scale, counts)
