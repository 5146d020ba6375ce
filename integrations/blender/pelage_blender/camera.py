# SPDX-License-Identifier: Apache-2.0
"""The camera of a Blender scene as the camera of a Pelage scene."""
from __future__ import annotations

import math
from typing import Any

import bpy
import mathutils
import numpy as np

from .axes import numbers, place, vertical_fov

Notes = set[str]


def focus_distance(camera: bpy.types.Object) -> float:
    """Distance of the focal plane along the view axis."""
    dof = camera.data.dof
    if dof.focus_object is None:
        return max(dof.focus_distance, 1e-4)
    target = dof.focus_object.matrix_world.translation - camera.matrix_world.translation
    return max(target.dot(-camera.matrix_world.col[2].xyz.normalized()), 1e-4)


def placement(matrix: mathutils.Matrix, distance: float) -> dict[str, list[float]]:
    """`position`, `look_at` and `up` of a camera that looks along -z of the matrix."""
    forward = -matrix.col[2].xyz.normalized()
    return {"position": place(matrix.translation), "look_at": place(matrix.translation + forward * distance),
            "up": place(matrix.col[1].xyz.normalized())}


def projected(projection: np.ndarray, orthographic: bool) -> dict[str, Any]:
    """Field of view and shift of a projection matrix (4, 4)."""
    result: dict[str, Any] = {}
    if orthographic:
        result["orthographic"] = numbers([2 / projection[1, 1]])[0]
        offset = -projection[0, 3] / 2, -projection[1, 3] / 2
    else:
        result["fov"] = numbers([min(max(vertical_fov(projection[1, 1]), 0.01), 170)])[0]
        offset = projection[0, 2] / 2, projection[1, 2] / 2
    if max(abs(value) for value in offset) > 1e-7:
        result["shift"] = numbers(offset)
    return result


def optics(camera: bpy.types.Object, projection: np.ndarray, notes: Notes) -> dict[str, Any]:
    """Field of view, shift and depth of field for a projection matrix (4, 4)."""
    data = camera.data
    if data.type == "PANO":
        notes.add("panoramic cameras: seen in perspective")
    result = projected(projection, data.type == "ORTHO")
    if data.dof.use_dof:
        focal_length = 1e-3 * data.lens if data.type != "ORTHO" else 1.0
        result["lens"] = {"f_stop": max(data.dof.aperture_fstop, 1e-3), "focal_length": focal_length,
                          "focus_distance": focus_distance(camera)}
        if data.dof.aperture_blades > 2 or abs(data.dof.aperture_ratio - 1) > 1e-3:
            notes.add("shape of the aperture: the aperture is round")
    return result


def scene_camera(camera: bpy.types.Object, depsgraph: bpy.types.Depsgraph, size: tuple[int, int],
                 notes: Notes) -> dict[str, Any]:
    """The camera at the present time of the depsgraph, for a picture of `size` pixels."""
    render = depsgraph.scene.render
    projection = np.array(camera.calc_matrix_camera(depsgraph, x=size[0], y=size[1], scale_x=render.pixel_aspect_x,
                                                    scale_y=render.pixel_aspect_y), np.float64)
    aspect = render.pixel_aspect_x / render.pixel_aspect_y
    if not math.isclose(aspect, 1):
        notes.add("pixels that are not square: the picture has square pixels")
    return placement(camera.matrix_world, 10.0) | optics(camera, projection, notes)
