// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/limit_surface.h"
#include "geom/tessellation.h"

namespace pelage {

struct Job;

/// A part of a skin that is tessellated by itself (tessellate_faces).
struct SkinPiece {
  std::vector<uint32_t>
      faces;            ///< ptex faces, ascending, all of each of some cage faces; empty: all there are
  size_t vertices = 0;  ///< what tessellating gives, of one motion key
  size_t triangles = 0;

  bool is_whole() const { return faces.empty(); }
};

/// What tessellating some faces takes, in triangles: posing a ptex face takes as much memory as this many.
constexpr size_t kTrianglesPerPose = 16;
constexpr size_t kMaxPieces = 64;

/// Divides a skin into pieces that are compact and much alike in cost: at most `max_cost` each, in triangles
/// and kTrianglesPerPose for each face, or one cage face, or a kMaxPieces-th of the whole, because each
/// piece poses the faces around it too. One piece where the whole costs no more. Every face is in one piece,
/// holes in any. The same for any number of threads. Throws as tessellate().
std::vector<SkinPiece> divide_skin(std::span<const LimitSurface> keys, const View& view,
                                   const TessellationOptions& options, size_t max_cost, const Job& job);

/// Ptex faces of the cage faces that have a vertex in common with those of `faces`, these included.
/// Ascending.
std::vector<uint32_t> faces_around(const SurfaceTopology& topology, std::span<const uint32_t> faces);
/// Vertices of the cage that shape `around`, ascending: the limit surface of the faces in the middle lies
/// within their hull, as LimitSurface says.
std::vector<uint32_t> vertices_of(const SurfaceTopology& topology, std::span<const uint32_t> around);

}  // namespace pelage
