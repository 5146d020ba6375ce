# SPDX-License-Identifier: Apache-2.0
"""Pelage for Blender: a render engine for fur, and fur that grows on meshes."""
from __future__ import annotations

import bpy

from . import engine, fur_operators, fur_panel, groom, preferences, settings, viewport

bl_info = {
    "name": "Pelage",
    "author": "The authors of Pelage",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Render properties, Render Engine: Pelage",
    "description": "Grows fur on meshes and renders it",
    "category": "Render",
}
MODULES = (preferences, settings, groom, fur_operators, fur_panel, viewport, engine)


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
