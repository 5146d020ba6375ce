# SPDX-License-Identifier: Apache-2.0
"""The panel of coats in the properties of an object, built from the keys that the program states."""
from __future__ import annotations

from typing import Any

import bpy

from . import coat_steps, fur_operators, preferences, process, schema


class PELAGE_UL_coats(bpy.types.UIList):
    def draw_item(self, context: Any, layout: Any, data: Any, item: Any, icon: Any, active: Any, name: Any, index: Any = 0,
                  flags: Any = 0) -> None:
        row = layout.row(align=True)
        row.prop(item, "name", text="", emboss=False, icon="STRANDS")
        row.prop(item, "enabled", text="", icon="HIDE_OFF" if item.enabled else "HIDE_ON", emboss=False)


class PELAGE_MT_fur(bpy.types.Menu):
    bl_label = "Pelage Fur"

    def draw(self, context: bpy.types.Context) -> None:
        for name, label, _ in fur_operators.PRESETS:
            self.layout.operator("object.pelage_fur_add", text=label, icon="STRANDS").preset = name


class _FurPanel:
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "object"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.object is not None and context.object.type == "MESH"


class PELAGE_PT_fur(_FurPanel, bpy.types.Panel):
    bl_label = "Pelage Fur"

    def draw(self, context: bpy.types.Context) -> None:
        layout, fur = self.layout, context.object.pelage
        try:
            schema.load(preferences.program())
        except process.PelageFailed as error:
            layout.label(text=str(error), icon="ERROR")
            return
        row = layout.row()
        row.template_list("PELAGE_UL_coats", "", fur, "coats", fur, "active", rows=2)
        side = row.column(align=True)
        side.menu("PELAGE_MT_fur", text="", icon="ADD")
        side.operator("object.pelage_fur_remove", text="", icon="REMOVE")
        coat = fur_operators.active_coat(context)
        if coat is None:
            layout.menu("PELAGE_MT_fur", text="Add Pelage Fur", icon="STRANDS")
            return
        column = layout.column()
        column.use_property_split, column.use_property_decorate = True, False
        for name in ("strands", "points", "seed", "role", "guides"):
            column.prop(coat, name)
        column.prop_search(coat, "guide_hair", context.object, "particle_systems")
        column.prop(coat, "use_density")
        if coat.use_density:
            draw_map(column, context.object, coat.density)
        layout.operator("scene.pelage_write_yaml", icon="FILE_TEXT")


class _CoatPanel(_FurPanel):
    """A part of the panel that is there while a coat is chosen."""
    bl_parent_id = "PELAGE_PT_fur"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return fur_operators.active_coat(context) is not None


class PELAGE_PT_fur_look(_CoatPanel, bpy.types.Panel):
    bl_label = "Look"

    def draw(self, context: bpy.types.Context) -> None:
        layout, coat = self.layout, fur_operators.active_coat(context)
        layout.use_property_split, layout.use_property_decorate = True, False
        layout.prop(coat, "material")
        if coat.material is None:
            for name in ("root_color", "tip_color", "color_variation", "roughness"):
                layout.prop(coat, name)


class PELAGE_PT_fur_operators(_CoatPanel, bpy.types.Panel):
    bl_label = "Operators"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        for index, operator in enumerate(fur_operators.active_coat(context).operators):
            draw_operator(layout.box(), context.object, operator, index)
        layout.operator_menu_enum("object.pelage_operator_add", "kind", icon="ADD")


def draw_operator(box: Any, ob: bpy.types.Object, operator: Any, index: int) -> None:
    row = box.row(align=True)
    row.prop(operator, "expanded", text="", emboss=False, icon="TRIA_DOWN" if operator.expanded else "TRIA_RIGHT")
    row.prop(operator, "enabled", text="")
    row.label(text=operator.kind.replace("_", " ").title())
    for action, icon in (("UP", "TRIA_UP"), ("DOWN", "TRIA_DOWN"), ("REMOVE", "X")):
        button = row.operator("object.pelage_operator_edit", text="", icon=icon, emboss=False)
        button.index, button.action = index, action
    block = coat_steps.step_schema(operator.kind)
    if not operator.expanded or block is None:
        return
    for key in block.keys:
        if key.kind != "other":
            draw_value(box, ob, operator, index, key)


def _button(row: Any, index: int, key: str, action: str, **look: Any) -> None:
    button = row.operator("object.pelage_value_set", **look)
    button.index, button.key, button.action = index, key, action


def draw_value(box: Any, ob: bpy.types.Object, operator: Any, index: int, key: schema.SchemaKey) -> None:
    label = key.name.replace("_", " ").capitalize()
    row = box.row(align=True)
    if key.name not in operator:
        row.label(text=label)
        _button(row, index, key.name, "GIVE", text="", icon="ADD", emboss=False)
    elif key.kind == "choice":
        row.label(text=label)
        _button(row, index, key.name, "NEXT", text=str(operator[key.name]))
    else:
        (row.column() if key.kind == "vector" else row).prop(operator, f'["{key.name}"]', text=label)
        if key.default is None:
            _button(row, index, key.name, "UNSET", text="", icon="X", emboss=False)
    if key.takes_maps:
        map_ = next((m for m in operator.maps if m.key == key.name), None)
        _button(row, index, key.name, "MAP", text="", icon="TEXTURE", depress=map_ is not None)
        if map_ is not None:
            draw_map(box, ob, map_)


def draw_map(layout: Any, ob: bpy.types.Object, map_: Any) -> None:
    row = layout.row(align=True)
    row.use_property_split = False
    row.prop(map_, "source", text="")
    if map_.source == "GROUP":
        row.prop_search(map_, "group", ob, "vertex_groups", text="")
    else:
        row.template_ID(map_, "image", open="image.open")
    row = layout.row(align=True)
    row.use_property_split = False
    row.prop(map_, "low")
    row.prop(map_, "high")


def _in_add_menu(self: Any, context: bpy.types.Context) -> None:
    self.layout.menu("PELAGE_MT_fur", icon="STRANDS")


CLASSES = (PELAGE_UL_coats, PELAGE_MT_fur, PELAGE_PT_fur, PELAGE_PT_fur_look, PELAGE_PT_fur_operators)


def register() -> None:
    bpy.types.VIEW3D_MT_object.append(_in_add_menu)


def unregister() -> None:
    bpy.types.VIEW3D_MT_object.remove(_in_add_menu)
