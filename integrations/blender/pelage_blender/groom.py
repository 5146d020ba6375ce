# SPDX-License-Identifier: Apache-2.0
"""Coats of Pelage on the objects of a scene: what is stored in the .blend, and what a scene file gets of it."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from bpy.props import (BoolProperty, CollectionProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty,
                       PointerProperty, StringProperty)

from . import coat_values
from .axes import to_pelage, transformed
from .files import hair_bytes
from .hair_curves import read_curves
from .images import image_file

if TYPE_CHECKING:
    from .collect import Item
    from .scene_writer import SceneWriter

CHANNELS = "rgb"


class PelageMap(bpy.types.PropertyGroup):
    """A factor on a value that varies over the skin."""
    key: StringProperty()  # type: ignore[valid-type]
    source: EnumProperty(name="Map", default="GROUP", items=(  # type: ignore[valid-type]
        ("GROUP", "Vertex Group", "Weights of a vertex group"), ("IMAGE", "Image", "The red channel of an image")))
    group: StringProperty(name="Vertex Group")  # type: ignore[valid-type]
    image: PointerProperty(type=bpy.types.Image)  # type: ignore[valid-type]
    low: FloatProperty(name="At 0", default=0, description="Factor where the map is 0")  # type: ignore[valid-type]
    high: FloatProperty(name="At 1", default=1, description="Factor where the map is 1")  # type: ignore[valid-type]


class PelageOperator(bpy.types.PropertyGroup):
    """An operator of a coat; its values are custom properties with the names of the keys."""
    kind: StringProperty()  # type: ignore[valid-type]
    enabled: BoolProperty(name="Enabled", default=True, description="Run this operator")  # type: ignore[valid-type]
    expanded: BoolProperty(name="Values", default=False)  # type: ignore[valid-type]
    maps: CollectionProperty(type=PelageMap)  # type: ignore[valid-type]


class PelageCoat(bpy.types.PropertyGroup):
    enabled: BoolProperty(name="Show", default=True, description="Grow this coat")  # type: ignore[valid-type]
    strands: IntProperty(name="Strands", default=100000, min=1, max=500000000, soft_max=2000000)  # type: ignore[valid-type]
    points: IntProperty(name="Points", default=8, min=2, max=1024, soft_max=32,  # type: ignore[valid-type]
                        description="Control points per strand")
    seed: IntProperty(name="Seed", default=0, min=0)  # type: ignore[valid-type]
    role: EnumProperty(name="Role", default="under", items=(  # type: ignore[valid-type]
        ("guard", "Guard Hair", ""), ("under", "Under Fur", ""), ("whisker", "Whiskers", "")))
    density: PointerProperty(type=PelageMap)  # type: ignore[valid-type]
    use_density: BoolProperty(name="Density Map", description="Distribute the strands by a map")  # type: ignore[valid-type]
    guides: PointerProperty(name="Guides", type=bpy.types.Object,  # type: ignore[valid-type]
                            poll=lambda self, ob: ob.type == "CURVES",
                            description="Hair Curves whose shape the strands take")
    guide_hair: StringProperty(name="Guide Hair",  # type: ignore[valid-type]
                               description="Particle hair of this mesh whose shape the strands take, in place of being rendered")
    material: PointerProperty(name="Material", type=bpy.types.Material,  # type: ignore[valid-type]
                              description="Material with a Principled Hair BSDF. Empty: the colours below")
    root_color: FloatVectorProperty(name="Root", subtype="COLOR", min=0, max=1, default=(0.1, 0.06, 0.04))  # type: ignore
    tip_color: FloatVectorProperty(name="Tip", subtype="COLOR", min=0, max=1, default=(0.5, 0.3, 0.15))  # type: ignore
    color_variation: FloatProperty(name="Variation", default=0.25, min=0, max=1,  # type: ignore[valid-type]
                                   description="Random darkening")
    roughness: FloatProperty(name="Roughness", default=0.3, min=0.02, max=1)  # type: ignore[valid-type]
    operators: CollectionProperty(type=PelageOperator)  # type: ignore[valid-type]


class PelageFur(bpy.types.PropertyGroup):
    coats: CollectionProperty(type=PelageCoat)  # type: ignore[valid-type]
    active: IntProperty(default=0, min=0)  # type: ignore[valid-type]


CLASSES = (PelageMap, PelageOperator, PelageCoat, PelageFur)


def register() -> None:
    bpy.types.Object.pelage = PointerProperty(type=PelageFur)


def unregister() -> None:
    del bpy.types.Object.pelage


def _maps(coat: PelageCoat) -> list[PelageMap]:
    density = [coat.density] if coat.use_density else []
    return density + [m for operator in coat.operators if operator.enabled for m in operator.maps]


def groups_of(ob: bpy.types.Object) -> list[str]:
    """Vertex groups that the coats of an object read, at most three. Raises ValueError if there are more."""
    names: list[str] = []
    for coat in ob.pelage.coats:
        for map_ in _maps(coat) if coat.enabled else []:
            if map_.source == "GROUP" and map_.group and map_.group not in names:
                names.append(map_.group)
    if len(names) > len(CHANNELS):
        raise ValueError(f"the fur of '{ob.name}' reads {len(names)} vertex groups; it can read three, and images for the others")
    return names


def rest_scale(item: Item) -> np.ndarray:
    """Scale of an object (3,): at rest, a coat is as large as in the world; negative x: the object is mirrored.

    Which axis is mirrored makes no difference, because the directions of operators are mirrored too.
    """
    scale = np.abs(np.array(item.matrix.to_scale(), np.float64))  # of a mirrored matrix, Blender's are all negative
    return scale * mirror(item)


def mirror(item: Item) -> np.ndarray:
    """Signs (3,) that turn a direction of the object into one of its rest pose."""
    return np.array([-1.0 if item.matrix.determinant() < 0 else 1.0, 1.0, 1.0])


def rest_points(item: Item) -> np.ndarray:
    """The skin before modifiers, at the origin and with the axes of Pelage."""
    points = item.cage.points if item.cage.rest is None else item.cage.rest
    return to_pelage(points * rest_scale(item))


def _field(writer: SceneWriter, ob: bpy.types.Object, map_: PelageMap) -> dict[str, Any] | None:
    """A map as a field; None while nothing is chosen. Raises ValueError if what was chosen is gone."""
    what = f"the map of '{map_.key or 'density'}' on '{ob.name}'"
    if map_.source == "GROUP":
        if not map_.group:
            writer.notes.add(f"{what}: no vertex group is chosen")
            return None
        if map_.group not in ob.vertex_groups:
            raise ValueError(f"{what} is the vertex group '{map_.group}', which does not exist")
        channel = CHANNELS[groups_of(ob).index(map_.group)]
        return coat_values.scaled_map({"vertex_color": channel}, map_.low, map_.high)
    if map_.image is None:
        raise ValueError(f"{what} has no image")
    path, _ = image_file(map_.image, writer.folder)
    wrap = {} if map_.image.source == "TILED" else {"wrap": "repeat"}
    return coat_values.scaled_map({"map": str(path), "channel": "r"} | wrap, map_.low, map_.high)


def _operator(writer: SceneWriter, item: Item, operator: PelageOperator) -> dict[str, Any]:
    values = {key: coat_values.scene_value(key, value.to_list() if hasattr(value, "to_list") else value, mirror(item))
              for key, value in operator.items() if key not in PelageOperator.bl_rna.properties}
    for map_ in operator.maps:
        factor = _field(writer, item.original, map_)
        if factor is not None:
            values[map_.key] = coat_values.times(values.get(map_.key, 1), factor)
    if values.get("mask") == 1:
        del values["mask"]
    return {operator.kind: values}


def _guides(writer: SceneWriter, item: Item, coat: PelageCoat) -> list[dict[str, Any]]:
    """The operator `guides` of hair Curves and of particle hair."""
    strands, matrix = [], item.original.matrix_world
    if coat.guides is not None:
        curves = read_curves(coat.guides.data, coat.guides.matrix_world)
        if curves is None:
            raise ValueError(f"the guides '{coat.guides.name}' have no curves")
        strands.append((curves, matrix))
    if coat.guide_hair:
        if coat.guide_hair not in item.guides:
            raise ValueError(f"'{item.name}' has no particle hair '{coat.guide_hair}' for guides")
        strands.append((item.guides[coat.guide_hair], item.matrix))
        if item.cage.rest is not None and not np.array_equal(item.cage.rest, item.cage.points):
            writer.notes.add("guide hair on a deformed mesh: it shapes the coat as it is in the pose of the frame")
    result = []
    for number, (hair, world) in enumerate(strands):
        points = to_pelage(transformed(hair.points, world.inverted_safe()) * rest_scale(item))
        file = writer.file(f"{item.name} guides {number}.hair", hair_bytes(points, hair.widths, hair.counts))
        result.append({"guides": {"file": file, "basis": "catmull-rom"}})
    return result


def write_coat(writer: SceneWriter, item: Item, skin: str, coat: PelageCoat) -> dict[str, str]:
    """Adds a coat to the document; its name with that of its material."""
    ob, name = item.original, writer.name("grooms", f"{item.name} {coat.name}")
    operators = _guides(writer, item, coat)
    operators += [_operator(writer, item, operator) for operator in coat.operators if operator.enabled]
    block: dict[str, Any] = {"skin": skin, "strands": coat.strands, "points": coat.points, "seed": coat.seed, "role": coat.role}
    if coat.use_density:
        density = _field(writer, ob, coat.density)
        if density is not None:
            block["density"] = density
    if coat.material is None:
        operators.append(coat_values.color_operator(coat.root_color, coat.tip_color, coat.color_variation))
        material = writer.name("materials", f"{name} fur")
        writer.document["materials"][material] = coat_values.fur_material(coat.roughness)
    else:
        material = writer.material("hair", coat.material)
    writer.document["grooms"][name] = block | {"operators": operators}
    return {name: material}
