// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles/follicles.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/parallel.h"
#include "groom/follicles/follicle_candidates.h"
#include "tests/groom/scene_text.h"
#include "tests/groom/shapes.h"
#include "tests/support/quiet_job.h"

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
  return FollicleTree::build(rest, options, QuietJob(threads));
}

TEST(Follicles, EveryPrefixIsBlueNoise) {
  for (const ControlMesh& cage : {shapes::square_cage(6), shapes::ball_cage()}) {
    const auto rest = shapes::surface_of(cage);
    const size_t count = 20000;
    const FollicleTree tree = grow(*rest, static_cast<int64_t>(count));
    ASSERT_EQ(tree.size(), count);
    const std::vector<Placed> places = by_id(tree, *rest);
    const double area = measure_surface(*rest, FollicleDensity(), QuietJob(1)).area;
    for (size_t prefix = count; prefix >= 300; prefix /= 2) {
      // Largest possible distance of that many points: hexagons [Yuksel15, section 3.1].
      const double max = 2 * std::sqrt(area / (2 * std::sqrt(3.0) * static_cast<double>(prefix)));
      const float distance = smallest_distance(places, prefix, static_cast<float>(max));
      EXPECT_GT(distance / max, 0.6) << prefix;
      RecordProperty("ratio", std::to_string(distance / max));
    }
  }
}

TEST(Follicles, IdsDoNotDependOnLeavesOrThreads) {
  const auto rest = shapes::surface_of(shapes::ball_cage());
  const Field density = scene_text::read<Field>("{ramp: {along: y, knots: [[-1, 0], [1, 1]]}}");
  const auto places = by_id(grow(*rest, 5000, density, 8000, 1), *rest);
  for (const auto& [leaf, threads] : {std::pair{8000, 4}, std::pair{100, 3}, std::pair{1, 2}}) {
    const FollicleTree tree = grow(*rest, 5000, density, leaf, threads);
    const auto same = by_id(tree, *rest);
    ASSERT_EQ(same.size(), places.size());
    for (size_t i = 0; i < same.size(); ++i) {
      ASSERT_EQ(same[i].root.face, places[i].root.face);
      ASSERT_EQ(same[i].root.u, places[i].root.u);
      ASSERT_EQ(same[i].root.v, places[i].root.v);
    }
    uint32_t next = 0;
    for (const FollicleTree::Leaf& l : tree.leaves()) {
      EXPECT_EQ(l.begin, next);
      EXPECT_LE(l.end - l.begin, static_cast<uint32_t>(leaf));
      for (uint32_t f = l.begin; f < l.end; ++f) {
        EXPECT_TRUE(f == l.begin || tree.id(f - 1) < tree.id(f));
        const RootAddress& root = tree.root(f);
        EXPECT_TRUE(l.rest_roots.intersects(rest->evaluate(root.face, root.u, root.v).position));
      }
      next = l.end;
    }
    EXPECT_EQ(next, tree.size());
  }
}

TEST(Follicles, LeavesAreCompact) {
  const auto rest = shapes::surface_of(shapes::ball_cage());
  const FollicleTree tree = grow(*rest, 20000, Field(1.0f), 300);
  // A leaf's share of the area would fit a square of this side.
  const double area = measure_surface(*rest, FollicleDensity(), QuietJob(1)).area;
  const double side = std::sqrt(area / static_cast<double>(tree.leaves().size()));
  double sum = 0;
  for (const FollicleTree::Leaf& leaf : tree.leaves()) {
    const V3f size = leaf.rest_roots.size();
    sum += std::max({size.x, size.y, size.z});
  }
  EXPECT_LT(sum / static_cast<double>(tree.leaves().size()), 2.0 * side);
  EXPECT_LT(tree.leaves().size(), 20000 / 300 * 5 / 4);
}

/// Chi-square of follicles on the unit square against a density, in n x n cells; cells expect `mass(i, j)`.
template <class Mass>
double chi_square(const std::vector<Placed>& places, int n, const Mass& mass, int& cells) {
  std::vector<double> seen(static_cast<size_t>(n * n), 0.0), expected(seen);
  const auto at = [n](float x) { return std::clamp(static_cast<int>(x * static_cast<float>(n)), 0, n - 1); };
  for (const Placed& p : places) seen[static_cast<size_t>(at(p.position.y) * n + at(p.position.x))] += 1;
  double total = 0;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) total += expected[static_cast<size_t>(j * n + i)] = mass(i, j);
  }
  double chi = 0;
  cells = 0;
  for (size_t k = 0; k < seen.size(); ++k) {
    const double e = expected[k] / total * static_cast<double>(places.size());
    if (e == 0) {
      EXPECT_EQ(seen[k], 0);
      continue;
    }
    chi += (seen[k] - e) * (seen[k] - e) / e;
    ++cells;
  }
  return chi;
}

