// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/root_spacing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "base/parallel.h"
#include "procedurals/detail/spread_follicles.h"

namespace pelage {
namespace {

constexpr size_t kSampledRoots = 32, kNeighbours = 8;

/// Returns the squared distance to the kNeighbours-th nearest other root.
double distance2_of_last(const Groom& groom, const PosedSkin& rest, size_t follicle) {
  const V3f from = groom.root(follicle, rest, 0).position;
  std::array<double, kNeighbours> nearest;
  nearest.fill(std::numeric_limits<double>::infinity());
  for (size_t other = 0; other < groom.follicles().size(); ++other) {
    const double distance2 = (groom.root(other, rest, 0).position - from).length2();
    if (other == follicle || !(distance2 < nearest.back())) continue;
    const auto place = std::upper_bound(nearest.begin(), nearest.end(), distance2);
    std::copy_backward(place, nearest.end() - 1, nearest.end());
    *place = distance2;
  }
  return nearest.back();
}

}  // namespace

float root_spacing(const Groom& groom, const Workers& workers) {
  if (groom.follicles().size() <= kNeighbours) return 0;
  const PosedSkin rest;
  const std::vector<size_t> roots = spread_follicles(groom, kSampledRoots);
  std::vector<double> areas(roots.size());
  workers.for_each(roots.size(), 1, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i)
      areas[i] = std::numbers::pi * distance2_of_last(groom, rest, roots[i]) / kNeighbours;
  });
  double sum = 0;
  for (const double area : areas) sum += area;
  return static_cast<float>(std::sqrt(sum / static_cast<double>(areas.size())));
}

}  // namespace pelage
