// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "rib/scene/rib_grid_mesh.h"
#include "rib/scene/rib_surfaces.h"

namespace pelage {
namespace {

constexpr int kPerSegment = 8;
constexpr int64_t kMaxAcross = 10'000, kMaxFaces = 4'000'000;  // points in one direction; of the mesh

/// The points with their weights that the surface has at a place along one direction.
struct Blend {
  std::vector<size_t> points;
  std::vector<double> weights;
};

/// One direction of a surface: for each corner of the mesh, its points.
using Direction = std::vector<Blend>;

Direction bilinear(size_t points, bool periodic) {
  Direction direction;
  for (size_t i = 0; i < points + periodic; ++i) direction.push_back({{i % points}, {1}});
  return direction;
}

Direction bicubic(const RibStatement& request, const RibBasis& basis, size_t points, bool periodic) {
  const uint32_t segments = basis.segments(static_cast<uint32_t>(points), periodic);
  if (segments == 0)
    request.fail(fmt::format("{} points do not form whole segments of a bicubic patch", points));
  Direction direction;
  for (uint32_t i = 0; i <= segments * kPerSegment; ++i) {
    const uint32_t segment = std::min(i / kPerSegment, segments - 1);
    const auto weights = basis.weights(static_cast<float>(i - segment * kPerSegment) / kPerSegment);
    Blend blend;
    for (size_t k = 0; k < 4; ++k) {
      blend.points.push_back((segment * static_cast<size_t>(basis.step) + k) % points);
      blend.weights.push_back(weights[k]);
    }
    direction.push_back(std::move(blend));
  }
  return direction;
}

/// By the recursion of Cox and de Boor.
Blend spline(const std::vector<double>& knots, size_t points, size_t order, double t) {
  size_t span = order - 1;
  while (span + 1 < points && t >= knots[span + 1]) ++span;
  Blend blend{{}, {1}};
  for (size_t degree = 1; degree < order; ++degree) {
    std::vector<double> next(degree + 1, 0.0);
    for (size_t k = 0; k < degree; ++k) {
      const double low = knots[span + 1 + k - degree], high = knots[span + 1 + k];
      const double at = high > low ? (t - low) / (high - low) : 0;
      next[k] += (1 - at) * blend.weights[k];
      next[k + 1] += at * blend.weights[k];
    }
    blend.weights = std::move(next);
  }
  for (size_t k = 0; k < order; ++k) blend.points.push_back(span + 1 + k - order);
  return blend;
}

/// Reads one request.
class PatchReader {
 public:
  PatchReader(RibStatement& request, const RibDeclarations& declarations, const RibBasis& u,
              const RibBasis& v)
      : request_(request), declarations_(declarations), bases_{u, v} {}

  RibGrid read() {
    size_t parameters = 1;
    if (request_.name == "NuPatch") {
      for (size_t axis = 0; axis < 2; ++axis) read_spline(axis, 5 * axis);
      parameters = 10;
    } else {
      const std::string type = text(0);
      if (type != "bilinear" && type != "bicubic")
        request_.fail(request_.arguments[0],
                      "unknown type " + quote(type) + "; expected \"bilinear\" or \"bicubic\"");
      const bool mesh = request_.name == "PatchMesh", cubic = type == "bicubic";
      for (size_t axis = 0; axis < 2; ++axis) {
        count_[axis] = mesh ? count(1 + 2 * axis) : cubic ? 4 : 2;
        const bool periodic = mesh && text(2 + 2 * axis) == "periodic";
        if (!cubic && count_[axis] < 2) request_.fail("a bilinear patch needs 2 points along each direction");
        direction_[axis] = cubic ? bicubic(request_, bases_[axis], count_[axis], periodic)
                                 : bilinear(count_[axis], periodic);
      }
      if (mesh) parameters = 5;
    }
    read_points(parameters);
    const auto size = [&](size_t axis) { return static_cast<int>(direction_[axis].size()) - 1; };
    if (int64_t{size(0)} * size(1) > kMaxFaces) request_.fail("the surface has too many segments");
    return RibGrid(size(0), size(1), [&](int column, int row) {
      return point(direction_[0][static_cast<size_t>(column)], direction_[1][static_cast<size_t>(row)]);
    });
  }

