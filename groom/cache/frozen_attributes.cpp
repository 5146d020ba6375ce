// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "base/hash.h"
#include "groom/cache/frozen_leaf.h"
#include "groom/cache/frozen_leaf_format.h"
#include "groom/cache/small_float.h"

namespace pelage {
namespace {

using Form = CodeColumn::Form;

template <class T>
const T* rows(const std::byte* at) {
  return reinterpret_cast<const T*>(at);
}

/// Codes of one element of the first strands of a block.
template <class T>
void codes_of(const CodeColumn& column, const std::byte* stored, size_t count, T* out) {
  if (column.form == Form::kRaw) {
    std::copy_n(rows<T>(stored), count, out);
    return;
  }
  std::array<uint16_t, kBlockStrands> index;
  column.indices(stored, count, index.data());
  const T* table = rows<T>(column.table.data());
  for (size_t s = 0; s < count; ++s) out[s] = table[index[s]];
}

void scales_of(const CodeColumn& column, const std::byte* stored, size_t count, float* __restrict out) {
  std::array<uint16_t, kBlockStrands> own;
  codes_of(column, stored, count, own.data());
  for (size_t s = 0; s < count; ++s) out[s] = small_float::decode(own[s]);
}

/// A column of numbers relative to a number of the strand.
class Profile {
 public:
  /// `table`: the decoded table of the column.
  Profile(const CodeColumn& column, const std::vector<float>& table, const std::byte* stored, size_t row,
          size_t count)
      : column_(column), table_(table.data()), stored_(stored), row_(row), count_(count) {
    if (column.form != Form::kRaw) column.indices(stored, count, index_.data());
  }

  template <class T, class Meaning>
  void multiply(size_t element, const float* __restrict whole, const Meaning& meaning,
                float* __restrict out) const {
    if (column_.form == Form::kRaw) {
      const T* code = rows<T>(stored_) + element * row_;
      for (size_t s = 0; s < count_; ++s) out[s] = whole[s] * meaning(code[s]);
    } else if (column_.form == Form::kOne) {
      const float ratio = table_[element];
      for (size_t s = 0; s < count_; ++s) out[s] = whole[s] * ratio;
    } else {
      const float* table = table_ + element;
      for (size_t s = 0; s < count_; ++s) out[s] = whole[s] * table[index_[s] * column_.elements];
    }
  }

 private:
  const CodeColumn& column_;
  const float* table_;
  const std::byte* stored_;
  size_t row_, count_;
  std::array<uint16_t, kBlockStrands> index_;
};

}  // namespace

void FrozenLeaf::attributes(const Block& block, StrandBatch& batch) const {
  const Layout layout(*this, block.count, static_cast<size_t>(block.points), block.plain);
  const CodeColumn& column = columns_[StrandCodes::kClump];
  std::array<uint16_t, kBlockStrands> clumps;
  if (column.form == Form::kAbsent) {
    for (size_t s = 0; s < batch.count; ++s)
      clumps[s] = codes::clump_code(unit_float(hash64(batch.ids[s], random_use("no clump"))));
  } else {
    codes_of(column, bytes_.data() + block.data + layout.columns[StrandCodes::kClump], batch.count,
             clumps.data());
  }
  for (size_t s = 0; s < batch.count; ++s) batch.clump[s] = codes::clump(clumps[s]);
  radii(block, layout, batch);
  if (has_colors()) colors(block, layout, batch);
}

void FrozenLeaf::radii(const Block& block, const Layout& layout, StrandBatch& batch) const {
  const std::byte* data = bytes_.data() + block.data;
  if (block.plain) {
    for (size_t p = 0; p < batch.points.size(); ++p)
      std::copy_n(rows<float>(data + layout.radii) + p * layout.row, batch.count,
                  batch.points[p].radius.data());
    return;
  }
  StrandRow widest;
  scales_of(columns_[StrandCodes::kWidthScale], data + layout.columns[StrandCodes::kWidthScale], batch.count,
            widest.data());
  const CodeColumn& column = columns_[StrandCodes::kWidthProfile];
  const Profile profile(column, width_table_, data + layout.columns[StrandCodes::kWidthProfile], layout.row,
                        batch.count);
  const auto ratio = [](auto code) { return codes::width_ratio(code); };
  for (size_t p = 0; p < batch.points.size(); ++p) {
    float* radius = batch.points[p].radius.data();
    if (column.element_bytes == 1) {
      profile.multiply<uint8_t>(p, widest.data(), ratio, radius);
    } else {
      profile.multiply<uint16_t>(p, widest.data(), ratio, radius);
    }
  }
}

void FrozenLeaf::colors(const Block& block, const Layout& layout, StrandBatch& batch) const {
  const std::byte* data = bytes_.data() + block.data;
  const size_t own_rows = color_rows(static_cast<size_t>(block.points));
  if (block.plain) {
    for (size_t r = 0; r < batch.colors.size() * 3; ++r) {
      const size_t from = std::min(r / 3, own_rows - 1) * 3 + r % 3;
      std::copy_n(rows<float>(data + layout.colors) + from * layout.row, batch.count,
                  batch.colors[r / 3][r % 3].data());
    }
    return;
  }
  StrandRow brightest;
  scales_of(columns_[StrandCodes::kColorScale], data + layout.columns[StrandCodes::kColorScale], batch.count,
            brightest.data());
  std::array<uint32_t, kBlockStrands> hue;
  codes_of(columns_[StrandCodes::kColorHue], data + layout.columns[StrandCodes::kColorHue], batch.count,
           hue.data());
  const Profile profile(columns_[StrandCodes::kColorProfile], color_table_,
                        data + layout.columns[StrandCodes::kColorProfile], layout.row, batch.count);
  for (size_t c = 0; c < 3; ++c) {
    StrandRow largest;
    for (size_t s = 0; s < batch.count; ++s)
      largest[s] = brightest[s] * codes::hue(hue[s], static_cast<int>(c));
    for (size_t p = 0; p < batch.colors.size(); ++p) {
      profile.multiply<int16_t>(
          std::min(p, own_rows - 1) * 3 + c, largest.data(),
          [](int16_t code) { return codes::color_ratio(code); }, batch.colors[p][c].data());
    }
  }
}

}  // namespace pelage
