// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/reflection_slots.h"

#include <tuple>

#include "render/reflection/cell_keys.h"

namespace pelage {
namespace {

// Stored keys that belong to no cell: a search ends at an empty slot, and goes on at one whose cell was
// dropped. The level bits of a cell are not 0.
constexpr uint64_t kEmpty = 0, kDropped = 4;

}  // namespace

static_assert(std::tuple_size_v<CellPath> <= 3, "a slot has two bits for the level, and 0 is no level");

ReflectionSlots::ReflectionSlots(size_t lights, size_t room, Density density)
    : words_(words(lights)), count_(slots_for(room, density)), slots_(count_ * words_) {}

void ReflectionSlots::add(const ReflectionTable& table, uint32_t fewest) {
  for (size_t i = 0; i < table.size(); ++i) {
    const ReflectionTable::Cell& cell = table.cell(i);
    if (cell.paths_of_largest < fewest) continue;
    size_t at = home(cell.key);
    while (key_at(at) != kEmpty && key_at(at) != kDropped) at = after(at);
    key_at(at) = stored(cell.key, cell.level);
    for (size_t light = 0; light + 1 < words_; ++light)
      slots_[at * words_ + 1 + light] = PackedRadiance::pack(table.radiance(i)[light]);
    ++size_;
  }
}

void ReflectionSlots::drop(uint32_t level) {
  for (size_t slot = 0; slot < count_; ++slot) {
    if ((key_at(slot) & kLevelBits) != level + 1) continue;
    key_at(slot) = kDropped;
    --size_;
  }
}

ReflectionSlots::Radiance ReflectionSlots::find(uint64_t key, uint32_t level) const {
  const uint64_t wanted = stored(key, level);
  for (size_t at = home(key);; at = after(at)) {
    const uint64_t found = key_at(at);
    if (found == wanted) return Radiance(&slots_[at * words_ + 1]);
    if (found == kEmpty) return {};
  }
}

}  // namespace pelage
