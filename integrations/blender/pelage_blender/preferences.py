# SPDX-License-Identifier: Apache-2.0
"""Preferences of the add-on: where the program is."""
from __future__ import annotations

import bpy

from . import process


class PelagePreferences(bpy.types.AddonPreferences):
    bl_idname = __package__
    program: bpy.props.StringProperty(  # type: ignore[valid-type]
        name="Program", subtype="FILE_PATH", description="The program pelage. Empty: the one on PATH")

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.prop(self, "program")
        try:
            self.layout.label(text=f"Found: {process.find_program(self.program)}", icon="CHECKMARK")
        except process.PelageFailed as error:
            self.layout.label(text=str(error), icon="ERROR")


def program() -> str:
    """Path of the program. Raises PelageFailed."""
    addon = bpy.context.preferences.addons.get(__package__)
    return process.find_program(bpy.path.abspath(addon.preferences.program) if addon is not None else "")


CLASSES = (PelagePreferences,)
