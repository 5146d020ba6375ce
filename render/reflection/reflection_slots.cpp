// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/reflection_slots.h"

#include <tuple>

#include "render/reflection/cell_keys.h"

namespace pelage {
namespace {

constexpr uint64_t kEmpty = 0;  // what an empty slot stores as key; the level bits of a cell are not 0

}  // namespace

static_assert(std::tuple_size_v<CellPath> <= 3, "a slot has two bits for the level, and 0 is no level");

ReflectionSlots::ReflectionSlots(size_t lights, size_t room, Density density)
    : words_(words(lights)), count_(slots_for(room, density)), slots_(count_ * words_) {}

void ReflectionSlots::add(const ReflectionTable& table, uint32_t fewest) {
  for (size_t i = 0; i < table.size(); ++i) {
    const ReflectionTable::Cell& cell = table.cell(i);
    if (cell.paths_of_largest < fewest) continue;
    size_t at = home(cell.key);
    while (key_at(at) != kEmpty) at = after(at);
    key_at(at) = stored(cell.key, cell.level);
    for (size_t light = 0; light + 1 < words_; ++light)
      slots_[at * words_ + 1 + light] = PackedRadiance::pack(table.radiance(i)[light]);
    ++size_;
  }
}

void ReflectionSlots::drop(uint32_t level) {
  for (size_t slot = 0; slot < count_; ++slot) {
    while ((key_at(slot) & kLevelBits) == level + 1) remove(slot);  // another cell may take the slot
  }
}

/// Empties a slot. Cells whose search would end there move up, so that no search meets a gap [Knuth98,
/// section 6.4, algorithm R].
void ReflectionSlots::remove(size_t slot) {
  --size_;
  for (size_t from = after(slot); key_at(from) != kEmpty; from = after(from)) {
    const size_t start = home(key_at(from));
    const bool stays = slot <= from ? slot < start && start <= from : slot < start || start <= from;
    if (stays) continue;
    for (size_t i = 0; i < words_; ++i) slots_[slot * words_ + i] = slots_[from * words_ + i];
    slot = from;
  }
  key_at(slot) = kEmpty;
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
