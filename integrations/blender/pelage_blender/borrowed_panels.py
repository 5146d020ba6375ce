# SPDX-License-Identifier: Apache-2.0
"""Panels of Blender and of Eevee that this engine shows as well."""
from __future__ import annotations

from typing import Any

import bpy

from .settings import ENGINE


def compatible_panels() -> list[Any]:
    """Panels of Blender that make sense with this engine."""
    unwanted = {"VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes", "RENDER_PT_eevee_sampling", "DATA_PT_light",
                "RENDER_PT_freestyle"}
    return [panel for panel in bpy.types.Panel.__subclasses__()
            if "BLENDER_RENDER" in getattr(panel, "COMPAT_ENGINES", ()) and panel.__name__ not in unwanted]


def register() -> None:
    for panel in compatible_panels():
        panel.COMPAT_ENGINES.add(ENGINE)
    _eevee_panels(True)


def unregister() -> None:
    for panel in compatible_panels():
        panel.COMPAT_ENGINES.discard(ENGINE)
    _eevee_panels(False)


def _eevee_panels(add: bool) -> None:
    """Panels of Eevee for materials, lights and the world, which edit the nodes that Pelage reads."""
    for name in ("EEVEE_MATERIAL_PT_context_material", "EEVEE_MATERIAL_PT_surface", "EEVEE_WORLD_PT_surface",
                 "DATA_PT_EEVEE_light", "NODE_DATA_PT_EEVEE_light", "DATA_PT_spot"):
        panel = getattr(bpy.types, name, None)
        if panel is not None and hasattr(panel, "COMPAT_ENGINES"):
            (panel.COMPAT_ENGINES.add if add else panel.COMPAT_ENGINES.discard)(ENGINE)


CLASSES = ()
