// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/gather/gather_integrator_test.cpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pelage {

/// An item of a list, to be sorted by the knot that it belongs to.
struct KnotItem {
  uint32_t knot = 0, light = 0;
  uint32_t index = 0;

  friend auto operator<=>(const KnotItem&, const KnotItem&) = default;
};

/// Stores the items first .. count - 1 in `order`, sorted by knot, then by light, then by index. `item(i)`
/// returns the KnotItem of item i. Reuses the memory of `order`.
template <class Item>
void sort_by_knot(size_t first, size_t count, const Item& item, std::vector<KnotItem>& order) {
  order.clear();
  for (size_t i = first; i < count; ++i) order.push_back(item(i));
  std::sort(order.begin(), order.end());
}

}  // namespace pelage
