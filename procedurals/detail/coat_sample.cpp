// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/coat_sample.h"

#include <algorithm>
#include <vector>

#include "base/parallel.h"
#include "geom/closest_point.h"
#include "geom/tessellation.h"

namespace pelage {
namespace {

struct Place {
  uint64_t id;
  size_t batch, strand;
};

}  // namespace

void visit_coat_sample(const Groom& groom, const LimitSurface* rest, uint64_t count, const Workers& workers,
                       const std::function<void(const Strands&, size_t strand)>& visit) {
  PosedSkin pose;
  if (rest) pose.keys = {rest, 1};
  SkinMesh mesh;
  std::vector<ClosestPointTree> trees;
  if (groom.needs_closest_point()) {
    const View view;  // so distant that no face is large
    mesh = tessellate(pose.keys, view, {}, workers);
    trees.emplace_back(mesh, 0);
    pose.trees = trees;
  }
  const FollicleTree& follicles = groom.follicles();
  std::vector<Strands> batches;
  std::vector<Place> places;
  for (size_t leaf = 0; leaf < follicles.leaves().size(); ++leaf) {
    std::vector<uint32_t> sample;
    const FollicleTree::Leaf& range = follicles.leaves()[leaf];
    for (uint32_t f = range.begin; f < range.end && follicles.id(f) < count; ++f)
      sample.push_back(f - range.begin);
    if (sample.empty()) continue;
    const std::vector<float> width(sample.size(), 1.0f);
    const KeptStrands kept{sample, width, {}};
    batches.push_back(groom.grow(leaf, pose, &kept));
    for (size_t s = 0; s < sample.size(); ++s)
      places.push_back({batches.back().id(s), batches.size() - 1, s});
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.id < b.id; });
  for (const Place& place : places) visit(batches[place.batch], place.strand);
}

}  // namespace pelage
