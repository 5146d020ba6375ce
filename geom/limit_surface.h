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

/// What is the same for all poses and all characters with one cage: refinement, patches, texture coordinates.
/// Immutable. Thread safety: const members may be called from any thread.
class SurfaceTopology {
 public:
  /// Throws Error (kInput) with `source` when the cage cannot be subdivided (non-manifold parts that the
  /// limit surface is not defined on, a Loop scheme with faces that are not triangles, ...). Scheme none
  /// takes any polygons: faces of more than three corners are cut into triangles where they lie at rest.
  static std::shared_ptr<const SurfaceTopology> create(const ControlMesh& mesh, SubdivisionScheme scheme,
                                                       BoundaryRule boundary, const std::string& source);
  /// The same, and throws Error (kStopped), between steps of less than 5 us a face.
  static std::shared_ptr<const SurfaceTopology> create(const ControlMesh& mesh, SubdivisionScheme scheme,
                                                       BoundaryRule boundary, const std::string& source,
                                                       const Job& job);
  ~SurfaceTopology();

  /// Most faces around a vertex and corners around a face: weights around it grow with the square of this.
  /// Ten of the largest may stand in one cage.
  static constexpr uint32_t kMaxValence = 1000;
  /// Faces above which a mesh is hardly a cage that was made to be subdivided: scheme none does as well.
  static constexpr size_t kDenseFaces = 20000;

  /// Ptex faces: one per quad, n per n-gon (Catmull-Clark); one per triangle (Loop; none, after cutting).
  uint32_t face_count() const;
  uint32_t control_count() const;
  /// Whether ptex faces are triangles (Loop, none), with parameters u + v <= 1, not squares.
  bool is_triangular() const;
  /// Whether they are the flat triangles of a mesh that is not subdivided (none).
  bool is_flat() const;
  bool is_hole(uint32_t face) const;
  /// Cage face that a ptex face is part of.
  uint32_t cage_face(uint32_t face) const;
  /// Texture coordinates at (u, v) of a ptex face: bilinear within the cage's, (u, v) itself when it has
  /// none.
  V2f texture_coordinates(uint32_t face, float u, float v) const;
  /// Ptex face across edge 0 .. 3 (v = 0, u = 1, v = 1, u = 0; triangles: v = 0, u + v = 1, u = 0) of `face`;
  /// -1 at a boundary and where more than two faces meet. Where a quad meets an n-gon, whose ptex faces have
  /// half its edge: the one at the edge's first corner, counterclockwise around `face`.
  int neighbour(uint32_t face, int edge) const;
  /// Of everything that the topology depends on; meshes with equal hashes share one topology.
  ContentHash hash() const;
  size_t bytes() const;
  /// Bytes of a LimitSurface of it, and what making it holds beside it.
  struct PoseBytes {
    size_t held = 0, making = 0;
  };
  PoseBytes pose_bytes() const;
  /// The same of one on `faces` only.
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

/// Position and derivatives of a limit surface. On triangles (u, v) are barycentric with u + v <= 1.
struct SurfacePoint {
  V3f position{0};
  V3f du{0};
  V3f dv{0};
  V3f smooth_normal{0};  ///< unit, of frames on flat triangles; 0: that of du x dv
};

/// A pose of a subdivision surface: the limit position and frame at any (ptex face, u, v). Exact up to
/// rounding at all (u, v) that are multiples of 1/8 and wherever the cage is regular. In the last eighth
/// around a vertex where other than four faces meet it is off by up to 1e-4 of the size of these faces, 1e-3
/// if they are more than five, and the normal at the vertex itself by 4e-3 rad. In cages of more than 6,000
/// faces eighths become quarters, above kDenseFaces halves; positions are then off by up to 1e-5 of the size
/// of the cage, normals by 1e-2 rad. Creases are resolved up to sharpness 6. Under scheme none the triangles
/// themselves, whose frames are smooth: the mean normals at the vertices, by angle, are interpolated, and
/// sharpness is not looked at. Immutable. Thread safety: const members may be called from any thread.
class LimitSurface {
 public:
  /// `positions`: one per control vertex, in the space the surface shall live in.
  LimitSurface(std::shared_ptr<const SurfaceTopology> topology, std::span<const V3f> positions);
  /// The same on `faces` only, in any order: bit by bit the same there, and not to be asked for elsewhere.
  /// Costs time and memory for these faces and what shapes them.
  LimitSurface(std::shared_ptr<const SurfaceTopology> topology, std::span<const V3f> positions,
               std::span<const uint32_t> faces);

  const SurfaceTopology& topology() const { return *topology_; }
  const std::shared_ptr<const SurfaceTopology>& shared_topology() const { return topology_; }

  /// (u, v) outside the face are moved to its border. `face` must exist. Faces that are holes have a surface
  /// here.
  SurfacePoint evaluate(uint32_t face, float u, float v) const;
  /// Orthonormal frame: normal = du x dv, or the smooth one of flat triangles; tangent = du made
  /// perpendicular. Where du x dv vanishes (poles,
  /// collapsed faces) it is taken a little towards the middle of the face; frames are always finite and
  /// orthonormal.
  Frame frame(uint32_t face, float u, float v) const { return frame(evaluate(face, u, v), face, u, v); }
  /// The same where `point`, the surface at (face, u, v), is known already.
  Frame frame(const SurfacePoint& point, uint32_t face, float u, float v) const;
  static Frame frame_of(const SurfacePoint& point);
  Box3f control_bounds() const { return bounds_; }
  /// Of topology and control points: surfaces with equal hashes are the same everywhere. Of whole surfaces.
  ContentHash hash() const;
  size_t bytes() const;

 private:
  void measure(std::span<const V3f> positions);
  size_t place_of(int point) const;
  void set_normal(uint32_t vertex, std::span<const V3f> positions);
  SurfacePoint evaluate_flat(uint32_t face, float u, float v) const;

  std::shared_ptr<const SurfaceTopology> topology_;
  std::vector<float> points_;     // control, refined and local points of the patches, xyz from the origin
  std::vector<float> normals_;    // of control points, on flat triangles
  std::vector<uint32_t> blocks_;  // of PointBlocks::place; empty for a whole surface
  V3f origin_{0};                 // middle of the cage, so that far from 0 no digits are lost
  Box3f bounds_;
};

}  // namespace pelage
