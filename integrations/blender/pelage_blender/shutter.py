# SPDX-License-Identifier: Apache-2.0
"""Motion blur: the times of its keys, and values that change from key to key."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import bpy
import numpy as np


def shutter_times(scene: bpy.types.Scene, keys: int) -> list[float]:
    """Times of the motion keys in frames, relative to the frame; one time without motion blur."""
    if not scene.render.use_motion_blur or scene.render.motion_blur_shutter <= 0:
        return [0.0]
    width = scene.render.motion_blur_shutter
    position = getattr(getattr(scene, "cycles", None), "motion_blur_position", "CENTER")
    start = {"START": 0.0, "CENTER": -0.5 * width, "END": -width}[position]
    return [start + width * i / (keys - 1) for i in range(keys)]


def visit(times: list[float], frame: float, frame_set: Callable[[int, float], None]) -> Iterator[float]:
    """Sets the scene to each of the times, and back to the frame at the end."""
    try:
        for time in times:
            whole = int(np.floor(frame + time))
            frame_set(whole, frame + time - whole)
            yield time
    finally:
        frame_set(int(np.floor(frame)), frame - np.floor(frame))


def moving(blocks: list[dict[str, Any]], names: tuple[str, ...]) -> dict[str, Any]:
    """A block whose values named `names` change from frame 1 to frame 2 of the Pelage scene, which are the ends of the shutter.

    blocks: one per motion key; the rest is the first's.
    """
    result = dict(blocks[0])
    for name in names:
        values = [block.get(name, result[name]) for block in blocks] if name in result else []
        if any(value != values[0] for value in values):
            result[name] = {"keys": {f"{1 + i / (len(values) - 1):.7g}": value for i, value in enumerate(values)}}
    return result
