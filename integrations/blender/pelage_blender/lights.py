# SPDX-License-Identifier: Apache-2.0
"""Lights and the world of a Blender scene as the lights of a Pelage scene."""
from __future__ import annotations

import math
import pathlib
from typing import Any

import bpy
import mathutils
import numpy as np

from .axes import environment_rotation, numbers, place, spot_softness
from .images import image_file
from .nodes import constant, linked_node, surface_node
from .scene_folder import SceneFolder

Notes = set[str]
SMALLEST_RADIUS = 1e-3
WITHOUT_FILE = 100.0  # the value of Cycles' IES texture whose file cannot be read


def _axes(matrix: mathutils.Matrix) -> dict[str, list[float]]:
    """Lights shine along -z of their matrix."""
    forward = -matrix.col[2].xyz.normalized()
    return {"position": place(matrix.translation), "look_at": place(matrix.translation + forward),
            "up": place(matrix.col[1].xyz.normalized())}


def _emission(light: bpy.types.Light, notes: Notes) -> tuple[list[float], float, bpy.types.Node | None]:
    """Colour, factor on the power of the light, and IES Texture, of its Emission node if it has nodes."""
    color = list(light.color)
    node = surface_node(light, "ShaderNodeOutputLight") if light.use_nodes else None
    if node is None:
        return color, 1.0, None
    if node.type != "EMISSION":
        notes.add("nodes of lights other than Emission: left out")
        return color, 1.0, None
    tint, profile = constant(node.inputs["Color"], notes), linked_node(node.inputs["Strength"])
    if profile is not None and profile.type == "TEX_IES" and light.type in ("POINT", "SPOT"):
        if profile.inputs["Vector"].is_linked:
            notes.add("vectors of IES textures: profiles turn with their light")
        factor = constant(profile.inputs["Strength"], notes)
    else:
        profile, factor = None, constant(node.inputs["Strength"], notes)
    return [a * b for a, b in zip(color, tint)], float(factor), profile


def _profile(node: bpy.types.Node, notes: Notes) -> dict[str, str] | None:
    """The file of an IES Texture, or its text, which SceneWriter writes to a file; None if it has neither."""
    if node.mode == "INTERNAL":
        if node.ies is not None:
            return {"profile_text": node.ies.as_string()}
    elif node.filepath and (path := pathlib.Path(bpy.path.abspath(node.filepath)).absolute()).is_file():
        return {"profile": str(path)}
    notes.add("IES textures without a file: 100 times as bright, as in Cycles")
    return None


def light_block(ob: bpy.types.Object, matrix: mathutils.Matrix, notes: Notes) -> dict[str, Any] | None:
    """A lamp as a block of `lights`; None if it emits nothing."""
    light = ob.data
    color, factor, profile = _emission(light, notes)
    energy = light.energy * factor
    if energy <= 0 or max(color) <= 0:
        return None
    block: dict[str, Any]
    axes = _axes(matrix)
    if light.type == "AREA":
        # Cycles gives an area light of E watts and area A the radiance E / (4 A): it emits pi / 4 of its watts.
        block = _area(light, matrix, axes, notes) | {"power": energy * math.pi / 4}
    elif light.type == "SUN":
        direction = place(-matrix.col[2].xyz.normalized())
        block = {"type": "sun", "direction": direction, "irradiance": energy,
                 "angle": min(max(math.degrees(light.angle), 0.001), 180)}
    elif light.type == "SPOT":
        if light.spot_size > math.radians(170):
            notes.add("spots wider than 170 degrees: their cone has 170 degrees")
        block = {"type": "spot", **axes, "radius": max(light.shadow_soft_size, SMALLEST_RADIUS), "power": energy,
                 "cone": min(math.degrees(light.spot_size), 170),
                 "softness": spot_softness(light.spot_size, light.spot_blend)}
    else:
        block = {"type": "point", "position": axes["position"], "power": energy,
                 "radius": max(light.shadow_soft_size, SMALLEST_RADIUS)}
    if profile is not None:
        shape = _profile(profile, notes)
        if shape is None:
            block["power"] *= WITHOUT_FILE
        else:
            # Both take the brightness of the file for 1 W.
            del block["power"]
            block |= axes | shape | {"intensity": energy}
    block["radiance"] = numbers(np.maximum(color, 0))
    cycles = getattr(light, "cycles", None)
    if cycles is not None and not cycles.cast_shadow:
        block["shadows"] = False
    return block


def _area(light: bpy.types.Light, matrix: mathutils.Matrix, axes: dict[str, list[float]], notes: Notes) -> dict[str, Any]:
    scale = matrix.to_scale()
    width, height = abs(light.size * scale.x), abs(light.size * scale.y)
    if light.shape in ("RECTANGLE", "ELLIPSE"):
        height = abs(light.size_y * scale.y)
    spread = {"spread": max(math.degrees(light.spread), 1.0)} if light.spread < math.pi - 1e-3 else {}
    width, height = max(width, 1e-5), max(height, 1e-5)
    if light.shape in ("DISK", "ELLIPSE"):
        if abs(width - height) > 1e-4 * width:
            notes.add("elliptic area lights: discs of the same area")
        return {"type": "disk", **{k: axes[k] for k in ("position", "look_at")}, "radius": 0.5 * math.sqrt(width * height)} | spread
    return {"type": "rectangle", **axes, "size": numbers([width, height])} | spread


def world_block(world: bpy.types.World | None, folder: SceneFolder, notes: Notes, frame: int) -> dict[str, Any] | None:
    """The world as an environment; None if it is black."""
    if world is None:
        return None
    if not world.use_nodes:
        return _environment(list(world.color), 1.0)
    node = surface_node(world, "ShaderNodeOutputWorld")
    if node is None:
        return None
    if node.type != "BACKGROUND":
        notes.add("nodes of worlds other than Background: left out")
        return None
    strength = float(constant(node.inputs["Strength"], notes))
    source = linked_node(node.inputs["Color"])
    if source is not None and source.type == "TEX_ENVIRONMENT" and source.image is not None:
        if source.projection != "EQUIRECTANGULAR":
            notes.add("mirror balls as worlds: read as equirectangular images")
        block = _environment([1.0, 1.0, 1.0], strength)
        if block is None:
            return None
        path, _ = image_file(source.image, folder, source.image_user, frame)
        return block | {"file": str(path), "rotate": environment_rotation(_mapping_z(source, notes))}
    return _environment(list(constant(node.inputs["Color"], notes))[:3], strength)


def _environment(color: list[float], strength: float) -> dict[str, Any] | None:
    if strength <= 0 or max(color) <= 0:
        return None
    return {"type": "environment", "radiance": numbers(color), "intensity": strength}


def _mapping_z(source: bpy.types.Node, notes: Notes) -> float:
    mapping = linked_node(source.inputs["Vector"])
    if mapping is None or mapping.type != "MAPPING":
        return 0.0
    rotation = constant(mapping.inputs["Rotation"], notes)
    if abs(rotation[0]) > 1e-6 or abs(rotation[1]) > 1e-6 or mapping.vector_type not in ("POINT", "TEXTURE"):
        notes.add("rotation of the world about x and y: left out")
    return float(rotation[2]) if mapping.vector_type != "TEXTURE" else -float(rotation[2])
