// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/reflection_table.h"

#include <algorithm>

namespace pelage {
namespace {

constexpr size_t kFewSlots = 16;

}  // namespace

void ReflectionTable::add(std::span<const uint64_t> cells, float weight, std::span<const Rgb> radiance) {
  for (size_t level = 0; level < cells.size(); ++level) {
    const size_t i = insert(cells[level], cells[std::min(level + 1, cells.size() - 1)]);
    ++cells_[i].paths;
    cells_[i].weight += weight;
    for (size_t light = 0; light < lights_; ++light)
      radiance_[i * lights_ + light] += weight * radiance[light];
  }
}

void ReflectionTable::add(const ReflectionTable& other) {
  for (size_t from = 0; from < other.size(); ++from) {
    const Cell& cell = other.cells_[from];
    const size_t i = insert(cell.key, cell.outer);
    cells_[i].paths += cell.paths;
    cells_[i].weight += cell.weight;
    for (size_t light = 0; light < lights_; ++light)
      radiance_[i * lights_ + light] += other.radiance_[from * lights_ + light];
  }
}

void ReflectionTable::finish(float blend) {
  std::vector<bool> finished(cells_.size(), false);
  for (size_t i = 0; i < cells_.size(); ++i) finish(i, blend, finished);
}

void ReflectionTable::finish(size_t i, float blend, std::vector<bool>& finished) {
  if (finished[i]) return;
  finished[i] = true;
  const Cell& cell = cells_[i];
  const size_t outer = cell.outer == cell.key ? i : find(cell.outer);
  if (outer != i) finish(outer, blend, finished);
  if (!(cell.weight > 0)) return;
  const float added = outer == i ? 0 : blend * cell.weight / static_cast<float>(cell.paths);
  for (size_t light = 0; light < lights_; ++light) {
    Rgb& mean = radiance_[i * lights_ + light];
    mean = (mean + added * radiance_[outer * lights_ + light]) / (cell.weight + added);
  }
}

size_t ReflectionTable::find(uint64_t key) const {
  if (index_.empty()) return cells_.size();
  const size_t mask = index_.size() - 1;
  for (size_t slot = key & mask;; slot = (slot + 1) & mask) {  // keys are hashes
    if (index_[slot] == 0) return cells_.size();
    if (cells_[index_[slot] - 1].key == key) return index_[slot] - 1;
  }
}

size_t ReflectionTable::insert(uint64_t key, uint64_t outer) {
  const size_t found = find(key);
  if (found < cells_.size()) return found;
  cells_.push_back({key, outer});
  radiance_.resize(cells_.size() * lights_, Rgb(0));
  if (2 * cells_.size() > index_.size()) {
    index_again(index_.empty() ? kFewSlots : 2 * index_.size());
  } else {
    const size_t mask = index_.size() - 1;
    size_t slot = key & mask;
    while (index_[slot] != 0) slot = (slot + 1) & mask;
    index_[slot] = static_cast<uint32_t>(cells_.size());
  }
  return found;
}

void ReflectionTable::index_again(size_t slots) {
  index_.assign(slots, 0);
  const size_t mask = slots - 1;
  for (size_t i = 0; i < cells_.size(); ++i) {
    size_t slot = cells_[i].key & mask;
    while (index_[slot] != 0) slot = (slot + 1) & mask;
    index_[slot] = static_cast<uint32_t>(i + 1);
  }
}

size_t ReflectionTable::bytes() const {
  return index_.capacity() * sizeof(uint32_t) + cells_.capacity() * sizeof(Cell) +
         radiance_.capacity() * sizeof(Rgb);
}

size_t ReflectionTable::max_bytes(size_t cells, size_t lights) {
  // Vectors grow by doubling: the old array of half the size exists beside the new one. The index has four
  // slots per cell at most.
  return 3 * cells * (sizeof(Cell) + lights * sizeof(Rgb)) + (4 * cells + 2 * kFewSlots) * sizeof(uint32_t);
}

}  // namespace pelage
