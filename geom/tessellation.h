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

/// The triangles of a skin that every consumer of a frame uses: rays, push_out, occlusion. Watertight where
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
  /// Becomes the one triangle `triangle` of `source`, over all motion keys, its corners vertices 0, 1, 2.
  /// Memory is reused.
  void assign_triangle(const SkinMesh& source, size_t triangle);
  size_t bytes() const;
};

struct TessellationOptions {
  float edge_pixels = 4;  ///< aimed length of the longest edge on screen
  int max_rate = 32;      ///< most quads along an edge of a ptex face
  /// Keys by whose edges the rates are chosen, from the first to the one before `end`: poses that are added
  /// before and after these change no triangle.
  size_t first_rated_key = 0, end_rated_key = SIZE_MAX;
};

/// Tessellates poses of one topology (one per motion key, at even times over the shutter) for `view`. Every
/// edge of the cage is divided by its own length on screen, so that a skin costs what is seen of it; faces
/// that share an edge share its vertices. Holes are left out. The same for any number of threads. Throws
/// Error (kMemory) when there would be more than 2^31 vertices or triangles.
SkinMesh tessellate(std::span<const LimitSurface> keys, const View& view, const TessellationOptions& options,
                    const Workers& workers);
/// The same, and throws Error (kStopped).
SkinMesh tessellate(std::span<const LimitSurface> keys, const View& view, const TessellationOptions& options,
                    const Job& job);
/// The triangles of `faces` alone: all ptex faces of some cage faces, ascending. Bit by bit those of the
/// whole, in the same order; their vertices are numbered anew. The surfaces need only be there on
/// faces_around(faces). By the calling thread.
SkinMesh tessellate_faces(std::span<const LimitSurface> keys, std::span<const uint32_t> faces,
                          const View& view, const TessellationOptions& options);
/// What either holds at most beside what it gives, of so many ptex faces, those around them included, and
/// vertices.
size_t tessellating_bytes(const SurfaceTopology& topology, size_t faces, size_t vertices);

}  // namespace pelage
