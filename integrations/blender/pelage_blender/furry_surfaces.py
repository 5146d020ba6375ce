# SPDX-License-Identifier: Apache-2.0
"""Surfaces with fur: instances share their mesh and their strands."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from . import groom
from .axes import to_pelage, transformed
from .placement import Placement, placement_of
from .scene_document import Block, SceneDocument
from .stage import Asset, Hair, Item
from .surfaces import slot_groups

Space = Callable[[np.ndarray, int], np.ndarray]
"""Turns points of an object at a motion key into those of its skin."""
Characters = list[tuple[str, list[Block]]]
"""Names that characters should have, and their parts."""


def _space(item: Item, place: Placement | None) -> Space:
    if place is not None:
        return lambda points, key: place.points(points)
    return lambda points, key: to_pelage(transformed(points, item.matrices[key]))


class FurWriter:
    """Adds surfaces with fur to a document; `check` is called before each coat; it may raise to stop."""

    def __init__(self, document: SceneDocument, check: Callable[[], None]) -> None:
        self.document, self.check = document, check
        self._written: dict[tuple[Any, ...], Characters] = {}

    def write(self, item: Item, curves: list[Hair]) -> None:
        """Adds an item with its own hair and with hair Curves, in world space, that grow on it."""
        place = placement_of(item.matrices, sized=True)
        key = (item.asset, place.shape) if place is not None and not curves else (item,)
        if key not in self._written:
            back = item.matrices[0].inverted_safe()
            hair = item.asset.hair + [Hair(curve.name, curve.strands.transformed(back), curve.material) for curve in curves]
            self._written[key] = self._characters(item, _space(item, place), hair)
        for name, parts in self._written[key]:
            self.document.character(name, parts, place.transform if place is not None else None)

    def _characters(self, item: Item, space: Space, hair: list[Hair]) -> Characters:
        asset, coats = item.asset, list(item.asset.original.pelage.coats)
        if not asset.shown:
            if coats:
                self.document.notes.add("fur of Pelage on objects that are not rendered: left out")
            return [(asset.name, [{"grooms": self._strands(hair, space, None)}])] if hair else []
        skin, part = self._skin(item, space, len(coats) > 0)
        for coat in coats:
            if coat.enabled:
                self.check()
                part["grooms"] |= groom.write_coat(self.document, item, skin, coat)
        result: Characters = [(asset.name, [part])]
        if coats and hair:
            # The rest pose of these strands is not the rest pose of the skin: they stay where they are.
            result.append((f"{asset.name} hair", [{"grooms": self._strands(hair, space, None)}]))
        else:
            part["grooms"] |= self._strands(hair, space, skin)
        return result

    def _skin(self, item: Item, space: Space, at_rest: bool) -> tuple[str, Block]:
        """The name of the skin of an item, and the part of a character with it. at_rest: coats grow on it."""
        asset: Asset = item.asset
        poses = [space(pose, key) for key, pose in enumerate(asset.poses)]
        groups = slot_groups(asset.cage)
        materials = [asset.material_of(slot) for slot in asset.cage.used_slots()]
        material = self.document.skin_material(f"{asset.name} skin", materials, groups)
        skin = self.document.skin(asset.name, (asset.cage, poses), groom.rest_points(item) if at_rest else None, groups)
        return skin, {"skin": skin, "material": material, "grooms": {}}

    def _strands(self, hair: list[Hair], space: Space, skin: str | None) -> dict[str, str]:
        """Writes strands; returns the names of their grooms with those of their materials."""
        return {self.document.strands(h.name, space(h.strands.points, 0), h.strands, skin):
                self.document.material("hair", h.material) for h in hair}
