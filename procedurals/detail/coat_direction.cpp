// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/coat_direction.h"

#include <algorithm>
#include <cmath>

#include "procedurals/detail/coat_sample.h"

namespace pelage {
namespace {

constexpr uint64_t kSample = 8192;
constexpr float kCells = 24;  // along the longest side of a skin
// Length of a mean of unit vectors above which it defines a direction.
constexpr float kKnown = 0.5f;

}  // namespace

CoatDirection::CoatDirection(const Groom& groom, std::shared_ptr<const LimitSurface> rest,
                             const Workers& workers)
    : rest_(std::move(rest)) {
  const Box3f box = rest_->control_bounds();
  const V3f size = box.size();
  origin_ = box.min;
  cell_ = std::max({size.x, size.y, size.z, 1e-6f}) / kCells;
  for (unsigned axis = 0; axis < 3; ++axis) nodes_[axis] = static_cast<int>(size[axis] / cell_) + 2;
  const size_t count =
      static_cast<size_t>(nodes_[0]) * static_cast<size_t>(nodes_[1]) * static_cast<size_t>(nodes_[2]);
  directions_.assign(count, V3f(0));
  std::vector<float> weights(count, 0.0f);
  visit_coat_sample(groom, rest_.get(), kSample, workers, [&](const Strands& strands, size_t s) {
    const uint32_t first = strands.first_point(s);
    const V3f root = strands.point(first);
    const V3f direction = (strands.point(first + strands.strand_points(s) - 1) - root).normalized();
    visit_nodes(root, [&](size_t node, float weight) {
      directions_[node] += weight * direction;
      weights[node] += weight;
    });
  });
  for (size_t node = 0; node < count; ++node) {
    if (weights[node] > 0) directions_[node] /= weights[node];
  }
}

template <class Use>
void CoatDirection::visit_nodes(const V3f& place, const Use& use) const {
  int base[3];
  float t[3];
  for (unsigned axis = 0; axis < 3; ++axis) {
    const float x =
        std::clamp((place[axis] - origin_[axis]) / cell_, 0.0f, static_cast<float>(nodes_[axis] - 1));
    base[axis] = std::min(static_cast<int>(x), nodes_[axis] - 2);
    t[axis] = x - static_cast<float>(base[axis]);
  }
  for (int corner = 0; corner < 8; ++corner) {
    float weight = 1;
    size_t node = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const int high = (corner >> axis) & 1;
      weight *= high ? t[axis] : 1 - t[axis];
      node = node * static_cast<size_t>(nodes_[axis]) + static_cast<size_t>(base[axis] + high);
    }
    use(node, weight);
  }
}

V3f CoatDirection::at(const RootAddress& root, const SurfacePoint& posed) const {
  const SurfacePoint rest = rest_->evaluate(root.face, root.u, root.v);
  V3f mean(0);
  visit_nodes(rest.position, [&](size_t node, float weight) { mean += weight * directions_[node]; });
  mean /= std::max(mean.length(), kKnown);
  return LimitSurface::frame_of(posed).to_world(LimitSurface::frame_of(rest).to_local(mean));
}

}  // namespace pelage