TEST(Follicles, DensityFollowsAMap) {
  const auto rest = shapes::surface_of(shapes::square_cage(5));
  // Along x: none, then rising to full, then even. Blue noise varies less than independent points would,
  // whose chi-square has as mean the number of cells.
  const Field density =
      scene_text::read<Field>("{ramp: {along: x, knots: [[0, 0], [0.25, 0], [0.75, 1], [1, 1]]}}");
  const auto places = by_id(grow(*rest, 20000, density), *rest);
  int cells = 0;
  const double chi = chi_square(
      places, 16,
      [](int i, int) {
        double sum = 0;
        for (int k = 0; k < 100; ++k) sum += std::clamp(((i + (k + 0.5) / 100) / 16 - 0.25) * 2, 0.0, 1.0);
        return sum;
      },
      cells);
  EXPECT_EQ(cells, 12 * 16);
  EXPECT_LT(chi, cells);
  // The same for the first half of the ids: every prefix has the density.
  const double half = chi_square(
      {places.begin(), places.begin() + 10000}, 8,
      [](int i, int) {
        double sum = 0;
        for (int k = 0; k < 100; ++k) sum += std::clamp(((i + (k + 0.5) / 100) / 8 - 0.25) * 2, 0.0, 1.0);
        return sum;
      },
      cells);
  EXPECT_LT(half, cells);
}

TEST(Follicles, CountComesFromDensityPerArea) {
  const auto rest = shapes::surface_of(shapes::square_cage(4));
  FollicleOptions options;
  options.per_area = 1;
  options.density = scene_text::read<Field>("{ramp: {along: y, knots: [[0, 0], [1, 6000]]}}");
  EXPECT_NEAR(static_cast<double>(FollicleTree::build(*rest, options, QuietJob(2)).size()), 3000, 10);
  options.density = Field(0.0f);
  EXPECT_EQ(FollicleTree::build(*rest, options, QuietJob(2)).size(), 0u);
  EXPECT_EQ(FollicleTree::build(*rest, options, QuietJob(2)).leaves().size(), 0u);
  options.density = Field(1e12f);
  EXPECT_THROW(FollicleTree::build(*rest, options, QuietJob(2)), Error);
  options.count = 1;
  EXPECT_EQ(FollicleTree::build(*rest, options, QuietJob(2)).size(), 1u);
}

TEST(Follicles, IdsSayNothingAboutPlaces) {
  const auto rest = shapes::surface_of(shapes::ball_cage());
  const auto places = by_id(grow(*rest, 40000), *rest);
  const auto n = static_cast<double>(places.size());
  for (int axis = 0; axis < 3; ++axis) {
    double sum = 0, square = 0;
    for (size_t i = 0; i < places.size(); ++i) {
      const double order = (static_cast<double>(i) + 0.5) / n - 0.5;
      sum += order * places[i].position[axis];
      square += places[i].position[axis] * places[i].position[axis];
    }
    EXPECT_LT(std::fabs(sum / n) / std::sqrt(square / n / 12), 0.01) << axis;
  }
}

TEST(Follicles, TheTwoSidesOfAThinEarAreApart) {
  // A flat box, a hundredth of the mean distance of follicles thick: each side is as dense as it would be
  // alone.
  ControlMesh box = shapes::ball_cage();
  for (V3f& p : box.positions) p.z *= 0.0005f;
  const auto rest = shapes::surface_of(box);
  const auto places = by_id(grow(*rest, 2000), *rest);
  const auto front =
      std::count_if(places.begin(), places.end(), [](const Placed& p) { return p.normal.z > 0.5f; });
  EXPECT_NEAR(static_cast<double>(front), 1000, 30);
  // Were the sides to shun each other, no two follicles could lie closer, back or front.
  int close = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    for (size_t j = 0; j < i; ++j) close += (places[i].position - places[j].position).length() < 0.01f;
  }
  EXPECT_GT(close, 50);
}

}  // namespace
}  // namespace pelage
