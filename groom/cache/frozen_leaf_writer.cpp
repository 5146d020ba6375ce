// SPDX-License-Identifier: Apache-2.0
#include "groom/cache/frozen_leaf_writer.h"

#include <algorithm>
#include <cstring>

#include "groom/cache/frozen_leaf_format.h"

namespace pelage {
namespace {

/// Copies rows of `count` values, each to the start of a longer one.
template <class T>
void put_rows(const T* from, size_t rows, size_t count, size_t row, std::byte* to) {
  for (size_t r = 0; r < rows; ++r)
    std::memcpy(to + r * row * sizeof(T), from + r * count, count * sizeof(T));
}

/// Transposes codes strand by strand to rows over strands.
void put_raw(const std::vector<std::byte>& entries, size_t element_bytes, size_t count, size_t row,
             std::byte* to) {
  const size_t elements = entries.size() / count / element_bytes;
  for (size_t s = 0; s < count; ++s) {
    for (size_t e = 0; e < elements; ++e) {
      std::memcpy(to + (e * row + s) * element_bytes, &entries[(s * elements + e) * element_bytes],
                  element_bytes);
    }
  }
}

}  // namespace

CodeColumn FrozenLeafWriter::column(StrandCodes::Column kind, CodeColumn::Choice& choice) const {
  CodeColumn column;
  const bool two = kind != StrandCodes::kWidthProfile || options_.one_width_profile;
  column.element_bytes = kind == StrandCodes::kColorHue ? 4 : two ? 2 : 1;
  size_t max = 0;
  for (const StrandCodes& block : blocks_)
    max = std::max(max, block.columns[kind].size() / block.count / column.element_bytes);
  if (max == 0) return column;
  column.elements = static_cast<uint16_t>(max);
  // Strands may have different numbers of points: the entries of shorter ones are padded with zeros.
  std::vector<std::byte> entries;
  for (const StrandCodes& block : blocks_) {
    const std::vector<std::byte>& own = block.columns[kind];
    const size_t bytes = own.size() / block.count;
    for (size_t at = 0; at < own.size(); at += bytes) {
      const auto from = own.begin() + static_cast<std::ptrdiff_t>(at);
      entries.insert(entries.end(), from, from + static_cast<std::ptrdiff_t>(bytes));
      entries.resize(entries.size() + column.entry_bytes() - bytes);
    }
  }
  choice = CodeColumn::choose(entries, column.entry_bytes());
  column.form = choice.form;
  column.table = choice.table;
  return column;
}

std::vector<std::byte> FrozenLeafWriter::finish() const {
  FrozenLeaf form;
  FrozenLeaf::Header header;
  header.blocks = static_cast<uint32_t>(blocks_.size());
  bool clumped = false;
  for (const StrandCodes& block : blocks_) {
    header.strands += static_cast<uint32_t>(block.count);
    form.has_base_ |= block.has_base;
    clumped |= block.clumped;
    if (block.color_rows > 0 && form.color_rows_ == FrozenLeaf::ColorRows::kNone)
      form.color_rows_ = FrozenLeaf::ColorRows::kPerPoint;
    if (block.color_rows > 0 && block.color_rows < block.points)
      form.color_rows_ = FrozenLeaf::ColorRows::kPerStrand;
  }
  header.has_base = form.has_base_;
  header.color_rows = static_cast<uint8_t>(form.color_rows_);
  std::array<CodeColumn::Choice, StrandCodes::kColumns> choices;
  size_t table = sizeof(header);
  for (size_t i = 0; i < StrandCodes::kColumns; ++i) {
    const auto kind = static_cast<StrandCodes::Column>(i);
    if (kind != StrandCodes::kClump || clumped) form.columns_[i] = this->column(kind, choices[i]);
    const CodeColumn& column = form.columns_[i];
    header.columns[i] = {
        static_cast<uint8_t>(column.form), column.element_bytes, column.elements,
        column.form == CodeColumn::Form::kAbsent ? 0 : static_cast<uint32_t>(column.entry_count())};
    table += (column.table.size() + 3) / 4 * 4;
  }

  size_t at = (table + blocks_.size() * sizeof(FrozenLeaf::Header::BlockEntry) + 15) / 16 * 16, total = at;
  for (const StrandCodes& block : blocks_)
    total += FrozenLeaf::Layout(form, block.count, block.points, block.plain).end;
  std::vector<std::byte> bytes(total);
  std::memcpy(bytes.data(), &header, sizeof(header));
  std::byte* to = bytes.data() + sizeof(header);
  for (const CodeColumn::Choice& choice : choices) {
    std::copy(choice.table.begin(), choice.table.end(), to);
    to += (choice.table.size() + 3) / 4 * 4;
  }
  std::array<size_t, StrandCodes::kColumns> coded{};  // strands of each column so far
  for (const StrandCodes& block : blocks_) {
    const FrozenLeaf::Header::BlockEntry entry{static_cast<uint16_t>(block.count),
                                               static_cast<uint16_t>(block.points), block.plain};
    std::memcpy(to, &entry, sizeof(entry));
    to += sizeof(entry);
    const FrozenLeaf::Layout layout(form, block.count, block.points, block.plain);
    const size_t n = block.count, row = layout.row, first = form.has_base_ ? 0 : 3;
    std::byte* out = bytes.data() + at;
    if (block.plain) {
      const float* from = block.floats.data();
      put_rows(from + first * n, block.points * 3 - first, n, row, out + layout.shapes);
      put_rows(from + block.points * 3 * n, block.points, n, row, out + layout.radii);
      put_rows(from + block.points * 4 * n, block.color_rows * 3, n, row, out + layout.colors);
    } else {
      put_rows(block.steps.data(), 1, n, row, out);
      put_rows(block.shape.data() + first * n, block.points * 3 - first, n, row, out + layout.shapes);
    }
    for (size_t i = 0; i < StrandCodes::kColumns; ++i) {
      const CodeColumn& column = form.columns_[i];
      if (column.form == CodeColumn::Form::kAbsent || block.columns[i].empty()) continue;
      std::byte* rows = out + layout.columns[i];
      if (column.form == CodeColumn::Form::kRaw)
        put_raw(block.columns[i], column.element_bytes, n, row, rows);
      for (size_t s = 0; s < n && column.form == CodeColumn::Form::kByte; ++s)
        rows[s] = static_cast<std::byte>(choices[i].indices[coded[i] + s]);
      if (column.form == CodeColumn::Form::kShort) std::memcpy(rows, &choices[i].indices[coded[i]], n * 2);
      coded[i] += n;
    }
    at += layout.end;
  }
  return bytes;
}

}  // namespace pelage
