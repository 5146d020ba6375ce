# SPDX-License-Identifier: Apache-2.0
"""Panels of the settings of a scene for the engine, and of what Pelage leaves out."""
from __future__ import annotations

from typing import Any

import bpy

from .settings import ENGINE

WITHOUT_COUNTERPART = (
    "volumes, emitting surfaces, transparency of surfaces",
    "metal, transmission, subsurface scattering, clear coat, sheen",
    "coat and random variation of the Principled Hair BSDF",
    "normal, bump and displacement maps",
    "shader nodes other than colours, numbers and image textures",
    "panoramic cameras, pixels that are not square, clipping",
    "ray visibility, light linking, holdouts",
    "rolling shutter, shutter curves, motion of strands relative to their emitter",
    "Freestyle, denoising, Cryptomatte",
)
"""Features of Blender that Pelage ignores. The panel shows them."""


class _Panel:
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "render"
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return bool(context.engine == ENGINE)


def _columns(panel: Any, owner: Any, *names: str) -> None:
    layout = panel.layout
    layout.use_property_split, layout.use_property_decorate = True, False
    for name in names:
        layout.prop(owner, name)


class PELAGE_PT_sampling(_Panel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.pelage
        _columns(self, settings, "integrator", "samples", "viewport_samples", "bounces", "adaptive")
        if settings.adaptive:
            self.layout.prop(settings, "noise")
        _columns(self, settings, "time_limit", "clamp", "seed")


class PELAGE_PT_strands(_Panel, bpy.types.Panel):
    bl_label = "Strands"

    def draw(self, context: bpy.types.Context) -> None:
        _columns(self, context.scene.pelage, "curves", "lod")


class PELAGE_PT_motion(_Panel, bpy.types.Panel):
    bl_label = "Motion Blur"

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context: bpy.types.Context) -> None:
        _columns(self, context.scene.render, "motion_blur_shutter")
        _columns(self, context.scene.pelage, "motion_keys")


class PELAGE_PT_performance(_Panel, bpy.types.Panel):
    bl_label = "Performance"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        _columns(self, context.scene.render, "threads_mode", "threads")
        _columns(self, context.scene.pelage, "memory")


class PELAGE_PT_counterparts(_Panel, bpy.types.Panel):
    bl_label = "Without Counterpart in Pelage"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        for line in WITHOUT_COUNTERPART:
            self.layout.label(text=line, icon="DOT")


class PELAGE_PT_passes(_Panel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        _columns(self, context.view_layer, "use_pass_z", "use_pass_normal")
        _columns(self, context.scene.pelage, "light_layers", "data_layers")


CLASSES = (PELAGE_PT_sampling, PELAGE_PT_strands, PELAGE_PT_motion, PELAGE_PT_performance, PELAGE_PT_counterparts,
           PELAGE_PT_passes)
