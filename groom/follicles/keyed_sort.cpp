// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles/keyed_sort.h"

#include <algorithm>
#include <array>

#include "base/job.h"

namespace pelage {

void sort_by_key(std::vector<SortItem>& items, int bits, const Job& job) {
  constexpr int kDigit = 11;
  constexpr size_t kValues = size_t(1) << kDigit;
  std::vector<SortItem> sorted(items.size());
  for (int shift = 0; shift < bits; shift += kDigit) {
    job.check_stop();
    const uint32_t mask = (1u << std::min(kDigit, bits - shift)) - 1;
    const auto digit = [=](const SortItem& item) { return item.key >> shift & mask; };
    std::array<uint32_t, kValues + 1> starts{};
    for (const SortItem& item : items) ++starts[digit(item) + 1];
    for (size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
    for (const SortItem& item : items) sorted[starts[digit(item)]++] = item;
    items.swap(sorted);
  }
}

}  // namespace pelage
