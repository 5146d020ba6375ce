// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/hash.h"
#include "base/value_readers.h"
#include "base/vector.h"
#include "geom/mesh.h"
#include "geom/strands.h"

namespace pelage {

struct Job;

enum class SubdivisionScheme { kCatmullClark, kLoop, kBilinear, kNone };
template <>
struct EnumNames<SubdivisionScheme> {
  static constexpr const char* names[] = {"catmull-clark", "loop", "bilinear", "none"};
};
enum class BoundaryRule { kEdgeAndCorner, kEdgeOnly };
template <>
struct EnumNames<BoundaryRule> {
  static constexpr const char* names[] = {"edge-and-corner", "edge-only"};
};

/// The part of a subdivision surface that does not depend on vertex positions: refinement, patches and
/// texture coordinates. All poses and all characters with the same cage share one topology. Immutable.
/// Thread safety: const members may be called from any thread.
class SurfaceTopology {
 public:
  /// Makes the topology of a cage. Throws Error (kInput) with `source` when the cage cannot be subdivided,
  /// for example because it has non-manifold parts without a limit surface, or faces that are not triangles
  /// with scheme Loop. Scheme none accepts any polygons and cuts faces with more than three corners into
  /// triangles, in the rest pose.
  static std::shared_ptr<const SurfaceTopology> create(const ControlMesh& mesh, SubdivisionScheme scheme,
                                                       BoundaryRule boundary, const std::string& source);
  /// Makes the same topology, but throws Error (kStopped) when the job is stopped. Checks the job between
  /// steps, each of which takes less than 5 us per face.
  static std::shared_ptr<const SurfaceTopology> create(const ControlMesh& mesh, SubdivisionScheme scheme,
                                                       BoundaryRule boundary, const std::string& source,
                                                       const Job& job);
  ~SurfaceTopology();

  /// Max number of faces around a vertex, and max number of corners of a face. The number of subdivision
  /// weights grows with the square of either number. The sum of these squares is limited: a cage may contain
  /// at most ten vertices or faces of the max size.
  static constexpr uint32_t kMaxValence = 1000;
  /// Number of faces above which a mesh is probably not a cage made for subdivision. Scheme none then gives
  /// the same quality.
  static constexpr size_t kDenseFaces = 20000;

  /// Number of ptex faces. Catmull-Clark and bilinear: one per quad, n per face with n other than 4 corners.
  /// Loop: one per triangle. None: one per triangle, after larger faces were cut into triangles.
  uint32_t face_count() const;
  /// Number of control vertices.
  uint32_t control_count() const;
  /// Whether ptex faces are triangles with u + v <= 1 (Loop, none) rather than squares.
  bool is_triangular() const;
  /// Whether the ptex faces are the flat triangles of a mesh that is not subdivided (none).
  bool is_flat() const;
  /// Whether a ptex face is a hole of the cage.
  bool is_hole(uint32_t face) const;
  /// Returns the cage face that contains a ptex face. With scheme none, each triangle counts as a cage face.
  uint32_t cage_face(uint32_t face) const;
  /// Returns the texture coordinates at (u, v) of a ptex face, interpolated bilinearly from the texture
  /// coordinates of the cage. Returns (u, v) itself when the cage has no texture coordinates.
  V2f texture_coordinates(uint32_t face, float u, float v) const;
  /// Returns the ptex face on the other side of edge `edge` of `face`. Returns -1 at a boundary and where
  /// more than two faces meet. The edges 0 .. 3 of a square are v = 0, u = 1, v = 1, u = 0. The edges 0 .. 2
  /// of a triangle are v = 0, u + v = 1, u = 0. Where a quad borders an n-gon, two ptex faces of the n-gon
  /// share the edge of the quad. In this case, returns the one at the edge's first corner, counterclockwise
  /// around `face`.
  int neighbour(uint32_t face, int edge) const;
  /// Hash of everything that the topology depends on. Meshes whose topologies have equal hashes can share one
  /// topology.
  ContentHash hash() const;
  size_t bytes() const;
  /// Bytes of a LimitSurface with this topology: held by the surface, and used temporarily while it is made.
  struct PoseBytes {
    size_t held = 0, making = 0;
  };
  PoseBytes pose_bytes() const;
  /// Returns the bytes of a LimitSurface that is limited to `faces`.
  PoseBytes pose_bytes(std::span<const uint32_t> faces) const;

  struct Impl;  // geom/surface_topology_impl.h
  const Impl& impl() const { return *impl_; }

