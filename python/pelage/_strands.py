# SPDX-License-Identifier: Apache-2.0
"""Strands as arrays."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING

from . import _pelage
from ._arguments import mapping, number, text
from ._arguments import path as file_path
from ._arrays import floats, integers
from ._errors import PelageWarning

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


class Strands:
    """A batch of strands. Its arrays are read-only views that stay valid as long as any of them is in use.

    Strand i has the points offsets[i] .. offsets[i + 1] - 1, from root to tip.

    points: (n, k, 3), n strands with k points each; or (p, 3) with `offsets`. Positions in scene units.
    widths: diameters in scene units: one number, (p,), (n, 1) for one per strand, or, with points (n, k, 3), whatever
        broadcasts to (n, k), such as (k,) for the same taper everywhere.
    offsets: (n + 1,), first point of each strand, and at last the number of points p.
    ids: (n,), numbers that name the strands; default: 0, 1, 2, ... In a groom, ids are always these.
    basis: how points define curves: "pinned-b-spline", "b-spline", "catmull-rom" or "linear".
    attributes: from names to (n,) or (n, c), one value per strand; (p,), (p, c) or (n, k, c), one per point; or
        (1, c), one for all. `color` is (…, 3), linear.

    Raises TypeError or ValueError for wrong types and shapes and for NaN.
    """

    __slots__ = ("_batch", "_data", "_widths")

    def __init__(
        self,
        points: ArrayLike,
        *,
        widths: ArrayLike,
        offsets: ArrayLike | None = None,
        ids: ArrayLike | None = None,
        basis: str = "pinned-b-spline",
        attributes: Mapping[str, ArrayLike] | None = None,
    ) -> None:
        import numpy as np

        if offsets is None:
            table = floats(points, "points", (None, None, 3))
            count, each = table.shape[:2]
            firsts = np.arange(count + 1, dtype=np.uint64) * np.uint64(each)
        else:
            table = floats(points, "points", (None, 3))
            firsts = integers(offsets, "offsets", "uint64", (None,))
            count = len(firsts) - 1
        total = table.size // 3
        if count < 0 or firsts[0] != 0 or firsts[-1] != total or (np.diff(firsts.astype(np.int64)) < 1).any():
            raise ValueError(f"offsets: expected ascending numbers from 0 to {total}, the number of points")
        lengths = np.diff(firsts.astype(np.int64))
        quads = np.empty((total, 4), np.float32)
        quads[:, :3] = table.reshape(total, 3)
        quads[:, 3] = _per_point(floats(widths, "widths"), table.shape[:-1], lengths) / 2
        if (quads[:, 3] < 0).any():
            raise ValueError("widths: must not be negative")
        numbers = np.arange(count, dtype=np.uint64) if ids is None else integers(ids, "ids", "uint64", (count,))
        values = {name: _attribute(value, name, count, total) for name, value in mapping(attributes, "attributes").items()}
        for name in values:
            if not text(name, "attributes"):
                raise ValueError("attributes: expected a name, got an empty one")
        self._take(_pelage.make_strands(quads, firsts.astype(np.uint32), numbers, text(basis, "basis"), values))

    def _take(self, batch: _pelage.StrandBatch) -> None:
        self._batch = batch
        self._data: _pelage.StrandData | None = None
        self._widths: NDArray[np.float32] | None = None

    @staticmethod
    def _of(batch: _pelage.StrandBatch) -> Strands:
        strands = Strands.__new__(Strands)
        strands._take(batch)
        return strands

    def _shared(self) -> _pelage.StrandData:
        if self._data is None:
            self._data = _pelage.share_strands(self._batch)
        return self._data

    @staticmethod
    def read(path: str | os.PathLike[str], *, basis: str = "", width: float = 0) -> Strands:
        """Reads a .hair, .tfx, .usda or .abc file. `basis` and `width` (scene units): for files that do not state them."""
        return Strands._of(_pelage.read_strands(file_path(path, "path"), text(basis, "basis"), number(width, "width", 1e6)))

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes a .hair, .tfx, .usda or .abc file, whole or not at all. Warns of what the format cannot hold."""
        file = file_path(path, "path")
        lost = _pelage.StrandBatch.what_is_lost(self._batch, file)
        if lost:
            warnings.warn(f"{file}: the file cannot hold {lost}", PelageWarning, stacklevel=2)
        self._batch.write(file)

    @property
    def points(self) -> NDArray[np.float32]:
        """(p, 3), positions when the shutter opens, in world space and scene units."""
        points: NDArray[np.float32] = self._batch.points[0]
        return points

    @property
    def motion(self) -> NDArray[np.float32]:
        """(keys, p, 3), positions at evenly spaced times from the opening of the shutter to its closing."""
        return self._batch.points

    @property
    def radii(self) -> NDArray[np.float32]:
        """(p,), half the widths, in scene units. Not a copy."""
        radii: NDArray[np.float32] = self._batch.radii[0, :, 0]
        return radii

    @property
    def widths(self) -> NDArray[np.float32]:
        """(p,), diameters in scene units; computed once from `radii`."""
        if self._widths is None:
            self._widths = self.radii * 2
            self._widths.flags.writeable = False
        return self._widths

    @property
    def offsets(self) -> NDArray[np.uint32]:
        """(n + 1,), first point of each strand, and at last the number of points."""
        return self._batch.offsets

    @property
    def ids(self) -> NDArray[np.uint64]:
        """(n,), numbers that name the strands and never change."""
        return self._batch.ids

    @property
    def root_faces(self) -> NDArray[np.uint32] | None:
        """(n,), ptex face of each root on its skin; None if the strands did not grow on a skin."""
        return self._batch.root_faces

    @property
    def root_face_uv(self) -> NDArray[np.float32] | None:
        """(n, 2), parameters of each root in its face, 0 to 1; None if the strands did not grow on a skin."""
        return self._batch.root_face_uv

    @property
    def root_uv(self) -> NDArray[np.float32] | None:
        """(n, 2), texture coordinates of each root; None if the skin has none."""
        return self._batch.root_uv

    @property
    def attributes(self) -> dict[str, NDArray[np.float32]]:
        """From names to (1, c), (n, c) or (p, c): one value for all, one per strand, or one per point."""
        return self._batch.attributes

    @property
    def basis(self) -> str:
        """How points define curves, such as "pinned-b-spline"."""
        return self._batch.basis

    def lengths(self) -> NDArray[np.float32]:
        """Returns (n,), the length of the polygon through the points of each strand, in scene units."""
        import numpy as np

        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        along = np.concatenate([[0.0], np.cumsum(steps, dtype=np.float64)])
        first, last = self.offsets[:-1].astype(np.int64), self.offsets[1:].astype(np.int64) - 1
        return np.asarray(along[last] - along[first], np.float32)

    def __len__(self) -> int:
        return len(self._batch)

    def __repr__(self) -> str:
        return f"<pelage.Strands: {len(self)} strands, {self.points.shape[0]} points, {self.basis}>"


