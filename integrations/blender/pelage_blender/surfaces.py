# SPDX-License-Identifier: Apache-2.0
"""Surfaces without fur: instances share a mesh, and all other surfaces become few meshes."""
from __future__ import annotations

import numpy as np

from .cage import Cage, Placed, faces_of_slot, merged
from .placement import Placement, placement_of
from .scene_document import Block, Groups, SceneDocument
from .stage import Asset, Item

SHARED_FACES = 32
"""Number of faces from which on the instances of a mesh share it. A skin takes 8 KB beside its triangles, so instances of smaller
meshes, such as blades of grass, take less memory as one large mesh."""


def slot_groups(cage: Cage) -> Groups | None:
    """The faces of each material; None if there is only one."""
    slots = cage.used_slots()
    return [(f"slot{slot}", np.flatnonzero(cage.slots == slot)) for slot in slots] if len(slots) > 1 else None


class SurfaceWriter:
    """Adds surfaces to a document."""

    def __init__(self, document: SceneDocument) -> None:
        self.document = document

    def write(self, items: list[Item]) -> None:
        groups: dict[object, list[tuple[Item, Placement | None]]] = {}
        for item in items:
            place = placement_of(item.matrices, sized=False)
            groups.setdefault((item.asset, place.shape) if place is not None else item, []).append((item, place))
        single: list[Item] = []
        for members in groups.values():
            first, place = members[0]
            if place is None or len(members) == 1 or len(first.asset.cage.sizes) < SHARED_FACES:
                single += [item for item, _ in members]
                continue
            parts = self._parts(first.asset, [place.points(pose) for pose in first.asset.poses])
            for item, own in members:
                assert own is not None
                self.document.character(item.asset.name, parts, own.transform)
        self._write_merged(single)

    def _parts(self, asset: Asset, poses: list[np.ndarray]) -> list[Block]:
        """The parts of a character for one asset."""
        if self._stays_whole(asset):
            return [self._whole(asset, poses)]
        parts = []
        for slot in asset.cage.used_slots():
            part = faces_of_slot(asset.cage, slot)
            material = self.document.material("surface", asset.material_of(slot))
            skin = self.document.skin(asset.name, (part, [pose[part.vertices] for pose in poses]))
            parts.append({"skin": skin, "material": material})
        return parts

    def _whole(self, asset: Asset, poses: list[np.ndarray]) -> Block:
        groups = slot_groups(asset.cage)
        skin = self.document.skin(asset.name, (asset.cage, poses), None, groups)
        materials = [asset.material_of(slot) for slot in asset.cage.used_slots()]
        return {"skin": skin, "material": self.document.skin_material(f"{asset.name} skin", materials, groups)}

    def _write_merged(self, items: list[Item]) -> None:
        """One skin per material, because few skins are faster, and one for each mesh of several materials that stays whole."""
        whole: list[Block] = []
        buckets: dict[tuple[str, str, str], list[Placed]] = {}
        for item in items:
            cage, poses = item.asset.cage, item.poses()
            if self._stays_whole(item.asset):
                whole.append(self._whole(item.asset, poses))
                continue
            for slot in cage.used_slots():
                part = faces_of_slot(cage, slot)
                material = self.document.material("surface", item.asset.material_of(slot))
                placed = part, [pose[part.vertices] for pose in poses]
                buckets.setdefault((material, part.scheme, part.boundary), []).append(placed)
        self.document.character("scene", [{"skin": self.document.skin(material, merged(parts)), "material": material}
                                          for (material, _, _), parts in buckets.items()] + whole)

    def _stays_whole(self, asset: Asset) -> bool:
        """Whether cutting a mesh by its materials would be seen: in the shape of a cage, or in smooth normals.

        Polygons whose materials differ in more than the colour are cut in any case.
        """
        cage, slots = asset.cage, asset.cage.used_slots()
        if len(slots) == 1:
            return False
        if cage.scheme != "none":
            return True
        of_corner = np.repeat(cage.slots, cage.sizes)
        used = sum(len(np.unique(cage.corners[of_corner == slot])) for slot in slots)
        cut_apart = used > len(np.unique(cage.corners))
        return cut_apart and not self.document.differ([asset.material_of(slot) for slot in slots])
