# SPDX-License-Identifier: Apache-2.0
"""Coats of Pelage on the objects of a scene."""
from __future__ import annotations

from typing import Any

import bpy


class PelageCoat(bpy.types.PropertyGroup):
    enabled: bpy.props.BoolProperty(name="Show", default=True)  # type: ignore[valid-type]


class PelageFur(bpy.types.PropertyGroup):
    coats: bpy.props.CollectionProperty(type=PelageCoat)  # type: ignore[valid-type]


CLASSES = (PelageCoat, PelageFur)


def register() -> None:
    bpy.types.Object.pelage = bpy.props.PointerProperty(type=PelageFur)


def unregister() -> None:
    del bpy.types.Object.pelage


def prepare(item: Any, notes: set[str]) -> Any:
    return None


def write_coat(writer: Any, item: Any, skin: str, coat: Any) -> dict[str, str]:
    return {}
