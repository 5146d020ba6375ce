# SPDX-License-Identifier: Apache-2.0
"""The steps of a coat, which are operators of its groom: how they and their values are stored in the .blend."""
from __future__ import annotations

from typing import Any

from . import coat_values, preferences, process, schema


def step_schema(kind: str) -> schema.SchemaBlock | None:
    """Keys of an operator, or None if the program is not there or does not know it."""
    try:
        return schema.load(preferences.program()).get(kind)
    except process.PelageFailed:
        return None


def set_value(step: Any, key: schema.SchemaKey, value: Any) -> None:
    """Stores a value as a custom property with limits and help."""
    if key.kind == "choice":
        step[key.name] = str(value)
        return
    step[key.name] = [float(v) for v in value] if key.kind == "vector" else \
        int(value) if key.kind in ("integer", "switch") else float(value)
    limits: dict[str, Any] = {"description": key.help}
    if key.kind in ("integer", "switch"):
        limits |= {"min": int(max(key.low, -2**31)), "max": int(min(key.high, 2**31 - 1))}
    elif key.kind != "vector":
        low, high = max(key.low, -1e9), min(key.high, 1e9)
        limits |= {"min": low, "max": high, "soft_min": low, "soft_max": high, "precision": 4,
                   "step": 0.01 * max(abs(float(value)), 1e-4)}
    step.id_properties_ui(key.name).update(**limits)


def add_step(coat: Any, block: schema.SchemaBlock, values: dict[str, Any]) -> Any:
    """Adds an operator with all values that have defaults, changed by `values`."""
    step = coat.operators.add()
    step.name = step.kind = block.name
    for key in block.keys:
        value = values.get(key.name, key.default)
        if key.kind == "vector" and key.name not in values:
            value = coat_values.from_scene(value)
        if value is not None and key.kind != "other":
            set_value(step, key, value)
    return step
