# SPDX-License-Identifier: Apache-2.0
"""Writes a depsgraph as a folder with a Pelage scene."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np

from . import exr, groom
from .axes import spot_image, to_pelage
from .camera import moving, scene_camera
from .collect import Hair, Item, Stage, add_pose, collect, shutter_times, visit
from .files import SceneFolder, document_text, hair_bytes, light_name, obj_text, pelage_name, vertex_text
from .lights import world_block
from .materials import MaterialConverter, by_slot
from .meshes import Cage, faces_of_slot
from .settings import render_block

Block = dict[str, Any]
Placed = tuple[Cage, list[np.ndarray]]  # a cage, and its points per motion key


def merged(parts: list[Placed]) -> Placed:
    """Several meshes as one."""
    first = np.cumsum([0] + [len(cage.points) for cage, _ in parts])
    uvs = [cage.uvs if cage.uvs is not None else np.zeros((len(cage.corners), 2), np.float32) for cage, _ in parts]
    has_uvs = any(cage.uvs is not None for cage, _ in parts)
    cage = Cage(np.concatenate([cage.points for cage, _ in parts]), np.concatenate([cage.sizes for cage, _ in parts]),
                np.concatenate([cage.corners + offset for (cage, _), offset in zip(parts, first)]),
                np.concatenate(uvs) if has_uvs else None, np.concatenate([cage.slots for cage, _ in parts]),
                parts[0][0].scheme, parts[0][0].boundary)
    return cage, [np.concatenate([poses[k] for _, poses in parts]) for k in range(len(parts[0][1]))]


class SceneWriter:
    """Writes scenes into one folder; a further scene replaces only the files that differ."""

    def __init__(self, folder: SceneFolder, check: Callable[[], None] = lambda: None) -> None:
        """check: called between objects; what it raises ends write()."""
        self.folder, self.check = folder, check
        self.notes: set[str] = set()

    def write(self, depsgraph: bpy.types.Depsgraph, size: tuple[int, int],
              frame_set: Callable[[int, float], None] | None = None, camera: Block | None = None, *,
              final: bool | None = None, text: Callable[[Block], str] | None = document_text) -> Block:
        """Writes scene.yaml and its files for a picture of `size` pixels, and returns the document.

        frame_set: sets the time of the depsgraph, for motion blur; None: no motion blur. camera: in place of the scene's.
        final: whether samples and layers are those of final pictures; None: if the depsgraph is for them. text: writes
        scene.yaml; None: only the files beside it.
        """
        self.notes = set()
        self._start(depsgraph)
        scene = depsgraph.scene
        times = shutter_times(scene, scene.pelage.motion_keys) if frame_set is not None else [0.0]
        if frame_set is None or len(times) == 1:
            stage, cameras = collect(depsgraph, self.notes, self.check), [camera or self._camera(depsgraph, size)]
        else:
            stage, cameras = Stage(), []
            frame = scene.frame_current + scene.frame_subframe
            for index, _ in enumerate(visit(times, frame, frame_set)):
                if index == 0:
                    stage = collect(depsgraph, self.notes, self.check)
                else:
                    add_pose(stage, depsgraph, self.notes)
                cameras.append(camera or self._camera(depsgraph, size))
        self._document(depsgraph, size, stage, cameras, depsgraph.mode == "RENDER" if final is None else final)
        if text is not None:
            self.folder.put("scene.yaml", text(self.document))
        return self.document

    def _start(self, depsgraph: bpy.types.Depsgraph) -> None:
        self.document: Block = {}
        self.taken: dict[str, set[str]] = {}
        self.files: set[str] = set()
        self.material_names: dict[Any, str] = {}
        self.converter = MaterialConverter(self.folder, self.notes, depsgraph.scene.frame_current)

    def _camera(self, depsgraph: bpy.types.Depsgraph, size: tuple[int, int]) -> Block:
        camera = depsgraph.scene.camera
        if camera is None:
            raise ValueError("the scene has no camera")
        return scene_camera(camera.evaluated_get(depsgraph), depsgraph, size, self.notes)

    def name(self, block: str, wanted: str) -> str:
        taken = self.taken.setdefault(block, set())
        return light_name(wanted, taken) if block == "lights" else pelage_name(wanted, taken)

    def file(self, name: str, content: str | bytes) -> str:
        return self.folder.put(self.file_name(name), content)

    def file_name(self, name: str) -> str:
        """A name for a file that no other file of the scene has."""
        stem, _, ending = name.rpartition(".")
        safe = "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "_" for c in stem)[:60]
        return pelage_name(safe, self.files) + "." + ending

    def material(self, kind: str, material: bpy.types.Material | None) -> str:
        key = kind, None if material is None else material.name_full
        if key not in self.material_names:
            name = self.name("materials", "grey" if material is None else material.name)
            convert = self.converter.hair if kind == "hair" else self.converter.surface
            self.document["materials"][name] = convert(material)
            self.material_names[key] = name
        return self.material_names[key]

    def skin(self, wanted: str, placed: Placed, rest: np.ndarray | None = None,
             groups: list[tuple[str, np.ndarray]] | None = None) -> str:
        """Writes a mesh and its poses; the name of the skin."""
        cage, poses = placed
        name = self.name("skins", wanted)
        first = poses[0] if rest is None else rest
        parts = [entry for group in groups or [] for entry in group]
        file = self.folder.put_made(self.file_name(f"{name}.obj"),
                                    [first, cage.sizes, cage.corners, cage.uvs, cage.colors, *parts],
                                    lambda: obj_text(first, cage.sizes, cage.corners, cage.uvs, groups, cage.colors))
        block: Block = {"mesh": file, "scheme": cage.scheme}
        if cage.scheme != "none":
            block["boundary"] = cage.boundary
        moves = any(not np.array_equal(poses[0], pose) for pose in poses[1:])
        if moves or rest is not None:
            kept = poses if moves else poses[:1]
            base = self.file(f"{name} pose.obj", "")[:-4]
            for number, pose in enumerate(kept, 1):
                self.folder.put_made(f"{base}.{number}.obj", [pose], lambda pose=pose: vertex_text(pose))
            block["poses"] = {"files": f"{base}.%d.obj", "first": 1, "count": len(kept),
                              "frames_per_pose": 1 / max(len(kept) - 1, 1)}
        self.document["skins"][name] = block
        return name

    def strands(self, hair: Hair, skin: str | None) -> tuple[str, str]:
        """Writes strands as a groom; its name and that of its material."""
        name = self.name("grooms", hair.name)
        data = hair_bytes(to_pelage(hair.strands.points), hair.strands.widths, hair.strands.counts)
        block: Block = {"strands_file": self.file(f"{name}.hair", data), "basis": "catmull-rom", "role": "guard"}
        if skin is not None:
            block |= {"skin": skin, "attach": "skin"}
        self.document["grooms"][name] = block
        return name, self.material("hair", hair.material)

    def _document(self, depsgraph: bpy.types.Depsgraph, size: tuple[int, int], stage: Stage, cameras: list[Block],
                  final: bool) -> None:
        scene = depsgraph.scene
        moving_camera = moving(cameras, ("position", "look_at", "up", "fov", "orthographic"))
        if len(cameras) > 1:
            moving_camera |= {"shutter": [0, 1], "motion_keys": len(cameras)}
        self.document |= {
            "pelage": 1, "units": {"meters_per_unit": scene.unit_settings.scale_length,
                                   "fps": scene.render.fps / scene.render.fps_base},
            "camera": moving_camera,
            "image": {"width": size[0], "height": size[1], "light_layers": scene.pelage.light_layers and final},
            "render": render_block(scene.pelage, not final),
            "skins": {}, "materials": {}, "grooms": {}, "characters": {}, "lights": {}}
        self._lights(scene, stage)
        hosts = {loose.surface for loose in stage.loose}
        plain = [item for key, item in stage.items.items()
                 if not (item.hair or len(item.original.pelage.coats) or key in hosts)]
        self._plain(plain)
        for key, item in stage.items.items():
            if item not in plain:
                self._furry(item, [loose.hair for loose in stage.loose if loose.surface == key])
        free = [loose.hair for loose in stage.loose if loose.surface not in stage.items]
        self._character("hair", [{"grooms": dict(self.strands(hair, None) for hair in free)}] if free else [])
        for empty in [key for key, value in self.document.items() if value == {}]:
            del self.document[empty]

    def _character(self, wanted: str, parts: list[Block]) -> None:
        if parts:
            self.document["characters"][self.name("characters", wanted)] = {"parts": parts}

    def _lights(self, scene: bpy.types.Scene, stage: Stage) -> None:
        world = world_block(scene.world, self.folder, self.notes, scene.frame_current)
        if world is not None:
            if scene.render.film_transparent:
                world["visible"] = False
            self.document["lights"][self.name("lights", "world")] = world
        for key, blocks in stage.lights.items():
            block = moving(blocks, ("position", "look_at", "direction"))
            if block["type"] == "spot":
                block["file"] = self.folder.put(f"spot {block['cone']:.3f}.exr", exr.encode({"Y": spot_image(block["cone"])}))
            self.document["lights"][self.name("lights", stage.names[key])] = block

    def _plain(self, items: list[Item]) -> None:
        """Surfaces without fur: one skin per material, because few skins are faster.

        A mesh of several materials is cut only where nothing depends on what lies across the cut.
        """
        whole: list[Block] = []
        buckets: dict[tuple[str, str, str], list[Placed]] = {}
        for item in items:
            if not item.shown:
                continue
            slots = [int(slot) for slot in np.unique(item.cage.slots)]
            if len(slots) > 1 and self._stays_whole(item, slots):
                skin = self.skin(item.name, (item.cage, item.poses), None, self._groups(item.cage, slots))
                whole.append({"skin": skin, "material": self._skin_material(item, slots)})
                continue
            for slot in slots:
                part = faces_of_slot(item.cage, slot)
                material = self.material("surface", item.materials[min(slot, len(item.materials) - 1)])
                poses = [pose[part.vertices] for pose in item.poses]
                buckets.setdefault((material, part.scheme, part.boundary), []).append((part, poses))
        self._character("scene", [{"skin": self.skin(material, merged(parts)), "material": material}
                                  for (material, _, _), parts in buckets.items()] + whole)

    def _stays_whole(self, item: Item, slots: list[int]) -> bool:
        """Whether cutting a mesh by its materials would be seen: in the shape of a cage, or in smooth normals.

        Polygons whose materials differ in more than the colour are cut in any case.
        """
        cage = item.cage
        if cage.scheme != "none":
            return True
        of_corner = np.repeat(cage.slots, cage.sizes)
        used = sum(len(np.unique(cage.corners[of_corner == slot])) for slot in slots)
        return used > len(np.unique(cage.corners)) and not self._differ(self._slot_blocks(item, slots))

    @staticmethod
    def _groups(cage: Cage, slots: list[int]) -> list[tuple[str, np.ndarray]] | None:
        return [(f"slot{slot}", np.flatnonzero(cage.slots == slot)) for slot in slots] if len(slots) > 1 else None

    def _slot_blocks(self, item: Item, slots: list[int]) -> list[Block]:
        return [self.converter.surface(item.materials[min(slot, len(item.materials) - 1)]) for slot in slots]

    @staticmethod
    def _differ(blocks: list[Block]) -> bool:
        """Whether materials differ in more than their colours."""
        return any(block | {"color": None} != blocks[0] | {"color": None} for block in blocks[1:])

    def _furry(self, item: Item, curves: list[Hair]) -> None:
        """A surface with fur: a character of its own."""
        coats = list(item.original.pelage.coats)
        hair = item.hair + curves
        if not item.shown:
            if coats:
                self.notes.add("fur of Pelage on objects that are not rendered: left out")
            self._character(item.name, [{"grooms": dict(self.strands(h, None) for h in hair)}] if hair else [])
            return
        cage, slots = item.cage, [int(slot) for slot in np.unique(item.cage.slots)]
        material = self._skin_material(item, slots)
        rest = groom.rest_points(item) if coats else None
        skin = self.skin(item.name, (cage, item.poses), rest, self._groups(cage, slots))
        part: Block = {"skin": skin, "material": material, "grooms": {}}
        for coat in coats:
            if coat.enabled:
                self.check()
                part["grooms"] |= groom.write_coat(self, item, skin, coat)
        if coats and hair:
            # The rest pose of these strands is not the rest pose of the skin: they stay where they are.
            self._character(f"{item.name} hair", [{"grooms": dict(self.strands(h, None) for h in hair)}])
        else:
            part["grooms"] |= dict(self.strands(h, skin) for h in hair)
        self._character(item.name, [part])

    def _skin_material(self, item: Item, slots: list[int]) -> str:
        if len(slots) == 1:
            return self.material("surface", item.materials[min(slots[0], len(item.materials) - 1)])
        name = self.name("materials", f"{item.name} skin")
        blocks = self._slot_blocks(item, slots)
        if self._differ(blocks):
            self.notes.add("several materials on a subdivided or furry mesh: all but their colours are those of the first")
        self.document["materials"][name] = by_slot(blocks, [f"slot{slot}" for slot in slots])
        return name
