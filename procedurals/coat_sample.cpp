// SPDX-License-Identifier: Apache-2.0
#include "procedurals/coat_sample.h"

#include <vector>

#include "base/parallel.h"
#include "geom/closest_point.h"
#include "geom/tessellation.h"

namespace pelage {

void visit_coat_sample(const Groom& groom, const LimitSurface* rest, uint64_t count, const Workers& workers,
                       const std::function<void(const Strands&)>& visit) {
  PosedSkin pose;
  if (rest) pose.keys = {rest, 1};
  SkinMesh mesh;
  std::vector<ClosestPointTree> trees;
  if (groom.needs_closest_point()) {
    const View view;  // from which no face is large
    mesh = tessellate(pose.keys, view, {}, workers);
    trees.emplace_back(mesh, 0);
    pose.trees = trees;
  }
  const FollicleTree& follicles = groom.follicles();
  for (size_t leaf = 0; leaf < follicles.leaves().size(); ++leaf) {
    std::vector<uint32_t> sample;
    const FollicleTree::Leaf& range = follicles.leaves()[leaf];
    for (uint32_t f = range.begin; f < range.end && follicles.id(f) < count; ++f)
      sample.push_back(f - range.begin);
    if (sample.empty()) continue;
    const std::vector<float> width(sample.size(), 1.0f);
    const KeptStrands kept{sample, width, {}};
    visit(groom.grow(leaf, pose, &kept));
  }
}

}  // namespace pelage
