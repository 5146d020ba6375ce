# SPDX-License-Identifier: Apache-2.0
"""What is read of a scene of Blender, before it becomes blocks of a scene file: surfaces, hair and lights."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import bpy
import mathutils
import numpy as np

from .axes import to_pelage, transformed
from .cage import Cage
from .hair_particles import HairStrands

Key = tuple[str, tuple[Any, ...]]
"""The name of an object, with what tells its instances apart."""
Notes = set[str]


@dataclass
class Hair:
    name: str
    strands: HairStrands  # hair of a surface in the space of its object; hair Curves in world space
    material: bpy.types.Material | None


@dataclass(eq=False)
class Asset:
    """A surface with its hair, in the space of its object and with the axes of Blender. Its instances share it."""
    name: str
    original: bpy.types.Object
    cage: Cage
    materials: list[bpy.types.Material | None]
    shown: bool
    poses: list[np.ndarray]  # per motion key: points (n, 3)
    hair: list[Hair] = field(default_factory=list)
    guides: dict[str, HairStrands] = field(default_factory=dict)  # parents of particle hair that shapes coats

    def material_of(self, slot: int) -> bpy.types.Material | None:
        return self.materials[min(slot, len(self.materials) - 1)]


@dataclass(eq=False)
class Item:
    """An asset at a place: an object, or one of its instances."""
    asset: Asset
    matrices: list[mathutils.Matrix]  # per motion key

    def poses(self) -> list[np.ndarray]:
        """Points (n, 3) per motion key, in world space and with the axes of Pelage."""
        return [to_pelage(transformed(pose, matrix)) for pose, matrix in zip(self.asset.poses, self.matrices)]


@dataclass
class Loose:
    """Hair Curves; `surface` is the key of the item that they grow on, if any."""
    hair: Hair
    surface: Key | None


@dataclass
class Stage:
    """Surfaces, hair and lights of a scene; the writer turns them into blocks."""
    items: dict[Key, Item] = field(default_factory=dict)
    loose: list[Loose] = field(default_factory=list)
    lights: dict[Key, list[dict[str, Any]]] = field(default_factory=dict)  # per motion key
    names: dict[Key, str] = field(default_factory=dict)  # of lights
