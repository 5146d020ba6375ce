# SPDX-License-Identifier: Apache-2.0
"""Reads shader nodes: what is linked to a socket, through reroutes, and constants."""
from __future__ import annotations

from typing import Any

import bpy

Notes = set[str]


def linked_node(socket: bpy.types.NodeSocket) -> bpy.types.Node | None:
    """The node that feeds a socket, or None."""
    for _ in range(64):  # a chain of reroutes
        if not socket.is_linked:
            return None
        node = socket.links[0].from_node
        if node.type != "REROUTE":
            return None if node.mute else node
        socket = node.inputs[0]
    return None


def surface_node(owner: Any, kind: str) -> bpy.types.Node | None:
    """The node at the surface of the active output of this kind in the node tree of a material, world or light."""
    outputs = [node for node in owner.node_tree.nodes if node.bl_idname == kind and node.target in ("ALL", "CYCLES")]
    outputs.sort(key=lambda node: not node.is_active_output)
    return linked_node(outputs[0].inputs["Surface"]) if outputs else None


def constant(socket: bpy.types.NodeSocket, notes: Notes) -> Any:
    """The value of a socket: of an RGB or Value node that feeds it, or else its own."""
    node = linked_node(socket)
    if node is not None:
        if node.type in ("RGB", "VALUE"):
            value = node.outputs[0].default_value
            return list(value)[:3] if node.type == "RGB" else float(value)
        if node.type == "BLACKBODY":
            notes.add("the node Blackbody: left out; its light is white")
            return [1.0, 1.0, 1.0]
        notes.add(f"nodes of the kind {node.bl_label}: left out where only numbers are read")
    value = socket.default_value
    if isinstance(value, (int, float)):
        return float(value)
    return [float(v) for v in value][:3]
