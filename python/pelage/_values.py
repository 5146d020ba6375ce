# SPDX-License-Identifier: Apache-2.0
"""Values of Python as values of a scene."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from typing import Any

from ._arguments import text
from ._arrays import refuse_masked
from ._geometry import Mesh, Poses
from ._map import Map
from ._strands import Strands

_MAX_DEPTH = 64


def scene_value(value: Any, path: str, depth: int = 0) -> Any:
    """Returns `value` as None, str, list, dict, MeshData, PoseData, ImageData or StrandData. `path`: keys that lead to it, for errors."""
    if depth > _MAX_DEPTH:
        raise ValueError(f"{path}: nested more than {_MAX_DEPTH} levels deep, or in itself")
    if value is None:
        return None
    if isinstance(value, str):
        return text(value, path)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return _number(value, path)
    if isinstance(value, Mapping):
        return {_key(key, path): scene_value(item, f"{path}.{key}".lstrip("."), depth + 1) for key, item in value.items()}
    if isinstance(value, (Map, Mesh, Poses)):
        return value._data
    if isinstance(value, Strands):
        return value._shared()
    if isinstance(value, os.PathLike):
        return text(os.fspath(value), path)
    if hasattr(value, "tolist") and hasattr(value, "dtype"):  # arrays and scalars of numpy
        refuse_masked(value, path)
        if path.rpartition(".")[2] == "map" and getattr(value, "ndim", 0) in (2, 3):
            return Map(value)._data
        return scene_value(value.tolist(), path, depth + 1)
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        return [scene_value(item, f"{path}.{i}", depth + 1) for i, item in enumerate(value)]
    raise TypeError(f"{path}: expected a number, text, list, dict, Map, Mesh, Poses or Strands, got {type(value).__name__}")


def _number(value: float, path: str) -> str:
    if not math.isfinite(value):
        raise ValueError(f"{path}: expected a finite number, got {value}")
    return str(int(value)) if value.is_integer() and abs(value) < 2**53 else repr(value)


def _key(key: Any, path: str) -> str:
    if isinstance(key, int) and not isinstance(key, bool):  # a frame, as in {"keys": {1: 0.0, 48: 1.0}}
        return str(key)
    if not isinstance(key, str):
        raise TypeError(f"{path or 'scene'}: expected names as keys, got {type(key).__name__}")
    return text(key, path or "scene")


def changes(key: Any, value: Any = None) -> dict[str, Any]:
    """Returns the arguments of Scene.set() as a dict from keys "a.b.c" to values."""
    pairs = key if isinstance(key, Mapping) else {_key(key, "key"): value}
    return {_key(name, "key"): scene_value(item, name) for name, item in pairs.items()}


