# SPDX-License-Identifier: Apache-2.0
"""Coats of Pelage as grooms of a scene file."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from . import coat_values
from .axes import to_pelage
from .coat_properties import PelageCoat, PelageMap, PelageOperator
from .geometry_files import hair_bytes
from .hair_curves import read_curves
from .images import image_file
from .placement import mirror, signed_scale

if TYPE_CHECKING:
    from .stage import Item
    from .scene_document import SceneDocument

CHANNELS = "rgb"


def _maps(coat: PelageCoat) -> list[PelageMap]:
    density = [coat.density] if coat.use_density else []
    return density + [m for operator in coat.operators if operator.enabled for m in operator.maps]


def groups_of(ob: bpy.types.Object) -> list[str]:
    """Names of the vertex groups that the coats of an object read. Raises ValueError if there are more than three."""
    names: list[str] = []
    for coat in ob.pelage.coats:
        for map_ in _maps(coat) if coat.enabled else []:
            if map_.source == "GROUP" and map_.group and map_.group not in names:
                names.append(map_.group)
    if len(names) > len(CHANNELS):
        raise ValueError(f"the fur of '{ob.name}' reads {len(names)} vertex groups; it can read three, and images for the others")
    return names


def rest_points(item: Item) -> np.ndarray:
    """The skin before modifiers, at the origin and with the axes of Pelage. At rest, a coat is as large as in the world."""
    cage = item.asset.cage
    points = cage.points if cage.rest is None else cage.rest
    return to_pelage(points * signed_scale(item.matrices[0]))


def _field(document: SceneDocument, ob: bpy.types.Object, map_: PelageMap) -> dict[str, Any] | None:
    """A map as a field; None if no vertex group is chosen. Raises ValueError if the group or image does not exist."""
    what = f"the map of '{map_.key or 'density'}' on '{ob.name}'"
    if map_.source == "GROUP":
        if not map_.group:
            document.notes.add(f"{what}: no vertex group is chosen")
            return None
        if map_.group not in ob.vertex_groups:
            raise ValueError(f"{what} is the vertex group '{map_.group}', which does not exist")
        channel = CHANNELS[groups_of(ob).index(map_.group)]
        return coat_values.scaled_map({"vertex_color": channel}, map_.low, map_.high)
    if map_.image is None:
        raise ValueError(f"{what} has no image")
    path, _ = image_file(map_.image, document.folder)
    wrap = {} if map_.image.source == "TILED" else {"wrap": "repeat"}
    return coat_values.scaled_map({"map": str(path), "channel": "r"} | wrap, map_.low, map_.high)


def _operator(document: SceneDocument, item: Item, operator: PelageOperator) -> dict[str, Any]:
    values = {key: coat_values.scene_value(key, value.to_list() if hasattr(value, "to_list") else value, mirror(item.matrices[0]))
              for key, value in operator.items() if key not in PelageOperator.bl_rna.properties}
    for map_ in operator.maps:
        factor = _field(document, item.asset.original, map_)
        if factor is not None:
            values[map_.key] = coat_values.times(values.get(map_.key, 1), factor)
    if values.get("mask") == 1:
        del values["mask"]
    return {operator.kind: values}


def _guides(document: SceneDocument, item: Item, coat: PelageCoat) -> list[dict[str, Any]]:
    """The operator `guides` of hair Curves and of particle hair."""
    asset, found = item.asset, []
    if coat.guides is not None:
        curves = read_curves(coat.guides.data, coat.guides.matrix_world)
        if curves is None:
            raise ValueError(f"the guides '{coat.guides.name}' have no curves")
        found.append(curves.transformed(asset.original.matrix_world.inverted_safe()))
    if coat.guide_hair:
        if coat.guide_hair not in asset.guides:
            raise ValueError(f"'{asset.name}' has no particle hair '{coat.guide_hair}' for guides")
        found.append(asset.guides[coat.guide_hair])
        if asset.cage.rest is not None and not np.array_equal(asset.cage.rest, asset.cage.points):
            document.notes.add("guide hair on a deformed mesh: it shapes the coat as it is in the pose of the frame")
    result = []
    for number, strands in enumerate(found):
        points = to_pelage(strands.points * signed_scale(item.matrices[0]))
        file = document.file(f"{asset.name} guides {number}.hair", hair_bytes(points, strands.widths, strands.counts))
        result.append({"guides": {"file": file, "basis": "catmull-rom"}})
    return result


def write_coat(document: SceneDocument, item: Item, skin: str, coat: PelageCoat) -> dict[str, str]:
    """Adds a coat to the document; returns {name of its groom: name of its material}."""
    ob, name = item.asset.original, document.name("grooms", f"{item.asset.name} {coat.name}")
    operators = _guides(document, item, coat)
    operators += [_operator(document, item, operator) for operator in coat.operators if operator.enabled]
    block: dict[str, Any] = {"skin": skin, "strands": coat.strands, "points": coat.points, "seed": coat.seed, "role": coat.role}
    if coat.use_density:
        density = _field(document, ob, coat.density)
        if density is not None:
            block["density"] = density
    if coat.material is None:
        operators.append(coat_values.color_operator(coat.root_color, coat.tip_color, coat.color_variation))
        material = document.name("materials", f"{name} fur")
        document.blocks["materials"][material] = coat_values.fur_material(coat.roughness)
    else:
        material = document.material("hair", coat.material)
    document.blocks["grooms"][name] = block | {"operators": operators}
    return {name: material}
