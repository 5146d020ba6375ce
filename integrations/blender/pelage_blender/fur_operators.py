# SPDX-License-Identifier: Apache-2.0
"""Operators that add and edit coats; all can be undone."""
from __future__ import annotations

import pathlib
from typing import Any

import bpy
import numpy as np
from bpy.props import EnumProperty, IntProperty, StringProperty

from . import coat_presets, coat_values, preferences, process, schema
from .files import SceneFolder
from .yaml_text import scene_text, signed, unchanged_name

PRESETS = tuple((name, look.label, look.help) for name, look in coat_presets.LOOKS.items())


def active_coat(context: bpy.types.Context) -> Any:
    fur = context.object.pelage if context.object is not None else None
    return fur.coats[min(fur.active, len(fur.coats) - 1)] if fur is not None and len(fur.coats) else None


def operator_schema(kind: str) -> schema.SchemaBlock | None:
    """Keys of an operator, or None if the program is not there or does not know it."""
    try:
        return schema.load(preferences.program()).get(kind)
    except process.PelageFailed:
        return None


def set_value(operator: Any, key: schema.SchemaKey, value: Any) -> None:
    """Stores a value as a custom property with limits and help."""
    if key.kind == "choice":
        operator[key.name] = str(value)
        return
    operator[key.name] = [float(v) for v in value] if key.kind == "vector" else \
        int(value) if key.kind in ("integer", "switch") else float(value)
    limits: dict[str, Any] = {"description": key.help}
    if key.kind in ("integer", "switch"):
        limits |= {"min": int(max(key.low, -2**31)), "max": int(min(key.high, 2**31 - 1))}
    elif key.kind != "vector":
        low, high = max(key.low, -1e9), min(key.high, 1e9)
        limits |= {"min": low, "max": high, "soft_min": low, "soft_max": high, "precision": 4,
                   "step": 0.01 * max(abs(float(value)), 1e-4)}
    operator.id_properties_ui(key.name).update(**limits)