 private:
  static std::shared_ptr<const SurfaceTopology> create(const ControlMesh& mesh, SubdivisionScheme scheme,
                                                       BoundaryRule boundary, const std::string& source,
                                                       const std::function<void()>& check_stop);
  explicit SurfaceTopology(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Position and derivatives at a point (u, v) of a limit surface. On triangles, u and v are barycentric
/// coordinates with u + v <= 1.
struct SurfacePoint {
  V3f position{0};
  V3f du{0};
  V3f dv{0};
  V3f smooth_normal{0};  ///< unit normal for frames on flat triangles; 0 elsewhere, where frames use du x dv
};

/// A pose of a subdivision surface. Evaluates limit position and frame at any (ptex face, u, v).
///
/// Exact up to rounding where the cage is regular, and at all (u, v) that are multiples of 1/8. The surface
/// is approximated in the last eighth of a face around an extraordinary vertex. There, positions have an
/// error of up to 1e-4 of the size of the faces (1e-3 for a valence above five). The normal at the vertex
/// itself has an error of up to 4e-3 rad.
///
/// In a cage of more than 6,000 faces, the surface is approximated in the last quarter of such a face and
/// exact at multiples of 1/4. In a cage of more than kDenseFaces faces, it is approximated in the last half
/// and exact at multiples of 1/2. In these cages, positions have an error of up to 1e-5 of the size of the
/// cage, and normals of up to 1e-2 rad. In all cages, creases are resolved up to sharpness 6.
///
/// Scheme none evaluates flat triangles and ignores sharpness. Its frames are smooth, because they
/// interpolate angle-weighted vertex normals.
///
/// Immutable. Thread safety: const members may be called from any thread.
class LimitSurface {
 public:
  /// `positions` holds the position of each control vertex, in the space that the surface shall have.
  LimitSurface(std::shared_ptr<const SurfaceTopology> topology, std::span<const V3f> positions);
  /// Makes the surface only on `faces`, which may be in any order. On these faces, it is bit-identical to the
  /// whole surface; other faces must not be evaluated. Time and memory are proportional to the number of
  /// these faces and of the vertices that shape them.
  LimitSurface(std::shared_ptr<const SurfaceTopology> topology, std::span<const V3f> positions,
               std::span<const uint32_t> faces);

  const SurfaceTopology& topology() const { return *topology_; }
  const std::shared_ptr<const SurfaceTopology>& shared_topology() const { return topology_; }

  /// Returns the surface at (u, v). Clamps (u, v) to the face. `face` must exist. Holes are evaluated like
  /// other faces.
  SurfacePoint evaluate(uint32_t face, float u, float v) const;
  /// Returns an orthonormal frame. Its normal is the direction of du x dv, or the smooth normal on flat
  /// triangles; its tangent is du made orthogonal to the normal. Where du x dv vanishes (poles, collapsed
  /// faces), takes the frame at a point slightly nearer to the middle of the face. The frame is always finite
  /// and orthonormal.
  Frame frame(uint32_t face, float u, float v) const { return frame(evaluate(face, u, v), face, u, v); }
  /// Returns the same frame for a known `point`, which must be evaluate(face, u, v).
  Frame frame(const SurfacePoint& point, uint32_t face, float u, float v) const;
  /// Returns the frame from `point` alone, without evaluating another point where du x dv vanishes. The frame
  /// may then be arbitrary, but is finite and orthonormal.
  static Frame frame_of(const SurfacePoint& point);
  /// Box of the control vertices.
  Box3f control_bounds() const { return bounds_; }
  /// Hash of topology and control points: surfaces with equal hashes are equal everywhere. Must not be called
  /// for a surface that is limited to some faces.
  ContentHash hash() const;
  size_t bytes() const;

 private:
  void measure(std::span<const V3f> positions);
  size_t place_of(int point) const;
  void set_normal(uint32_t vertex, std::span<const V3f> positions);
  SurfacePoint evaluate_flat(uint32_t face, float u, float v) const;

  std::shared_ptr<const SurfaceTopology> topology_;
  std::vector<float> points_;     // control, refined and local points of the patches: xyz relative to origin_
  std::vector<float> normals_;    // flat triangles: normals of control points
  std::vector<uint32_t> blocks_;  // PointBlocks::place of the points kept; empty for a whole surface
  V3f origin_{0};                 // middle of the cage, to keep precision far from the origin
  Box3f bounds_;
};

}  // namespace pelage
