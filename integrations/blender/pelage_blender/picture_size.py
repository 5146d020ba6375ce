# SPDX-License-Identifier: Apache-2.0
"""The size of the picture and its render region in pixels, rounded as Blender does."""
from __future__ import annotations

import bpy
import numpy as np

Region = tuple[int, int, int, int]


def picture_size(scene: bpy.types.Scene) -> tuple[int, int]:
    """Width and height in pixels."""
    render = scene.render
    return (max(1, render.resolution_x * render.resolution_percentage // 100),
            max(1, render.resolution_y * render.resolution_percentage // 100))


def border(scene: bpy.types.Scene, size: tuple[int, int]) -> Region | None:
    """The render region in pixels from the upper left corner: x0, y0, x1, y1; None: the whole picture."""
    render = scene.render
    if not render.use_border:
        return None
    # Blender multiplies single floats.
    x0, x1 = (int(np.float32(side) * np.float32(size[0])) for side in (render.border_min_x, render.border_max_x))
    y0, y1 = (int(np.float32(side) * np.float32(size[1])) for side in (render.border_min_y, render.border_max_y))
    return x0, size[1] - y1, x1, size[1] - y0
