// SPDX-License-Identifier: Apache-2.0
#include "groom/frozen_leaf_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/hash.h"
#include "groom/frozen_leaf_format.h"

namespace pelage {
namespace {

constexpr float kSeparableTolerance = 1e-4f;
constexpr float kLargestStep = 32766.0f;  // one less than 16 bits hold: for the rounding of the step before
constexpr float kWidthsPerError = 20.0f;  // no point is off by more than this part of the strand's width

template <class T>
T* rows(std::byte* at) {
  return reinterpret_cast<T*>(at);
}

/// `value` in steps, as a whole number up to `most`; what is no number is 0.
uint32_t quantised(float value, float step, float most) {
  const float steps = std::round(value / step);
  return steps > 0 ? static_cast<uint32_t>(std::min(steps, most)) : 0;
}
uint16_t sixteen_bits(float value, float step) {
  return static_cast<uint16_t>(quantised(value, step, 65535.0f));
}

}  // namespace

void FrozenLeafWriter::add(const StrandBatch& batch) {
  Block& block = blocks_.emplace_back();
  const size_t n = block.count = batch.count;
  block.points = batch.points.size();
  block.shape.resize(block.points * 3 * n);
  block.radius.resize(block.points * n);
  for (size_t p = 0; p < block.points; ++p) {
    const std::array<const VectorRow*, 3> axes{&batch.rest.tangent, &batch.rest.bitangent,
                                               &batch.rest.normal};
    const VectorRow& offset = batch.points[p].offset;
    for (size_t axis = 0; axis < 3; ++axis) {
      float* out = &block.shape[(p * 3 + axis) * n];
      const VectorRow& along = *axes[axis];
      for (size_t s = 0; s < n; ++s)
        out[s] = offset[0][s] * along[0][s] + offset[1][s] * along[1][s] + offset[2][s] * along[2][s];
    }
    std::copy_n(batch.points[p].radius.data(), n, &block.radius[p * n]);
  }
  for (const VectorRow& row : batch.colors) {
    for (const StrandRow& channel : row)
      block.color.insert(block.color.end(), channel.begin(),
                         channel.begin() + static_cast<std::ptrdiff_t>(n));
  }
  block.clump.assign(batch.clump.begin(), batch.clump.begin() + static_cast<std::ptrdiff_t>(n));
  for (size_t s = 0; s < n; ++s)
    block.clumped |= block.clump[s] != unit_float(hash64(batch.ids[s], random_use("no clump")));
}

FrozenLeafWriter::Profile FrozenLeafWriter::profile_of(const std::vector<Block>& blocks,
                                                       std::vector<float> Block::*values, float untouched) {
  Profile result;
  const auto row_count = [&](const Block& b) { return (b.*values).size() / b.count; };
  const size_t n = row_count(blocks.front());
  bool touched = false, equal_rows = true;
  float largest = 0;
  std::pair<const Block*, size_t> of_largest{&blocks.front(), 0};
  for (const Block& block : blocks) {
    equal_rows &= row_count(block) == n;
    for (size_t i = 0; i < (block.*values).size(); ++i) {
      const float v = (block.*values)[i];
      touched |= v != untouched;
      if (v > largest) {
        largest = v;
        of_largest = {&block, i % block.count};
      }
    }
  }
  result.step = largest / 65535.0f;
  if (!touched) return result;
  result.kind = FrozenClass::kFull;
  if (!equal_rows || !(largest > 0)) {
    // Nothing but zeros where something was set: a profile of zeros.
    if (equal_rows) result.kind = FrozenClass::kConstant, result.profile.assign(n, 0.0f);
    return result;
  }
  for (size_t r = 0; r < n; ++r)
    result.profile.push_back((of_largest.first->*values)[r * of_largest.first->count + of_largest.second]);
  bool constant = true, separable = true;
  for (const Block& block : blocks) {
    for (size_t s = 0; s < block.count && separable; ++s) {
      float factor = 0;
      for (size_t r = 0; r < n; ++r) factor = std::max(factor, (block.*values)[r * block.count + s]);
      for (size_t r = 0; r < n; ++r) {
        const float v = (block.*values)[r * block.count + s];
        constant &= v == result.profile[r];
        separable &= std::fabs(v - factor * (result.profile[r] / largest)) <= kSeparableTolerance * factor;
      }
    }
  }
  if (constant) {
    result.kind = FrozenClass::kConstant;
  } else if (separable) {
    result.kind = FrozenClass::kSeparable;
    for (float& v : result.profile) v /= largest;
  } else {
    result.profile.clear();
  }
  return result;
}

bool FrozenLeafWriter::needs_floats() const {
  for (const Block& block : blocks_) {
    for (size_t s = 0; s < block.count; ++s) {
      float width = 0, longest = 0, furthest = 0;
      for (size_t p = 0; p < block.points; ++p) {
        width = std::max(width, 2.0f * block.radius[p * block.count + s]);
        for (size_t axis = 0; axis < 3; ++axis) {
          const float* at = &block.shape[(p * 3 + axis) * block.count + s];
          const float before = p > 0 ? *(at - 3 * block.count) : 0.0f;
          if (!std::isfinite(*at)) return true;
          longest = std::max(longest, std::fabs(*at - before));
          furthest = std::max(furthest, std::fabs(*at));
        }
      }
      // Half a step along each axis, and the rounding of the sums.
      const float error = 0.8661f * longest / kLargestStep + 4e-7f * furthest;
      if (width > 0 && error * kWidthsPerError > width) return true;
    }
  }
  return false;
}

void FrozenLeafWriter::write_shapes(const Block& block, const FrozenLeaf& form, std::byte* out) const {
  const FrozenLeaf::Layout layout(form, block.count, static_cast<int>(block.points));
  const size_t n = block.count, row = layout.row, first = form.has_base_ ? 0 : 1;
  std::byte* shapes = out + layout.shapes;
  if (form.wide_) {
    for (size_t r = first * 3; r < block.points * 3; ++r, shapes += row * 4)
      std::copy_n(&block.shape[r * n], n, rows<float>(shapes));
    return;
  }
  for (size_t s = 0; s < n; ++s) {
    float longest = 0;
    for (size_t r = first * 3; r < block.points * 3; ++r) {
      const float before = r >= 3 ? block.shape[(r - 3) * n + s] : 0.0f;
      longest = std::max(longest, std::fabs(block.shape[r * n + s] - before));
    }
    const float step = longest / kLargestStep;
    rows<float>(out + layout.steps)[s] = step;
    float decoded[3] = {0, 0, 0};
    for (size_t r = first * 3; r < block.points * 3; ++r) {
      float& at = decoded[r % 3];
      const float steps = step > 0 ? std::round((block.shape[r * n + s] - at) / step) : 0.0f;
      const auto q = static_cast<int16_t>(std::clamp(steps, -32767.0f, 32767.0f));
      rows<int16_t>(shapes)[(r - first * 3) * row + s] = q;
      at += static_cast<float>(q) * step;  // as the reader does
    }
  }
}

std::vector<std::byte> FrozenLeafWriter::finish() const {
  FrozenLeaf form;
  FrozenLeaf::Header header;
  header.blocks = static_cast<uint32_t>(blocks_.size());
  for (const Block& block : blocks_) {
    header.strands += static_cast<uint32_t>(block.count);
    form.has_clump_ |= block.clumped;
    const auto base = std::span(block.shape).first(3 * block.count);
    form.has_base_ |= std::any_of(base.begin(), base.end(), [](float v) { return v != 0; });
  }
  form.wide_ = needs_floats();
  Profile width, color;
  if (!blocks_.empty()) {
    width = profile_of(blocks_, &Block::radius, 0.0f);
    if (!blocks_.front().color.empty()) {
      color = profile_of(blocks_, &Block::color, 1.0f);
      form.color_rows_ = blocks_.front().color.size() / blocks_.front().count / 3;
    }
  }
  form.width_class_ = width.kind;
  form.color_class_ = color.kind;
  header.wide = form.wide_;
  header.has_base = form.has_base_;
  header.has_clump = form.has_clump_;
  header.width_class = static_cast<uint8_t>(width.kind);
  header.color_class = static_cast<uint8_t>(color.kind);
  header.width_points = static_cast<uint32_t>(width.profile.size());
  header.color_rows = static_cast<uint32_t>(form.color_rows_);
  header.color_profile_rows = static_cast<uint32_t>(color.profile.size() / 3);
  header.width_step = width.step;
  for (size_t c = 0; c < 3; ++c) {
    float largest = 0;
    for (const Block& block : blocks_) {
      for (size_t i = 0; i < block.color.size(); ++i)
        if (i / block.count % 3 == c) largest = std::max(largest, block.color[i]);
    }
    const bool per_point = color.kind == FrozenClass::kFull && form.color_rows_ != 1;
    header.color_step[c] = color.kind == FrozenClass::kSeparable ? color.step
                           : per_point                           ? largest / (255.0f * 255.0f)
                                                                 : largest / 65535.0f;
  }

  const size_t table = sizeof(header) + (width.profile.size() + color.profile.size()) * 4;
  size_t at = (table + blocks_.size() * 4 + 15) / 16 * 16, total = at;
  for (const Block& block : blocks_)
    total += FrozenLeaf::Layout(form, block.count, static_cast<int>(block.points)).end;
  std::vector<std::byte> bytes(total);
  std::memcpy(bytes.data(), &header, sizeof(header));
  std::byte* profiles = bytes.data() + sizeof(header);
  for (const std::vector<float>* profile : {&width.profile, &color.profile}) {
    const auto from = std::as_bytes(std::span(*profile));
    profiles = std::copy(from.begin(), from.end(), profiles);
  }
  for (size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    const uint16_t shape[2] = {static_cast<uint16_t>(block.count), static_cast<uint16_t>(block.points)};
    std::memcpy(bytes.data() + table + b * 4, shape, 4);
    const FrozenLeaf::Layout layout(form, block.count, static_cast<int>(block.points));
    std::byte* out = bytes.data() + at;
    const size_t n = block.count, row = layout.row;
    write_shapes(block, form, out);
    for (size_t s = 0; s < n; ++s) {
      if (form.has_clump_)
        rows<uint16_t>(out + layout.clumps)[s] = static_cast<uint16_t>(block.clump[s] * 65536.0f);
      float widest = 0, brightest = 0;
      for (size_t p = 0; p < block.points; ++p) widest = std::max(widest, block.radius[p * n + s]);
      for (size_t r = 0; r < form.color_rows_ * 3; ++r)
        brightest = std::max(brightest, block.color[r * n + s]);
      if (width.kind >= FrozenClass::kSeparable)
        rows<uint16_t>(out + layout.widths)[s] = sixteen_bits(widest, width.step);
      if (width.kind == FrozenClass::kFull) {
        for (size_t p = 0; p < block.points; ++p) {
          rows<uint8_t>(out + layout.widths + row * 2)[p * row + s] =
              static_cast<uint8_t>(quantised(block.radius[p * n + s], widest / 255.0f, 255.0f));
        }
      }
      if (color.kind == FrozenClass::kSeparable)
        rows<uint16_t>(out + layout.colors)[s] = sixteen_bits(brightest, color.step);
      if (color.kind != FrozenClass::kFull) continue;
      for (size_t r = 0; r < form.color_rows_ * 3; ++r) {
        const float v = block.color[r * n + s], step = header.color_step[r % 3];
        if (form.color_rows_ == 1) {
          rows<uint16_t>(out + layout.colors)[r * row + s] = sixteen_bits(v, step);
        } else {
          rows<uint8_t>(out + layout.colors)[r * row + s] =
              static_cast<uint8_t>(quantised(std::sqrt(v / step), 1.0f, 255.0f));
        }
      }
    }
    at += layout.end;
  }
  return bytes;
}

}  // namespace pelage
