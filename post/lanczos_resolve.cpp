// SPDX-License-Identifier: Apache-2.0
#include "post/lanczos_resolve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "post/color_sum.h"

namespace pelage {
namespace {

double sinc(double t) {
  const double a = std::numbers::pi * t;
  return std::abs(a) < 1e-9 ? 1 : std::sin(a) / a;
}

double lanczos(double t) {
  const int lobes = LanczosResolve::kReach;
  return std::abs(t) < lobes ? sinc(t) * sinc(t / lobes) : 0;
}

// More than a segment's sources: kEnoughSources, plus the sources of one more pixel, 56 x 56 at most.
constexpr int kSlotBits = 14;
constexpr size_t kSlots = size_t{1} << kSlotBits;

size_t slot_of(uint32_t pixel) { return (pixel * 0x9e3779b1u) >> (32 - kSlotBits); }

}  // namespace

LanczosResolve::LanczosResolve(const PostLayers& layers, int scale)
    : scale_(scale), reach_(kReach * scale), slots_(kSlots) {
  // Taps from kReach pixels before the pixel's first sample to kReach pixels behind its last one.
  for (int tap = 0; tap < scale + 2 * reach_; ++tap) {
    weights_.push_back(lanczos((tap - reach_ + 0.5) / scale - 0.5));
  }
  sums_to_.push_back(0);
  for (double w : weights_) sums_to_.push_back(sums_to_.back() + w);
  for (const PostChannel& channel : layers.channels) {
    if (channel.role == LayerRole::kColor) channels_.push_back(channel);
  }
  color_count_ = channels_.size();
  while (channels_.size() % kLanes != 0) channels_.push_back(PostChannel(channels_.back()));
}

size_t LanczosResolve::bytes_needed(int width, size_t channels, int scale) {
  const auto s = static_cast<size_t>(scale), rows = (1 + 2 * kReach) * s;
  const size_t lanes = (channels + kLanes - 1) / kLanes * kLanes;
  const size_t sources = (kLongestSegment + 2 * kReach + 2) * (1 + 2 * kReach);
  const size_t runs = static_cast<size_t>(width) + 2;
  return sizeof(Run) * 2 * rows * runs + kSlots * sizeof(uint16_t) + sources * (lanes * sizeof(float) + 16) +
         kLongestSegment * (1 + 2 * kReach) * (1 + 2 * kReach) * 2 * sizeof(Part);
}

void LanczosResolve::find_runs(const WorkBuffer& buffer, int y) {
  const PixelBox& box = buffer.samples();
  const int first = std::max(box.y0, y * scale_ - reach_), last = std::min(box.y1, (y + 1) * scale_ + reach_);
  // The rows of the pixels above are kept from the previous call.
  const int kept_end = runs_row_ + static_cast<int>(runs_.size());
  if (first < runs_row_ || first > kept_end) {
    runs_.clear();
  } else {
    std::rotate(runs_.begin(), runs_.begin() + (first - runs_row_), runs_.end());
    runs_.resize(static_cast<size_t>(std::max(0, kept_end - first)));
  }
  runs_row_ = first;
  for (int row = first + static_cast<int>(runs_.size()); row < last; ++row) {
    std::vector<Run> runs;
    const Sample* samples = buffer.row(row);
    for (int x = box.x0; x < box.x1; ++x) {
      const Sample& sample = samples[x - box.x0];
      if (runs.empty() || runs.back().sample != sample) runs.push_back({x, sample});
    }
    runs.push_back({box.x1, Sample()});
    runs_.push_back(std::move(runs));
  }
  runs_.resize(static_cast<size_t>(last - first));
  first_run_.assign(runs_.size(), 0);
}

/// Whether the next row has the same runs between two samples and contributes to the same pixels.
bool LanczosResolve::is_repeated(size_t row, int begin, int end) {
  if (row + 1 >= runs_.size() || (runs_row_ + static_cast<int>(row) + 1) % scale_ == 0) return false;
  const std::vector<Run>&a = runs_[row], &b = runs_[row + 1];
  while (b[first_run_[row + 1] + 1].begin <= begin) ++first_run_[row + 1];
  size_t i = first_run_[row], k = first_run_[row + 1];
  if (a[i].sample != b[k].sample) return false;
  for (++i, ++k; a[i].begin < end || b[k].begin < end; ++i, ++k) {
    if (a[i].begin != b[k].begin || a[i].sample != b[k].sample) return false;
  }
  return true;
}

void LanczosResolve::add(uint32_t pixel, float weight, bool is_near) {
  size_t slot = slot_of(pixel);
  while (slots_[slot] != 0 && sources_[slots_[slot] - 1u] != pixel) slot = (slot + 1) % kSlots;
  if (slots_[slot] == 0) {
    sources_.push_back(pixel);
    shares_.emplace_back();
    slots_[slot] = static_cast<uint16_t>(sources_.size());
  }
  const uint32_t source = slots_[slot] - 1u;
  Share& share = shares_[source];
  if (!share.is_met) met_.push_back(source);
  share.is_met = true;
  share.weight += weight;
  share.is_near |= is_near;
}

LanczosResolve::Gathered LanczosResolve::gather(int x, int y, const PixelBox& samples) {
  bool near_hole = false;
  const int tap0 = x * scale_ - reach_;  // sample of the first tap
  const int begin = std::max(samples.x0, tap0), end = std::min(samples.x1, (x + 1) * scale_ + reach_);
  const double across =
      sums_to_[static_cast<size_t>(end - tap0)] - sums_to_[static_cast<size_t>(begin - tap0)];
  double down = 0, pending = 0;
  const int near_x0 = (x - 1) * scale_, near_x1 = (x + 2) * scale_;
  for (size_t i = 0; i < runs_.size(); ++i) {
    const int row = runs_row_ + static_cast<int>(i);
    const double weight = weights_[static_cast<size_t>(row - (y * scale_ - reach_))];
    down += weight;
    pending += weight;
    const std::vector<Run>& runs = runs_[i];
    size_t& first = first_run_[i];
    while (runs[first + 1].begin <= begin) ++first;
    if (is_repeated(i, begin, end)) continue;
    const bool near_row = row >= (y - 1) * scale_ && row < (y + 2) * scale_;
    for (size_t r = first; r + 1 < runs.size() && runs[r].begin < end; ++r) {
      const int from = std::max(runs[r].begin, begin), to = std::min(runs[r + 1].begin, end);
      const bool is_near = near_row && from < near_x1 && to > near_x0;
      if (runs[r].sample.is_empty()) {
        near_hole |= is_near;
        continue;
      }
      const double run =
          sums_to_[static_cast<size_t>(to - tap0)] - sums_to_[static_cast<size_t>(from - tap0)];
      add(runs[r].sample.pixel(), static_cast<float>(pending * run), is_near);
    }
    pending = 0;
  }
  Gathered result{parts_.size(), 0, 0, static_cast<float>(across * down), near_hole};
  for (const bool near : {true, false}) {
    for (const uint32_t source : met_) {
      if (shares_[source].is_near == near) parts_.push_back({source, shares_[source].weight});
    }
    (near ? result.near_last : result.last) = parts_.size();
  }
  for (const uint32_t source : met_) shares_[source] = {};
  met_.clear();
  return result;
}

void LanczosResolve::fetch_colors() {
  colors_.resize(std::max<size_t>(1, sources_.size()) * channels_.size());  // never null
  for (size_t c0 = 0; c0 < channels_.size(); c0 += kLanes) {
    const PostChannel* const channels = &channels_[c0];
    float* to = colors_.data() + c0;
    for (const uint32_t pixel : sources_) {
      const int x = static_cast<int>(pixel & 0xffff), y = static_cast<int>(pixel >> 16);
      for (size_t c = 0; c < kLanes; ++c) {
        to[c] = color_to_sum(channels[c].source.at(x, y));
      }
      to += channels_.size();
    }
  }
}

void LanczosResolve::resolve(const Gathered& pixel, int x, int y) const {
  const size_t stride = channels_.size();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (size_t c0 = 0; c0 < stride; c0 += kLanes) {
    // In separate loops, so that each keeps its lanes in registers.
    const float* const colors = colors_.data() + c0;
    float sum[kLanes] = {}, low[kLanes], high[kLanes];
    for (size_t i = pixel.first; i < pixel.last; ++i) {
      const float* const v = colors + parts_[i].source * stride;
      const float weight = parts_[i].weight;
      for (size_t c = 0; c < kLanes; ++c) sum[c] += weight * v[c];
    }
    std::fill(low, low + kLanes, pixel.near_hole ? 0 : kInfinity);
    for (size_t i = pixel.first; i < pixel.near_last; ++i) {
      const float* const v = colors + parts_[i].source * stride;
      for (size_t c = 0; c < kLanes; ++c) low[c] = v[c] < low[c] ? v[c] : low[c];
    }
    std::fill(high, high + kLanes, pixel.near_hole ? 0 : -kInfinity);
    for (size_t i = pixel.first; i < pixel.near_last; ++i) {
      const float* const v = colors + parts_[i].source * stride;
      for (size_t c = 0; c < kLanes; ++c) high[c] = v[c] > high[c] ? v[c] : high[c];
    }
    for (size_t c = 0; c < std::min(kLanes, color_count_ - c0); ++c) {
      const float value = sum[c] / pixel.weight;
      // Infinite colours make the sum meaningless, but the limits are still valid.
      channels_[c0 + c].target.at(x, y) =
          color_of_mean(value == value ? std::clamp(value, low[c], high[c]) : high[c]);
    }
  }
}

void LanczosResolve::finish_segment(int x0, int y) {
  fetch_colors();
  for (size_t i = 0; i < pixels_.size(); ++i) resolve(pixels_[i], x0 + static_cast<int>(i), y);
  pixels_.clear();
  parts_.clear();
  sources_.clear();
  shares_.clear();
  std::fill(slots_.begin(), slots_.end(), uint16_t{0});
}

void LanczosResolve::write_row(const WorkBuffer& buffer, int y) {
  if (color_count_ == 0) return;
  find_runs(buffer, y);
  const PixelBox& samples = buffer.samples();
  const int end = samples.x1 / scale_;
  int x0 = samples.x0 / scale_;
  for (int x = x0; x < end; ++x) {
    pixels_.push_back(gather(x, y, samples));
    if (pixels_.size() < kLongestSegment && sources_.size() < kEnoughSources && x + 1 < end) continue;
    finish_segment(x0, y);
    x0 = x + 1;
  }
}

}  // namespace pelage
