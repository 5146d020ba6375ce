// SPDX-License-Identifier: Apache-2.0
#include "groom/cache/frozen_leaf.h"

#include <algorithm>
#include <cstring>

#include "groom/cache/frozen_leaf_format.h"
#include "groom/cache/small_float.h"

namespace pelage {
namespace {

using Form = CodeColumn::Form;

template <class T>
const T* stored_values(const std::byte* at) {
  return reinterpret_cast<const T*>(at);
}

/// Adds the next step of every strand to its position.
void advance(const int16_t* __restrict q, const float* __restrict step, size_t count, float* __restrict at) {
  for (size_t s = 0; s < count; ++s) at[s] += static_cast<float>(q[s]) * step[s];
}

void decode(const uint16_t* __restrict code, size_t count, float* __restrict out) {
  for (size_t s = 0; s < count; ++s) out[s] = small_float::decode(code[s]);
}

/// Decodes each element of a column's table.
template <class T, class Meaning>
std::vector<float> decoded(const CodeColumn& column, const Meaning& meaning) {
  std::vector<T> codes(column.table.size() / sizeof(T));
  if (!codes.empty()) std::memcpy(codes.data(), column.table.data(), column.table.size());
  std::vector<float> values;
  for (const T code : codes) values.push_back(meaning(code));
  return values;
}

std::vector<float> width_values(const CodeColumn& column) {
  const auto meaning = [](auto code) { return codes::width_ratio(code); };
  return column.element_bytes == 1 ? decoded<uint8_t>(column, meaning) : decoded<uint16_t>(column, meaning);
}

}  // namespace

std::optional<FrozenLeaf> FrozenLeaf::read(std::span<const std::byte> bytes) {
  Header header;
  if (bytes.size() < sizeof(header)) return {};
  std::memcpy(&header, bytes.data(), sizeof(header));
  if (header.color_rows > static_cast<uint8_t>(ColorRows::kPerPoint)) return {};
  FrozenLeaf leaf;
  leaf.bytes_ = bytes;
  leaf.strands_ = header.strands;
  leaf.has_base_ = header.has_base != 0;
  leaf.color_rows_ = static_cast<ColorRows>(header.color_rows);
  size_t at = sizeof(header);
  for (size_t i = 0; i < StrandCodes::kColumns; ++i) {
    const Header::Column& stored = header.columns[i];
    if (stored.form > static_cast<uint8_t>(Form::kRaw)) return {};
    const bool half = i == StrandCodes::kWidthProfile && stored.element_bytes == 1;
    if (stored.element_bytes != (i == StrandCodes::kColorHue ? 4 : half ? 1 : 2)) return {};
    CodeColumn& column = leaf.columns_[i];
    column.form = static_cast<Form>(stored.form);
    column.element_bytes = stored.element_bytes;
    column.elements = stored.elements;
    const bool has_table = column.form != Form::kAbsent && column.form != Form::kRaw;
    if (has_table != (stored.entries > 0) || (has_table && column.elements == 0)) return {};
    const size_t table = column.entry_bytes() * stored.entries;
    if (table > bytes.size() - at) return {};
    column.table = bytes.subspan(at, table);
    at = std::min(at + (table + 3) / 4 * 4, bytes.size());
  }
  leaf.width_table_ = width_values(leaf.columns_[StrandCodes::kWidthProfile]);
  leaf.color_table_ = decoded<int16_t>(leaf.columns_[StrandCodes::kColorProfile],
                                       [](int16_t c) { return codes::color_ratio(c); });

  const size_t entries = at;
  at = (at + size_t(header.blocks) * sizeof(Header::BlockEntry) + 15) / 16 * 16;
  if (at > bytes.size()) return {};
  uint32_t first = 0;
  for (uint32_t i = 0; i < header.blocks; ++i) {
    Header::BlockEntry block;
    std::memcpy(&block, bytes.data() + entries + i * sizeof(block), sizeof(block));
    if (block.count == 0 || block.count > kBlockStrands || block.points < 1 || block.plain > 1) return {};
    const Layout layout(leaf, block.count, block.points, block.plain != 0);
    if (layout.end > bytes.size() - at) return {};
    for (size_t c = 0; c < StrandCodes::kColumns; ++c) {
      if (block.plain && c != StrandCodes::kClump) continue;
      const CodeColumn& column = leaf.columns_[c];
      const bool needed = c == StrandCodes::kWidthScale || c == StrandCodes::kWidthProfile ||
                          (c != StrandCodes::kClump && leaf.has_colors());
      if (needed && column.form == Form::kAbsent) return {};
      const size_t elements = c == StrandCodes::kWidthProfile   ? block.points
                              : c == StrandCodes::kColorProfile ? leaf.color_rows(block.points) * 3
                                                                : 1;
      if (!column.table.empty() && column.elements < elements) return {};
      if (!column.names_entries(bytes.data() + at + layout.columns[c], block.count)) return {};
    }
    leaf.blocks_.push_back({first, block.count, block.points, block.plain != 0, at});
    first += block.count;
    at += layout.end;
  }
  if (first != header.strands || at != bytes.size()) return {};
  return leaf;
}

void FrozenLeaf::shape(const Block& block, const RootRows& frames, float scale, StrandBatch& batch) const {
  const Layout layout(*this, block.count, static_cast<size_t>(block.points), block.plain);
  const std::byte* data = bytes_.data() + block.data;
  const size_t count = batch.count, row = layout.row;
  const std::byte* next = data + layout.shapes;
  StrandRow step;
  if (!block.plain) decode(stored_values<uint16_t>(data), count, step.data());
  VectorRow local;
  for (StrandRow& axis : local) std::fill_n(axis.data(), count, 0.0f);
  const std::array<const VectorRow*, 3> axes{&frames.tangent, &frames.bitangent, &frames.normal};
  std::array<VectorRow, 3> matrix;  // [axis of the space][axis of the frame]
  for (size_t to = 0; to < 3; ++to) {
    for (size_t from = 0; from < 3; ++from) {
      const float* __restrict axis = (*axes[from])[to].data();
      float* __restrict m = matrix[to][from].data();
      for (size_t s = 0; s < count; ++s) m[s] = scale * axis[s];
    }
  }
  for (size_t p = 0; p < batch.points.size(); ++p) {
    VectorRow& offset = batch.points[p].offset;
    if (p == 0 && !has_base_) {
      for (StrandRow& axis : offset) std::fill_n(axis.data(), count, 0.0f);
      continue;
    }
    for (StrandRow& axis : local) {
      if (block.plain) {
        std::copy_n(stored_values<float>(next), count, axis.data());
        next += row * 4;
      } else {
        advance(stored_values<int16_t>(next), step.data(), count, axis.data());
        next += row * 2;
      }
    }
    const float* __restrict x = local[0].data();
    const float* __restrict y = local[1].data();
    const float* __restrict z = local[2].data();
    for (size_t to = 0; to < 3; ++to) {
      const float* __restrict a = matrix[to][0].data();
      const float* __restrict b = matrix[to][1].data();
      const float* __restrict c = matrix[to][2].data();
      float* __restrict out = offset[to].data();
      for (size_t s = 0; s < count; ++s) out[s] = a[s] * x[s] + b[s] * y[s] + c[s] * z[s];
    }
  }
}

}  // namespace pelage
