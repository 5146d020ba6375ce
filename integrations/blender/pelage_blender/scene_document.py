# SPDX-License-Identifier: Apache-2.0
"""A scene file in the making: its blocks, the names in it, and the files beside it."""
from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from .cage import Placed
from .geometry_files import hair_bytes, obj_text, vertex_text
from .hair_particles import HairStrands
from .materials import MaterialConverter, by_slot
from .names import light_name, pelage_name
from .scene_folder import SceneFolder

Block = dict[str, Any]
Groups = list[tuple[str, np.ndarray]]  # names, and the faces that have them
Materials = list[bpy.types.Material | None]


def _differ(blocks: list[Block]) -> bool:
    """Whether materials differ in more than their colours."""
    return any(block | {"color": None} != blocks[0] | {"color": None} for block in blocks[1:])


class SceneDocument:
    """Adds blocks to `blocks`, gives them names that are not taken, and writes their files into `folder`."""

    def __init__(self, folder: SceneFolder, frame: int, notes: set[str]) -> None:
        self.folder, self.notes = folder, notes
        self.blocks: Block = {}
        self._taken: dict[str, set[str]] = {}
        self._files: set[str] = set()
        self._material_names: dict[Any, str] = {}
        self._converter = MaterialConverter(folder, notes, frame)

    def name(self, block: str, wanted: str) -> str:
        taken = self._taken.setdefault(block, set())
        return light_name(wanted, taken) if block == "lights" else pelage_name(wanted, taken)

    def file(self, name: str, content: str | bytes) -> str:
        return self.folder.put(self.file_name(name), content)

    def file_name(self, name: str) -> str:
        """A name for a file that no other file of the scene has."""
        stem, _, ending = name.rpartition(".")
        safe = "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "_" for c in stem)[:60]
        return pelage_name(safe, self._files) + "." + ending

    def character(self, wanted: str, parts: list[Block], transform: Block | None = None) -> None:
        if parts:
            block = {"parts": parts} | ({"transform": transform} if transform else {})
            self.blocks["characters"][self.name("characters", wanted)] = block

    def material(self, kind: str, material: bpy.types.Material | None) -> str:
        key = kind, None if material is None else material.name_full
        if key not in self._material_names:
            name = self.name("materials", "grey" if material is None else material.name)
            convert = self._converter.hair if kind == "hair" else self._converter.surface
            self.blocks["materials"][name] = convert(material)
            self._material_names[key] = name
        return self._material_names[key]

    def differ(self, materials: Materials) -> bool:
        """Whether materials of surfaces differ in more than their colours."""
        return _differ([self._converter.surface(material) for material in materials])

    def skin_material(self, wanted: str, materials: Materials, groups: Groups | None) -> str:
        """The material of a skin whose groups of faces have a material each; None: it has one material."""
        if groups is None:
            return self.material("surface", materials[0])
        blocks = [self._converter.surface(material) for material in materials]
        if _differ(blocks):
            self.notes.add("several materials on a subdivided or furry mesh: all but their colours are those of the first")
        name = self.name("materials", wanted)
        self.blocks["materials"][name] = by_slot(blocks, [group for group, _ in groups])
        return name

    def skin(self, wanted: str, placed: Placed, rest: np.ndarray | None = None, groups: Groups | None = None) -> str:
        """Writes a mesh and its poses, and returns the name of the skin. rest: points at rest; None: those of the first pose."""
        cage, poses = placed
        name = self.name("skins", wanted)
        first = poses[0] if rest is None else rest
        parts = [entry for group in groups or [] for entry in group]
        parts += cage.creases.arrays() if cage.creases is not None else []
        file = self.folder.put_made(self.file_name(f"{name}.obj"),
                                    [first, cage.sizes, cage.corners, cage.uvs, cage.colors, *parts],
                                    lambda: obj_text(first, cage.sizes, cage.corners, cage.uvs, groups, cage.colors, cage.creases))
        block: Block = {"mesh": file, "scheme": cage.scheme}
        if cage.scheme != "none":
            block["boundary"] = cage.boundary
        moves = any(not np.array_equal(poses[0], pose) for pose in poses[1:])
        if moves or not np.allclose(first, poses[0], rtol=0, atol=1e-6 * float(np.abs(first).max(initial=0))):
            kept = poses if moves else poses[:1]
            base = self.file(f"{name} pose.obj", "")[:-4]
            for number, pose in enumerate(kept, 1):
                self.folder.put_made(f"{base}.{number}.obj", [pose], lambda pose=pose: vertex_text(pose))
            block["poses"] = {"files": f"{base}.%d.obj", "first": 1, "count": len(kept),
                              "frames_per_pose": 1 / max(len(kept) - 1, 1)}
        self.blocks["skins"][name] = block
        return name

    def strands(self, wanted: str, points: np.ndarray, hair: HairStrands, skin: str | None) -> str:
        """Writes strands as a groom, which follows a skin if one is given, and returns its name."""
        name = self.name("grooms", wanted)
        block: Block = {"strands_file": self.file(f"{name}.hair", hair_bytes(points, hair.widths, hair.counts)),
                        "basis": "catmull-rom", "role": "guard"}
        if skin is not None:
            block |= {"skin": skin, "attach": "skin"}
        self.blocks["grooms"][name] = block
        return name
