# SPDX-License-Identifier: Apache-2.0
"""Maps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import _pelage
from ._arrays import floats, integers

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class Map:
    """An image in memory, in a scene in place of an image file: `map` of a field, or `file` of a light.

    pixels: (height, width) or (height, width, c) with 1 to 4 channels, row 0 at the top. Floats are linear values, as in an
    EXR file. uint8 and uint16 are as in a PNG file: 0 to 1, and colours are decoded from sRGB, unless the field has
    `channel` or `space: linear`.

    In {"map": array}, an array with 2 or 3 axes is such a map, too.

    Raises TypeError or ValueError for wrong types, shapes and NaN.
    """

    __slots__ = ("_data", "_shape")

    def __init__(self, pixels: ArrayLike) -> None:
        import numpy as np

        kind = np.asarray(pixels).dtype
        shapes = ((None, None), (None, None, None))
        if kind in (np.uint8, np.uint16):
            table = integers(pixels, "pixels", kind.name, *shapes)
        else:
            table = floats(pixels, "pixels", *shapes)
        if table.ndim == 2:
            table = table[:, :, None]
        if table.size == 0 or not 1 <= table.shape[2] <= 4:
            raise ValueError(f"pixels: expected pixels of 1 to 4 channels, got {table.shape}")
        makers: dict[str, Any] = {"uint8": _pelage.make_image8, "uint16": _pelage.make_image16}
        self._data: _pelage.ImageData = makers.get(kind.name, _pelage.make_image)(table)
        self._shape: tuple[int, ...] = table.shape

    def __repr__(self) -> str:
        return f"<pelage.Map: {self._shape[1]} x {self._shape[0]}, {self._shape[2]} channels>"
