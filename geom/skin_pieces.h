// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/limit_surface.h"
#include "geom/tessellation.h"

namespace pelage {

struct Job;

/// A part of a skin that is tessellated separately (tessellate_faces).
struct SkinPiece {
  std::vector<uint32_t> faces;  ///< ascending: all ptex faces of some cage faces; empty: the whole skin
  size_t vertices = 0;          ///< size of its tessellation, for one motion key
  size_t triangles = 0;

  bool is_whole() const { return faces.empty(); }
};

/// Cost of posing a ptex face relative to a triangle, by memory.
constexpr size_t kTrianglesPerPose = 16;
constexpr size_t kMaxPieces = 64;

/// Divides a skin into compact pieces of similar cost. A piece costs its triangles, plus kTrianglesPerPose
/// per face. Each piece costs at most `max_cost`, unless it consists of one cage face or costs 1 / kMaxPieces
/// of the whole skin. Smaller pieces would be wasteful, because each piece also poses the faces around it.
/// Returns one piece if the whole skin costs at most `max_cost`. Every face is in exactly one piece, holes
/// included. The result is the same for any number of threads. Throws as tessellate().
std::vector<SkinPiece> divide_skin(std::span<const LimitSurface> keys, const View& view,
                                   const TessellationOptions& options, size_t max_cost, const Job& job);

/// Ptex faces of all cage faces that share a vertex with the cage faces of `faces`, including `faces`.
/// Ascending.
std::vector<uint32_t> faces_around(const SurfaceTopology& topology, std::span<const uint32_t> faces);
/// Vertices of the cage faces of `around`, ascending. If `around` is faces_around(faces), the limit surface
/// of `faces` lies within the hull of these vertices, to the accuracy of LimitSurface.
std::vector<uint32_t> vertices_of(const SurfaceTopology& topology, std::span<const uint32_t> around);

}  // namespace pelage
