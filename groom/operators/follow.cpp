// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/follow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "geom/limit_surface.h"
#include "groom/operators/push_out.h"
#include "groom/strands/part_lines.h"
#include "groom/strands/strand_batch.h"

namespace pelage {
namespace {

constexpr size_t kMostGuides = 8;

struct Turn {
  V3f v{0};
  float w = 0;
  void add(const float* q, float weight) {
    v += V3f(q[0], q[1], q[2]) * weight;
    w += q[3] * weight;
  }
  /// Difference between the turned vector and the vector.
  V3f change_of(const V3f& x) const {
    const float size2 = v.dot(v) + w * w;
    if (!(size2 > 0)) return V3f(0);
    const V3f t = v.cross(x) * 2.0f;
    return (t * w + v.cross(t)) * (1 / size2);
  }
};

/// Median distance from a root to the nearest other one, of a sample of the roots.
float spacing_of(const std::vector<V3f>& roots, const std::vector<V3f>& normals, float otherwise) {
  std::vector<float> distances;
  for (size_t i = 0; i < roots.size(); i += std::max<size_t>(1, roots.size() / 200)) {
    float nearest = std::numeric_limits<float>::infinity();
    for (size_t j = 0; j < roots.size(); ++j) {
      if (j != i && RootGrid::same_side(normals[i], normals[j]))
        nearest = std::min(nearest, (roots[i] - roots[j]).length2());
    }
    if (std::isfinite(nearest) && nearest > 0) distances.push_back(std::sqrt(nearest));
  }
  if (distances.empty()) return otherwise;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace

void MovingGuides::place(size_t count, const FollicleTree& coat, const LimitSurface& rest) {
  follicles.resize(coat.size());
  std::iota(follicles.begin(), follicles.end(), 0u);
  count = std::min(count, follicles.size());
  const auto middle = follicles.begin() + static_cast<std::ptrdiff_t>(count);
  std::nth_element(follicles.begin(), middle, follicles.end(),
                   [&](uint32_t a, uint32_t b) { return coat.id(a) < coat.id(b); });
  follicles.resize(count);
  follicles.shrink_to_fit();
  std::sort(follicles.begin(), follicles.end(),
            [&](uint32_t a, uint32_t b) { return coat.id(a) < coat.id(b); });
  std::vector<V3f> positions, normals;
  for (const uint32_t f : follicles) {
    const RootAddress& root = coat.root(f);
    positions.push_back(rest.evaluate(root.face, root.u, root.v).position);
    normals.push_back(rest.frame(root.face, root.u, root.v).normal);
  }
  const float size = rest.control_bounds().size().length();
  const float radius = std::min(size, 4 * spacing_of(positions, normals, size));
  roots = RootGrid(std::move(positions), std::move(normals), radius);
}

void Follow::apply(StrandBatch& batch) const {
  if (!batch.turns) return;
  const auto segments = static_cast<size_t>(batch.segment_count());
  std::array<RootGrid::Neighbour, kMostGuides + 1> near;
  std::array<float, kMostGuides> weight;
  for (size_t s = 0; s < batch.count; ++s) {
    const V3f root = vector_at(batch.rest.position, s), normal = vector_at(batch.rest.normal, s);
    const int found = guides_->roots.nearest_if(root, normal, neighbours_ + 1, near.data(), [&](uint32_t i) {
      return !divides(parts_, root, normal, guides_->roots.position(i));
    });
    if (found == 0) continue;
    const auto count = static_cast<size_t>(std::min(found, neighbours_));
    const float radius = found > neighbours_ ? near[count].distance : guides_->roots.radius();
    float total = 0;
    for (size_t k = 0; k < count; ++k) {
      const float x = radius > 0 ? std::max(0.0f, 1 - near[k].distance / radius) : 0.0f;
      total += weight[k] = x * x;
    }
    if (!(total > 1e-12f)) std::fill_n(weight.begin(), count, 1.0f);
    V3f before = batch.offset(0, s), shift(0);  // a strand whose guides are not turned stays bit for bit
    for (size_t p = 0; p < segments; ++p) {
      Turn turn;
      const float* nearest = batch.turns->data() + 4 * (near[0].index * segments + p);
      for (size_t k = 0; k < count; ++k) {
        const float* q = batch.turns->data() + 4 * (near[k].index * segments + p);
        const float cosine = q[0] * nearest[0] + q[1] * nearest[1] + q[2] * nearest[2] + q[3] * nearest[3];
        turn.add(q, cosine < 0 ? -weight[k] : weight[k]);
      }
      const auto point = static_cast<int>(p + 1);
      const V3f here = batch.offset(point, s);
      shift += turn.change_of(here - before);
      before = here;
      batch.set_offset(point, s, here + shift);
    }
  }
}

StrandReach Follow::reach_after(const StrandReach& before) const {
  StrandReach after = before;
  after.length *= 1.00001f;  // rounding
  after.distance = after.length;
  after.lean = std::numbers::pi_v<float>;
  return after;
}

size_t follow_place(const DynamicsParams& params, const OperatorList& list) {
  const auto named = [&](const OperatorList::Item& item) { return item.name == params.after.name; };
  if (!params.after.name.empty()) {
    const auto last = std::find_if(list.items.rbegin(), list.items.rend(), named);
    return static_cast<size_t>(list.items.rend() - last);
  }
  const auto pushes = [](const OperatorList::Item& item) { return item.name == PushOut::kName; };
  return static_cast<size_t>(std::find_if(list.items.begin(), list.items.end(), pushes) - list.items.begin());
}

OperatorList::Item follow_item(const DynamicsParams& params, std::shared_ptr<const MovingGuides> guides) {
  OperatorList::Item item;
  item.name = Follow::kName;
  item.prototype = std::make_shared<const Follow>(
      params.neighbours, std::move(guides),
      params.guides ? std::to_string(*params.guides) : params.default_guides());
  item.clone = [](const Operator& op) -> std::unique_ptr<Operator> {
    return std::make_unique<Follow>(static_cast<const Follow&>(op));
  };
  return item;
}

}  // namespace pelage
