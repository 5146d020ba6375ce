// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace pelage {

/// An item that was selected, once or several times.
struct SelectedItem {
  size_t index = 0;
  double share = 0;  ///< times it was selected / count of all selections
  /// The factor by which a quantity of the item must be multiplied, so that the sum over all selected items
  /// estimates the sum over all items.
  double scale = 0;
};

/// Selects `count` items with probabilities proportional to their weights: at even steps of the summed
/// weight. The sum of quantity * scale over the selected items is an unbiased estimate of the sum of the
/// quantity over all items, and the better the more the quantity is proportional to the weight
/// [HansenHurwitz43]. With at most `count` items, selects each of them once.
std::vector<SelectedItem> select_by_weight(std::span<const double> weights, size_t count);

}  // namespace pelage
