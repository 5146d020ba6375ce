// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "geom/surface_topology_impl.h"

// Topology of polygons that are not subdivided (scheme none). For the sources of geom.

namespace pelage {

/// Fills `impl` with the topology of unsubdivided polygons. Cuts faces with more than three corners into
/// triangles, in the rest pose of the mesh (cut_polygon). The mesh must have been validated. Calls
/// `check_stop` from time to time; `check_stop` may throw.
void fill_flat_topology(const ControlMesh& mesh, const std::function<void()>& check_stop,
                        SurfaceTopology::Impl& impl);

/// Returns the max bytes that fill_flat_topology() uses at any moment, including its result, for a mesh with
/// this number of triangles.
size_t flat_temporary_bytes(size_t triangles, size_t vertices, bool has_uv);
/// Returns the bytes of the result of fill_flat_topology() alone.
size_t flat_bytes(size_t triangles, size_t vertices, bool has_uv);

/// Returns an upper bound of the number of triangles into which the faces of a mesh are cut.
size_t flat_triangle_count(const ControlMesh& mesh);

/// Returns the unit normal at a vertex: the mean of the normals of the adjacent triangles, weighted by the
/// triangles' angles at the vertex [Baerentzen05]. Returns 0 if the normals cancel or no triangle has a
/// normal. Depends only on the positions of these triangles.
V3f flat_vertex_normal(const SurfaceTopology::Impl& impl, std::span<const V3f> positions, uint32_t vertex);

}  // namespace pelage
