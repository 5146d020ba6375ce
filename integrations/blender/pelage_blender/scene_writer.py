# SPDX-License-Identifier: Apache-2.0
"""Writes a depsgraph as a folder with a Pelage scene."""
from __future__ import annotations

import hashlib
from collections.abc import Callable

import bpy

from . import exr
from .axes import spot_image, to_pelage
from .camera import scene_camera
from .collect import add_pose, collect
from .furry_surfaces import FurWriter
from .lights import world_block
from .scene_document import Block, SceneDocument
from .scene_folder import SceneFolder
from .scene_json import document_text
from .settings import render_block
from .shutter import moving, shutter_times, visit
from .stage import Hair, Stage
from .surfaces import SurfaceWriter


class SceneWriter:
    """Writes scenes into one folder; a further scene replaces only the files that differ."""

    def __init__(self, folder: SceneFolder, check: Callable[[], None] = lambda: None) -> None:
        """check: called between objects; it may raise an exception to stop write()."""
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
        scene = depsgraph.scene
        self.document = SceneDocument(self.folder, scene.frame_current, self.notes)
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
        blocks = self._blocks(depsgraph, size, stage, cameras, depsgraph.mode == "RENDER" if final is None else final)
        if text is not None:
            self.folder.put("scene.yaml", text(blocks))
        return blocks

    def _camera(self, depsgraph: bpy.types.Depsgraph, size: tuple[int, int]) -> Block:
        camera = depsgraph.scene.camera
        if camera is None:
            raise ValueError("the scene has no camera")
        return scene_camera(camera.evaluated_get(depsgraph), depsgraph, size, self.notes)

    def _blocks(self, depsgraph: bpy.types.Depsgraph, size: tuple[int, int], stage: Stage, cameras: list[Block],
                final: bool) -> Block:
        """All blocks of the scene that are not empty."""
        scene, blocks = depsgraph.scene, self.document.blocks
        moving_camera = moving(cameras, ("position", "look_at", "up", "fov", "orthographic"))
        if len(cameras) > 1:
            moving_camera |= {"shutter": [0, 1], "motion_keys": len(cameras)}
        blocks |= {
            "pelage": 1, "units": {"meters_per_unit": scene.unit_settings.scale_length,
                                   "fps": scene.render.fps / scene.render.fps_base},
            "camera": moving_camera,
            "image": {"width": size[0], "height": size[1], "light_layers": scene.pelage.light_layers and final},
            "render": render_block(scene.pelage, not final),
            "skins": {}, "materials": {}, "grooms": {}, "characters": {}, "lights": {}}
        self._lights(scene, stage)
        self._surfaces(stage)
        self._free_hair([loose.hair for loose in stage.loose if loose.surface not in stage.items])
        for empty in [key for key, value in blocks.items() if value == {}]:
            del blocks[empty]
        return blocks

    def _lights(self, scene: bpy.types.Scene, stage: Stage) -> None:
        lights = self.document.blocks["lights"]
        world = world_block(scene.world, self.folder, self.notes, scene.frame_current)
        if world is not None:
            if scene.render.film_transparent:
                world["visible"] = False
            lights[self.document.name("lights", "world")] = world
        for key, keys in stage.lights.items():
            block = moving(keys, ("position", "look_at", "direction"))
            if block["type"] == "spot":
                block["file"] = self.folder.put(f"spot {block['cone']:.3f}.exr", exr.encode({"Y": spot_image(block["cone"])}))
            if "profile_text" in block:
                text = block.pop("profile_text")
                digest = hashlib.blake2b(text.encode(), digest_size=8).hexdigest()
                block["profile"] = self.folder.put(f"profile_{digest}.ies", text)
            lights[self.document.name("lights", stage.names[key])] = block

    def _surfaces(self, stage: Stage) -> None:
        hosts = {loose.surface for loose in stage.loose}
        furry = {key for key, item in stage.items.items()
                 if item.asset.hair or len(item.asset.original.pelage.coats) or key in hosts}
        SurfaceWriter(self.document).write([item for key, item in stage.items.items() if key not in furry and item.asset.shown])
        fur_writer = FurWriter(self.document, self.check)
        for key, item in stage.items.items():
            if key in furry:
                fur_writer.write(item, [loose.hair for loose in stage.loose if loose.surface == key])

    def _free_hair(self, hair: list[Hair]) -> None:
        """Hair Curves without a surface, which stay where they are."""
        grooms = {self.document.strands(h.name, to_pelage(h.strands.points), h.strands, None):
                  self.document.material("hair", h.material) for h in hair}
        self.document.character("hair", [{"grooms": grooms}] if grooms else [])
