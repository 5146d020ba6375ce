# SPDX-License-Identifier: Apache-2.0
"""Operators that add and remove coats; both can be undone."""
from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from bpy.props import EnumProperty

from . import coat_presets, preferences, process, schema
from .coat_steps import add_step

PRESETS = tuple((name, look.label, look.help) for name, look in coat_presets.LOOKS.items())


def active_coat(context: bpy.types.Context) -> Any:
    fur = context.object.pelage if context.object is not None else None
    return fur.coats[min(fur.active, len(fur.coats) - 1)] if fur is not None and len(fur.coats) else None


def area_of(ob: bpy.types.Object, context: bpy.types.Context) -> float:
    """Area of a mesh with its modifiers, in square units of the world."""
    evaluated = ob.evaluated_get(context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    try:
        areas = np.empty(len(mesh.polygons), np.float32)
        mesh.polygons.foreach_get("area", areas)
    finally:
        evaluated.to_mesh_clear()
    scale = abs(np.linalg.det(np.array(ob.matrix_world)[:3, :3])) ** (1 / 3)
    return float(areas.sum()) * scale**2


class OnMesh:
    """An operator on the active mesh; edit() says whether it has changed something."""
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        # What is linked from another file cannot be saved here.
        ob = context.object
        return ob is not None and ob.type == "MESH" and ob.library is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not self.edit(context):
            return {"CANCELLED"}
        context.object.update_tag()
        return {"FINISHED"}

    def edit(self, context: bpy.types.Context) -> bool:
        raise NotImplementedError


class PELAGE_OT_fur_add(OnMesh, bpy.types.Operator):
    """Grow fur on the active mesh"""
    bl_idname = "object.pelage_fur_add"
    bl_label = "Add Pelage Fur"
    preset: EnumProperty(name="Coat", items=PRESETS, default="FLUFFY")  # type: ignore[valid-type]

    def edit(self, context: bpy.types.Context) -> bool:
        ob = context.object
        if len(ob.data.polygons) == 0:
            self.report({"ERROR"}, f"'{ob.name}' has no faces on which fur could grow")
            return False
        try:
            known = schema.load(preferences.program())
        except process.PelageFailed as error:
            self.report({"ERROR"}, f"Pelage: {error}")
            return False
        plan = coat_presets.plan(self.preset, area_of(ob, context))
        coat = ob.pelage.coats.add()
        names = {c.name for c in ob.pelage.coats}
        label = coat_presets.LOOKS[self.preset].label
        coat.name = next(n for n in [label, *(f"{label} {i}" for i in range(2, 1000))] if n not in names)
        ob.pelage.active = len(ob.pelage.coats) - 1
        coat.strands, coat.points, coat.role = plan.strands, plan.points, plan.role
        coat.root_color, coat.tip_color, coat.roughness = plan.root_color, plan.tip_color, plan.roughness
        for kind, values in plan.operators:
            add_step(coat, known[kind], values)
        if self.preset == "WHISKERS" and ob.vertex_groups.active is not None:
            coat.use_density, coat.density.group = True, ob.vertex_groups.active.name
        return True


class PELAGE_OT_fur_remove(OnMesh, bpy.types.Operator):
    """Remove the active coat"""
    bl_idname = "object.pelage_fur_remove"
    bl_label = "Remove Coat"

    def edit(self, context: bpy.types.Context) -> bool:
        fur = context.object.pelage
        if not len(fur.coats):
            return False
        fur.coats.remove(min(fur.active, len(fur.coats) - 1))
        fur.active = max(0, min(fur.active, len(fur.coats) - 1))
        return True


CLASSES = (PELAGE_OT_fur_add, PELAGE_OT_fur_remove)
