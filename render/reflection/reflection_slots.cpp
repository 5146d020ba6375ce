// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/reflection_slots.h"

#include <bit>

namespace pelage {
namespace {

constexpr uint64_t kEmptyKey = 0;  // the key of an empty slot; a cell with this key would be left out

template <class Slot>
uint64_t key_of(const Slot& slot) {
  return std::bit_cast<uint64_t>(std::array<float, 2>{slot.values[0], slot.values[1]});
}

}  // namespace

ReflectionSlots::ReflectionSlots(const ReflectionTable& table, size_t lights, uint32_t fewest)
    : half_lines_(half_lines(lights)) {
  const auto kept = [&](size_t i) {
    return table.cell(i).paths_of_largest >= fewest && table.cell(i).key != kEmptyKey;
  };
  for (size_t i = 0; i < table.size(); ++i) size_ += kept(i) ? 1 : 0;
  count_ = slots_for(size_, lights);
  slots_.resize(count_ * half_lines_);
  for (size_t i = 0; i < table.size(); ++i) {
    if (!kept(i)) continue;
    HalfLine* slot = &insert(table.cell(i).key);
    for (size_t v = 0; v < 3 * lights; ++v) {
      const size_t at = kKeyFloats + v;
      slot[at / kFloats].values[at % kFloats] = table.radiance(i)[v / 3][static_cast<int>(v % 3)];
    }
  }
}

ReflectionSlots::HalfLine& ReflectionSlots::insert(uint64_t key) {
  size_t at = home(key);
  while (key_of(slots_[at * half_lines_]) != kEmptyKey) at = at + 1 < count_ ? at + 1 : 0;
  HalfLine& slot = slots_[at * half_lines_];
  const auto halves = std::bit_cast<std::array<float, 2>>(key);
  slot.values[0] = halves[0];
  slot.values[1] = halves[1];
  return slot;
}

ReflectionSlots::Radiance ReflectionSlots::find(uint64_t key) const {
  for (size_t at = home(key);; at = at + 1 < count_ ? at + 1 : 0) {
    const HalfLine& slot = slots_[at * half_lines_];
    const uint64_t found = key_of(slot);
    if (found == kEmptyKey) return {};
    if (found == key) return Radiance(&slot);
  }
}

}  // namespace pelage
