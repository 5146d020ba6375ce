// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/coat_stats.h"

#include <cmath>
#include <numeric>
#include <vector>

#include "procedurals/detail/coat_sample.h"

namespace pelage {
namespace {

constexpr uint64_t kStatsSample = 256;

struct Sums {
  double strands = 0, length = 0, area = 0;
};

/// Sums along the control polygon.
void add_strand_sums(const Strands& strands, size_t strand, Sums& sums) {
  const uint32_t first = strands.first_point(strand), count = strands.strand_points(strand);
  sums.strands += 1;
  for (uint32_t p = first + 1; p < first + count; ++p) {
    const double step = (strands.point(p) - strands.point(p - 1)).length();
    sums.length += step;
    sums.area += step * (strands.radius(p) + strands.radius(p - 1));
  }
}

/// Areas from 2 x 2 points per face.
std::vector<double> face_areas(const LimitSurface& surface) {
  const SurfaceTopology& topology = surface.topology();
  const float low = 0.5f - 0.5f / std::sqrt(3.0f), high = 1 - low;
  const bool triangles = topology.is_triangular();
  std::vector<double> areas(topology.face_count(), 0.0);
  const auto add = [&](uint32_t face, float u, float v, double weight) {
    const SurfacePoint point = surface.evaluate(face, u, v);
    areas[face] += weight * point.du.cross(point.dv).length();
  };
  for (uint32_t face = 0; face < topology.face_count(); ++face) {
    if (topology.is_hole(face)) continue;
    if (triangles) {
      add(face, 1 / 6.0f, 1 / 6.0f, 1 / 6.0);
      add(face, 2 / 3.0f, 1 / 6.0f, 1 / 6.0);
      add(face, 1 / 6.0f, 2 / 3.0f, 1 / 6.0);
    } else {
      for (const float u : {low, high}) {
        for (const float v : {low, high}) add(face, u, v, 0.25);
      }
    }
  }
  return areas;
}

/// Strands per unit of skin area, averaged over the strands.
double density(const FollicleTree& follicles, const std::vector<double>& areas) {
  std::vector<double> strands(areas.size(), 0.0);
  for (const RootAddress& root : follicles.roots()) ++strands[root.face];
  double sum = 0;
  for (size_t face = 0; face < areas.size(); ++face) {
    if (areas[face] > 0) sum += strands[face] * (strands[face] - 1) / areas[face];
  }
  return follicles.size() > 0 ? sum / static_cast<double>(follicles.size()) : 0;
}

}  // namespace

CoatStats coat_stats(const Groom& groom, const LimitSurface* rest, const Workers& workers) {
  Sums sums;
  visit_coat_sample(groom, rest, kStatsSample, workers,
                    [&](const Strands& strands, size_t s) { add_strand_sums(strands, s, sums); });
  CoatStats stats;
  if (!(sums.length > 0)) return stats;
  stats.width = static_cast<float>(sums.area / sums.length);
  stats.length = static_cast<float>(sums.length / sums.strands);
  stats.even = groom.has_priority_order();
  if (rest) {
    const std::vector<double> areas = face_areas(*rest);
    stats.area_share =
        static_cast<float>(sums.area / sums.strands / std::accumulate(areas.begin(), areas.end(), 0.0));
    stats.density = static_cast<float>(density(groom.follicles(), areas));
  }
  return stats;
}

}  // namespace pelage
