# SPDX-License-Identifier: Apache-2.0
"""Values of the panel as values of a scene file. Knows nothing of Blender's types."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .axes import numbers, to_pelage
from .schema import DIRECTIONS, POINTS

Color = Sequence[float]


def scene_value(key: str, value: Any, signs: Sequence[float] = (1.0, 1.0, 1.0)) -> Any:
    """A number, text or vector of the panel; directions and points are turned from z up to y up, times `signs`."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return value
    if isinstance(value, int):
        return value
    if isinstance(value, float):
        return numbers([value])[0]
    return numbers(to_pelage([a * b for a, b in zip(value, signs)])) if key in DIRECTIONS | POINTS else numbers(value)


def from_scene(vector: Sequence[float]) -> tuple[float, float, float]:
    """A direction of a scene file, y up, as the panel shows it, z up."""
    x, y, z = vector
    return float(x), -float(z) + 0.0, float(y)


def scaled_map(source: dict[str, Any], low: float, high: float) -> dict[str, Any]:
    """A field that is `low` where a map is 0 and `high` where it is 1."""
    if (low, high) == (0, 1):
        return source
    return {"remap": source, "knots": [[0, numbers([low])[0]], [1, numbers([high])[0]]]}


def times(value: Any, factor: dict[str, Any] | None) -> Any:
    """A value times a map."""
    if factor is None:
        return value
    return factor if value == 1 else {"product": [value, factor]}


def color_operator(root: Color, tip: Color, variation: float) -> dict[str, Any]:
    """Colours from root to tip."""
    knots = [[0, numbers(root)], [1, numbers(tip)]]
    return {"color": {"value": {"ramp": {"along": "strand", "knots": knots}}, "variation": numbers([variation])[0]}}


def fur_material(roughness: float) -> dict[str, Any]:
    """The hair model in the colours of the coat."""
    value = min(max(roughness, 0.02), 1.0)
    return {"model": "chiang", "color": {"attribute": "color"}, "beta_m": numbers([value])[0], "beta_n": numbers([value])[0]}
