// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "geom/surface_topology_impl.h"

// Polygons as they are (scheme none), for the sources of geom.

namespace pelage {

/// Fills in what a topology of flat triangles is made of: faces of more corners are cut (cut_polygon), where
/// the mesh has them at rest. The mesh has been checked. `check_stop` is called now and then and may throw.
void fill_flat_topology(const ControlMesh& mesh, const std::function<void()>& check_stop,
                        SurfaceTopology::Impl& impl);

/// Most bytes that fill_flat_topology() holds at any moment, and that it leaves, for so many triangles.
size_t flat_temporary_bytes(size_t triangles, size_t vertices, bool has_uv);
size_t flat_bytes(size_t triangles, size_t vertices, bool has_uv);

/// Triangles that the faces of a mesh are cut into, at most.
size_t flat_triangle_count(const ControlMesh& mesh);

/// Unit normal at a vertex: the mean of those of the triangles around it, by their angles there
/// [Baerentzen05]; 0 where they cancel out, or none has one. The same whatever else is asked for.
V3f flat_vertex_normal(const SurfaceTopology::Impl& impl, std::span<const V3f> positions, uint32_t vertex);

}  // namespace pelage
