# SPDX-License-Identifier: Apache-2.0
"""Coats of Pelage on the objects of a .blend: what Blender saves, copies and undoes."""
from __future__ import annotations

import bpy
from bpy.props import (BoolProperty, CollectionProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty,
                       PointerProperty, StringProperty)


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
