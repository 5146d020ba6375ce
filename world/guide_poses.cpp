// SPDX-License-Identifier: Apache-2.0
#include "world/guide_poses.h"

#include "base/check.h"
#include "base/job.h"
#include "base/memory_budget.h"
#include "geom/tessellation.h"
#include "groom/operators/follow.h"

namespace pelage {
namespace {

/// Bytes that a point of a guide takes, as groomed and in the result.
constexpr size_t kBytesOfWrittenPoint = 80;

/// A rotation whose columns are the axes of a follicle frame.
Imath::Quatd turn_of(const Frame& frame) {
  const V3d x(frame.tangent), y(frame.bitangent), z(frame.normal);
  const double trace = x.x + y.y + z.z;
  Imath::Quatd q;
  if (trace > 0) {
    q = {1 + trace, V3d(y.z - z.y, z.x - x.z, x.y - y.x)};
  } else if (x.x > y.y && x.x > z.z) {
    q = {y.z - z.y, V3d(1 + x.x - y.y - z.z, x.y + y.x, z.x + x.z)};
  } else if (y.y > z.z) {
    q = {z.x - x.z, V3d(x.y + y.x, 1 + y.y - x.x - z.z, y.z + z.y)};
  } else {
    q = {x.y - y.x, V3d(z.x + x.z, y.z + z.y, 1 + z.z - x.x - y.y)};
  }
  return q.normalize();
}

}  // namespace

LimitSurface posed_skin(const FrameCharacter& character, size_t part, const Assets& assets, double time) {
  CameraParams instant;
  instant.shutter = V2f(0);
  const CharacterPose pose = pose_character(character, part, assets, instant, time);
  return LimitSurface(pose.topology, pose.shutter.cages.front());
}

SkinMesh guide_triangles(const LimitSurface& skin, const Job& job) {
  View everywhere;
  everywhere.focal_pixels = 1e12f;
  TessellationOptions options;
  options.max_rate = skin.topology().is_flat() ? 1 : 2;
  options.edge_pixels = 0;  // no edge is short enough for less than the max rate, even one of no length
  return tessellate(std::span(&skin, 1), everywhere, options, job);
}

RestPose::RestPose(const LimitSurface& rest, bool closest_points, const Job& job) : rest_(rest) {
  if (!closest_points) return;
  mesh_ = guide_triangles(rest, job);
  trees_.emplace_back(mesh_, 0, &job);
}

PosedSkin RestPose::skin(bool guides_only) const {
  PosedSkin pose;
  pose.keys = {&rest_, 1};
  pose.trees = trees_;
  pose.guides_only = guides_only;
  return pose;
}

std::vector<RodRoot> guide_roots(const Groom& groom, const LimitSurface& skin, double scale) {
  std::vector<RodRoot> roots;
  for (const uint32_t f : groom.guides()->follicles) {
    const RootAddress& root = groom.follicles().root(f);
    roots.push_back({V3d(skin.evaluate(root.face, root.u, root.v).position) * scale,
                     turn_of(skin.frame(root.face, root.u, root.v))});
  }
  return roots;
}

std::vector<GuideShape> groomed_guides(const Groom& groom, const LimitSurface& rest, double scale,
                                       const Job& job) {
  const std::vector<uint32_t>& guides = groom.guides()->follicles;
  std::vector<GuideShape> shapes(guides.size());
  const RestPose pose(rest, groom.guides_need_closest_point(), job);
  groom.visit_guides(pose.skin(true), [&](size_t guide, const Strands& strands, size_t s) {
    const RootAddress& root = groom.follicles().root(guides[guide]);
    const Frame frame = rest.frame(root.face, root.u, root.v);
    const uint32_t begin = strands.first_point(s);
    for (uint32_t p = begin; p < strands.first_point(s + 1); ++p)
      shapes[guide].points.push_back(V3d(frame.to_local(strands.point(p) - strands.point(begin))) * scale);
  });
  return shapes;
}

Strands guide_strands(const Assets& assets, const MovingCoat& coat, double frame, const GuideTurns& turns,
                      const Job& job) {
  const size_t guides = coat.groom->guides()->follicles.size();
  const MemoryCharge charge = reserve(job.ledger, MemoryTag::kGrooms,
                                      static_cast<int64_t>((coat.segments() + guides) * kBytesOfWrittenPoint),
                                      "the guides of " + coat.name);
  PELAGE_CHECK(turns.empty() || turns.size() == 4 * coat.segments());
  const LimitSurface& rest = *assets.skins.at(coat.character.params->parts[coat.part].skin.name).rest;
  const double scale = coat.character.params->transform.scale.at(frame);
  const std::vector<GuideShape> shapes = groomed_guides(*coat.groom, rest, scale, job);
  const std::vector<RodRoot> roots =
      guide_roots(*coat.groom, posed_skin(coat.character, coat.part, assets, frame), 1);
  StrandArrays arrays;
  arrays.first_point.push_back(0);
  size_t segment = 0;
  for (size_t g = 0; g < shapes.size(); ++g) {
    V3d point = roots[g].position;
    for (size_t i = 0; i < shapes[g].points.size(); ++i) {
      if (i > 0) {
        V3d along = turned(roots[g].frame, shapes[g].points[i] - shapes[g].points[i - 1]);
        if (!turns.empty()) {
          const float* q = &turns[4 * segment++];
          along = turned(Imath::Quatd(q[3], q[0], q[1], q[2]).normalized(), along);
        }
        point += along;
      }
      for (const double c : {point.x, point.y, point.z}) arrays.points.push_back(static_cast<float>(c));
      arrays.points.push_back(0);
    }
    arrays.ids.push_back(g);
    arrays.first_point.push_back(static_cast<uint32_t>(arrays.points.size() / 4));
  }
  return Strands(std::move(arrays));
}

}  // namespace pelage