def area_of(ob: bpy.types.Object, context: bpy.types.Context) -> float:
    """Area of a mesh with its modifiers, in square units of the world."""
    evaluated = ob.evaluated_get(context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    areas = np.empty(len(mesh.polygons), np.float32)
    mesh.polygons.foreach_get("area", areas)
    evaluated.to_mesh_clear()
    scale = abs(np.linalg.det(np.array(ob.matrix_world)[:3, :3])) ** (1 / 3)
    return float(areas.sum()) * scale**2


class _OnMesh:
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        # What is linked from another file cannot be saved here.
        ob = context.object
        return ob is not None and ob.type == "MESH" and ob.library is None


class PELAGE_OT_fur_add(_OnMesh, bpy.types.Operator):
    """Grow fur on the active mesh"""
    bl_idname = "object.pelage_fur_add"
    bl_label = "Add Pelage Fur"
    preset: EnumProperty(name="Coat", items=PRESETS, default="FLUFFY")  # type: ignore[valid-type]

    def execute(self, context: bpy.types.Context) -> set[str]:
        ob = context.object
        if len(ob.data.polygons) == 0:
            self.report({"ERROR"}, f"'{ob.name}' has no faces on which fur could grow")
            return {"CANCELLED"}
        try:
            known = schema.load(preferences.program())
        except process.PelageFailed as error:
            self.report({"ERROR"}, f"Pelage: {error}")
            return {"CANCELLED"}
        plan = coat_presets.plan(self.preset, area_of(ob, context))
        coat = ob.pelage.coats.add()
        names = {c.name for c in ob.pelage.coats}
        label = coat_presets.LOOKS[self.preset].label
        coat.name = next(n for n in [label, *(f"{label} {i}" for i in range(2, 1000))] if n not in names)
        ob.pelage.active = len(ob.pelage.coats) - 1
        coat.strands, coat.points, coat.role = plan.strands, plan.points, plan.role
        coat.root_color, coat.tip_color, coat.roughness = plan.root_color, plan.tip_color, plan.roughness
        for kind, values in plan.operators:
            add_operator(coat, known[kind], values)
        ob.update_tag()
        if self.preset == "WHISKERS" and ob.vertex_groups.active is not None:
            coat.use_density, coat.density.group = True, ob.vertex_groups.active.name
        return {"FINISHED"}


def add_operator(coat: Any, block: schema.SchemaBlock, values: dict[str, Any]) -> Any:
    """Adds an operator with all numbers that have defaults, changed by `values`."""
    operator = coat.operators.add()
    operator.name = operator.kind = block.name
    for key in block.keys:
        value = values.get(key.name, key.default)
        if key.kind == "vector" and key.name not in values:
            value = coat_values.from_scene(value)
        if value is not None and key.kind != "other":
            set_value(operator, key, value)
    return operator


class PELAGE_OT_fur_remove(_OnMesh, bpy.types.Operator):
    """Remove the active coat"""
    bl_idname = "object.pelage_fur_remove"
    bl_label = "Remove Coat"

    def execute(self, context: bpy.types.Context) -> set[str]:
        fur = context.object.pelage
        if not len(fur.coats):
            return {"CANCELLED"}
        fur.coats.remove(min(fur.active, len(fur.coats) - 1))
        fur.active = max(0, min(fur.active, len(fur.coats) - 1))
        context.object.update_tag()
        return {"FINISHED"}


def _operator_items(self: Any, context: bpy.types.Context) -> list[tuple[str, str, str]]:
    try:
        blocks = schema.load(preferences.program())
    except process.PelageFailed:
        return []
    _operator_items.kept = [(n, n.replace("_", " ").title(), b.help[:250]) for n, b in blocks.items()]  # type: ignore
    return _operator_items.kept  # type: ignore[attr-defined,no-any-return]


class PELAGE_OT_operator_add(_OnMesh, bpy.types.Operator):
    """Add a step that shapes the strands"""
    bl_idname = "object.pelage_operator_add"
    bl_label = "Add Operator"
    kind: EnumProperty(name="Operator", items=_operator_items)  # type: ignore[valid-type]

    def execute(self, context: bpy.types.Context) -> set[str]:
        coat, block = active_coat(context), operator_schema(self.kind)
        if coat is None or block is None:
            return {"CANCELLED"}
        add_operator(coat, block, {}).expanded = True
        width = next((i for i, o in enumerate(coat.operators) if o.kind == "width"), len(coat.operators) - 1)
        if self.kind != "width":
            coat.operators.move(len(coat.operators) - 1, width)
        context.object.update_tag()
        return {"FINISHED"}


class PELAGE_OT_operator_edit(_OnMesh, bpy.types.Operator):
    """Move or remove an operator"""
    bl_idname = "object.pelage_operator_edit"
    bl_label = "Edit Operator"
    index: IntProperty()  # type: ignore[valid-type]
    action: EnumProperty(items=(("UP", "Up", ""), ("DOWN", "Down", ""), ("REMOVE", "Remove", "")))  # type: ignore[valid-type]

    def execute(self, context: bpy.types.Context) -> set[str]:
        coat = active_coat(context)
        if coat is None or not 0 <= self.index < len(coat.operators):
            return {"CANCELLED"}
        if self.action == "REMOVE":
            coat.operators.remove(self.index)
        else:
            target = self.index + (1 if self.action == "DOWN" else -1)
            if 0 <= target < len(coat.operators):
                coat.operators.move(self.index, target)
        context.object.update_tag()
        return {"FINISHED"}


class PELAGE_OT_value_set(_OnMesh, bpy.types.Operator):
    """Give this value, choose another word, or add and remove its map"""
    bl_idname = "object.pelage_value_set"
    bl_label = "Set Value"
    index: IntProperty()  # type: ignore[valid-type]
    key: StringProperty()  # type: ignore[valid-type]
    action: EnumProperty(items=(("GIVE", "Give", ""), ("UNSET", "Leave Out", ""), ("NEXT", "Next", ""),  # type: ignore
                                ("MAP", "Map", "")))

    def execute(self, context: bpy.types.Context) -> set[str]:
        coat = active_coat(context)
        operator = coat.operators[self.index] if coat is not None and 0 <= self.index < len(coat.operators) else None
        block = operator_schema(operator.kind) if operator is not None else None
        key = block.key(self.key) if block is not None else None
        if key is None:
            return {"CANCELLED"}
        if self.action == "GIVE":
            set_value(operator, key, key.default if key.default is not None else min(max(1.0, key.low), key.high))
        elif self.action == "UNSET" and key.name in operator:
            del operator[key.name]
        elif self.action == "NEXT" and key.choices:
            at = key.choices.index(operator[key.name]) if operator.get(key.name) in key.choices else -1
            operator[key.name] = key.choices[(at + 1) % len(key.choices)]
        elif self.action == "MAP":
            there = [i for i, m in enumerate(operator.maps) if m.key == key.name]
            if there:
                operator.maps.remove(there[0])
            else:
                operator.maps.add().key = key.name
        context.object.update_tag()
        return {"FINISHED"}


class PELAGE_OT_write_yaml(bpy.types.Operator):
    """Write the scene as YAML into a folder beside the .blend, for the program pelage: with the samples of final pictures, """ \
        """at this moment without motion blur, and with what the viewport shows of modifiers, hair and visibility"""
    bl_idname = "scene.pelage_write_yaml"
    bl_label = "Write YAML"

    def execute(self, context: bpy.types.Context) -> set[str]:
        from .engine import picture_size
        from .scene_writer import SceneWriter
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


CLASSES = (PELAGE_OT_fur_add, PELAGE_OT_fur_remove, PELAGE_OT_operator_add, PELAGE_OT_operator_edit, PELAGE_OT_value_set,
           PELAGE_OT_write_yaml)
