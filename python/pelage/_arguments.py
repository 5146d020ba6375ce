# SPDX-License-Identifier: Apache-2.0
"""Checks of arguments: every mistake is a TypeError or a ValueError that names the argument."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from typing import Any


def text(value: Any, name: str) -> str:
    """Returns text that can be written as UTF-8."""
    if not isinstance(value, str):
        raise TypeError(f"{name}: expected text, got {type(value).__name__}")
    try:
        value.encode()
    except UnicodeEncodeError:
        raise ValueError(f"{name}: expected text, got half of a surrogate pair") from None
    return value


def path(value: Any, name: str) -> str:
    """Returns the name of a file."""
    if not isinstance(value, (str, os.PathLike)):
        raise TypeError(f"{name}: expected text or a path, got {type(value).__name__}")
    file = os.fspath(value)
    if not isinstance(file, str):
        raise TypeError(f"{name}: expected text or a path, got {type(file).__name__}")
    try:
        if b"\0" in os.fsencode(file):
            raise ValueError(f"{name}: no file has a name with a null character")
    except UnicodeEncodeError:
        raise ValueError(f"{name}: expected text, got half of a surrogate pair") from None
    return file


def callback(value: Any, name: str) -> Any:
    """Returns a callable or None."""
    if value is not None and not callable(value):
        raise TypeError(f"{name}: expected something to call, got {type(value).__name__}")
    return value


def flag(value: Any, name: str) -> bool:
    """Returns True or False."""
    if not isinstance(value, bool):
        raise TypeError(f"{name}: expected True or False, got {type(value).__name__}")
    return value


def whole(value: Any, name: str, least: int, most: int) -> int:
    """Returns an integer from `least` to `most`."""
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        raise TypeError(f"{name}: expected an integer, got {type(value).__name__}")
    number = int(value.__index__())
    if not least <= number <= most:
        raise ValueError(f"{name}: expected {least} to {most}, got {number}")
    return number


def number(value: Any, name: str, most: float) -> float:
    """Returns a number from -`most` to `most`."""
    if isinstance(value, (bool, str)) or not hasattr(value, "__float__"):
        raise TypeError(f"{name}: expected a number, got {type(value).__name__}")
    try:
        real = float(value)
    except OverflowError:
        raise ValueError(f"{name}: expected a number from {-most:.0f} to {most:.0f}") from None
    except TypeError:  # an array of several numbers
        raise TypeError(f"{name}: expected a number, got {type(value).__name__}") from None
    if not math.isfinite(real):
        raise ValueError(f"{name}: expected a finite number, got {real}")
    if abs(real) > most:
        raise ValueError(f"{name}: expected a number from {-most:.0f} to {most:.0f}, got {real}")
    return real


def mapping(value: Any, name: str) -> Mapping[Any, Any]:
    """Returns a mapping, an empty one for None."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise TypeError(f"{name}: expected a dict, got {type(value).__name__}")
    return value
