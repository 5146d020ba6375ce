// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "groom/follicle_candidates.h"
#include "tests/groom/shapes.h"

namespace pelage {
namespace {

struct Placed {
  V3f position{0};
  V3f normal{0};
  RootAddress root;
};

/// Follicles by id.
std::vector<Placed> by_id(const FollicleTree& tree, const LimitSurface& rest) {
  std::vector<Placed> result(tree.size());
  for (size_t f = 0; f < tree.size(); ++f) {
    const RootAddress& root = tree.root(f);
    result[tree.id(f)] = {rest.evaluate(root.face, root.u, root.v).position,
                          rest.frame(root.face, root.u, root.v).normal, root};
  }
  return result;
}

/// Smallest distance between any two of the first `count`, whose normals lie within 60 degrees.
float smallest_distance(const std::vector<Placed>& places, size_t count, float cell) {
  std::map<std::array<int, 3>, std::vector<size_t>> grid;
  const auto key = [cell](const V3f& p, int dx, int dy, int dz) {
    return std::array{static_cast<int>(std::floor(p.x / cell)) + dx,
                      static_cast<int>(std::floor(p.y / cell)) + dy,
                      static_cast<int>(std::floor(p.z / cell)) + dz};
  };
  float best = cell;
  for (size_t i = 0; i < count; ++i) {
    const V3f& p = places[i].position;
    for (int k = 0; k < 27; ++k) {
      const auto found = grid.find(key(p, k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
      if (found == grid.end()) continue;
      for (size_t j : found->second) {
        if (places[i].normal.dot(places[j].normal) > 0.51f)
          best = std::min(best, (places[j].position - p).length());
      }
    }
    grid[key(p, 0, 0, 0)].push_back(i);
  }
  return best;
}

FollicleTree grow(const LimitSurface& rest, int64_t count, const Field& density = Field(1.0f),
                  int leaf = 8000, int threads = 2) {
  FollicleOptions options;
  options.count = count;
  options.density = density;
  options.seed = 7;
  options.leaf_strands = leaf;
  return FollicleTree::build(rest, options, Workers(threads));
}

TEST(Follicles, EveryPrefixIsBlueNoise) {
  for (const ControlMesh& cage : {shapes::square_cage(6), shapes::ball_cage()}) {
    const auto rest = shapes::surface_of(cage);
    const size_t count = 20000;
    const FollicleTree tree = grow(*rest, static_cast<int64_t>(count));
    ASSERT_EQ(tree.size(), count);
    const std::vector<Placed> places = by_id(tree, *rest);
    const double area = measure_surface(*rest, {}, Workers(1)).area;
    for (size_t prefix = count; prefix >= 300; prefix /= 2) {
      // Largest possible distance of that many points: hexagons [Yuksel15, section 3.1].
      const double most = 2 * std::sqrt(area / (2 * std::sqrt(3.0) * static_cast<double>(prefix)));
      const float distance = smallest_distance(places, prefix, static_cast<float>(most));
      EXPECT_GT(distance / most, 0.6) << prefix;
      RecordProperty("ratio", std::to_string(distance / most));
    }
  }
}

}  // namespace
}  // namespace pelage
