# SPDX-License-Identifier: Apache-2.0
"""What a depsgraph shows at one time, and how it moves over the shutter."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import bpy
import mathutils
import numpy as np

from . import groom
from .axes import to_pelage, transformed
from .hair_curves import read_curves
from .hair_particles import HairStrands, hair_systems, read_hair
from .lights import light_block
from .meshes import Cage, cage_of, pose_of, turned_over

SOLID = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
Key = tuple[str, tuple[Any, ...]]
Notes = set[str]


@dataclass
class Hair:
    name: str
    strands: HairStrands
    material: bpy.types.Material | None


@dataclass(eq=False)
class Item:
    """A surface with its hair."""
    name: str
    original: bpy.types.Object
    cage: Cage
    matrix: mathutils.Matrix
    materials: list[bpy.types.Material | None]
    shown: bool
    poses: list[np.ndarray]  # per motion key: points (n, 3) in world space and with the axes of Pelage
    hair: list[Hair] = field(default_factory=list)
    guides: dict[str, HairStrands] = field(default_factory=dict)  # parents of particle hair that shapes coats, in world space

    @property
    def moves(self) -> bool:
        return any(not np.array_equal(self.poses[0], pose) for pose in self.poses[1:])


@dataclass
class Loose:
    """Hair Curves; `surface` is the key of the item that they grow on."""
    hair: Hair
    surface: Key | None


@dataclass
class Stage:
    """Everything that a scene file contains."""
    items: dict[Key, Item] = field(default_factory=dict)
    loose: list[Loose] = field(default_factory=list)
    lights: dict[Key, list[dict[str, Any]]] = field(default_factory=dict)  # per motion key
    names: dict[Key, str] = field(default_factory=dict)  # of lights


def _instances(depsgraph: bpy.types.Depsgraph) -> Iterator[tuple[Key, bpy.types.Object, Any]]:
    for instance in depsgraph.object_instances:
        ob = instance.object
        # The numbers are those of the instancer, so they are unique together with its name.
        persistent = (instance.parent.name_full, *instance.persistent_id) if instance.is_instance else ()
        yield (ob.name_full, persistent), ob, instance


def _material(ob: bpy.types.Object, slot: int) -> bpy.types.Material | None:
    slots = ob.material_slots
    return slots[min(max(slot, 0), len(slots) - 1)].material if len(slots) else None


def _add_item(stage: Stage, key: Key, ob: bpy.types.Object, instance: Any, render: bool) -> None:
    matrix = instance.matrix_world.copy()
    systems = hair_systems(ob, render) if instance.show_particles and ob.type == "MESH" else []
    mesh = ob.to_mesh()
    try:
        fur = ob.original if len(ob.original.pelage.coats) else None
        groups = groom.groups_of(fur) if fur is not None else []
        cage = cage_of(ob, mesh, render, fur is not None, groups) if mesh is not None else None
    finally:
        ob.to_mesh_clear()
    if cage is None:
        return
    if matrix.determinant() < 0:
        turned_over(cage)
    materials = [_material(ob, int(slot)) for slot in range(max(1, len(ob.material_slots)))]
    item = Item(ob.name, ob.original, cage, matrix, materials, bool(instance.show_self),
                [to_pelage(transformed(cage.points, matrix))])
    guides = {coat.guide_hair for coat in ob.original.pelage.coats if coat.enabled}
    for _, system in systems:
        if system.name in guides:
            parents = read_hair(ob, system, render, parents=True)
            if parents is not None:
                item.guides[system.name] = parents
            continue
        strands = read_hair(ob, system, render)
        if strands is not None:
            if instance.is_instance:
                local = transformed(strands.points, ob.matrix_world.inverted_safe())
                strands.points = transformed(local, matrix)
            item.hair.append(Hair(system.name, strands, _material(ob, system.settings.material - 1)))
    stage.items[key] = item


def collect(depsgraph: bpy.types.Depsgraph, notes: Notes, check: Callable[[], None] = lambda: None) -> Stage:
    """The scene at the present time of the depsgraph; `check` is called before each object, and what it raises ends this."""
    stage, render = Stage(), depsgraph.mode == "RENDER"
    for key, ob, instance in _instances(depsgraph):
        check()
        if ob.type in SOLID and (instance.show_self or instance.show_particles):
            _add_item(stage, key, ob, instance, render)
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
    """Adds the present time of the depsgraph as one more motion key. What is gone or has changed its topology stays."""
    seen: set[Key] = set()
    for key, ob, instance in _instances(depsgraph):
        if key in stage.items:
            item, mesh = stage.items[key], ob.to_mesh()
            points = pose_of(ob, mesh, item.cage) if mesh is not None else None
            ob.to_mesh_clear()
            if points is not None:
                item.poses.append(to_pelage(transformed(points, instance.matrix_world)))
                seen.add(key)
        elif key in stage.lights:
            block = light_block(ob, instance.matrix_world, notes)
            if block is not None:
                stage.lights[key].append(block)
                seen.add(key)
    for key in stage.items.keys() - seen:
        stage.items[key].poses.append(stage.items[key].poses[-1])
    for key in stage.lights.keys() - seen:
        stage.lights[key].append(stage.lights[key][-1])


def shutter_times(scene: bpy.types.Scene, keys: int) -> list[float]:
    """Times of the motion keys in frames, relative to the frame; one time without motion blur."""
    if not scene.render.use_motion_blur or scene.render.motion_blur_shutter <= 0:
        return [0.0]
    width = scene.render.motion_blur_shutter
    position = getattr(getattr(scene, "cycles", None), "motion_blur_position", "CENTER")
    start = {"START": 0.0, "CENTER": -0.5 * width, "END": -width}[position]
    return [start + width * i / (keys - 1) for i in range(keys)]


def visit(times: list[float], frame: float, frame_set: Callable[[int, float], None]) -> Iterator[float]:
    """Sets the scene to each of the times, and back to the frame at the end."""
    try:
        for time in times:
            whole = int(np.floor(frame + time))
            frame_set(whole, frame + time - whole)
            yield time
    finally:
        frame_set(int(np.floor(frame)), frame - np.floor(frame))
