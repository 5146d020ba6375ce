// SPDX-License-Identifier: Apache-2.0
#include "render/gather/coat_cells.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "lod/lod_view.h"
#include "render/frame/rest_place.h"

namespace pelage {
namespace {

constexpr int kMinSizeExponent = -60, kMaxSizeExponent = 60;

}  // namespace

CoatCells::CoatCells(const Camera& camera, const std::vector<FurPart>& fur, float samples)
    : fur_(fur), view_(camera.lod_view()), samples_(samples) {}

float CoatCells::samples_on(const Strands& strand, float length) const {
  float radius = 0;
  const uint32_t points = strand.strand_points(0);
  for (uint32_t i = 0; i < points; ++i) radius += strand.radius(i);
  const float width = 2 * radius / static_cast<float>(points) * pixels_per_unit(view_, strand.point(0));
  return samples_ * width * length;
}

uint64_t CoatCells::key(const Hit& hit, const Strands& strand, float length, float place,
                        uint64_t random) const {
  const uint64_t key = cube(hit, strand, kPixels, random);
  const int level = level_of(length, kPixels);
  const float u = unit_float(hash64(random_use("part of a strand"), random));
  return hash64(key, pack(level, gather_point_near(place, level, u)));
}

uint64_t CoatCells::patch(const Hit& hit, const Strands& strand) const {
  return cube(hit, strand, kPatchPixels, hash64(random_use("patch of a coat"), hit.part, hit.strand_id));
}

uint64_t CoatCells::cube(const Hit& hit, const Strands& strand, float side, uint64_t random) const {
  const RestPlace root = rest_place(fur_[hit.part], strand);
  const float pixels = root.scale * pixels_per_unit(view_, strand.point(0));
  const int exponent = std::clamp(std::ilogb(side / pixels), kMinSizeExponent, kMaxSizeExponent);
  uint64_t key =
      hash64(random_use("cell of a coat"), hit.part, side_of(root.normal), static_cast<uint32_t>(exponent));
  for (int axis = 0; axis < 3; ++axis) {
    random = mix64(random);
    const double at = std::ldexp(double{root.position[axis]}, -exponent) + unit_float(random) - 0.5;
    key = hash64(key, static_cast<uint64_t>(static_cast<int64_t>(std::floor(at))));
  }
  return key;
}

}  // namespace pelage
