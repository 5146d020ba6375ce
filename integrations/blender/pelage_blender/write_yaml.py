# SPDX-License-Identifier: Apache-2.0
"""Writes the scene as YAML for people, and never over a file that they have edited."""
from __future__ import annotations

import hashlib
import itertools
import pathlib

import bpy

from .picture_size import picture_size
from .scene_folder import SceneFolder
from .scene_writer import SceneWriter
from .yaml_text import scene_text


def signed(text: str) -> str:
    """The text with a last line that tells whether someone has edited it."""
    return f"{text}# Written by Blender, {hashlib.blake2b(text.encode(), digest_size=8).hexdigest()}\n"


def unchanged_name(folder: pathlib.Path) -> str:
    """scene.yaml, or scene 2.yaml and so on: the first that is not there, or is as signed() returned it."""
    for number in itertools.count(1):
        path = folder / ("scene.yaml" if number == 1 else f"scene {number}.yaml")
        if not path.exists():
            break
        text = path.read_text(encoding="utf-8", errors="replace")
        if text == signed(text[:text.rstrip("\n").rfind("\n") + 1]):
            break
    return path.name


class PELAGE_OT_write_yaml(bpy.types.Operator):
    """Write the scene as YAML into a folder beside the .blend, for the program pelage: with the samples of final pictures, """ \
        """at this moment without motion blur, and with what the viewport shows of modifiers, hair and visibility"""
    bl_idname = "scene.pelage_write_yaml"
    bl_label = "Write YAML"

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not bpy.data.filepath:
            self.report({"ERROR"}, "Please save the .blend first: the scene is written beside it")
            return {"CANCELLED"}
        path = pathlib.Path(bpy.data.filepath).with_suffix("")
        folder = path.with_name(path.name + "_pelage")
        try:
            folder.mkdir(exist_ok=True)
            writer = SceneWriter(SceneFolder(folder))
            document = writer.write(context.evaluated_depsgraph_get(), picture_size(context.scene), final=True, text=None)
            name = unchanged_name(folder)
            writer.folder.put(name, signed(scene_text(document)))
        except (OSError, ValueError) as error:
            self.report({"ERROR"}, f"Pelage: {error}")
            return {"CANCELLED"}
        if name != "scene.yaml":
            self.report({"WARNING"}, f"scene.yaml was edited and stays as it is. Written: {folder / name}")
        else:
            self.report({"INFO"}, f"Written: {folder / name}")
        return {"FINISHED"}


CLASSES = (PELAGE_OT_write_yaml,)
