// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// Weighted sums of radiance by cell and light. Each sum depends only on the order of the paths that were
/// added to its cell, and sums over several tables only on the order of the tables. Used by one thread while
/// it changes; after that, const members may be called from any thread.
class ReflectionTable {
 public:
  struct Cell {
    uint64_t key = 0;
    uint64_t outer = 0;  ///< key of the next larger cell around this one; its own key if there is none
    uint32_t paths = 0;  ///< count of the paths that were added
    float weight = 0;    ///< sum of their weights
    uint32_t level = 0;  ///< 0: the smallest of the cells that a path was added to
    uint32_t paths_of_largest = 0;  ///< after finish(): `paths` of the largest cell around this one
  };

  /// `room`: the count of cells for which memory is reserved at once. `smallest`: no cells below this level.
  explicit ReflectionTable(size_t lights = 0, size_t room = 0, uint32_t smallest = 0);

  /// Adds the radiance of one path, by light, to cells: the smallest cell first, and each inside the next.
  void add(std::span<const uint64_t> cells, float weight, std::span<const Rgb> radiance);
  /// Adds the cells of another table, in their order.
  void add(const ReflectionTable& other);
  /// Removes the smallest cells, and adds no such cells any more: first those of level 0, then those of level
  /// 1, and so on.
  void drop_smallest();
  /// Replaces sums by estimates of the mean. In the estimate of a small cell, the estimate of the next larger
  /// cell weighs as much as `blend` paths of the small cell. Call once, after all paths were added.
  void finish(float blend);

  size_t size() const { return cells_.size(); }
  /// Returns the level of the smallest cells that are kept: how often drop_smallest() was called.
  uint32_t smallest_level() const { return smallest_; }
  /// Returns the index of the cell with this key; size() if there is none.
  size_t find(uint64_t key) const;
  const Cell& cell(size_t index) const { return cells_[index]; }
  /// Returns the sums or, after finish(), the estimates of a cell, by light.
  const Rgb* radiance(size_t index) const { return radiance_.data() + index * lights_; }
  /// Returns the memory of the cells that were ever stored at the same time, in bytes. Reserved memory that
  /// was never written does not count, because the system has not provided it yet.
  size_t bytes() const;
  /// Returns an upper bound of bytes() of a table with room for `cells` cells that has no more cells.
  static size_t max_bytes(size_t cells, size_t lights);

 private:
  size_t insert(uint64_t key, uint64_t outer, uint32_t level);
  void index_again(size_t slots);
  void finish(size_t cell, float blend, std::vector<bool>& finished);

  size_t lights_;
  uint32_t smallest_ = 0;        // level of the smallest cells
  std::vector<uint32_t> index_;  // open addressing: 1 + index of a cell, or 0; its size is a power of two
  std::vector<Cell> cells_;
  size_t most_ = 0;            // cells that were ever stored at the same time
  std::vector<Rgb> radiance_;  // by cell and light
};

}  // namespace pelage
