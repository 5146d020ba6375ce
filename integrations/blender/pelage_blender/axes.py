# SPDX-License-Identifier: Apache-2.0
"""Directions, angles and lengths: Blender has z up, Pelage has y up; both are right-handed. Knows nothing of Blender's types."""
from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

FLOATS = np.ndarray
"""Array of numbers of any shape."""


def to_pelage(points: Any) -> FLOATS:
    """Turns points or directions (..., 3) of Blender, (x, y, z), into those of Pelage, (x, z, -y)."""
    old = np.asarray(points, np.float32)
    return np.stack([old[..., 0], old[..., 2], -old[..., 1]], axis=-1)


def transformed(points: FLOATS, matrix: Any) -> FLOATS:
    """Applies a matrix (4, 4) of columns to points (n, 3), in double precision."""
    m = np.asarray(matrix, np.float64)
    return np.asarray(points, np.float64) @ m[:3, :3].T + m[:3, 3]


def numbers(values: Any) -> list[float]:
    """Plain numbers for a scene file: seven digits, as a float has."""
    return [float(f"{value:.7g}") + 0.0 for value in np.asarray(values, np.float64).ravel()]


def place(point: Sequence[float]) -> list[float]:
    """A point or direction of Blender as numbers of a scene file."""
    return numbers(to_pelage(np.asarray(point, np.float64)))


def environment_rotation(mapping_z: float) -> list[float]:
    """`rotate` of an environment, in degrees, for a Mapping node that rotates by mapping_z radians about z.

    Blender's direction +x is the centre column of the image, Pelage's is -z, which is +y of Blender.
    """
    return [0.0, float(f"{-90 - math.degrees(mapping_z):.7g}"), 0.0]


def vertical_fov(projection_11: float) -> float:
    """Vertical field of view in degrees of a projection matrix whose element [1][1] is given."""
    return math.degrees(2 * math.atan(1 / projection_11))


def spot_softness(cone: float, blend: float) -> float:
    """`softness` of a spot with a whole angle of `cone` radians, for Blender's `blend`.

    Both fade by a cubic step between the cosines of two angles. In Blender, `blend` divides the difference of the cosines; in
    Pelage, `softness` divides the angle.
    """
    half = 0.5 * cone
    inner = math.acos(min(1.0, math.cos(half) + (1 - math.cos(half)) * blend))
    return min(max(1 - inner / half, 0.0), 1.0)


def spot_image(cone: float, pixels: int = 65) -> FLOATS:
    """Image (pixels, pixels) for a spot with a whole angle of `cone` degrees: the cosine of the angle to the axis.

    Cycles multiplies the light of a spot by this cosine, Pelage does not. The square of the image fits around the cone.
    """
    side = np.linspace(1 / pixels - 1, 1 - 1 / pixels, pixels) * math.tan(math.radians(0.5 * cone))
    return np.asarray(1 / np.sqrt(1 + side[:, None] ** 2 + side[None, :] ** 2), np.float32)


def index_of_refraction(specular: float) -> float:
    """Index of refraction for `Specular` of the Principled BSDF, which is the reflectance at normal incidence / 0.08."""
    root = math.sqrt(min(max(0.08 * specular, 1e-4), 0.9))
    return min((1 + root) / (1 - root), 3.0)
