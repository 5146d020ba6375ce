// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "geom/surface_topology_impl.h"

// Unsubdivided polygons (scheme none), for the sources of geom.

namespace pelage {

/// Fills the members of a flat topology: faces with more than three corners are triangulated (cut_polygon) in
/// the rest pose of the mesh, which must have been validated. `check_stop` is called from time to time and
/// may throw.
void fill_flat_topology(const ControlMesh& mesh, const std::function<void()>& check_stop,
                        SurfaceTopology::Impl& impl);

/// Max bytes that fill_flat_topology() holds at any moment, including its result, for this number of
/// triangles.
size_t flat_temporary_bytes(size_t triangles, size_t vertices, bool has_uv);
size_t flat_bytes(size_t triangles, size_t vertices, bool has_uv);

/// Upper bound of the number of triangles that the faces of a mesh are cut into.
size_t flat_triangle_count(const ControlMesh& mesh);

/// Unit normal at a vertex: the mean of the adjacent triangles' normals, weighted by their angles
/// [Baerentzen05]; 0 if the normals cancel or no triangle has a normal. Independent of other queries.
V3f flat_vertex_normal(const SurfaceTopology::Impl& impl, std::span<const V3f> positions, uint32_t vertex);

}  // namespace pelage
