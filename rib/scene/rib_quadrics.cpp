// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "rib/scene/rib_grid_mesh.h"
#include "rib/scene/rib_surfaces.h"

namespace pelage {
namespace {

using Imath::V2d;

constexpr int kAround = 48, kAlong = 24;
constexpr double kRadians = std::numbers::pi / 180;

/// Cosine and sine of an angle in degrees. Multiples of 90 degrees are exact, so that seams and poles close.
V2d direction(double degrees) {
  const double quarter = degrees / 90;
  if (quarter == std::round(quarter)) {
    constexpr double kCosine[] = {1, 0, -1, 0};
    const int turn = static_cast<int>(std::fmod(quarter, 4));
    const size_t at = static_cast<size_t>(turn < 0 ? turn + 4 : turn);
    return {kCosine[at], kCosine[(at + 3) % 4]};
  }
  return {std::cos(degrees * kRadians), std::sin(degrees * kRadians)};
}

/// Numbers of the request before its parameters.
std::vector<double> sizes_of(const RibStatement& request, size_t count) {
  std::vector<double> numbers;
  for (const RibOperand& a : request.arguments) {
    if (!a.is_number()) break;
    for (size_t i = 0; i < a.size() && numbers.size() <= count; ++i) numbers.push_back(a.number(i));
  }
  if (numbers.size() != count)
    request.fail(fmt::format("expected {} numbers, got {}", count, numbers.size()));
  for (const double x : numbers) {
    if (!(std::abs(x) < 1e18)) request.fail("a number is not finite or beyond 1e18");
  }
  return numbers;
}

/// The distance from the axis and the height of a point of the profile, at v in [0, 1].
V2d profile(const std::string& name, const std::vector<double>& n, double v) {
  if (name == "Cone") return {n[1] * (1 - v), n[0] * v};
  if (name == "Cylinder") return {n[0], n[1] + v * (n[2] - n[1])};
  if (name == "Disk") return {n[1] * (1 - v), n[0]};
  if (name == "Paraboloid") {
    const double z = n[1] + v * (n[2] - n[1]);
    return {n[2] != 0 ? n[0] * std::sqrt(std::max(0.0, z / n[2])) : 0, z};
  }
  if (name == "Torus") {
    const V2d at = direction(n[2] + v * (n[3] - n[2]));
    return {n[0] + n[1] * at.x, n[1] * at.y};
  }
  const auto latitude = [&](double z, double pole) {
    return std::abs(z) >= std::abs(n[0]) ? (z < 0 ? -90.0 : 90.0)
           : n[0] == 0                   ? pole
                                         : std::asin(z / std::abs(n[0])) / kRadians;
  };
  const double low = latitude(n[1], -90), high = latitude(n[2], 90);
  const V2d at = direction(low + v * (high - low));
  return std::abs(n[0]) * at;
}

RibGrid quadric(const RibStatement& request) {
  const std::string& name = request.name;
  const bool hyperboloid = name == "Hyperboloid";
  const size_t count = hyperboloid ? 7 : name == "Torus" ? 5 : name == "Cone" || name == "Disk" ? 3 : 4;
  const std::vector<double> n = sizes_of(request, count);
  return RibGrid(kAround, kAlong, [&](int column, int row) {
    const double v = row / double{kAlong};
    const V2d turn = direction(n.back() * column / kAround);
    V2d at(0);
    double z = 0;
    if (hyperboloid) {
      at = V2d(n[0] + v * (n[3] - n[0]), n[1] + v * (n[4] - n[1]));
      z = n[2] + v * (n[5] - n[2]);
    } else {
      const V2d p = profile(name, n, v);
      at.x = p.x, z = p.y;
    }
    return V3f(static_cast<float>(at.x * turn.x - at.y * turn.y),
               static_cast<float>(at.x * turn.y + at.y * turn.x), static_cast<float>(z));
  });
}

}  // namespace

RibMesh read_quadric(std::span<RibStatement> samples) {
  std::vector<RibGrid> grids;
  for (const RibStatement& sample : samples) grids.push_back(quadric(sample));
  return grid_mesh(grids);
}

}  // namespace pelage
