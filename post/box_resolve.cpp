// SPDX-License-Identifier: Apache-2.0
#include "post/box_resolve.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "post/color_sum.h"

namespace pelage {
namespace {

int source_x(uint32_t pixel) { return static_cast<int>(pixel & 0xffff); }
int source_y(uint32_t pixel) { return static_cast<int>(pixel >> 16); }

/// The distinct source pixels among the samples of one pixel, in order of first occurrence.
class Sources {
 public:
  void count(const Sample& sample) {
    if (sample.is_empty()) return;
    const uint32_t pixel = sample.pixel();
    if (size_ > 0 && pixels_[last_] == pixel) {
      ++counts_[last_];
      return;
    }
    for (last_ = 0; last_ < size_ && pixels_[last_] != pixel; ++last_) {
    }
    if (last_ == size_) {
      pixels_[size_] = pixel;
      counts_[size_++] = 0;
    }
    ++counts_[last_];
  }
  uint32_t size() const { return size_; }
  uint32_t pixel(uint32_t i) const { return pixels_[i]; }
  uint32_t count_of(uint32_t i) const { return counts_[i]; }

 private:
  uint32_t pixels_[64], counts_[64];  // 8 x 8 samples at most
  uint32_t size_ = 0, last_ = 0;
};

}  // namespace

void BoxResolve::begin(const PixelBox& box, int scale) {
  box_ = box;
  scale_ = scale;
  samples_ = 0;
  const size_t pixels = static_cast<size_t>(box.width()) * static_cast<size_t>(box.height());
  states_.assign(pixels, State());
  entries_.clear();
  sums_.assign(with_colors_ ? pixels * layers_.channels.size() : 0, 0);
  matte_sums_.assign(layers_.mattes.empty() ? 0 : pixels * layers_.mattes.size(), {});
}

void BoxResolve::see(uint32_t at, uint32_t source, uint32_t count) {
  State& state = states_[at];
  if (state.count > 0 && state.source != source) {
    entries_.push_back({at, state.source, state.count});
    state.is_mixed = true;
    state.count = 0;
    if (entries_.size() >= kMaxEntries) flush();
  }
  state.source = source;
  state.count += count;
}

void BoxResolve::add(const WorkBuffer& buffer, int steps) {
  const auto repeats = static_cast<uint32_t>(steps);
  const int s = scale_;
  const auto all = static_cast<uint32_t>(s) * static_cast<uint32_t>(s);
  samples_ += all * repeats;
  uint32_t at = 0;
  for (int y = box_.y0; y < box_.y1; ++y) {
    const Sample* rows[8];
    for (int j = 0; j < s; ++j) rows[j] = buffer.row(y * s + j) + (box_.x0 * s - buffer.samples().x0);
    for (int x = box_.x0; x < box_.x1; ++x, ++at) {
      const Sample first = rows[0][0];
      bool same = true;
      for (int j = 0; j < s; ++j) {
        for (int i = 0; i < s; ++i) same &= rows[j][i] == first;
      }
      State& state = states_[at];
      if (same) {
        if (!first.is_empty()) {
          see(at, first.pixel(), all * repeats);
          if (first.is_nearer_than(state.front)) state.front = first;
        }
      } else {
        Sources sources;
        Sample front = state.front;
        for (int j = 0; j < s; ++j) {
          for (int i = 0; i < s; ++i) {
            sources.count(rows[j][i]);
            if (rows[j][i].is_nearer_than(front)) front = rows[j][i];
          }
        }
        state.front = front;
        for (uint32_t i = 0; i < sources.size(); ++i)
          see(at, sources.pixel(i), sources.count_of(i) * repeats);
      }
      for (int j = 0; j < s; ++j) rows[j] += s;
    }
  }
}

void BoxResolve::flush() {
  for (size_t c = 0; c < layers_.channels.size(); ++c) {
    const PostChannel& channel = layers_.channels[c];
    if (channel.role != LayerRole::kColor || !with_colors_) continue;
    float* const sums = &sums_[c * states_.size()];
    for (const Entry& e : entries_) {
      const float v = channel.source.at(source_x(e.source), source_y(e.source));
      sums[e.at] += static_cast<float>(e.count) * color_to_sum(v);
    }
  }
  for (size_t m = 0; m < layers_.mattes.size(); ++m) {
    for (const Entry& e : entries_) add_to_matte(layers_.mattes[m], e);
  }
  entries_.clear();
}

void BoxResolve::add_to_matte(const RankedMatte& matte, const Entry& e) {
  const size_t number = static_cast<size_t>(&matte - layers_.mattes.data());
  auto& sums = matte_sums_[number * states_.size() + e.at];
  const int x = source_x(e.source), y = source_y(e.source);
  for (const RankedMatte::Rank& rank : matte.ranks) {
    const float coverage = layers_.channels[rank.coverage].source.at(x, y);
    if (!(coverage > 0)) continue;
    const auto id = std::bit_cast<uint32_t>(layers_.channels[rank.id].source.at(x, y));
    auto found = std::find_if(sums.begin(), sums.end(), [&](const auto& sum) { return sum.first == id; });
    if (found == sums.end()) found = sums.insert(sums.end(), {id, 0.0f});
    found->second += static_cast<float>(e.count) * color_to_sum(coverage);
  }
}

void BoxResolve::write_matte(size_t matte, uint32_t at, int x, int y) {
  auto& sums = matte_sums_[matte * states_.size() + at];
  std::sort(sums.begin(), sums.end(), [](const auto& a, const auto& b) {
    return a.second != b.second ? a.second > b.second : a.first < b.first;
  });
  const auto& ranks = layers_.mattes[matte].ranks;
  for (size_t i = 0; i < ranks.size(); ++i) {
    const bool has = i < sums.size();
    layers_.channels[ranks[i].id].target.at(x, y) = has ? std::bit_cast<float>(sums[i].first) : 0;
    layers_.channels[ranks[i].coverage].target.at(x, y) =
        has ? color_of_mean(sums[i].second / static_cast<float>(samples_)) : 0;
  }
}

void BoxResolve::write_pixel(uint32_t at, int x, int y) {
  const State& state = states_[at];
  const bool is_copy = !state.is_mixed && state.count == samples_;
  for (size_t c = 0; c < layers_.channels.size(); ++c) {
    const PostChannel& channel = layers_.channels[c];
    if (channel.role == LayerRole::kColor && !with_colors_) continue;
    float& to = channel.target.at(x, y);
    if (is_copy) {
      to = channel.source.at(source_x(state.source), source_y(state.source));
    } else if (channel.role == LayerRole::kColor) {
      to = color_of_mean(sums_[c * states_.size() + at] / static_cast<float>(samples_));
    } else if (channel.role == LayerRole::kData || channel.role == LayerRole::kDepth) {
      const float empty = channel.role == LayerRole::kDepth ? std::numeric_limits<float>::infinity() : 0.0f;
      to = state.front.is_empty() ? empty : channel.source.at(state.front.x(), state.front.y());
    }
  }
  if (is_copy) return;
  for (size_t m = 0; m < layers_.mattes.size(); ++m) write_matte(m, at, x, y);
}

void BoxResolve::finish() {
  for (uint32_t at = 0; at < states_.size(); ++at) {
    const State& state = states_[at];
    if (state.count > 0 && (state.is_mixed || state.count < samples_)) {
      entries_.push_back({at, state.source, state.count});
      if (entries_.size() >= kMaxEntries) flush();
    }
  }
  flush();
  uint32_t at = 0;
  for (int y = box_.y0; y < box_.y1; ++y) {
    for (int x = box_.x0; x < box_.x1; ++x) write_pixel(at++, x, y);
  }
}

}  // namespace pelage
