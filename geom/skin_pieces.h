// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/limit_surface.h"
#include "geom/tessellation.h"

namespace pelage {

struct Job;

/// A part of a skin that is tessellated on its own (tessellate_faces).
struct SkinPiece {
  std::vector<uint32_t> faces;  ///< all ptex faces of some cage faces, ascending; empty: the whole skin
  size_t vertices = 0;          ///< number of vertices of its tessellation, for one motion key
  size_t triangles = 0;         ///< number of triangles of its tessellation

  bool is_whole() const { return faces.empty(); }
};

/// Memory that posing one ptex face needs, as a number of triangles that need the same memory.
constexpr size_t kTrianglesPerPose = 16;
/// Division stops at pieces that cost no more than 1 / kMaxPieces of the skin, see divide_skin().
constexpr size_t kMaxPieces = 64;

/// Divides a skin into compact pieces of similar cost. The cost of a piece is its number of triangles, plus
/// kTrianglesPerPose per ptex face. Each piece costs at most `max_cost` or 1 / kMaxPieces of the whole skin,
/// whichever is larger; only a piece that consists of a single cage face may cost more. Smaller pieces would
/// be wasteful, because each piece also poses the faces around it.
///
/// Returns a single piece if the whole skin costs at most `max_cost`. Every face, also a hole, is in exactly
/// one piece. The result is the same for any number of threads. Throws the same errors as tessellate().
std::vector<SkinPiece> divide_skin(std::span<const LimitSurface> keys, const View& view,
                                   const TessellationOptions& options, size_t max_cost, const Job& job);

/// Returns the ptex faces of all cage faces that share a vertex with a cage face of `faces`, including
/// `faces` themselves. Ascending.
std::vector<uint32_t> faces_around(const SurfaceTopology& topology, std::span<const uint32_t> faces);
/// Returns the vertices of the cage faces of `around`, ascending. If `around` is faces_around(faces), the
/// limit surface of `faces` lies within the convex hull of these vertices, to the accuracy of LimitSurface.
std::vector<uint32_t> vertices_of(const SurfaceTopology& topology, std::span<const uint32_t> around);

}  // namespace pelage
