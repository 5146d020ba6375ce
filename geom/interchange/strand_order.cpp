// SPDX-License-Identifier: Apache-2.0
#include "geom/interchange/strand_order.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace pelage {
namespace {

/// Returns the strands in the order of their ids; nothing if two ids are equal.
std::vector<uint32_t> order_of(std::span<const uint64_t> ids) {
  std::vector<uint32_t> order(ids.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return ids[a] < ids[b]; });
  const auto equal = std::adjacent_find(order.begin(), order.end(),
                                        [&](uint32_t a, uint32_t b) { return ids[a] == ids[b]; });
  if (equal != order.end()) order.clear();
  return order;
}

/// Sorts values, `count` for each point of a strand.
std::vector<float> sort_values(const std::vector<uint32_t>& order, const std::vector<uint32_t>& first_point,
                               size_t count, const std::vector<float>& values) {
  std::vector<float> sorted;
  sorted.reserve(values.size());
  for (const uint32_t s : order) {
    sorted.insert(sorted.end(), values.begin() + static_cast<ptrdiff_t>(count * first_point[s]),
                  values.begin() + static_cast<ptrdiff_t>(count * first_point[s + 1]));
  }
  return sorted;
}

}  // namespace

void sort_by_id(std::span<const uint64_t> ids, StrandArrays& arrays) {
  const size_t strands = arrays.first_point.size() - 1;
  if (ids.size() != strands || std::is_sorted(ids.begin(), ids.end())) return;
  const std::vector<uint32_t> order = order_of(ids);
  if (order.empty()) return;

  arrays.points = sort_values(order, arrays.first_point, 4, arrays.points);
  std::vector<uint32_t> one_each;
  for (StrandAttribute& attribute : arrays.attributes) {
    const auto components = static_cast<size_t>(attribute.components);
    if (attribute.frequency == AttributeClass::kPerPoint) {
      attribute.values = sort_values(order, arrays.first_point, components, attribute.values);
    } else if (attribute.frequency == AttributeClass::kPerStrand) {
      one_each.resize(strands + 1);
      std::iota(one_each.begin(), one_each.end(), 0u);
      attribute.values = sort_values(order, one_each, components, attribute.values);
    }
  }
  if (!arrays.root_uv.empty()) {
    std::vector<V2f> uv;
    uv.reserve(strands);
    for (const uint32_t s : order) uv.push_back(arrays.root_uv[s]);
    arrays.root_uv = std::move(uv);
  }
  std::vector<uint32_t> first_point = {0};
  first_point.reserve(strands + 1);
  for (const uint32_t s : order)
    first_point.push_back(first_point.back() + arrays.first_point[s + 1] - arrays.first_point[s]);
  arrays.first_point = std::move(first_point);
}

}  // namespace pelage
