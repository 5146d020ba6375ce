# SPDX-License-Identifier: Apache-2.0
"""Layers of Pelage as passes of Blender."""
from __future__ import annotations

import pathlib
from collections.abc import Iterator
from typing import Any

import bpy
import numpy as np

from . import exr
from .axes import FLOATS
from .names import light_name

LOBES = ("diffuse", "primary", "secondary")
DATA = {"id": ("X", "VALUE", ("id.X",)), "root": ("UV", "VECTOR", ("root.u", "root.v")),
        "tangent": ("XYZ", "VECTOR", ("tangent.X", "tangent.Y", "tangent.Z")),
        "forward": ("UV", "VECTOR", ("forward.u", "forward.v"))}
"""Passes of data: letters, type, and channels of the file."""
VECTORS = {"N", "tangent"}
"""Layers of directions in world space."""


def light_names(scene: bpy.types.Scene, layer: bpy.types.ViewLayer | None = None) -> list[str]:
    """Names that lights get in a Pelage scene, of all lights that may be in the picture."""
    taken: set[str] = set()
    names = [light_name("world", taken)] if scene.world is not None else []
    lights = [ob for ob in (layer.objects if layer is not None else scene.objects) if ob.type == "LIGHT"]
    return names + [light_name(ob.name, taken) for ob in lights if not ob.hide_render]


def wanted_passes(scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> Iterator[tuple[str, int, str, str]]:
    """Name, number of channels, their letters, and type, of the passes beside Blender's own."""
    if scene.pelage.light_layers:
        for light in light_names(scene, layer):
            for lobe in (*LOBES, "emission") if light == "world" else LOBES:
                yield f"{light}.{lobe}", 3, "RGB", "COLOR"
    if scene.pelage.data_layers:
        for name, (letters, kind, _) in DATA.items():
            yield name, len(letters), letters, kind


class Picture:
    """A picture of Pelage, in the order of Blender: the bottom row first."""

    def __init__(self, path: pathlib.Path, every: bool) -> None:
        few = {"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z"}
        self.header, self.channels = exr.read(path, (lambda name: True) if every else few.__contains__)

    @property
    def size(self) -> tuple[int, int]:
        return self.header.width, self.header.height

    def _stacked(self, names: tuple[str, ...]) -> FLOATS | None:
        if any(name not in self.channels for name in names):
            return None
        result = np.empty((self.header.height, self.header.width, len(names)), np.float32)
        for index, name in enumerate(names):
            result[..., index] = self.channels[name][::-1]
        return result.reshape(-1, len(names))

    def combined(self, transparent: bool) -> FLOATS:
        """RGBA (pixels, 4)."""
        result = self._stacked(("R", "G", "B", "A"))
        if result is None:
            raise exr.ExrError("the picture has no colours")
        if not transparent:
            result[:, 3] = 1
        return result

    def layer(self, name: str) -> FLOATS | None:
        """(pixels, channels) of a pass by its name in Blender, or None."""
        if name == "Depth":
            depth = self._stacked(("Z",))
            return None if depth is None else np.where(np.isfinite(depth), depth, np.float32(1e10))
        if name == "Normal":
            return self._turned(self._stacked(("N.X", "N.Y", "N.Z")))
        if name in DATA:
            result = self._stacked(DATA[name][2])
            return self._turned(result) if name in VECTORS else result
        return self._stacked((f"{name}.R", f"{name}.G", f"{name}.B"))

    @staticmethod
    def _turned(vectors: FLOATS | None) -> FLOATS | None:
        """From y up to z up."""
        return None if vectors is None else np.stack([vectors[:, 0], -vectors[:, 2], vectors[:, 1]], axis=1)


def fill(passes: Any, picture: Picture, transparent: bool) -> None:
    """Copies a picture to the passes of a layer of a render result."""
    for render_pass in passes:
        name = render_pass.name
        values = picture.combined(transparent) if name == "Combined" else picture.layer(name)
        if values is not None and values.shape[1] == render_pass.channels:
            render_pass.rect.foreach_set(np.ascontiguousarray(values, np.float32))
