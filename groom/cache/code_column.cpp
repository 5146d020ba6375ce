// SPDX-License-Identifier: Apache-2.0
#include "groom/cache/code_column.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <string_view>

namespace pelage {

size_t CodeColumn::block_bytes(size_t row, size_t own_elements) const {
  switch (form) {
    case Form::kByte:
      return row;
    case Form::kShort:
      return row * 2;
    case Form::kRaw:
      return row * element_bytes * own_elements;
    default:
      return 0;
  }
}

void CodeColumn::indices(const std::byte* block, size_t count, uint16_t* out) const {
  if (form == Form::kShort) {
    std::memcpy(out, block, count * 2);
  } else {
    for (size_t s = 0; s < count; ++s) out[s] = form == Form::kByte ? static_cast<uint8_t>(block[s]) : 0;
  }
}

bool CodeColumn::names_entries(const std::byte* block, size_t count) const {
  if (form == Form::kAbsent || form == Form::kRaw) return true;
  std::vector<uint16_t> own(count);
  indices(block, count, own.data());
  return std::all_of(own.begin(), own.end(), [max = entry_count()](uint16_t i) { return i < max; });
}

CodeColumn::Choice CodeColumn::choose(std::span<const std::byte> entries, size_t entry_bytes) {
  Choice choice;
  const size_t strands = entries.size() / entry_bytes;
  std::map<std::string_view, uint16_t> seen;
  const auto* text = reinterpret_cast<const char*>(entries.data());
  choice.form = Form::kRaw;
  for (size_t s = 0; s < strands; ++s) {
    const std::string_view entry(text + s * entry_bytes, entry_bytes);
    const auto [found, is_new] = seen.try_emplace(entry, static_cast<uint16_t>(seen.size()));
    choice.indices.push_back(found->second);
    if (!is_new) continue;
    // Once the table and the indices take more space than the codes, adding strands cannot make the table
    // worthwhile.
    const size_t index_bytes = seen.size() == 1 ? 0 : seen.size() <= 256 ? 1 : 2;
    if (seen.size() > UINT16_MAX || seen.size() * entry_bytes + strands * index_bytes > strands * entry_bytes)
      return choice;
  }
  choice.form = seen.size() <= 1 ? Form::kOne : seen.size() <= 256 ? Form::kByte : Form::kShort;
  choice.table.resize(seen.size() * entry_bytes);
  for (const auto& [entry, index] : seen)
    std::memcpy(choice.table.data() + index * entry_bytes, entry.data(), entry_bytes);
  return choice;
}

}  // namespace pelage
