// SPDX-License-Identifier: Apache-2.0
#include "render/light/barn_doors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace pelage {
namespace {

constexpr float kFlapRadians = std::numbers::pi_v<float> / 180;

/// Whether a ray passes a flap: whether at the height of the flap's edge, the ray is inside of the edge.
/// `inside`: distance of the ray's start from the hinge. `slope`: of the ray, outwards, per height.
bool passes_flap(float inside, float slope, float length, float degrees) {
  const float height = length * std::cos(degrees * kFlapRadians);
  return slope * height - inside <= length * std::sin(degrees * kFlapRadians);
}

/// The edge of a flap in the plane across its hinge.
struct FlapEdge {
  float side, height;
};

/// Returns the smallest slope, of either sign, of the rays that pass between two opposite flaps; infinite if
/// none does. The rays start at height 0, between -`half` and `half`.
float least_slope(float half, const FlapEdge& low, const FlapEdge& high) {
  const auto least = [&](float place) { return (low.side - place) / low.height; };
  const auto most = [&](float place) { return (high.side - place) / high.height; };
  const auto gap = [&](float place) { return most(place) - least(place); };  // linear
  float from = -half, to = half;
  if (!(gap(from) > 0) && !(gap(to) > 0)) return std::numeric_limits<float>::infinity();
  if (!(gap(from) > 0) || !(gap(to) > 0)) {
    const float edge = from + (to - from) * gap(from) / (gap(from) - gap(to));
    (gap(from) > 0 ? to : from) = edge;
  }
  return std::max({0.0f, std::min(least(from), least(to)), -std::max(most(from), most(to))});
}

}  // namespace

bool BarnDoors::are_closed(const V2f& half_size, float max_slope) const {
  if (!(length > 0)) return false;
  const auto edge = [&](float half, float degrees, float outwards) {
    const float angle = degrees * kFlapRadians;
    return FlapEdge{outwards * (half + length * std::sin(angle)), length * std::cos(angle)};
  };
  const float x = least_slope(half_size.x, edge(half_size.x, left, -1), edge(half_size.x, right, 1));
  const float y = least_slope(half_size.y, edge(half_size.y, bottom, -1), edge(half_size.y, top, 1));
  return std::isinf(x) || std::isinf(y) || std::hypot(x, y) >= max_slope;
}

bool BarnDoors::pass(const V2f& place, const V2f& half_size, const V3f& direction) const {
  if (!(length > 0)) return true;
  const V2f slope(direction.x / direction.z, direction.y / direction.z);
  return passes_flap(half_size.x - place.x, slope.x, length, right) &&
         passes_flap(half_size.x + place.x, -slope.x, length, left) &&
         passes_flap(half_size.y - place.y, slope.y, length, top) &&
         passes_flap(half_size.y + place.y, -slope.y, length, bottom);
}

const Schema<BarnDoors>& BarnDoors::schema() {
  static const Schema<BarnDoors> table = [] {
    Schema<BarnDoors> s(
        "barn doors",
        "Four flaps at the sides of a rectangle block the light beside its beam. The camera does not see "
        "them. Sides are named as seen from the emitting side; a two-sided rectangle has the same flaps on "
        "both sides.");
    s.set_example(R"(lights:
  key:
    type: rectangle
    position: [-4, 6, 5]
    look_at: [0, 0.5, 0]
    size: [2, 2]
    power: 900
    barn_doors: {length: 1.5, left: 0, right: 20})");
    constexpr std::string_view kAngle = "Angle of this flap: 0 is straight ahead, 90 would be fully open";
    s.key("length", &BarnDoors::length,
          {.unit = "scene units",
           .help = "Length of the flaps, from the hinge to the edge",
           .required = true,
           .min = 0});
    s.key("left", &BarnDoors::left, {.unit = "degrees", .help = kAngle, .min = -60, .max = 89});
    s.key("right", &BarnDoors::right, {.unit = "degrees", .help = kAngle, .min = -60, .max = 89});
    s.key("top", &BarnDoors::top, {.unit = "degrees", .help = kAngle, .min = -60, .max = 89});
    s.key("bottom", &BarnDoors::bottom, {.unit = "degrees", .help = kAngle, .min = -60, .max = 89});
    return s;
  }();
  return table;
}

}  // namespace pelage
