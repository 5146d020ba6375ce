# SPDX-License-Identifier: Apache-2.0
"""Settings of a scene for the engine, and their panel."""
from __future__ import annotations

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

ENGINE = "PELAGE"
WITHOUT_COUNTERPART = (
    "volumes, emitting surfaces, transparency of surfaces",
    "metal, transmission, subsurface scattering, clear coat, sheen",
    "coat and random variation of the Principled Hair BSDF",
    "normal, bump and displacement maps",
    "shader nodes other than colours, numbers and image textures",
    "panoramic cameras, pixels that are not square, clipping",
    "spread of area lights, ray visibility, light linking, holdouts",
    "rolling shutter and shutter curves; motion of strands other than that of their emitter",
    "Freestyle, denoising, Cryptomatte",
)
"""What Blender has and Pelage has not; shown in the panel."""


class PelageSettings(bpy.types.PropertyGroup):
    samples: IntProperty(name="Samples", default=64, min=1, max=1 << 20, description="Paths per pixel")  # type: ignore
    viewport_samples: IntProperty(name="Viewport", default=16, min=1, max=1 << 16,  # type: ignore
                                  description="Paths per pixel in the viewport")
    bounces: IntProperty(name="Bounces", default=8, min=0, max=1024,  # type: ignore
                         description="Max number of indirect bounces; light-coloured fur needs many")
    integrator: EnumProperty(name="Integrator", default="gather", items=(  # type: ignore
        ("gather", "Gather", "Samples that see the same piece of a strand share light: less noise in the same time"),
        ("path", "Path", "Every sample is a path of its own: the reference")))
    adaptive: BoolProperty(name="Adaptive", default=False,  # type: ignore
                           description="Take more samples in noisy pixels; Samples is then the maximum")
    noise: FloatProperty(name="Noise", default=0.05, min=1e-4, max=10, description="Noise budget")  # type: ignore
    time_limit: FloatProperty(name="Time Limit", default=0, min=0, max=1e7, unit="TIME_ABSOLUTE",  # type: ignore
                              description="Seconds per frame; 0 is no limit")
    clamp: FloatProperty(name="Clamp Indirect", default=0, min=0,  # type: ignore
                         description="Max luminance of the indirect light of one path; 0 is no limit")
    seed: IntProperty(name="Seed", default=0, min=0)  # type: ignore
    curves: EnumProperty(name="Strands", default="flat", items=(  # type: ignore
        ("flat", "Flat", "Strands are ribbons that face each ray"), ("round", "Round", "Strands are tubes, for close-ups")))
    lod: BoolProperty(name="Level of Detail", default=True,  # type: ignore
                      description="Grow fewer and wider strands where they are too thin to tell apart")
    motion_keys: IntProperty(name="Motion Steps", default=2, min=2, max=16,  # type: ignore
                             description="Poses over the shutter")
    memory: IntProperty(name="Memory", default=4096, min=64, max=1 << 22, description="Memory limit in MB")  # type: ignore
    light_layers: BoolProperty(name="Lights", default=False,  # type: ignore
                               description="One pass per light and lobe; the passes add up to the picture")
    data_layers: BoolProperty(name="Fur Data", default=False,  # type: ignore
                              description="Passes of ids, texture coordinates of roots, tangents and motion")


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


CLASSES = (PelageSettings, PELAGE_PT_sampling, PELAGE_PT_strands, PELAGE_PT_motion, PELAGE_PT_performance,
           PELAGE_PT_counterparts, PELAGE_PT_passes)


def register() -> None:
    bpy.types.Scene.pelage = PointerProperty(type=PelageSettings)


def unregister() -> None:
    del bpy.types.Scene.pelage


def render_block(settings: PelageSettings, viewport: bool) -> dict[str, Any]:
    """The block `render` of a scene file."""
    block: dict[str, Any] = {
        "integrator": settings.integrator, "samples": settings.viewport_samples if viewport else settings.samples,
        "bounces": settings.bounces, "seed": settings.seed, "curves": settings.curves, "memory": f"{settings.memory}M",
        "lod": {"enabled": settings.lod}}
    if settings.clamp > 0:
        block["clamp_indirect"] = settings.clamp
    if settings.adaptive and not viewport:
        block["adaptive"] = {"noise": settings.noise}
    if settings.time_limit > 0 and not viewport:
        block["time_limit"] = settings.time_limit
    return block
