# SPDX-License-Identifier: Apache-2.0
"""Meshes of a depsgraph as arrays: cages where Pelage's limit surface is Blender's, and evaluated polygons elsewhere."""
from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from .cage import Cage, Creases
from .limit_cage import LimitMap

DEFORMING = {"ARMATURE", "CAST", "CLOTH", "COLLISION", "CORRECTIVE_SMOOTH", "CURVE", "DATA_TRANSFER", "DISPLACE", "HOOK",
             "LAPLACIANDEFORM", "LAPLACIANSMOOTH", "LATTICE", "MESH_CACHE", "MESH_DEFORM", "MESH_SEQUENCE_CACHE",
             "NORMAL_EDIT", "SHRINKWRAP", "SIMPLE_DEFORM", "SMOOTH", "SOFT_BODY", "SURFACE", "SURFACE_DEFORM",
             "UV_PROJECT", "UV_WARP", "VERTEX_WEIGHT_EDIT", "VERTEX_WEIGHT_MIX", "VERTEX_WEIGHT_PROXIMITY", "WARP", "WAVE",
             "WEIGHTED_NORMAL"}
"""Kinds of modifiers that keep vertices and faces."""


def _array(collection: Any, name: str, kind: Any, width: int = 1) -> np.ndarray:
    values = np.empty(len(collection) * width, kind)
    collection.foreach_get(name, values)
    return values if width == 1 else values.reshape(-1, width)


def vertices_of(mesh: bpy.types.Mesh) -> np.ndarray:
    return _array(mesh.vertices, "co", np.float32, 3)


def topology_of(mesh: bpy.types.Mesh) -> tuple[int, int]:
    return len(mesh.vertices), len(mesh.loops)


def _texture_coordinates(mesh: bpy.types.Mesh) -> np.ndarray | None:
    layer = next((layer for layer in mesh.uv_layers if layer.active_render), None)
    return _array(layer.data, "uv", np.float32, 2) if layer is not None and len(layer.data) else None


