// SPDX-License-Identifier: Apache-2.0
#include "lab/pictures/error_region.h"

#include <utility>
#include <vector>

namespace pelage {
namespace {

constexpr double kSquaredTangent = 0.05;

/// Squared length of the layer of the region, which is alpha or the vector `tangent`.
std::optional<Plane> squared_layer(const ExrImage& image, ErrorRegion region) {
  Plane squares(image.width, image.height);
  for (const char* name : region == ErrorRegion::kFur
                              ? std::vector<const char*>{"tangent.X", "tangent.Y", "tangent.Z"}
                              : std::vector<const char*>{"A"}) {
    const ExrChannel* channel = image.find(name);
    if (!channel || channel->pixels.size() != squares.pixels.size()) return {};
    for (size_t p = 0; p < squares.pixels.size(); ++p)
      squares.pixels[p] += double{channel->pixels[p]} * channel->pixels[p];
  }
  return squares;
}

}  // namespace

std::optional<Plane> region_of(const ExrImage& a, const ExrImage& b, ErrorRegion region) {
  if (a.width != b.width || a.height != b.height) return {};
  const std::optional<Plane> in_a = squared_layer(a, region), in_b = squared_layer(b, region);
  if (!in_a || !in_b) return {};
  const double limit = region == ErrorRegion::kFur ? kSquaredTangent : 0;
  Plane inside(a.width, a.height);
  for (size_t p = 0; p < inside.pixels.size(); ++p)
    inside.pixels[p] = in_a->pixels[p] > limit && in_b->pixels[p] > limit;
  return inside;
}

std::optional<std::array<Plane, 3>> color_planes(const ExrImage& image) {
  const auto plane = [&](const char* name) {
    const ExrChannel* channel = image.find(name);
    return channel && !channel->pixels.empty() ? Plane(image.width, image.height, channel->pixels)
                                               : Plane(0, 0);
  };
  std::array<Plane, 3> planes{plane("R"), plane("G"), plane("B")};
  for (const Plane& channel : planes) {
    if (channel.pixels.empty()) return {};
  }
  return planes;
}

}  // namespace pelage
