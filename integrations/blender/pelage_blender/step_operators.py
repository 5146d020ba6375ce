# SPDX-License-Identifier: Apache-2.0
"""Operators that edit the steps of the active coat; all can be undone."""
from __future__ import annotations

from typing import Any

import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty

from . import preferences, process, schema
from .coat_steps import add_step, set_value, step_schema
from .fur_operators import OnMesh, active_coat


def _step_kinds(self: Any, context: bpy.types.Context) -> list[tuple[str, str, str]]:
    try:
        blocks = schema.load(preferences.program())
    except process.PelageFailed:
        return []
    # Blender does not copy the texts, so somebody has to keep them.
    _step_kinds.kept = [(n, n.replace("_", " ").title(), b.help[:250]) for n, b in blocks.items()]  # type: ignore
    return _step_kinds.kept  # type: ignore[attr-defined,no-any-return]


class PELAGE_OT_operator_add(OnMesh, bpy.types.Operator):
    """Add a step that shapes the strands"""
    bl_idname = "object.pelage_operator_add"
    bl_label = "Add Operator"
    kind: EnumProperty(name="Operator", items=_step_kinds)  # type: ignore[valid-type]

    def edit(self, context: bpy.types.Context) -> bool:
        coat, block = active_coat(context), step_schema(self.kind)
        if coat is None or block is None:
            return False
        add_step(coat, block, {}).expanded = True
        width = next((i for i, step in enumerate(coat.operators) if step.kind == "width"), len(coat.operators) - 1)
        if self.kind != "width":
            coat.operators.move(len(coat.operators) - 1, width)
        return True


class _OnStep(OnMesh):
    """Edits the step at `index`."""

    def edit(self, context: bpy.types.Context) -> bool:
        coat = active_coat(context)
        if coat is None or not 0 <= self.index < len(coat.operators):  # type: ignore[attr-defined]
            return False
        return self.edit_step(coat.operators, coat.operators[self.index])  # type: ignore[attr-defined]

    def edit_step(self, steps: Any, step: Any) -> bool:
        raise NotImplementedError


class PELAGE_OT_operator_edit(_OnStep, bpy.types.Operator):
    """Move or remove an operator"""
    bl_idname = "object.pelage_operator_edit"
    bl_label = "Edit Operator"
    index: IntProperty()  # type: ignore[valid-type]
    action: EnumProperty(items=(("UP", "Up", ""), ("DOWN", "Down", ""), ("REMOVE", "Remove", "")))  # type: ignore[valid-type]

    def edit_step(self, steps: Any, step: Any) -> bool:
        if self.action == "REMOVE":
            steps.remove(self.index)
        else:
            target = self.index + (1 if self.action == "DOWN" else -1)
            if 0 <= target < len(steps):
                steps.move(self.index, target)
        return True


class PELAGE_OT_value_set(_OnStep, bpy.types.Operator):
    """Give this value, choose another word, or add and remove its map"""
    bl_idname = "object.pelage_value_set"
    bl_label = "Set Value"
    index: IntProperty()  # type: ignore[valid-type]
    key: StringProperty()  # type: ignore[valid-type]
    action: EnumProperty(items=(("GIVE", "Give", ""), ("UNSET", "Leave Out", ""), ("NEXT", "Next", ""),  # type: ignore
                                ("MAP", "Map", "")))

    def edit_step(self, steps: Any, step: Any) -> bool:
        block = step_schema(step.kind)
        key = block.key(self.key) if block is not None else None
        if key is None:
            return False
        if self.action == "GIVE":
            set_value(step, key, key.default if key.default is not None else min(max(1.0, key.low), key.high))
        elif self.action == "UNSET" and key.name in step:
            del step[key.name]
        elif self.action == "NEXT" and key.choices:
            at = key.choices.index(step[key.name]) if step.get(key.name) in key.choices else -1
            step[key.name] = key.choices[(at + 1) % len(key.choices)]
        elif self.action == "MAP":
            there = [i for i, map_ in enumerate(step.maps) if map_.key == key.name]
            if there:
                step.maps.remove(there[0])
            else:
                step.maps.add().key = key.name
        return True


CLASSES = (PELAGE_OT_operator_add, PELAGE_OT_operator_edit, PELAGE_OT_value_set)
