# SPDX-License-Identifier: Apache-2.0
"""Progressive pictures in the viewport: `pelage view` renders a folder that follows the edits in Blender."""
from __future__ import annotations

import pathlib
import shutil
import time
import traceback
from typing import Any

import bpy
import gpu
import numpy as np
from gpu_extras.presets import draw_texture_2d

from . import preferences, process
from .camera import optics, placement, projected
from .scene_folder import SceneFolder
from .scene_json import document_text
from .scene_writer import SceneWriter
from .temporary_folders import new_folder
from .view_client import ViewClient, ViewPicture

FAR = 1000.0
"""How far behind its view an orthographic viewport has its camera, in units: Blender shows what is behind it, too."""


def view_camera(context: bpy.types.Context, depsgraph: bpy.types.Depsgraph, notes: set[str]) -> dict[str, Any]:
    """The camera of a viewport."""
    view = context.region_data
    projection = np.array(view.window_matrix, np.float64)
    matrix = view.view_matrix.inverted()
    camera = context.space_data.camera
    if view.view_perspective == "CAMERA" and camera is not None and camera.type == "CAMERA":
        return placement(matrix, 10.0) | optics(camera.evaluated_get(depsgraph), projection, notes)
    if not view.is_perspective:
        matrix.translation += matrix.col[2].xyz.normalized() * FAR
    return placement(matrix, 10.0) | projected(projection, not view.is_perspective)


class ViewportSession:
    """The process, the folder and the picture of one viewport."""

    def __init__(self) -> None:
        self.program = preferences.program()
        self.folder = new_folder()
        self.writer = SceneWriter(SceneFolder(pathlib.Path(self.folder)))
        self.document: dict[str, Any] | None = None
        self.client: ViewClient | None = None
        self.texture: gpu.types.GPUTexture | None = None
        self.shown = -1
        self.announced, self.announced_s = (-1, ""), 0.0
        self.problem = ""

    def write(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Rewrites the files whose content an edit has changed, and starts the program unless it runs."""
        try:
            size = max(context.region.width, 1), max(context.region.height, 1)
            self.document = self.writer.write(depsgraph, size, camera=view_camera(context, depsgraph, self.writer.notes))
            self.problem = ""
        except (ValueError, OSError, MemoryError) as error:
            self.problem = str(error)
            return
        except Exception as error:  # the viewport keeps its last picture
            traceback.print_exc()
            self.problem = f"internal error in the add-on: {error}"
            return
        if self.client is not None and self.client.ended:
            self.client.close()
            self.client, self.shown = None, -1
            self.announced = -1, ""  # the new program counts its pictures from the start
        if self.client is None:
            scene = depsgraph.scene
            threads = scene.render.threads if scene.render.threads_mode == "FIXED" else 0
            self.client = ViewClient(self.program, str(pathlib.Path(self.folder) / "scene.yaml"), threads)

    def follow_view(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Writes the camera if the view has moved or has another size."""
        if self.document is None:
            return
        camera = view_camera(context, depsgraph, set())
        image = {**self.document["image"], "width": max(context.region.width, 1), "height": max(context.region.height, 1)}
        if (camera, image) != (self.document["camera"], self.document["image"]):
            self.document = {**self.document, "camera": camera, "image": image}
            self.writer.folder.put("scene.yaml", document_text(self.document))

    def draw(self, context: bpy.types.Context) -> None:
        """Draws the newest picture."""
        picture = self.client.picture if self.client is not None else None
        if picture is None:
            return
        if picture.version != self.shown or self.texture is None:
            self.texture, self.shown = _texture(picture, context.scene.render.film_transparent), picture.version
        rows, columns = picture.rgba.shape[:2]
        factor = context.region.width / picture.width, context.region.height / picture.height
        width, height = columns * picture.grid * factor[0], rows * picture.grid * factor[1]
        gpu.state.blend_set("ALPHA_PREMULT")
        draw_texture_2d(self.texture, (0, context.region.height - height), width, height)
        gpu.state.blend_set("NONE")

    def status(self) -> str:
        """One line for the viewport."""
        if self.problem or self.client is None:
            return self.problem
        error = self.client.error  # a thread may clear it
        if error:
            return process.readable(error.splitlines()[0], pathlib.Path(self.folder) / "scene.yaml")
        state = self.client.state
        if state.get("done"):
            return f"Samples {state.get('samples', 0):.0f}"
        if state.get("stage"):
            return f"{str(state['stage']).capitalize()} {100 * state.get('progress', 0):.0f} %"
        return f"Samples {state.get('samples', 0):.0f} of {state.get('wanted_samples', 0)}"

    def changed(self) -> bool:
        """Whether there is something new to draw since the last call: a picture, or a status that is four to a second at most."""
        picture = self.client.picture if self.client is not None else None
        version, now = picture.version if picture is not None else -1, time.monotonic()
        if version != self.announced[0] or (now - self.announced_s > 0.25 and self.status() != self.announced[1]):
            self.announced, self.announced_s = (version, self.status()), now
            return True
        return False

    def close(self) -> None:
        if self.client is not None:
            self.client.close()
            self.client = None
        shutil.rmtree(self.folder, ignore_errors=True)


def _texture(picture: ViewPicture, transparent: bool) -> gpu.types.GPUTexture:
    rows, columns = picture.rgba.shape[:2]
    rgba = picture.rgba.copy()
    if not transparent:
        rgba[..., 3] = 1  # Pelage's alpha is 0 where only the world is seen
    pixels = gpu.types.Buffer("FLOAT", rgba.size, rgba.ravel())
    return gpu.types.GPUTexture((columns, rows), format="RGBA16F", data=pixels)
