// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <vector>

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/ptexIndices.h>

#include "geom/cage_refiner.h"

// The slow truth beside the patches: uniform refinement and the exact limit of its vertices.

namespace pelage {

namespace Far = OpenSubdiv::Far;

/// A vector as OpenSubdiv's refiners want to see it.
struct FarPoint {
  V3d p{0};
  void Clear() { p = V3d(0); }
  void AddWithWeight(const FarPoint& other, double w) { p += w * other.p; }
};

/// A vertex of a refined cage: its position on a ptex face, and its limit.
struct LimitVertex {
  uint32_t face;
  float u, v;
  V3d position, normal;  ///< normal: du x dv, not normalised
};

/// Positions of all vertices after `levels` uniform refinements, in double.
inline std::vector<FarPoint> refine_uniformly(Far::TopologyRefiner& refiner, const ControlMesh& mesh,
                                              int levels) {
  Far::TopologyRefiner::UniformOptions options(levels);
  options.fullTopologyInLastLevel = true;
  refiner.RefineUniform(options);
  std::vector<FarPoint> points;
  for (const V3f& p : mesh.positions) points.push_back({V3d(p)});
  const Far::PrimvarRefinerReal<double> primvars(refiner);
  for (int level = 1; level <= levels; ++level) {
    std::vector<FarPoint> next(static_cast<size_t>(refiner.GetLevel(level).GetNumVertices()));
    primvars.Interpolate(level, points, next);
    points = std::move(next);
  }
  return points;
}

/// All vertices of all faces after `levels` refinements, with the parameters that follow from halving each
/// face at each level, and their limits by the masks of their last vertices.
inline std::vector<LimitVertex> uniform_limit(const ControlMesh& mesh, SubdivisionScheme scheme,
                                              BoundaryRule boundary, int levels) {
  const std::unique_ptr<Far::TopologyRefiner> refiner = make_refiner(mesh, scheme, boundary, "oracle");
  const std::vector<FarPoint> points = refine_uniformly(*refiner, mesh, levels);
  std::vector<FarPoint> limit(points.size()), du(points.size()), dv(points.size());
  Far::PrimvarRefinerReal<double>(*refiner).Limit(points, limit, du, dv);

  struct Face {
    uint32_t ptex;
    std::vector<V2f> uv;  // of its corners; empty for a cage face that is several ptex faces
  };
  const bool loop = scheme == SubdivisionScheme::kLoop;
  const Far::PtexIndices ptex(*refiner);
  std::vector<Face> faces;
  for (int f = 0; f < refiner->GetLevel(0).GetNumFaces(); ++f) {
    const int n = refiner->GetLevel(0).GetFaceVertices(f).size();
    Face face{static_cast<uint32_t>(ptex.GetFaceId(f)), {}};
    if (loop) face.uv = {{0, 0}, {1, 0}, {0, 1}};
    if (!loop && n == 4) face.uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    faces.push_back(std::move(face));
  }
  for (int level = 0; level < levels; ++level) {
    const Far::TopologyLevel& parent = refiner->GetLevel(level);
    const Far::TopologyLevel& child = refiner->GetLevel(level + 1);
    std::vector<Face> children(static_cast<size_t>(child.GetNumFaces()));
    for (int f = 0; f < parent.GetNumFaces(); ++f) {
      const Face& face = faces[static_cast<size_t>(f)];
      const Far::ConstIndexArray vertices = parent.GetFaceVertices(f), edges = parent.GetFaceEdges(f);
      const int n = vertices.size();
      const Far::ConstIndexArray parts = parent.GetFaceChildFaces(f);
      for (int k = 0; k < parts.size(); ++k) {
        std::map<int, V2f> places;
        Face part{face.ptex, {}};
        if (face.uv.empty()) {
          part.ptex += static_cast<uint32_t>(k);
          places[parent.GetVertexChildVertex(vertices[k])] = {0, 0};
          places[parent.GetEdgeChildVertex(edges[k])] = {1, 0};
          places[parent.GetFaceChildVertex(f)] = {1, 1};
          places[parent.GetEdgeChildVertex(edges[(k + n - 1) % n])] = {0, 1};
        } else {
          V2f middle(0);
          for (int i = 0; i < n; ++i) {
            const V2f here = face.uv[static_cast<size_t>(i)],
                      next = face.uv[static_cast<size_t>((i + 1) % n)];
            places[parent.GetVertexChildVertex(vertices[i])] = here;
            places[parent.GetEdgeChildVertex(edges[i])] = 0.5f * (here + next);
            middle += here / static_cast<float>(n);
          }
          if (!loop) places[parent.GetFaceChildVertex(f)] = middle;
        }
        for (int vertex : child.GetFaceVertices(parts[k])) part.uv.push_back(places.at(vertex));
        children[static_cast<size_t>(parts[k])] = std::move(part);
      }
    }
    faces = std::move(children);
  }
  std::vector<LimitVertex> result;
  for (size_t f = 0; f < faces.size(); ++f) {
    const Far::ConstIndexArray vertices = refiner->GetLevel(levels).GetFaceVertices(static_cast<int>(f));
    for (int i = 0; i < vertices.size(); ++i) {
      const auto v = static_cast<size_t>(vertices[i]);
      const V2f uv = faces[f].uv[static_cast<size_t>(i)];
      result.push_back({faces[f].ptex, uv.x, uv.y, limit[v].p, du[v].p.cross(dv[v].p)});
    }
  }
  return result;
}

/// Angle between two directions.
inline double angle_between(const V3d& a, const V3d& b) { return std::atan2(a.cross(b).length(), a.dot(b)); }

}  // namespace pelage
