// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pelage {

struct Job;

/// A number to sort by, and the index of an element.
struct SortItem {
  uint32_t key, index;
};

/// Sorts stably by the lower `bits` bits of the keys, in linear time. Needs as much memory as `items` in
/// addition. Throws Error (kStopped) when the job is stopped.
void sort_by_key(std::vector<SortItem>& items, int bits, const Job& job);

/// Moves the element at order[i].index to place i, for all i. Follows the cycles of the permutation, which
/// needs no second array of elements. Destroys `order`.
template <class T>
void arrange(std::vector<T>& elements, std::vector<SortItem>& order) {
  for (uint32_t start = 0; start < order.size(); ++start) {
    if (order[start].index == start) continue;
    const T first = elements[start];
    uint32_t to = start;
    while (order[to].index != start) {
      const uint32_t from = order[to].index;
      elements[to] = elements[from];
      order[to].index = to;
      to = from;
    }
    elements[to] = first;
    order[to].index = to;
  }
}

}  // namespace pelage
