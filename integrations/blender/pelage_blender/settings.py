# SPDX-License-Identifier: Apache-2.0
"""Settings of a scene for the engine, and what a scene file gets of them."""
from __future__ import annotations

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

ENGINE = "PELAGE"


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


CLASSES = (PelageSettings,)


def register() -> None:
    bpy.types.Scene.pelage = PointerProperty(type=PelageSettings)


def unregister() -> None:
    del bpy.types.Scene.pelage
