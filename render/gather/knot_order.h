// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/gather/gather_integrator_test.cpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pelage {

/// Sort key of an item (a ray or a visible point) that belongs to a knot.
struct KnotItem {
  uint32_t knot = 0, light = 0;
  uint32_t index = 0;  ///< of the item in its own list

  friend auto operator<=>(const KnotItem&, const KnotItem&) = default;
};

/// Fills `order` with the keys of items first .. count - 1, sorted by knot, then by light, then by index.
/// `item(i)` must return the KnotItem of item i. Reuses the memory of `order`.
template <class Item>
void sort_by_knot(size_t first, size_t count, const Item& item, std::vector<KnotItem>& order) {
  order.clear();
  for (size_t i = first; i < count; ++i) order.push_back(item(i));
  std::sort(order.begin(), order.end());
}

}  // namespace pelage
