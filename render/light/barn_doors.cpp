// SPDX-License-Identifier: Apache-2.0
#include "render/light/barn_doors.h"

#include <cmath>
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

}  // namespace

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
