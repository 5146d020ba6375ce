# SPDX-License-Identifier: Apache-2.0
"""The render engine: final pictures by `pelage render` in a process of its own."""
from __future__ import annotations

import math
import pathlib
import shutil
import traceback

import bpy

from . import exr, passes, preferences, process, viewport_sessions
from .picture_size import border, picture_size
from .scene_folder import SceneFolder
from .scene_writer import SceneWriter
from .settings import ENGINE
from .temporary_folders import new_folder
from .viewport import ViewportSession

SHARE = {"read": (0.0, 0.05), "pose": (0.05, 0.05), "grow": (0.05, 0.15), "bounds": (0.05, 0.15),
         "reflection cache": (0.15, 0.2), "render": (0.2, 0.98), "write": (0.98, 1.0)}
"""Where stages of a render begin and end on the progress bar."""


class PelageEngine(bpy.types.RenderEngine):
    bl_idname = ENGINE
    bl_label = "Pelage"
    bl_use_preview = False
    bl_use_shading_nodes_custom = False
    bl_use_postprocess = True
    bl_use_eevee_viewport = True
    stage = ""
    session: ViewportSession | None = None

    def __del__(self) -> None:
        if self.session is not None:
            viewport_sessions.release(self.session)

    def view_update(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        try:
            if self.session is None:
                self.session = viewport_sessions.acquire()
                viewport_sessions.follow(self)
            self.session.write(context, depsgraph)
        except (process.PelageFailed, OSError) as error:
            self.update_stats("Pelage", str(error))

    def view_draw(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        if self.session is None:
            return
        try:
            self.session.follow_view(context, depsgraph)
            self.bind_display_space_shader(depsgraph.scene)
            try:
                self.session.draw(context)
            finally:
                self.unbind_display_space_shader()
            self.update_stats("Pelage", self.session.status())
        except Exception as error:  # Blender would call again at once, and fill its console
            self.update_stats("Pelage", f"The picture cannot be drawn: {error}")

    def update_render_passes(self, scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> None:
        self.register_pass(scene, layer, "Combined", 4, "RGBA", "COLOR")
        if layer.use_pass_z:
            self.register_pass(scene, layer, "Depth", 1, "Z", "VALUE")
        if layer.use_pass_normal:
            self.register_pass(scene, layer, "Normal", 3, "XYZ", "VECTOR")
        for name, count, letters, kind in passes.wanted_passes(scene, layer):
            self.register_pass(scene, layer, name, count, letters, kind)

    def render(self, depsgraph: bpy.types.Depsgraph) -> None:
        # Blender 3.4 crashes when an exception leaves this function, and in error_set().
        try:
            folder = new_folder()
            try:
                self._render(depsgraph, pathlib.Path(folder))
            finally:
                shutil.rmtree(folder, ignore_errors=True)
        except process.Cancelled:
            pass
        except (process.PelageFailed, exr.ExrError, ValueError, OSError, MemoryError) as error:
            self.report({"ERROR"}, f"Pelage: {error}")
        except Exception:  # the user sees where
            self.report({"ERROR"}, f"Pelage: internal error in the add-on:\n{traceback.format_exc()}")

    def _render(self, depsgraph: bpy.types.Depsgraph, folder: pathlib.Path) -> None:
        scene = depsgraph.scene
        program = preferences.program()
        size = picture_size(scene)
        region = border(scene, size)
        self.update_stats("Pelage", "Reading the scene")
        writer = SceneWriter(SceneFolder(folder), self._check)
        writer.write(depsgraph, size, self.frame_set)
        if writer.notes:
            self.report({"INFO"}, "Pelage: without counterpart: " + "; ".join(sorted(writer.notes)))
        output = folder / "picture.exr"
        command = [program, "render", str(folder / "scene.yaml"), "-o", str(output), "--progress", "json"]
        if scene.render.threads_mode == "FIXED":
            command += ["--threads", str(scene.render.threads)]
        if region is not None:
            command += ["--region", ",".join(map(str, region))]
        result = process.run_render(command, folder / "scene.yaml", self.test_break, self._progress)
        for warning in result.warnings:
            self.report({"WARNING"}, f"Pelage: {warning}")
        self._show(depsgraph, output, size if region is None else (region[2] - region[0], region[3] - region[1]))

    def _check(self) -> None:
        if self.test_break():
            raise process.Cancelled

    def _progress(self, stage: str, fraction: float) -> None:
        begin, end = SHARE.get(stage, (0.0, 0.05))
        if math.isfinite(fraction):
            self.update_progress(begin + (end - begin) * min(max(fraction, 0.0), 1.0))
        if stage and stage != self.stage:
            self.stage = stage
            self.update_stats("Pelage", stage.capitalize())

    def _show(self, depsgraph: bpy.types.Depsgraph, path: pathlib.Path, size: tuple[int, int]) -> None:
        scene, view_layer = depsgraph.scene, depsgraph.view_layer
        wanted = list(passes.wanted_passes(scene, view_layer))
        picture = passes.Picture(path, every=bool(wanted))
        if picture.size != size:
            raise exr.ExrError(f"the picture has {picture.size} pixels instead of {size}")
        for name, count, letters, _ in wanted:
            self.add_pass(name, count, letters, layer=view_layer.name)
        result = self.begin_result(0, 0, *size, layer=view_layer.name)
        if not result.layers:
            return
        try:
            passes.fill(result.layers[0].passes, picture, scene.render.film_transparent)
        finally:
            self.end_result(result, cancel=self.test_break())


CLASSES = (PelageEngine,)
