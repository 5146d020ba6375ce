// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/pilot_patch.h"

#include <cmath>

#include "base/hash.h"
#include "geom/curve.h"

namespace pelage {
namespace {

constexpr float kMostAround = 16000;  // strands of a patch, roughly
constexpr uint64_t kCounted = 16;     // one strand in so many is counted first
constexpr uint64_t kCountUse = random_use("strands around a pilot root");

/// `normal`: 0 without a skin.
void add_strand(const Strands& strands, size_t s, const V3f& normal, float priority, bool starts,
                PilotPatch& patch) {
  const auto number = static_cast<uint32_t>(patch.strands.size());
  const auto begin = static_cast<uint32_t>(patch.pieces.size());
  const uint32_t segments = segment_count(strands.basis(), strands.strand_points(s));
  for (uint32_t segment = 0; segment < segments; ++segment) {
    const CubicSegment c = bezier_segment(strands, s, segment);
    patch.pieces.push_back({c.p[0], c.p[3], c.r[0], c.r[3], number, segment == 0, segment + 1 == segments});
  }
  const auto end = static_cast<uint32_t>(patch.pieces.size());
  if (end == begin) return;
  const V3f along = patch.pieces.back().end - patch.pieces[begin].begin;
  const V3f up = normal.length2() > 0 ? normal : along;
  patch.strands.push_back({strands.id(s), priority, up, starts, begin, end});
}

/// `radius`, or a smaller one where strands are much denser than on average, so that a patch stays small.
float radius_around(const Groom& groom, const RestPose& rest, const V3f& middle, float radius) {
  const FollicleTree& follicles = groom.follicles();
  float around = 0;
  for (size_t f = 0; f < follicles.size(); ++f) {
    if (hash64(kCountUse, follicles.id(f)) % kCounted != 0) continue;
    if ((groom.root(f, rest.skin(), 0).position - middle).length() < radius) around += kCounted;
  }
  return around > kMostAround ? radius * std::sqrt(kMostAround / around) : radius;
}

}  // namespace

PilotPatch strands_around(const Groom& groom, const RestPose& rest, const EvenPriorities* priorities,
                          size_t follicle, float mean_radius, const Job& job) {
  const FollicleTree& follicles = groom.follicles();
  const V3f middle = groom.root(follicle, rest.skin(), 0).position;
  const float radius = radius_around(groom, rest, middle, mean_radius);
  PilotPatch patch;
  for (size_t leaf = 0; leaf < follicles.leaves().size(); ++leaf) {
    job.check_stop();
    const FollicleTree::Leaf& range = follicles.leaves()[leaf];
    std::vector<uint32_t> around;
    std::vector<float> distances;
    std::vector<V3f> normals;
    for (uint32_t f = range.begin; f < range.end; ++f) {
      const SurfacePoint root = groom.root(f, rest.skin(), 0);
      const float distance = (root.position - middle).length();
      if (!(distance < radius)) continue;
      around.push_back(f - range.begin);
      distances.push_back(distance);
      normals.push_back(root.du.cross(root.dv));
    }
    if (around.empty()) continue;
    const std::vector<float> width(around.size(), 1.0f);
    const KeptStrands kept{around, width, {}};
    const Strands strands = groom.grow(leaf, rest.skin(), &kept);
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      const size_t f = range.begin + around[s];
      add_strand(strands, s, normals[s], priorities ? (*priorities)[f] : groom.priority(f),
                 distances[s] < 0.5f * radius, patch);
    }
  }
  return patch;
}

}  // namespace pelage
