# SPDX-License-Identifier: Apache-2.0
"""Materials of Blender as materials of Pelage: `lambert` and `glossy` for surfaces, `chiang` and others for strands."""
from __future__ import annotations

import math
from typing import Any

import bpy

from . import hair_color
from .axes import index_of_refraction, numbers
from .images import image_file
from .nodes import constant, linked_node, surface_node
from .scene_folder import SceneFolder

Notes = set[str]
Block = dict[str, Any]
DEFAULT_COLOR = [0.8, 0.8, 0.8]


class MaterialConverter:
    """Converts materials of Blender, and adds a note for each property that Pelage cannot render."""

    def __init__(self, folder: SceneFolder, notes: Notes, frame: int) -> None:
        self.folder, self.notes, self.frame = folder, notes, frame

    def surface(self, material: bpy.types.Material | None) -> Block:
        """Material of a skin."""
        node = self._node(material)
        if node is None:
            color = DEFAULT_COLOR if material is None or material.use_nodes else list(material.diffuse_color)[:3]
            return {"model": "lambert", "color": self._limited(color)}
        if node.type == "BSDF_PRINCIPLED":
            return self._principled(node)
        if node.type in ("BSDF_GLOSSY", "BSDF_ANISOTROPIC"):
            self.notes.add("shader Glossy BSDF: diffuse under a clear coat")
            return {"model": "glossy", "color": self.color(node.inputs["Color"]),
                    "roughness": self._number(node.inputs["Roughness"])}
        if "Color" not in node.inputs:
            self.notes.add(f"shader {node.bl_label}: grey and diffuse")
            return {"model": "lambert", "color": DEFAULT_COLOR}
        if node.type != "BSDF_DIFFUSE":
            self.notes.add(f"shader {node.bl_label}: diffuse")
        return {"model": "lambert", "color": self.color(node.inputs["Color"])}

    def hair(self, material: bpy.types.Material | None) -> Block:
        """Material of strands."""
        node = self._node(material)
        if node is None:
            return {"model": "chiang", "color": DEFAULT_COLOR}
        if node.type == "BSDF_HAIR_PRINCIPLED":
            return self._principled_hair(node)
        if node.type == "BSDF_DIFFUSE":
            color = self.color(node.inputs["Color"])
            if isinstance(color, list):
                return {"model": "lambert-cylinder", "albedo": color}
            return {"model": "lambert-cylinder", "color": color}
        name = "Base Color" if node.type == "BSDF_PRINCIPLED" else "Color"
        self.notes.add(f"shader {node.bl_label} on hair: the hair model of its colour")
        return {"model": "chiang", "color": self.color(node.inputs[name]) if name in node.inputs else DEFAULT_COLOR}

    def color(self, socket: bpy.types.NodeSocket) -> Any:
        """A colour, or a map of an image that feeds the socket."""
        node = linked_node(socket)
        if node is not None and node.type == "TEX_IMAGE" and node.image is not None:
            return self._map(node)
        return self._limited(constant(socket, self.notes))

    def _map(self, node: bpy.types.Node) -> Block:
        path, space = image_file(node.image, self.folder, node.image_user, self.frame)
        vector = linked_node(node.inputs["Vector"])
        if vector is not None and vector.type not in ("UVMAP", "TEX_COORD"):
            self.notes.add("mapping of image textures: images lie as the UV map says")
        if node.projection != "FLAT":
            self.notes.add("projections of image textures: images lie as the UV map says")
        wrap = {"REPEAT": "repeat", "EXTEND": "clamp", "CLIP": "black"}.get(node.extension, "repeat")
        return {"map": str(path), "space": space} | ({} if node.image.source == "TILED" else {"wrap": wrap})

    def _principled(self, node: bpy.types.Node) -> Block:
        inputs = node.inputs
        color, specular = self.color(inputs["Base Color"]), self._number(inputs["Specular"])
        for name, what in (("Metallic", "metal"), ("Transmission", "transmission"), ("Subsurface", "subsurface scattering"),
                           ("Clearcoat", "clear coat"), ("Sheen", "sheen")):
            if inputs[name].is_linked or inputs[name].default_value > 0:
                self.notes.add(f"{what} of the Principled BSDF: left out")
        if inputs["Alpha"].is_linked or inputs["Alpha"].default_value < 1:
            self.notes.add("transparency of surfaces: surfaces are opaque")
        if inputs["Normal"].is_linked:
            self.notes.add("normal and bump maps: left out")
        if inputs["Emission"].is_linked or max(list(inputs["Emission"].default_value)[:3]) > 0:
            self.notes.add("emission of surfaces: left out")
        if specular <= 0:
            return {"model": "lambert", "color": color}
        return {"model": "glossy", "color": color, "roughness": self._number(inputs["Roughness"]),
                "ior": numbers([index_of_refraction(specular)])[0]}

    def _principled_hair(self, node: bpy.types.Node) -> Block:
        inputs = node.inputs
        radial = min(max(self._number(inputs["Radial Roughness"]), 0.02), 1.0)
        block: Block = {"model": "chiang", "beta_m": min(max(self._number(inputs["Roughness"]), 0.02), 1.0), "beta_n": radial,
                        "eta": min(max(self._number(inputs["IOR"]), 1.05), 3.0),
                        "alpha": min(max(math.degrees(self._number(inputs["Offset"])), -10.0), 10.0)}
        for name in ("Coat", "Random Roughness", "Random Color"):
            used = node.parametrization == "MELANIN" or name != "Random Color"
            if used and (inputs[name].is_linked or inputs[name].default_value > 0):
                self.notes.add(f"{name} of the Principled Hair BSDF: left out")
        if node.parametrization == "ABSORPTION":
            block["absorption"] = numbers(self._constant_color(inputs["Absorption Coefficient"]))
        elif node.parametrization == "MELANIN":
            melanin, redness = self._number(inputs["Melanin"]), self._number(inputs["Melanin Redness"])
            tint = self._constant_color(inputs["Tint"])
            block["absorption"] = numbers(hair_color.from_melanin(melanin, redness, tint, radial))
        else:
            color = self.color(inputs["Color"])
            if isinstance(color, list):
                block["absorption"] = numbers(hair_color.from_color(color, radial))
            else:
                block["color"] = color
        return block

    def _constant_color(self, socket: bpy.types.NodeSocket) -> list[float]:
        return [max(float(v), 0.0) for v in constant(socket, self.notes)]

    def _number(self, socket: bpy.types.NodeSocket) -> float:
        node = linked_node(socket)
        if node is not None and node.type == "TEX_IMAGE":
            self.notes.add("image textures for numbers, such as roughness: left out")
            return float(socket.default_value)
        value = constant(socket, self.notes)
        return float(f"{(value if isinstance(value, float) else sum(value) / 3):.7g}")

    def _node(self, material: bpy.types.Material | None) -> bpy.types.Node | None:
        """The shader of a material; of mixed shaders the first."""
        if material is None or not material.use_nodes:
            return None
        node = surface_node(material, "ShaderNodeOutputMaterial")
        for _ in range(32):
            if node is None or node.type not in ("MIX_SHADER", "ADD_SHADER"):
                break
            self.notes.add("mixed shaders: only one of them")
            shaders = [linked_node(s) for s in node.inputs if s.type == "SHADER"]
            known = [n for n in shaders if n is not None]
            opaque = [n for n in known if n.type not in ("BSDF_TRANSPARENT", "EMISSION")]
            node = next(iter(opaque + known), None)
        return node

    @staticmethod
    def _limited(color: Any) -> list[float]:
        values = color if isinstance(color, (list, tuple)) else [color] * 3
        return numbers([min(max(float(v), 0.0), 1.0) for v in values[:3]])


def by_slot(blocks: list[Block], groups: list[str]) -> Block:
    """One material for a skin whose faces have several: the colour follows the groups of the mesh, the rest is the first's."""
    result = dict(blocks[0])
    color = blocks[0].get("color", DEFAULT_COLOR)
    for block, group in zip(blocks[1:], groups[1:]):
        color = {"mix": [color, block.get("color", DEFAULT_COLOR)], "by": {"group": group}}
    return result | {"color": color}
