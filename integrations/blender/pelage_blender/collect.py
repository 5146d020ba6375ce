# SPDX-License-Identifier: Apache-2.0
"""Reads the visible surfaces, hair and lights of a depsgraph, at one time or at several times of the shutter."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import bpy

from . import groom
from .cage import turned_over
from .hair_curves import read_curves
from .hair_particles import hair_systems, read_hair
from .lights import light_block
from .meshes import cage_of, pose_of
from .stage import Asset, Hair, Item, Key, Loose, Notes, Stage

SOLID = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


def _instances(depsgraph: bpy.types.Depsgraph) -> Iterator[tuple[Key, bpy.types.Object, Any]]:
    for instance in depsgraph.object_instances:
        ob = instance.object
        # The numbers are those of the instancer, so they are unique together with its name.
        persistent = (instance.parent.name_full, *instance.persistent_id) if instance.is_instance else ()
        yield (ob.name_full, persistent), ob, instance


def _material(ob: bpy.types.Object, slot: int) -> bpy.types.Material | None:
    slots = ob.material_slots
    return slots[min(max(slot, 0), len(slots) - 1)].material if len(slots) else None


def _asset_key(ob: bpy.types.Object, instance: Any) -> Key:
    """Instances with the same key share an asset. Nodes may instance several meshes under the name of one object."""
    data = ob.data.as_pointer() if ob.data is not None else 0
    return ob.name_full, (data, instance.matrix_world.determinant() < 0, instance.show_self, instance.show_particles)


def _read_asset(ob: bpy.types.Object, instance: Any, render: bool) -> Asset | None:
    """The surface of an object, or None if it has none. Faces are turned over if the instance is mirrored."""
    systems = hair_systems(ob, render) if instance.show_particles and ob.type == "MESH" else []
    mesh = ob.to_mesh()
    try:
        fur = ob.original if len(ob.original.pelage.coats) else None
        groups = groom.groups_of(fur) if fur is not None else []
        cage = cage_of(ob, mesh, render, fur is not None, groups) if mesh is not None else None
    finally:
        ob.to_mesh_clear()
    if cage is None:
        return None
    if instance.matrix_world.determinant() < 0:
        turned_over(cage)
    materials = [_material(ob, int(slot)) for slot in range(max(1, len(ob.material_slots)))]
    asset = Asset(ob.name, ob.original, cage, materials, bool(instance.show_self), [cage.points])
    guides = {coat.guide_hair for coat in ob.original.pelage.coats if coat.enabled}
    for _, system in systems:
        shapes = system.name in guides
        strands = read_hair(ob, system, render, parents=shapes)
        if strands is None:
            continue
        strands = strands.transformed(ob.matrix_world.inverted_safe())
        if shapes:
            asset.guides[system.name] = strands
        else:
            asset.hair.append(Hair(system.name, strands, _material(ob, system.settings.material - 1)))
    return asset


def collect(depsgraph: bpy.types.Depsgraph, notes: Notes, check: Callable[[], None] = lambda: None) -> Stage:
    """Reads the scene at the current time of the depsgraph. `check` is called before each object; it may raise to stop."""
    stage, render = Stage(), depsgraph.mode == "RENDER"
    assets: dict[Key, Asset | None] = {}
    for key, ob, instance in _instances(depsgraph):
        check()
        if ob.type in SOLID and (instance.show_self or instance.show_particles):
            shared = _asset_key(ob, instance)
            if shared not in assets:
                assets[shared] = _read_asset(ob, instance, render)
            asset = assets[shared]
            if asset is not None:
                stage.items[key] = Item(asset, [instance.matrix_world.copy()])
        elif ob.type == "CURVES" and instance.show_self:
            strands = read_curves(ob.data, instance.matrix_world)
            if strands is not None:
                surface = ob.original.data.surface
                stage.loose.append(Loose(Hair(ob.name, strands, _material(ob, 0)),
                                         (surface.name_full, ()) if surface is not None else None))
        elif ob.type == "LIGHT" and instance.show_self:
            block = light_block(ob, instance.matrix_world, notes)
            if block is not None:
                stage.lights[key], stage.names[key] = [block], ob.name
        elif ob.type == "VOLUME":
            notes.add("volumes: left out")
    return stage


def add_pose(stage: Stage, depsgraph: bpy.types.Depsgraph, notes: Notes) -> None:
    """Adds a motion key at the current time of the depsgraph. Objects that are gone or have another topology stay."""
    seen: set[Key] = set()
    read: dict[Asset, bool] = {}  # whether the topology is the same
    for key, ob, instance in _instances(depsgraph):
        if key in stage.items:
            item = stage.items[key]
            if item.asset not in read:
                read[item.asset] = _add_shape(item.asset, ob)
            if read[item.asset]:
                item.matrices.append(instance.matrix_world.copy())
                seen.add(key)
        elif key in stage.lights:
            block = light_block(ob, instance.matrix_world, notes)
            if block is not None:
                stage.lights[key].append(block)
                seen.add(key)
    for asset in {item.asset for item in stage.items.values()} - read.keys():
        asset.poses.append(asset.poses[-1])
    for key in stage.items.keys() - seen:
        stage.items[key].matrices.append(stage.items[key].matrices[-1])
    for key in stage.lights.keys() - seen:
        stage.lights[key].append(stage.lights[key][-1])


def _add_shape(asset: Asset, ob: bpy.types.Object) -> bool:
    """Adds the current shape of an object to the poses of its asset; returns whether the topology is still the same."""
    mesh = ob.to_mesh()
    points = pose_of(ob, mesh, asset.cage) if mesh is not None else None
    ob.to_mesh_clear()
    asset.poses.append(asset.poses[-1] if points is None else points)
    return points is not None
