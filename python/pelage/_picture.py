# SPDX-License-Identifier: Apache-2.0
"""Pictures, and pictures that form."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from . import _pelage
from ._arguments import number

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Layers = Mapping[str, NDArray[Any]]
else:
    Layers = Mapping


class Picture(Layers):
    """A rendered frame: a mapping from layers to arrays (height, width, channels), row 0 at the top.

    "RGBA" (4 channels, linear radiance and coverage), one layer of 3 channels per light and kind of scattering
    ("key.diffuse"), "Z" (distance from the camera), "N" and "tangent" (3), "forward" (2: motion in pixels), "root"
    (2: texture coordinates of the root) and "id" (1, uint32). Names and meaning are those of the EXR file, whose
    colours have half precision while these are float32.
    """

    def __init__(self, result: dict[str, Any]) -> None:
        self._layers: dict[str, NDArray[Any]] = result["layers"]
        self.region: tuple[int, int, int, int] = result["region"]
        """Pixels x0 <= x < x1, y0 <= y < y1 of the whole picture that the arrays hold."""
        self.partial: bool = result["partial"]
        """Whether the render was cancelled: some pixels have fewer samples than requested, or none."""
        self._statistics: str = result["statistics"]

    @property
    def stats(self) -> dict[str, Any]:
        """What `pelage render --stats` writes, for this frame: times in seconds, memory in bytes, counts."""
        import json

        statistics: dict[str, Any] = json.loads(self._statistics)
        return statistics

    @property
    def rgba(self) -> NDArray[np.float32]:
        """The layer "RGBA"."""
        return self["RGBA"]

    def display(self, exposure: float = 0) -> NDArray[np.uint8]:
        """Returns (height, width, 3), bytes for a screen, like a .png of Pelage. `exposure`: in stops."""
        import numpy as np

        exposure = number(exposure, "exposure", 100)
        x = 0.72 * np.clip(self.rgba[..., :3] * 2.0**exposure, 0, 1000)
        curve = np.clip(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0, 1)
        encoded = np.where(curve <= 0.0031308, 12.92 * curve, 1.055 * curve ** (1 / 2.4) - 0.055)
        return np.asarray(encoded * 255 + 0.5, np.uint8)

    def __getitem__(self, layer: str) -> NDArray[Any]:
        try:
            return self._layers[layer]
        except KeyError:
            raise _no_layer(layer, list(self)) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._layers)

    def __len__(self) -> int:
        return len(self._layers)

    def __repr__(self) -> str:
        height, width = self.rgba.shape[:2]
        return f"<pelage.Picture: {width} x {height}, {len(self)} layers{', partial' if self.partial else ''}>"


class Pass:
    """A frame between two passes of its render. Valid only while the callback that gets it runs.

    samples: least sample count of a pixel. mean_samples: their mean.
    grid: above 1, only pixels whose x and y are multiples of it are sure to have samples; 0: too early to tell.
    coarse: whether the picture is a rough one, made before the samples of the frame.
    """

    def __init__(self, view: _pelage.PassView) -> None:
        self._view = view
        self.samples: int = view.samples
        self.mean_samples: float = view.mean_samples
        self.grid: int = view.grid
        self.coarse: bool = view.coarse

    def layers(self, *names: str) -> dict[str, NDArray[Any]]:
        """Returns the layers of these names, or all, as a dict of arrays, as in a Picture.

        Raises KeyError, with the nearest name, for a layer that the picture does not have.
        """
        if names:
            known = self._view.names
            for name in names:
                if name not in known:
                    raise _no_layer(name, known)
        return self._view.layers(list(names) or None)

    def __getitem__(self, layer: str) -> NDArray[Any]:
        return self.layers(layer)[layer]


def _no_layer(name: object, known: list[str]) -> KeyError:
    nearest = _pelage.suggest(name, known) if isinstance(name, str) else ""
    return KeyError(f"there is no layer {name!r}{nearest or '; expected one of ' + ', '.join(known)}")
