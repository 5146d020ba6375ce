# SPDX-License-Identifier: Apache-2.0
"""Particle hair as strands."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from .axes import transformed
from .particle_keys import read_keys


@dataclass
class HairStrands:
    points: np.ndarray   # (p, 3) with the axes of Blender
    widths: np.ndarray   # (p,) diameters
    counts: np.ndarray   # (n,) points of each strand

    def transformed(self, matrix: Any) -> HairStrands:
        """Strands of the same width whose points are multiplied by a matrix (4, 4)."""
        return HairStrands(transformed(self.points, matrix), self.widths, self.counts)


def hair_systems(ob: bpy.types.Object, render: bool) -> list[tuple[Any, Any]]:
    """Modifiers of an evaluated object and their particle systems that draw hair as paths."""
    return [(m, m.particle_system) for m in ob.modifiers
            if m.type == "PARTICLE_SYSTEM" and (m.show_render if render else m.show_viewport)
            and m.particle_system.settings.type == "HAIR" and m.particle_system.settings.render_type == "PATH"]


def strand_range(system: Any, render: bool) -> range:
    """Numbers of the strands that Blender draws: children, if there are any, hide their parents."""
    settings, parents = system.settings, len(system.particles)
    children = len(system.child_particles)
    if not render:
        children = children * settings.display_percentage // 100
    if settings.child_type == "NONE" or children == 0:
        return range(parents)
    return range(0 if settings.use_parent_particles else parents, parents + children)


def steps_of(system: Any, render: bool) -> int:
    settings = system.settings
    steps = 2 ** (settings.render_step if render else settings.display_step)
    return steps + (settings.kink_extra_steps if settings.kink == "SPIRAL" and settings.child_type != "NONE" else 0)


def tapered(along: np.ndarray, settings: Any) -> np.ndarray:
    """Diameters at fractions of the length, as Cycles computes them: `shape` bends the taper from root to tip."""
    shape, rest = settings.shape, np.clip(1 - along, 0, 1)
    rest = rest ** (1 + shape) if shape < 0 else rest ** (1 / max(1 - shape, 1e-3))
    return settings.radius_scale * (rest * (settings.root_radius - settings.tip_radius) + settings.tip_radius)


def read_hair(ob: bpy.types.Object, system: Any, render: bool, parents: bool = False) -> HairStrands | None:
    """The strands of a particle system of an evaluated object, or its parents only; None if there are none."""
    numbers = range(len(system.particles)) if parents else strand_range(system, render)
    steps = steps_of(system, render)
    if len(numbers) == 0:
        return None
    keys, segments = read_keys(ob, system, numbers, steps)
    kept = segments > 0
    keys, segments = keys[kept], segments[kept]
    if len(keys) == 0:
        return None
    inside = np.arange(steps + 1) <= segments[:, None]
    pieces = np.linalg.norm(np.diff(keys, axis=1), axis=2) * inside[:, 1:]
    lengths = np.concatenate([np.zeros((len(keys), 1)), np.cumsum(pieces, axis=1)], axis=1)
    widths = tapered(lengths / np.maximum(lengths[:, -1:], 1e-12), system.settings)
    if system.settings.use_close_tip:
        widths[np.arange(len(keys)), segments] = 0
    return HairStrands(keys[inside], widths[inside], segments + 1)
