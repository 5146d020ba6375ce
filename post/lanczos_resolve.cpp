// SPDX-License-Identifier: Apache-2.0
#include "post/lanczos_resolve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

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

constexpr size_t kSlots = 1 << 13;  // more than the 48 x 48 samples of a pixel's filter, so never full

}  // namespace

LanczosResolve::LanczosResolve(const PostLayers& layers, int scale)
    : layers_(layers), scale_(scale), reach_(kReach * scale), slots_(kSlots) {
  // Taps from kReach pixels before the pixel's first sample to kReach pixels behind its last one.
  for (int tap = 0; tap < scale + 2 * reach_; ++tap) {
    weights_.push_back(lanczos((tap - reach_ + 0.5) / scale - 0.5));
  }
  sums_to_.push_back(0);
  for (double w : weights_) sums_to_.push_back(sums_to_.back() + w);
}

void LanczosResolve::find_runs(const WorkBuffer& buffer, int y) {
  const PixelBox& box = buffer.samples();
  const int first = std::max(box.y0, y * scale_ - reach_), last = std::min(box.y1, (y + 1) * scale_ + reach_);
  // The rows of the pixels above are kept from the last call.
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

void LanczosResolve::add(uint32_t source, float weight, bool is_near) {
  size_t slot = (source * 0x9e3779b1u) >> (32 - 13);
  while (slots_[slot] != 0 && pixel_[slots_[slot] - 1u].source != source) slot = (slot + 1) % kSlots;
  if (slots_[slot] == 0) {
    pixel_.push_back({source, 0, false});
    slots_[slot] = static_cast<uint16_t>(pixel_.size());
  }
  Part& part = pixel_[slots_[slot] - 1u];
  part.weight += weight;
  part.is_near |= is_near;
}

LanczosResolve::Gathered LanczosResolve::gather(int x, int y, const PixelBox& samples) {
  for (const Part& part : pixel_) {  // empties the table: what it holds is near where it belongs
    size_t slot = (part.source * 0x9e3779b1u) >> (32 - 13);
    while (slots_[slot] != 0) {
      slots_[slot] = 0;
      slot = (slot + 1) % kSlots;
    }
  }
  pixel_.clear();
  bool near_hole = false;
  const int tap0 = x * scale_ - reach_;  // sample of the first tap
  const int begin = std::max(samples.x0, tap0), end = std::min(samples.x1, (x + 1) * scale_ + reach_);
  const double across =
      sums_to_[static_cast<size_t>(end - tap0)] - sums_to_[static_cast<size_t>(begin - tap0)];
  double down = 0;
  const int near_x0 = (x - 1) * scale_, near_x1 = (x + 2) * scale_;
  for (size_t i = 0; i < runs_.size(); ++i) {
    const int row = runs_row_ + static_cast<int>(i);
    const double weight = weights_[static_cast<size_t>(row - (y * scale_ - reach_))];
    down += weight;
    const bool near_row = row >= (y - 1) * scale_ && row < (y + 2) * scale_;
    const std::vector<Run>& runs = runs_[i];
    size_t& first = first_run_[i];
    while (runs[first + 1].begin <= begin) ++first;
    for (size_t r = first; r + 1 < runs.size() && runs[r].begin < end; ++r) {
      const int from = std::max(runs[r].begin, begin), to = std::min(runs[r + 1].begin, end);
      const bool is_near = near_row && from < near_x1 && to > near_x0;
      if (runs[r].sample.is_empty()) {
        near_hole |= is_near;
        continue;
      }
      const double run =
          sums_to_[static_cast<size_t>(to - tap0)] - sums_to_[static_cast<size_t>(from - tap0)];
      add(runs[r].sample.pixel(), static_cast<float>(weight * run), is_near);
    }
  }
  Gathered result{sources_.size(), 0, 0, static_cast<float>(across * down), near_hole};
  for (const bool near : {true, false}) {
    for (const Part& part : pixel_) {
      if (part.is_near != near) continue;
      sources_.push_back(part.source);
      part_weights_.push_back(part.weight);
    }
    (near ? result.near_last : result.last) = sources_.size();
  }
  return result;
}

void LanczosResolve::find_offsets(const Plane& source) {
  offsets_.clear();
  for (const uint32_t pixel : sources_) {
    const auto x = static_cast<ptrdiff_t>(pixel & 0xffff), y = static_cast<ptrdiff_t>(pixel >> 16);
    offsets_.push_back((y - source.first_row) * source.row_stride + x * source.pixel_stride);
  }
}

float LanczosResolve::resolve(const Gathered& pixel, const float* words) const {
  float low = pixel.near_hole ? 0 : std::numeric_limits<float>::infinity();
  float high = pixel.near_hole ? 0 : -low;
  for (size_t i = pixel.first; i < pixel.near_last; ++i) {
    float v = words[offsets_[i]];
    v = v == v ? v : 0;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  // Four sums that do not wait for each other.
  float sums[4] = {0, 0, 0, 0};
  const auto add_to = [&](float& sum, size_t i) {
    const float v = words[offsets_[i]];
    sum += part_weights_[i] * (v == v ? v : 0);
  };
  size_t i = pixel.first;
  for (; i + 4 <= pixel.last; i += 4) {
    for (size_t k = 0; k < 4; ++k) add_to(sums[k], i + k);
  }
  for (; i < pixel.last; ++i) add_to(sums[0], i);
  const float value = ((sums[0] + sums[1]) + (sums[2] + sums[3])) / pixel.weight;
  // Infinite colours make the sum meaningless; the limits are still true.
  return value == value ? std::clamp(value, low, high) : high;
}

void LanczosResolve::write_row(const WorkBuffer& buffer, int y) {
  find_runs(buffer, y);
  const PixelBox& samples = buffer.samples();
  const int end = samples.x1 / scale_;
  for (int x0 = samples.x0 / scale_; x0 < end; x0 += kSegment) {
    const int x1 = std::min(x0 + kSegment, end);
    pixels_.clear();
    sources_.clear();
    part_weights_.clear();
    for (int x = x0; x < x1; ++x) pixels_.push_back(gather(x, y, samples));
    const Plane* last = nullptr;
    for (const PostChannel& channel : layers_.channels) {
      if (channel.role != LayerRole::kColor) continue;
      const Plane& source = channel.source;
      const bool same_layout = last && last->pixel_stride == source.pixel_stride &&
                               last->row_stride == source.row_stride && last->first_row == source.first_row;
      if (!same_layout) find_offsets(source);
      last = &source;
      for (int x = x0; x < x1; ++x) {
        channel.target.at(x, y) = resolve(pixels_[static_cast<size_t>(x - x0)], source.words);
      }
    }
  }
}

}  // namespace pelage
