// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/reflection_table.h"

#include <algorithm>

namespace pelage {
namespace {

constexpr size_t kFewSlots = 16;

}  // namespace

ReflectionTable::ReflectionTable(size_t lights, size_t room, uint32_t smallest)
    : lights_(lights), smallest_(smallest) {
  cells_.reserve(room);
  radiance_.reserve(room * lights);
}

void ReflectionTable::add(std::span<const uint64_t> cells, float weight, std::span<const Rgb> radiance) {
  for (size_t level = smallest_; level < cells.size(); ++level) {
    const size_t outer = std::min(level + 1, cells.size() - 1);
    const size_t i = insert(cells[level], cells[outer], static_cast<uint32_t>(level));
    ++cells_[i].paths;
    cells_[i].weight += weight;
    for (size_t light = 0; light < lights_; ++light)
      radiance_[i * lights_ + light] += weight * radiance[light];
  }
}

void ReflectionTable::add(const ReflectionTable& other) {
  for (size_t from = 0; from < other.size(); ++from) {
    const Cell& cell = other.cells_[from];
    if (cell.level < smallest_) continue;
    const size_t i = insert(cell.key, cell.outer, cell.level);
    cells_[i].paths += cell.paths;
    cells_[i].weight += cell.weight;
    for (size_t light = 0; light < lights_; ++light)
      radiance_[i * lights_ + light] += other.radiance_[from * lights_ + light];
  }
}

void ReflectionTable::drop_smallest() {
  ++smallest_;
  size_t kept = 0;
  for (size_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i].level < smallest_) continue;
    for (size_t light = 0; light < lights_; ++light)
      radiance_[kept * lights_ + light] = radiance_[i * lights_ + light];
    cells_[kept++] = cells_[i];
  }
  cells_.resize(kept);
  radiance_.resize(kept * lights_);
  index_again(index_.size());
}

void ReflectionTable::finish(float blend) {
  std::vector<bool> finished(cells_.size(), false);
  for (size_t i = 0; i < cells_.size(); ++i) finish(i, blend, finished);
}

void ReflectionTable::finish(size_t i, float blend, std::vector<bool>& finished) {
  if (finished[i]) return;
  finished[i] = true;
  Cell& cell = cells_[i];
  const size_t outer = cell.outer == cell.key ? i : find(cell.outer);
  if (outer != i) finish(outer, blend, finished);
  cell.paths_of_largest = outer == i ? cell.paths : cells_[outer].paths_of_largest;
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

size_t ReflectionTable::insert(uint64_t key, uint64_t outer, uint32_t level) {
  const size_t found = find(key);
  if (found < cells_.size()) return found;
  cells_.push_back({key, outer, 0, 0, level, 0});
  radiance_.resize(cells_.size() * lights_, Rgb(0));
  most_ = std::max(most_, cells_.size());
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
  std::vector<uint32_t>().swap(index_);  // before the new one is made
  index_.assign(slots, 0);
  const size_t mask = slots - 1;
  for (size_t i = 0; i < cells_.size(); ++i) {
    size_t slot = cells_[i].key & mask;
    while (index_[slot] != 0) slot = (slot + 1) & mask;
    index_[slot] = static_cast<uint32_t>(i + 1);
  }
}

size_t ReflectionTable::bytes() const {
  return index_.size() * sizeof(uint32_t) + most_ * (sizeof(Cell) + lights_ * sizeof(Rgb));
}

size_t ReflectionTable::max_bytes(size_t cells, size_t lights) {
  // The index has four slots per cell at most.
  return cells * (sizeof(Cell) + lights * sizeof(Rgb)) + (4 * cells + 2 * kFewSlots) * sizeof(uint32_t);
}

}  // namespace pelage
