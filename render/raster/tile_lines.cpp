// SPDX-License-Identifier: Apache-2.0
#include "render/raster/tile_lines.h"

#include <cmath>
#include <numeric>

namespace pelage {
namespace {

constexpr float kBeamRounding = 0x1p-18f;

constexpr float kPerCell = 8;     // lines in a row's height of cells, on average
constexpr size_t kPerGroup = 64;  // lines, at least

int part_of(float x, const Range& range, int parts) {
  if (parts == 1 || !(range.size() > 0)) return 0;
  const float at = (x - range.low) / range.size() * static_cast<float>(parts);
  return std::clamp(static_cast<int>(at), 0, parts - 1);
}

}  // namespace

/// The least position of many lines is a concave function of depth: between two depths it is above its chord.
TileBeam::TileBeam(const TileFrame& frame, const TileLines& lines, float near, float first, float last) {
  last = std::max(last, first + 1e-3f * std::abs(first) + 1e-20f);
  const std::array<Range, 2> begin = lines.extent(first), end = lines.extent(last);
  const float reach = std::max({std::abs(first), std::abs(last), frame.origin.length()});
  for (size_t i = 0; i < 4; ++i) {
    const size_t axis = i / 2;
    const bool is_low = i % 2 == 0;
    const float sign = is_low ? 1.0f : -1.0f;
    const float from = is_low ? begin[axis].low : begin[axis].high,
                to = is_low ? end[axis].low : end[axis].high;
    Side& side = sides_[i];
    side.axis = static_cast<int>(axis);
    side.sign = sign;
    side.slope = (to - from) / (last - first);
    side.offset = from - side.slope * first - sign * kBeamRounding * (reach + std::abs(from) + std::abs(to));
    const V3f normal = sign * (frame.axes[axis] - side.slope * frame.axes[2]);
    beam_.sides[i] = {normal, -sign * side.offset - normal.dot(frame.origin)};
  }
  for (size_t axis = 0; axis < 2; ++axis)
    beam_.across[axis] = {frame.axes[axis], -frame.axes[axis].dot(frame.origin)};
  beam_.depth = {frame.axes[2], -frame.axes[2].dot(frame.origin)};
  beam_.near = near - kBeamRounding * reach;
}

int TileLines::cell(float position, size_t axis) const {
  const float at = (position - low_[axis]) * inverse_size_[axis];
  const int count = axis == 0 ? columns_ : rows_;
  return static_cast<int>(std::clamp(at + 1, 0.0f, static_cast<float>(count + 1))) - 1;
}

void TileLines::assign(std::span<const TileLine> lines, float reference, int lens_parts) {
  inverse_reference_ = std::isfinite(reference) && reference > 0 ? 1 / reference : 0;
  const auto position = [&](const TileLine& line) { return line.b + inverse_reference_ * line.a; };
  Range at[2], a[2], time;
  slopes_[0] = slopes_[1] = {};
  offsets_[0] = offsets_[1] = {};
  for (const TileLine& line : lines) {
    slopes_[0].extend(line.b.x), slopes_[1].extend(line.b.y);
    const V2f c = position(line);
    at[0].extend(c.x), at[1].extend(c.y);
    a[0].extend(line.a.x), a[1].extend(line.a.y);
    time.extend(line.time);
  }
  has_lens_ = a[0].size() > 0 || a[1].size() > 0 || a[0].low != 0 || a[1].low != 0;
  offsets_[0] = a[0], offsets_[1] = a[1];
  grid_.begin(lines.size(), at);
  int parts = 1;
  while (has_lens_ && parts < std::min(lens_parts, kMaxLensParts) &&
         lines.size() >= kPerGroup * static_cast<size_t>((parts + 1) * (parts + 1)))
    ++parts;
  const auto group_count = static_cast<size_t>(parts * parts);
  const float per_group = static_cast<float>(lines.size()) / static_cast<float>(group_count);
  rows_ = std::clamp(static_cast<int>(std::sqrt(per_group / kPerCell)), 1, kMaxRows);
  columns_ = 2 * rows_;
  for (size_t axis = 0; axis < 2; ++axis) {
    const int count = axis == 0 ? columns_ : rows_;
    low_[axis] = at[axis].low;
    size_[axis] = std::max(at[axis].size() / static_cast<float>(count), 1e-30f);
    inverse_size_[axis] = 1 / size_[axis];
  }

  const auto cells = static_cast<uint32_t>(rows_ * columns_);
  groups_.assign(group_count, {});
  for (size_t g = 0; g < group_count; ++g) groups_[g].first_start = static_cast<uint32_t>(g) * cells;
  starts_.assign(group_count * cells + 1, 0);
  keys_.resize(lines.size());
  for (size_t i = 0; i < lines.size(); ++i) {
    const TileLine& line = lines[i];
    const int g = part_of(line.a.y, a[1], parts) * parts + part_of(line.a.x, a[0], parts);
    Group& group = groups_[static_cast<size_t>(g)];
    group.a[0].extend(line.a.x), group.a[1].extend(line.a.y);
    group.time.extend(line.time);
    const V2f c = position(line);
    const int row = std::clamp(cell(c.y, 1), 0, rows_ - 1),
              column = std::clamp(cell(c.x, 0), 0, columns_ - 1);
    keys_[i] = static_cast<uint32_t>(g) * cells + static_cast<uint32_t>(row * columns_ + column);
    ++starts_[keys_[i]];
  }
  std::exclusive_scan(starts_.begin(), starts_.end(), starts_.begin(), 0u);
  place_.resize(lines.size());
  for (size_t i = 0; i < lines.size(); ++i) place_[i] = starts_[keys_[i]]++;
  for (size_t i = starts_.size() - 1; i > 0; --i) starts_[i] = starts_[i - 1];
  starts_[0] = 0;

  const size_t padded = lines.size() + kPadding;
  for (auto* values : {&ax_, &ay_, &bx_, &by_, &time_}) values->assign(padded, 0.0f);
  depth_.assign(padded, std::numeric_limits<float>::infinity());
  chunk_.assign(padded, TileWinner::kNothing);
  for (auto* values : {&primitive_, &random_}) values->assign(padded, 0u);
  for (size_t i = 0; i < lines.size(); ++i) {
    const TileLine& line = lines[i];
    const uint32_t to = place_[i];
    ax_[to] = line.a.x, ay_[to] = line.a.y;
    bx_[to] = line.b.x, by_[to] = line.b.y;
    time_[to] = line.time;
    random_[to] = line.random;
    grid_.place(to, position(line));
  }
}

int TileLines::lens_parts(const Range& depths) const {
  if (!has_lens_) return 1;
  float shift = 0;
  for (const float depth : {depths.low, depths.high})
    shift = std::max(shift, std::abs(1 / std::max(depth, 1e-18f) - inverse_reference_));
  const float radius = 0.5f * std::max(offsets_[0].size(), offsets_[1].size());
  const float blur = shift * radius * std::min(grid_.inverse_size(0), grid_.inverse_size(1));  // in cells
  // The cells of a group are larger by the number of its parts.
  return static_cast<int>(std::clamp(std::sqrt(blur), 1.0f, float{kMaxLensParts}));
}

TileLines::Arrays TileLines::arrays() {
  return {ax_.data(),    ay_.data(),    bx_.data(),        by_.data(),    time_.data(),
          depth_.data(), chunk_.data(), primitive_.data(), random_.data()};
}

std::array<Range, 2> TileLines::extent(float depth) const {
  std::array<Range, 2> result;
  if (!has_lens_) {
    for (size_t axis = 0; axis < 2; ++axis) {
      result[axis].extend(depth * slopes_[axis].low);
      result[axis].extend(depth * slopes_[axis].high);
    }
    return result;
  }
  for (size_t i = 0; i < size(); ++i) {
    result[0].extend(ax_[i] + depth * bx_[i]);
    result[1].extend(ay_[i] + depth * by_[i]);
  }
  return result;
}

void TileLines::trace_all() { std::fill(chunk_.begin(), chunk_.end(), TileWinner::kTraced); }

void TileLines::trace(const ViewFootprint& footprint) {
  for (size_t i = 0; i < size(); ++i) {
    if (footprint.depth > depth_[i] || !grid_.contains(footprint, i)) continue;
    depth_[i] = footprint.depth;
    chunk_[i] = TileWinner::kTraced;
  }
}

size_t TileLines::bytes(size_t lines) {
  const size_t starts = lines / static_cast<size_t>(kPerCell) * 2 + kMaxLensParts * kMaxLensParts * 2 + 1;
  return (lines + kPadding) * (9 * sizeof(float)) + lines * 2 * sizeof(uint32_t) + starts * sizeof(uint32_t) +
         kMaxLensParts * kMaxLensParts * sizeof(Group) + DepthGrid::bytes(lines);
}

}  // namespace pelage
