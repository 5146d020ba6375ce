// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/vector.h"
#include "geom/limit_surface.h"
#include "geom/view.h"

namespace pelage {

class Workers;

/// The triangles of a skin. Within one frame, rays, push_out and occlusion all use the same triangles.
/// Vertices lie on the limit surface. Watertight where the surface is closed.
struct SkinMesh {
  int motion_keys = 1;
  std::vector<float> positions;  ///< motion_keys x vertex_count x (x, y, z): all of key 0 first
  /// Unit limit normals in the layout of `positions`, averaged over the adjacent faces at sharp edges.
  std::vector<float> normals;
  std::vector<uint32_t> triangles;  ///< 3 vertex indices each
  std::vector<uint32_t> faces;      ///< ptex face of each triangle
  std::vector<V2f> vertex_uv;       ///< parameters of each triangle's 3 corners in its ptex face

  size_t vertex_count() const { return positions.size() / 3 / static_cast<size_t>(motion_keys); }
  size_t triangle_count() const { return triangles.size() / 3; }
  V3f position(size_t vertex, int key = 0) const {
    const float* p = &positions[(static_cast<size_t>(key) * vertex_count() + vertex) * 3];
    return {p[0], p[1], p[2]};
  }
  V3f normal(size_t vertex, int key = 0) const {
    const float* p = &normals[(static_cast<size_t>(key) * vertex_count() + vertex) * 3];
    return {p[0], p[1], p[2]};
  }
  /// Turns this mesh into the single triangle `triangle` of `source`, with all motion keys and with the
  /// vertex indices 0, 1, 2. Reuses the memory of this mesh.
  void assign_triangle(const SkinMesh& source, size_t triangle);
  size_t bytes() const;
};

struct TessellationOptions {
  float edge_pixels = 4;  ///< target length in pixels of the parts of an edge on screen
  /// Max number of parts into which an edge of the cage is divided; at least 2 beside an n-gon.
  int max_rate = 32;
  /// Range of the keys that determine the rates (numbers of parts of edges). Poses outside this range are
  /// tessellated too, but do not change how edges are divided.
  size_t first_rated_key = 0, end_rated_key = SIZE_MAX;
};

/// Tessellates poses of one topology for `view`. The poses are motion keys at evenly spaced times over the
/// shutter. Divides every edge of the cage according to its length on screen, so that the cost of a skin
/// depends on its visible size. Adjacent faces share the vertices of their common edge. Omits holes. The
/// result is the same for any number of threads. Throws Error (kMemory) for more than 2^31 - 1 vertices or
/// triangles.
SkinMesh tessellate(std::span<const LimitSurface> keys, const View& view, const TessellationOptions& options,
                    const Workers& workers);
/// Tessellates in the same way, but throws Error (kStopped) when the job is stopped.
SkinMesh tessellate(std::span<const LimitSurface> keys, const View& view, const TessellationOptions& options,
                    const Job& job);
/// Tessellates only `faces`: indices of ptex faces, ascending. If one ptex face of a cage face is in the
/// list, all ptex faces of this cage face must be. The triangles are bit-identical to those of the whole skin
/// and in the same order; their vertices are renumbered. The surfaces are needed only on faces_around(faces).
/// Runs on the calling thread.
SkinMesh tessellate_faces(std::span<const LimitSurface> keys, std::span<const uint32_t> faces,
                          const View& view, const TessellationOptions& options);
/// Returns the max temporary memory, without the result, of tessellate() and tessellate_faces(). `faces`:
/// number of ptex faces, including those around the tessellated ones. `vertices`: number of vertices.
size_t tessellating_bytes(const SurfaceTopology& topology, size_t faces, size_t vertices);

}  // namespace pelage
