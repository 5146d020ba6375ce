// SPDX-License-Identifier: Apache-2.0
#include "groom/frozen_leaf.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/hash.h"
#include "groom/frozen_leaf_format.h"

namespace pelage {
namespace {

template <class T>
const T* rows(const std::byte* at) {
  return reinterpret_cast<const T*>(at);
}

/// Adds the next step of every strand to where it is.
template <class T>
void advance(const T* __restrict q, const float* __restrict step, size_t count, float* __restrict at) {
  for (size_t s = 0; s < count; ++s) at[s] += static_cast<float>(q[s]) * step[s];
}

bool good_floats(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

}  // namespace

std::optional<FrozenLeaf> FrozenLeaf::read(std::span<const std::byte> bytes) {
  Header header;
  if (bytes.size() < sizeof(header)) return {};
  std::memcpy(&header, bytes.data(), sizeof(header));
  const auto is_class = [](uint8_t c) { return c <= static_cast<uint8_t>(FrozenClass::kFull); };
  if (!is_class(header.width_class) || !is_class(header.color_class)) return {};
  const size_t profiles = (size_t(header.width_points) + size_t(header.color_profile_rows) * 3) * 4;
  const size_t table = sizeof(header) + profiles;
  size_t at = (table + size_t(header.blocks) * 4 + 15) / 16 * 16;
  if (at > bytes.size()) return {};

  FrozenLeaf leaf;
  leaf.bytes_ = bytes;
  leaf.strands_ = header.strands;
  leaf.wide_ = header.wide != 0;
  leaf.has_base_ = header.has_base != 0;
  leaf.has_clump_ = header.has_clump != 0;
  leaf.width_class_ = static_cast<FrozenClass>(header.width_class);
  leaf.color_class_ = static_cast<FrozenClass>(header.color_class);
  leaf.color_rows_ = header.color_rows;
  leaf.width_step_ = header.width_step;
  std::copy_n(header.color_step, 3, leaf.color_step_);
  leaf.width_profile_.resize(header.width_points);
  leaf.color_profile_.resize(size_t(header.color_profile_rows) * 3);
  size_t from = sizeof(header);
  for (std::vector<float>* profile : {&leaf.width_profile_, &leaf.color_profile_}) {
    const auto values = bytes.subspan(from, profile->size() * 4);
    std::copy(values.begin(), values.end(), std::as_writable_bytes(std::span(*profile)).begin());
    from += values.size();
  }
  if (!good_floats(leaf.width_profile_) || !good_floats(leaf.color_profile_) ||
      !good_floats({header.width_step, header.color_step[0], header.color_step[1], header.color_step[2]})) {
    return {};
  }
  const bool profiled =
      leaf.color_class_ == FrozenClass::kConstant || leaf.color_class_ == FrozenClass::kSeparable;
  if (leaf.color_class_ != FrozenClass::kNone && (header.color_rows == 0 || header.color_rows > UINT16_MAX))
    return {};
  if (profiled && header.color_profile_rows != header.color_rows) return {};

  const bool one_width =
      leaf.width_class_ == FrozenClass::kConstant || leaf.width_class_ == FrozenClass::kSeparable;
  uint32_t first = 0;
  for (uint32_t i = 0; i < header.blocks; ++i) {
    uint16_t shape[2];
    std::memcpy(shape, bytes.data() + table + size_t(i) * 4, 4);
    const auto [count, points] = shape;
    if (count == 0 || count > kBlockStrands || points < 1) return {};
    if (one_width && points != header.width_points) return {};
    if (leaf.color_class_ != FrozenClass::kNone && header.color_rows != 1 && header.color_rows != points)
      return {};
    const Layout layout(leaf, count, points);
    if (layout.end > bytes.size() - at) return {};
    leaf.blocks_.push_back({first, count, points, at});
    first += count;
    at += layout.end;
  }
  if (first != header.strands || at != bytes.size()) return {};
  return leaf;
}

void FrozenLeaf::attributes(const Block& block, StrandBatch& batch) const {
  const Layout layout(*this, block.count, block.points);
  const std::byte* data = bytes_.data() + block.data;
  const size_t count = batch.count, row = layout.row;
  for (size_t s = 0; s < count; ++s) {
    batch.clump[s] = has_clump_ ? (rows<uint16_t>(data + layout.clumps)[s] + 0.5f) * 0x1p-16f
                                : unit_float(hash64(batch.ids[s], random_use("no clump")));
  }
  if (width_class_ != FrozenClass::kNone) {
    const auto* factor = rows<uint16_t>(data + layout.widths);
    const auto* full = rows<uint8_t>(data + layout.widths + row * 2);
    for (size_t p = 0; p < batch.points.size(); ++p) {
      float* __restrict radius = batch.points[p].radius.data();
      if (width_class_ == FrozenClass::kConstant) {
        std::fill_n(radius, count, width_profile_[p]);
      } else if (width_class_ == FrozenClass::kSeparable) {
        for (size_t s = 0; s < count; ++s) radius[s] = factor[s] * width_step_ * width_profile_[p];
      } else {
        for (size_t s = 0; s < count; ++s)
          radius[s] = factor[s] * width_step_ * (full[p * row + s] * (1.0f / 255.0f));
      }
    }
  }
  if (color_class_ == FrozenClass::kNone) return;
  for (size_t p = 0; p < batch.colors.size(); ++p) {
    const size_t from = std::min(p, color_rows_ - 1);
    for (size_t c = 0; c < 3; ++c) {
      float* __restrict out = batch.colors[p][c].data();
      const std::byte* at = data + layout.colors;
      if (color_class_ == FrozenClass::kConstant) {
        std::fill_n(out, count, color_profile_[from * 3 + c]);
      } else if (color_class_ == FrozenClass::kSeparable) {
        const float step = color_step_[0] * color_profile_[from * 3 + c];
        for (size_t s = 0; s < count; ++s) out[s] = rows<uint16_t>(at)[s] * step;
      } else if (color_rows_ == 1) {
        for (size_t s = 0; s < count; ++s) out[s] = rows<uint16_t>(at)[c * row + s] * color_step_[c];
      } else {
        const auto* root = rows<uint8_t>(at) + (from * 3 + c) * row;
        for (size_t s = 0; s < count; ++s) {
          const float q = root[s];
          out[s] = q * q * color_step_[c];
        }
      }
    }
  }
}

void FrozenLeaf::shape(const Block& block, const RootRows& frames, float scale, StrandBatch& batch) const {
  const Layout layout(*this, block.count, block.points);
  const std::byte* data = bytes_.data() + block.data;
  const size_t count = batch.count, row = layout.row;
  const auto* step = rows<float>(data + layout.steps);
  const std::byte* next = data + layout.shapes;
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
      if (wide_) {
        std::copy_n(rows<float>(next), count, axis.data());
        next += row * 4;
      } else {
        advance(rows<int16_t>(next), step, count, axis.data());
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
