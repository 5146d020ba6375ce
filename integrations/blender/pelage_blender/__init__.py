# SPDX-License-Identifier: Apache-2.0
"""Pelage for Blender: a render engine for fur, and fur that grows on meshes."""
from __future__ import annotations

import bpy

from . import (borrowed_panels, coat_properties, engine, fur_operators, fur_panel, preferences, settings, settings_panels,
               step_operators, viewport_sessions, write_yaml)

bl_info = {
    "name": "Pelage",
    "author": "The authors of Pelage",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Render properties, Render Engine: Pelage",
    "description": "Grows fur on meshes and renders it",
    "category": "Render",
}
MODULES = (preferences, settings, settings_panels, coat_properties, fur_operators, step_operators, write_yaml, fur_panel,
           viewport_sessions, engine, borrowed_panels)


def register() -> None:
    for module in MODULES:
        for cls in module.CLASSES:
            bpy.utils.register_class(cls)
        if hasattr(module, "register"):
            module.register()


def unregister() -> None:
    for module in reversed(MODULES):
        if hasattr(module, "unregister"):
            module.unregister()
        for cls in reversed(module.CLASSES):
            bpy.utils.unregister_class(cls)