def _split_at_sharp_edges(mesh: bpy.types.Mesh, corners: np.ndarray, sizes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Gives each vertex a copy for each of its normals: the vertex of `mesh` of each copy, and the copy of each corner.

    Pelage interpolates normals between the vertices of a mesh, so a sharp edge needs vertices of its own.
    """
    if mesh.use_auto_smooth or mesh.has_custom_normals:
        mesh.calc_normals_split()
        normal = np.round(_array(mesh.loops, "normal", np.float32, 3) * 512).astype(np.int64)
        key = ((normal[:, 0] + 512) * 1025 + normal[:, 1] + 512) * 1025 + normal[:, 2] + 512
    else:
        smooth = np.repeat(_array(mesh.polygons, "use_smooth", bool), sizes)
        if smooth.all():
            return np.arange(len(mesh.vertices)), corners
        key = np.where(smooth, -1, np.repeat(np.arange(len(sizes)), sizes))
    pairs = np.stack([corners, key], axis=1)
    unique, places = np.unique(pairs, axis=0, return_inverse=True)
    return unique[:, 0], places.ravel()


def read_mesh(mesh: bpy.types.Mesh, sharp: bool = True) -> Cage | None:
    """The polygons of a mesh; None if it has none. `sharp`: flat faces and sharp edges get vertices of their own."""
    if len(mesh.polygons) == 0:
        return None
    sizes = _array(mesh.polygons, "loop_total", np.int32)
    corners = _array(mesh.loops, "vertex_index", np.int32).astype(np.int64)
    vertices = np.arange(len(mesh.vertices))
    points = vertices_of(mesh)
    slots = _array(mesh.polygons, "material_index", np.int32)
    uvs = _texture_coordinates(mesh)
    if sharp:
        vertices, corners = _split_at_sharp_edges(mesh, corners, sizes)
    return Cage(points[vertices], sizes, corners, uvs, slots, vertices=vertices, topology=topology_of(mesh))


def geometry_modifiers(ob: bpy.types.Object, render: bool) -> list[bpy.types.Modifier]:
    """The modifiers that change the mesh, in their order."""
    return [m for m in ob.modifiers if (m.show_render if render else m.show_viewport)
            and m.type not in ("PARTICLE_SYSTEM", "COLLISION", "SURFACE")]


def subdivision(ob: bpy.types.Object, render: bool) -> bpy.types.Modifier | None:
    """The last modifier, if it is Catmull-Clark as Pelage knows it, and the others only deform the mesh."""
    found = geometry_modifiers(ob, render)
    if ob.type != "MESH" or not found or found[-1].type != "SUBSURF" or any(m.type not in DEFORMING for m in found[:-1]):
        return None
    modifier, mesh = found[-1], ob.original.data
    levels = modifier.render_levels if render else modifier.levels
    exact = modifier.subdivision_type == "CATMULL_CLARK" and levels > 0 and modifier.use_limit_surface
    return modifier if exact and len(mesh.polygons) else None


def _sharpness(crease: np.ndarray) -> np.ndarray:
    """Blender's creases go from 0 to 1; it gives OpenSubdiv the sharpness 10 crease^2."""
    return 10 * np.square(crease)


def read_creases(mesh: bpy.types.Mesh) -> Creases | None:
    """The creases of a mesh; None if it has none."""
    ends, vertices = np.zeros((0, 2), np.int64), np.zeros(0, np.int64)
    of_edges, of_vertices = np.zeros(0, np.float32), np.zeros(0, np.float32)
    if mesh.has_crease_edge:
        crease = _array(mesh.edges, "crease", np.float32)
        sharp = (crease > 0) & ~_array(mesh.edges, "is_loose", bool)  # Pelage has edges of faces only
        ends, of_edges = _array(mesh.edges, "vertices", np.int32, 2)[sharp].astype(np.int64), _sharpness(crease[sharp])
    if mesh.has_crease_vertex:
        crease = _array(mesh.vertex_creases[0].data, "value", np.float32)
        vertices, of_vertices = np.flatnonzero(crease > 0), _sharpness(crease[crease > 0])
    return Creases(ends, of_edges, vertices, of_vertices) if len(ends) + len(vertices) else None


def deforms(ob: bpy.types.Object, render: bool) -> bool:
    """Whether something deforms the mesh before its last modifier."""
    return len(geometry_modifiers(ob, render)) > 1 or ob.data.shape_keys is not None


def cage_of(ob: bpy.types.Object, mesh: bpy.types.Mesh, render: bool, rest: bool, groups: list[str]) -> Cage | None:
    """The cage of an evaluated object whose evaluated mesh is given, with the weights of up to three vertex groups as colours.

    rest: also find the positions before modifiers, so that a coat of Pelage stays where it is while the object deforms; such
    meshes are not split at sharp edges.
    """
    modifier = subdivision(ob, render)
    creases = read_creases(ob.original.data) if modifier is not None and modifier.use_creases else None
    # LimitMap knows no creases.
    if modifier is not None and (not deforms(ob, render) or (rest and creases is None)):
        cage = read_mesh(ob.original.data, sharp=False)
        assert cage is not None
        cage.scheme, cage.creases = "catmull-clark", creases
        cage.boundary = "edge-only" if modifier.boundary_smooth == "ALL" else "edge-and-corner"
        cage.colors, cage.topology = _group_colors(ob, ob.original.data, groups), topology_of(mesh)
        if deforms(ob, render):
            cage.limit = LimitMap(cage.sizes, cage.corners, len(cage.points), cage.boundary == "edge-and-corner")
            cage.rest = cage.points
            cage.points = cage.limit.cage(vertices_of(mesh)[:len(cage.points)])
        return cage
    cage = read_mesh(mesh, sharp=not rest)
    if cage is None or not rest or ob.type != "MESH":
        return cage
    cage.colors = _group_colors(ob, mesh, groups)
    original = ob.original.data
    keeps = all(m.type in DEFORMING for m in geometry_modifiers(ob, render))
    if keeps and len(original.vertices) == len(mesh.vertices):
        cage.rest = vertices_of(original)
    return cage


def pose_of(ob: bpy.types.Object, mesh: bpy.types.Mesh, cage: Cage) -> np.ndarray | None:
    """Points of the cage in the pose of `mesh`, the same object at another time; None if the mesh has changed."""
    if topology_of(mesh) != cage.topology:
        return None
    if cage.limit is not None:
        return cage.limit.cage(vertices_of(mesh)[:len(cage.points)])
    if cage.scheme == "catmull-clark":
        return cage.points
    return vertices_of(mesh)[cage.vertices]


def vertex_weights(mesh: bpy.types.Mesh, index: int) -> np.ndarray:
    """Weights (n,) of the vertices of a mesh in the vertex group with this index."""
    weights = np.zeros(len(mesh.vertices), np.float32)
    for vertex in mesh.vertices:
        for group in vertex.groups:
            if group.group == index:
                weights[vertex.index] = group.weight
    return weights


def _group_colors(ob: bpy.types.Object, mesh: bpy.types.Mesh, groups: list[str]) -> np.ndarray | None:
    """Weights (n, 3) of up to three vertex groups."""
    if not groups:
        return None
    colors = np.zeros((len(mesh.vertices), 3), np.float32)
    for channel, name in enumerate(groups):
        if name in ob.vertex_groups:
            colors[:, channel] = vertex_weights(mesh, ob.vertex_groups[name].index)
    return colors
