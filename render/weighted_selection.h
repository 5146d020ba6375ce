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

/// Selects items at `count` even steps of the summed weight, so the number of times that an item is selected
/// is about proportional to its weight. Nothing is random. The sum of quantity * scale over the selected
/// items estimates the sum of the quantity over all items [HansenHurwitz43]; it is exact if the quantity is
/// proportional to the weight. With at most `count` items, selects each of them once.
std::vector<SelectedItem> select_by_weight(std::span<const double> weights, size_t count);

}  // namespace pelage
