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

/// The part of a subdivision surface that all poses and all characters with the same cage share: refinement,
/// patches, texture coordinates. Immutable. Thread safety: const members may be called from any thread.
class SurfaceTopology {
 public:
  /// Throws Error (kInput) with `source` when the cage cannot be subdivided (non-manifold parts without a
  /// limit surface, a Loop scheme with faces that are not triangles, ...). Scheme none accepts any polygons:
  /// faces with more than three corners are triangulated in the rest pose.
  static std::shared_ptr<const SurfaceTopology> create(const ControlMesh& mesh, SubdivisionScheme scheme,
                                                       BoundaryRule boundary, const std::string& source);
  /// The same, but throws Error (kStopped) between steps that take less than 5 us per face.
  static std::shared_ptr<const SurfaceTopology> create(const ControlMesh& mesh, SubdivisionScheme scheme,
                                                       BoundaryRule boundary, const std::string& source,
                                                       const Job& job);
  ~SurfaceTopology();

  /// Max number of faces around a vertex, and of corners of a face. The number of subdivision weights grows
  /// with the square of each. A cage may contain ten such vertices or faces.
  static constexpr uint32_t kMaxValence = 1000;
  /// Above this number of faces, a mesh is probably not a cage made for subdivision, and scheme none gives
  /// the same quality.
  static constexpr size_t kDenseFaces = 20000;

  /// Ptex faces: one per quad, n per n-gon (Catmull-Clark); one per triangle (Loop; none, after cutting).
  uint32_t face_count() const;
  uint32_t control_count() const;
  /// Whether ptex faces are triangles (Loop, none), with parameters u + v <= 1, rather than squares.
  bool is_triangular() const;
  /// Whether the ptex faces are the flat triangles of a mesh that is not subdivided (none).
  bool is_flat() const;
  bool is_hole(uint32_t face) const;
  /// Cage face that contains a ptex face.
  uint32_t cage_face(uint32_t face) const;
  /// Texture coordinates at (u, v) of a ptex face: interpolated bilinearly from the texture coordinates of
  /// the cage; (u, v) itself when the cage has no texture coordinates.
  V2f texture_coordinates(uint32_t face, float u, float v) const;
  /// Ptex face across edge 0 .. 3 (v = 0, u = 1, v = 1, u = 0; triangles: v = 0, u + v = 1, u = 0) of `face`;
  /// -1 at a boundary and where more than two faces meet. Where a quad borders an n-gon, two ptex faces of
  /// the n-gon share the edge: returns the one at the edge's first corner, counterclockwise around `face`.
  int neighbour(uint32_t face, int edge) const;
  /// Hash of everything that the topology depends on; meshes with equal hashes share one topology.
  ContentHash hash() const;
  size_t bytes() const;
  /// Bytes of a LimitSurface with this topology, and temporary bytes while it is made.
  struct PoseBytes {
    size_t held = 0, making = 0;
  };
  PoseBytes pose_bytes() const;
  /// The same for a LimitSurface on `faces` only.
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
  V3f smooth_normal{0};  ///< unit normal of frames on flat triangles; 0: use du x dv
};

/// A pose of a subdivision surface: limit position and frame at any (ptex face, u, v).
///
/// Exact up to rounding at all (u, v) that are multiples of 1/8 and wherever the cage is regular. In the last
/// eighth around an extraordinary vertex, positions are off by up to 1e-4 of the size of the faces (1e-3 for
/// a valence above five), and the normal at the vertex itself by 4e-3 rad. In cages of more than 6,000 faces,
/// read quarter instead of eighth; above kDenseFaces, half. Positions are then off by up to 1e-5 of the size
/// of the cage, normals by 1e-2 rad. Creases are resolved up to sharpness 6. Scheme none evaluates the
/// triangles themselves with smooth frames: angle-weighted vertex normals are interpolated, and sharpness is
/// ignored.
///
/// Immutable. Thread safety: const members may be called from any thread.
class LimitSurface {
 public:
  /// `positions`: one per control vertex; they define the space of the surface.
  LimitSurface(std::shared_ptr<const SurfaceTopology> topology, std::span<const V3f> positions);
  /// The same on `faces` only, in any order. Bit-identical on these faces; other faces must not be evaluated.
  /// Time and memory are proportional to these faces and the vertices that shape them.
  LimitSurface(std::shared_ptr<const SurfaceTopology> topology, std::span<const V3f> positions,
               std::span<const uint32_t> faces);

  const SurfaceTopology& topology() const { return *topology_; }
  const std::shared_ptr<const SurfaceTopology>& shared_topology() const { return topology_; }

  /// (u, v) outside the face are clamped to its border. `face` must exist. Holes have a surface here.
  SurfacePoint evaluate(uint32_t face, float u, float v) const;
  /// Orthonormal frame: normal = du x dv, or the smooth normal of flat triangles; tangent = du,
  /// orthogonalised. Where du x dv vanishes (poles, collapsed faces), the frame is evaluated slightly towards
  /// the middle of the face; frames are always finite and orthonormal.
  Frame frame(uint32_t face, float u, float v) const { return frame(evaluate(face, u, v), face, u, v); }
  /// The same when `point`, the surface at (face, u, v), is already known.
  Frame frame(const SurfacePoint& point, uint32_t face, float u, float v) const;
  static Frame frame_of(const SurfacePoint& point);
  Box3f control_bounds() const { return bounds_; }
  /// Hash of topology and control points: surfaces with equal hashes are equal everywhere. Whole surfaces
  /// only.
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
  V3f origin_{0};                 // middle of the cage, to keep precision far from the origin
  Box3f bounds_;
};

}  // namespace pelage