def _per_point(values: NDArray[np.float32], shape: tuple[int, ...], lengths: NDArray[np.int64]) -> NDArray[np.float32]:
    """Returns one width per point. `shape`: the shape of the points, without coordinates."""
    import numpy as np

    if values.shape == (len(lengths), 1):
        return np.repeat(values[:, 0], lengths)
    if values.shape == (lengths.sum(),):
        return values
    try:
        return np.broadcast_to(values, shape).ravel()
    except ValueError:
        raise ValueError(f"widths: expected one number, {shape} or ({len(lengths)}, 1), got {values.shape}") from None


def _attribute(value: ArrayLike, name: str, count: int, total: int) -> NDArray[np.float32]:
    array = floats(value, name)
    if array.ndim == 3:
        array = array.reshape(-1, array.shape[2])
    if array.ndim == 1:
        array = array.reshape(-1, 1)
    if array.ndim != 2 or array.shape[0] not in (1, count, total) or array.shape[1] < 1:
        raise ValueError(f"{name}: expected 1, {count} or {total} rows of values, got {array.shape}")
    return array


def read_strands(path: str | os.PathLike[str], *, basis: str = "", width: float = 0) -> Strands:
    """Reads a .hair, .tfx, .usda or .abc file; the same as Strands.read()."""
    return Strands.read(path, basis=basis, width=width)