 private:
  const RibOperand& argument(size_t i) const {
    if (i >= request_.arguments.size()) request_.fail(fmt::format("argument {} is missing", i + 1));
    return request_.arguments[i];
  }
  std::string text(size_t i) const {
    const RibOperand& a = argument(i);
    if (a.is_number() || a.size() != 1) request_.fail(a, "expected a name, got " + a.describe());
    return a.strings[0];
  }
  double number(size_t i) const {
    const RibOperand& a = argument(i);
    if (!a.is_number() || a.size() != 1) request_.fail(a, "expected a number, got " + a.describe());
    return a.number(0);
  }
  size_t count(size_t i) const {
    const double n = number(i);
    if (!(n >= 1 && n <= kMaxAcross)) request_.fail(argument(i), fmt::format("{} points", n));
    return static_cast<size_t>(n);
  }

  void read_spline(size_t axis, size_t first) {
    const size_t points = count_[axis] = count(first), order = count(first + 1);
    const RibOperand& a = argument(first + 2);
    if (!a.is_number() || a.size() != points + order || order > points || order > 16)
      request_.fail(a, fmt::format("{} points of order {} need {} knots, and an order of at most {}", points,
                                   order, points + order, std::min<size_t>(points, 16)));
    std::vector<double> knots;
    for (size_t i = 0; i < a.size(); ++i) {
      knots.push_back(a.number(i));
      if (!std::isfinite(knots[i]) || (i > 0 && knots[i] < knots[i - 1]))
        request_.fail(a, "knots must be finite and may not descend");
    }
    const double low = std::max(number(first + 3), knots[order - 1]),
                 high = std::min(number(first + 4), knots[points]);
    const int steps = static_cast<int>(points - order + 1) * (order > 2 ? kPerSegment : 1);
    for (int i = 0; i <= steps; ++i)
      direction_[axis].push_back(spline(knots, points, order, low + (high - low) * i / steps));
  }

  void read_points(size_t parameters) {
    std::vector<std::string> undeclared;
    const std::vector<RibNamedValue> all = declarations_.parameters(request_, parameters, undeclared);
    const RibNamedValue *p = find_parameter(all, "P"), *pw = find_parameter(all, "Pw"),
                        *pz = find_parameter(all, "Pz");
    const RibNamedValue* from = p ? p : pw ? pw : pz;
    components_ = from == pz ? 1 : p ? 3 : 4;
    if (!from || from->value->kind != RibOperand::Kind::kFloats ||
        from->value->size() != components_ * count_[0] * count_[1])
      request_.fail(
          fmt::format("parameter \"P\", \"Pw\" or \"Pz\" must have {} points", count_[0] * count_[1]));
    points_ = from->value->floats;
    if (from == pz) raise_points();
    for (const float x : points_) {
      if (!(std::abs(x) < 1e18f)) request_.fail(*from->value, "a point is not finite or beyond 1e18");
    }
  }

  // "Pz" states heights above the unit square [RISPEC 3.2, Patch].
  void raise_points() {
    const std::vector<float> heights = std::move(points_);
    points_.clear();
    components_ = 3;
    const size_t across = std::max<size_t>(count_[0] - 1, 1), up = std::max<size_t>(count_[1] - 1, 1);
    for (size_t i = 0; i < heights.size(); ++i)
      points_.insert(points_.end(), {static_cast<float>(i % count_[0]) / static_cast<float>(across),
                                     static_cast<float>(i / count_[0]) / static_cast<float>(up), heights[i]});
  }

  V3f point(const Blend& u, const Blend& v) const {
    double sum[4] = {0, 0, 0, 0};
    for (size_t j = 0; j < v.points.size(); ++j) {
      for (size_t i = 0; i < u.points.size(); ++i) {
        const double weight = u.weights[i] * v.weights[j];
        const float* p = &points_[components_ * (v.points[j] * count_[0] + u.points[i])];
        for (size_t k = 0; k < components_; ++k) sum[k] += weight * double{p[k]};
        if (components_ == 3) sum[3] += weight;
      }
    }
    const double w = components_ == 4 && sum[3] != 0 ? sum[3] : 1;
    return {static_cast<float>(sum[0] / w), static_cast<float>(sum[1] / w), static_cast<float>(sum[2] / w)};
  }

  RibStatement& request_;
  const RibDeclarations& declarations_;
  const RibBasis bases_[2];
  size_t count_[2] = {0, 0};  // points
  Direction direction_[2];
  size_t components_ = 3;
  std::vector<float> points_;
};

}  // namespace

RibMesh read_patches(std::span<RibStatement> samples, const RibDeclarations& declarations, const RibBasis& u,
                     const RibBasis& v) {
  std::vector<RibGrid> grids;
  for (RibStatement& sample : samples) {
    grids.push_back(PatchReader(sample, declarations, u, v).read());
    if (grids.back().columns != grids[0].columns || grids.back().rows != grids[0].rows)
      sample.fail("the patches of a motion block must have the same number of points");
  }
  return grid_mesh(grids);
}

}  // namespace pelage
