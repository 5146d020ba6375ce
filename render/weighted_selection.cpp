// SPDX-License-Identifier: Apache-2.0
#include "render/weighted_selection.h"

#include <numeric>

namespace pelage {

std::vector<SelectedItem> select_by_weight(std::span<const double> weights, size_t count) {
  std::vector<SelectedItem> chosen;
  if (weights.size() <= count) {
    for (size_t i = 0; i < weights.size(); ++i)
      chosen.push_back({i, 1 / static_cast<double>(weights.size()), 1});
    return chosen;
  }
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
  const auto selections = static_cast<double>(count);
  double sum = 0;
  size_t step = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i];
    size_t times = 0;
    for (; step < count && sum > all * (static_cast<double>(step) + 0.5) / selections; ++step) ++times;
    if (times == 0) continue;
    const double share = static_cast<double>(times) / selections;
    chosen.push_back({i, share, share * all / weights[i]});
  }
  return chosen;
}

}  // namespace pelage
