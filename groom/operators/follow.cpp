// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/follow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "geom/four_lanes.h"
#include "geom/limit_surface.h"
#include "groom/operators/push_out.h"
#include "groom/strands/near_roots.h"
#include "groom/strands/part_lines.h"
#include "groom/strands/strand_batch.h"

namespace pelage {
namespace {

constexpr size_t kMaxGuides = 8;
constexpr size_t kLanes = 4;

/// The guides that turn one strand, nearest first.
struct Influences {
  size_t count = 0;                            // 0: no guide is near
  std::array<const float*, kMaxGuides> turns;  // of the first segment of each
  std::array<float, kMaxGuides> weight;
};

/// Rows become columns.
void transpose(std::array<Four, 4>& m) {
  const Four a = __builtin_shufflevector(m[0], m[1], 0, 4, 1, 5),
             b = __builtin_shufflevector(m[0], m[1], 2, 6, 3, 7);
  const Four c = __builtin_shufflevector(m[2], m[3], 0, 4, 1, 5),
             d = __builtin_shufflevector(m[2], m[3], 2, 6, 3, 7);
  m = {__builtin_shufflevector(a, c, 0, 1, 4, 5), __builtin_shufflevector(a, c, 2, 3, 6, 7),
       __builtin_shufflevector(b, d, 0, 1, 4, 5), __builtin_shufflevector(b, d, 2, 3, 6, 7)};
}

/// Returns the weighted sum (x, y, z, w) of the turns of a segment. Negates turns in the hemisphere of
/// quaternions opposite to the turn of the nearest guide: they mean the same rotation.
Four mean_turn(const Influences& guides, size_t segment) {
  Four sum = four(0);
  const Four nearest = guides.count > 0 ? load_four(guides.turns[0] + 4 * segment) : sum;
  for (size_t first = 0; first < guides.count; first += kLanes) {
    const size_t last = std::min(first + kLanes, guides.count);
    std::array<Four, kLanes> turns{};
    for (size_t k = first; k < last; ++k) turns[k - first] = load_four(guides.turns[k] + 4 * segment);
    std::array<Four, kLanes> parts = turns;
    transpose(parts);
    const Four cosine =
        parts[0] * nearest[0] + parts[1] * nearest[1] + parts[2] * nearest[2] + parts[3] * nearest[3];
    for (size_t k = first; k < last; ++k)
      sum += turns[k - first] * (cosine[k - first] < 0 ? -guides.weight[k] : guides.weight[k]);
  }
  return sum;
}

/// Returns turned vectors minus the vectors. `turn`: x, y, z and w of quaternions of any length.
FourVectors movement_of(const std::array<Four, 4>& turn, const FourVectors& x) {
  const FourVectors v{turn[0], turn[1], turn[2]};
  const Four w = turn[3], size2 = v.dot(v) + w * w;
  const FourVectors t = v.cross(x) * four(2);
  const FourVectors movement = (t * w + v.cross(t)) * (1 / size2);
  const Four none = four(0);
  return {size2 > 0 ? movement.x : none, size2 > 0 ? movement.y : none, size2 > 0 ? movement.z : none};
}

/// Finds the guides of a strand. `turns`: of all guides, from which the result points.
template <class Accept>
Influences find_influences(const NearRoots& roots, float max_radius, int neighbours, const V3f& root,
                           const V3f& normal, const float* turns, size_t segments, const Accept& accept) {
  std::array<RootGrid::Neighbour, kMaxGuides + 1> near;
  const int found = roots.nearest_if(root, normal, near.data(), accept);
  Influences guides;
  guides.count = static_cast<size_t>(std::min(found, neighbours));
  if (guides.count == 0) return guides;
  const float radius = found > neighbours ? near[guides.count].distance : max_radius;
  float total = 0;
  for (size_t k = 0; k < guides.count; ++k) {
    guides.turns[k] = turns + 4 * (near[k].index * segments);
    const float x = radius > 0 ? std::max(0.0f, 1 - near[k].distance / radius) : 0.0f;
    total += guides.weight[k] = x * x;
  }
  if (!(total > 1e-12f)) std::fill_n(guides.weight.begin(), guides.count, 1.0f);
  return guides;
}

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
  NearRoots roots(guides_->roots, neighbours_ + 1);
  roots.collect(batch.rest, batch.count);
  for (size_t first = 0; first < batch.count; first += kLanes) {
    std::array<Influences, kLanes> guides{};
    for (size_t lane = 0; lane < kLanes && first + lane < batch.count; ++lane) {
      const V3f root = vector_at(batch.rest.position, first + lane),
                normal = vector_at(batch.rest.normal, first + lane);
      guides[lane] = find_influences(
          roots, guides_->roots.radius(), neighbours_, root, normal, batch.turns->data(), segments,
          [&](uint32_t i) { return !divides(parts_, root, normal, guides_->roots.position(i)); });
    }
    const auto offsets = [&](size_t point) {
      const VectorRow& row = batch.points[point].offset;
      return FourVectors{load_four(&row[0][first]), load_four(&row[1][first]), load_four(&row[2][first])};
    };
    // A strand whose guides are not turned stays bit for bit.
    FourVectors before = offsets(0), shift{four(0), four(0), four(0)};
    for (size_t p = 0; p < segments; ++p) {
      std::array<Four, kLanes> turns;
      for (size_t lane = 0; lane < kLanes; ++lane) turns[lane] = mean_turn(guides[lane], p);
      transpose(turns);
      const FourVectors here = offsets(p + 1);
      shift = shift + movement_of(turns, here - before);
      before = here;
      VectorRow& row = batch.points[p + 1].offset;
      const FourVectors moved = here + shift;
      store_four(&row[0][first], moved.x);
      store_four(&row[1][first], moved.y);
      store_four(&row[2][first], moved.z);
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
