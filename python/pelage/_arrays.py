# SPDX-License-Identifier: Apache-2.0
"""Checks of array arguments: every mistake is a TypeError or a ValueError that names the argument."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Union

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    FloatArray = NDArray[np.float32]
    IntArray = NDArray[Any]

Shape = tuple[Union[int, None], ...]


def _shape_text(shape: Shape) -> str:
    sizes = ["n" if size is None else str(size) for size in shape]
    return "(" + ", ".join(sizes) + ("," if len(sizes) == 1 else "") + ")"


def _fits(array: NDArray[Any], shape: Shape) -> bool:
    return array.ndim == len(shape) and all(want is None or have == want for have, want in zip(array.shape, shape))


def refuse_masked(array: Any, name: str) -> None:
    """Raises ValueError for an array of numpy.ma some of whose values are masked: there is nothing in their place."""
    mask = getattr(array, "mask", None)
    if mask is not None and (mask if isinstance(mask, bool) else mask.any()):
        raise ValueError(f"{name}: some values are masked")


def _array(value: ArrayLike, name: str) -> NDArray[Any]:
    import numpy as np

    refuse_masked(value, name)
    try:
        return np.asarray(value)
    except ValueError as error:  # lists of different lengths
        raise ValueError(f"{name}: {error}") from None


def floats(value: ArrayLike, name: str, *shapes: Shape) -> FloatArray:
    """Returns float32 of one of the shapes, finite. A contiguous float32 array is not copied."""
    import numpy as np

    array = _array(value, name)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name}: expected numbers, got {array.dtype}")
    if shapes and not any(_fits(array, shape) for shape in shapes):
        wanted = " or ".join(map(_shape_text, shapes))
        raise ValueError(f"{name}: expected the shape {wanted}, got {array.shape}")
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        place = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise ValueError(f"{name}: not finite at {place}")
    with np.errstate(over="ignore"):
        result = np.ascontiguousarray(array, dtype=np.float32)
    if array.dtype.itemsize > 4 and array.dtype.kind == "f" and not np.isfinite(result).all():
        place = tuple(int(i) for i in np.argwhere(~np.isfinite(result))[0])
        raise ValueError(f"{name}: {array[place]} at {place} is too large for float32")
    return result


def integers(value: ArrayLike, name: str, dtype: str, *shapes: Shape) -> IntArray:
    """Returns integers of `dtype` of one of the shapes, none of them outside its range."""
    import numpy as np

    array = _array(value, name)
    if array.size == 0 and array.dtype.kind == "f":
        array = array.astype(dtype)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name}: expected integers, got {array.dtype}")
    if shapes and not any(_fits(array, shape) for shape in shapes):
        wanted = " or ".join(map(_shape_text, shapes))
        raise ValueError(f"{name}: expected the shape {wanted}, got {array.shape}")
    limits = np.iinfo(dtype)
    if array.size and (int(array.min()) < limits.min or int(array.max()) > limits.max):
        raise ValueError(f"{name}: values must be between {limits.min} and {limits.max}")
    return np.ascontiguousarray(array, dtype=dtype)
