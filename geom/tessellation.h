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

/// The triangles of a skin, shared by all consumers of a frame: rays, push_out, occlusion. Watertight where
/// the surface is closed. Vertices lie on the limit surface.
struct SkinMesh {
  int motion_keys = 1;
  std::vector<float> positions;     ///< motion_keys x vertex_count x 3, the whole of key 0 first
  std::vector<float> normals;       ///< as positions: unit limit normals, averaged over faces at sharp edges
  std::vector<uint32_t> triangles;  ///< 3 vertices each
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
  /// Becomes the single triangle `triangle` of `source`, with all motion keys and corners 0, 1, 2. Reuses its
  /// memory.
  void assign_triangle(const SkinMesh& source, size_t triangle);
  size_t bytes() const;
};

struct TessellationOptions {
  float edge_pixels = 4;  ///< target length of the longest edge on screen
  int max_rate = 32;      ///< max number of quads along an edge of a ptex face
  /// Range of keys whose edges determine the rates: poses added before and after these change no triangle.
  size_t first_rated_key = 0, end_rated_key = SIZE_MAX;
};

/// Tessellates poses of one topology (one per motion key, at evenly spaced times over the shutter) for
/// `view`. Every edge of the cage is divided according to its length on screen, so the cost of a skin depends
/// on its visible size. Adjacent faces share the vertices of their common edge. Holes are omitted. The result
/// is the same for any number of threads. Throws Error (kMemory) for more than 2^31 vertices or triangles.
SkinMesh tessellate(std::span<const LimitSurface> keys, const View& view, const TessellationOptions& options,
                    const Workers& workers);
/// The same, but throws Error (kStopped) when the job is stopped.
SkinMesh tessellate(std::span<const LimitSurface> keys, const View& view, const TessellationOptions& options,
                    const Job& job);
/// The triangles of `faces` only: all ptex faces of some cage faces, ascending. Bit-identical to the
/// triangles of the whole skin and in the same order, with vertices renumbered. The surfaces need to exist
/// only on faces_around(faces). Runs on the calling thread.
SkinMesh tessellate_faces(std::span<const LimitSurface> keys, std::span<const uint32_t> faces,
                          const View& view, const TessellationOptions& options);
/// Max temporary memory of either function, without its result, for this number of ptex faces (including
/// those around them) and vertices.
size_t tessellating_bytes(const SurfaceTopology& topology, size_t faces, size_t vertices);

}  // namespace pelage
