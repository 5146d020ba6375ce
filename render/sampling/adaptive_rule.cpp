// SPDX-License-Identifier: Apache-2.0
#include "render/sampling/adaptive_rule.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

/// Pixels darker than this fraction of the picture's mean are treated as that bright.
constexpr double kDark = 0.1;
/// Per pixel, variances are estimates too: without this factor half of the pixels would exceed the budget.
constexpr double kExcess = 1.5;

struct Offset {
  int x, y;
};
/// The pixels of the other colour in a 5 x 5 neighbourhood.
constexpr Offset kOtherColor[] = {{0, -1},  {-1, 0}, {1, 0},  {0, 1}, {-1, -2}, {1, -2},
                                  {-2, -1}, {2, -1}, {-2, 1}, {2, 1}, {-1, 2},  {1, 2}};

/// The others of the same colour.
constexpr Offset kOwnColor[] = {{-2, 0}, {-1, -1}, {-1, 1},  {0, -2}, {0, 2},  {1, -1},
                                {1, 1},  {2, 0},   {-2, -2}, {2, -2}, {-2, 2}, {2, 2}};

double squared(double x) { return x * x; }

/// Counts of the pixels of one colour.
class ColorCounts {
 public:
  ColorCounts(const Pilot& pilot, int color, const AdaptiveParams& params, uint32_t max)
      : pilot_(pilot), color_(color), params_(params), max_(max), floor2_(squared(kDark * mean_of_other())) {}

  void fill(std::vector<float>& counts) const {
    std::vector<Variance> variances;
    for_each_pixel([&](int x, int y) {
      variances.push_back({relative_variance(x, y), pilot_.pixels[index(x, y)].samples});
    });
    double sum = 0, roots = 0;
    size_t known = 0;
    for (const auto& [v, given] : variances) {
      if (!(v > 0)) continue;
      sum += v;
      roots += std::sqrt(v);
      ++known;
    }
    const double budget = squared(params_.noise / kConfidence);
    const bool frame = params_.goal == NoiseGoal::kFrame;
    const double factor = frame ? frame_factor(variances, known, budget) : kExcess / budget;
    const double average =
        known == 0 ? static_cast<double>(max_) : factor * (frame ? roots : sum) / static_cast<double>(known);
    size_t i = 0;
    for_each_pixel([&](int x, int y) {
      const double v = variances[i++].value;
      double count = 0;
      if (v > 0) {
        count = factor * (frame ? std::sqrt(v) : v);
      } else if (v == kUnknown) {
        count = average;
      }
      counts[index(x, y)] = static_cast<float>(count);
    });
  }

 private:
  /// A ray hit something, but all samples of the pilot are equal, for example black: the variance is unknown.
  static constexpr double kUnknown = -1;

  struct Variance {
    double value;    // relative; 0 where nothing varies
    uint32_t given;  // samples of the pixel
  };
  size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(pilot_.width) + static_cast<size_t>(x);
  }
  template <class Each>
  void for_each_pixel(const Each& each) const {
    for (int y = 0; y < pilot_.height; ++y) {
      for (int x = (color_ + y) % 2; x < pilot_.width; x += 2) each(x, y);
    }
  }

  /// Mean over the pixels of the other colour that vary.
  double mean_of_other() const {
    double sum = 0;
    size_t count = 0;
    for (int y = 0; y < pilot_.height; ++y) {
      for (int x = (color_ + 1 + y) % 2; x < pilot_.width; x += 2) {
        const PilotPixel& pixel = pilot_.pixels[index(x, y)];
        if (!(pixel.variance > 0)) continue;
        sum += pixel.mean;
        ++count;
      }
    }
    return count > 0 ? sum / static_cast<double>(count) : 0;
  }

  double relative_variance(int x, int y) const {
    double mean = 0, variance = 0;
    int count = 0;
    bool hit = false;
    for (const Offset& offset : kOtherColor) {
      const int px = x + offset.x, py = y + offset.y;
      if (px < 0 || py < 0 || px >= pilot_.width || py >= pilot_.height) continue;
      const PilotPixel& pixel = pilot_.pixels[index(px, py)];
      mean += pixel.mean;
      variance += pixel.variance;
      hit |= pixel.hit;
      ++count;
    }
    if (count == 0) return kUnknown;
    mean /= count;
    variance /= count;
    if (variance > 0) return variance / (mean * mean + floor2_);
    return hit ? kUnknown : 0;
  }

  /// The smallest k for which counts k sqrt(v), clamped to the allowed range, reduce the mean of v / count
  /// over the `known` pixels that vary to `budget`.
  double frame_factor(const std::vector<Variance>& variances, size_t known, double budget) const {
    const auto excess = [&](double k) {
      double sum = 0;
      for (const auto& [v, given] : variances) {
        if (v > 0)
          sum += v / std::clamp(k * std::sqrt(v), static_cast<double>(given), static_cast<double>(max_));
      }
      return sum - budget * static_cast<double>(known);
    };
    double low = -20, high = 60;  // powers of two
    for (int step = 0; step < 50; ++step) {
      const double middle = 0.5 * (low + high);
      (excess(std::exp2(middle)) > 0 ? low : high) = middle;
    }
    return std::exp2(high);
  }

  const Pilot& pilot_;
  int color_;
  const AdaptiveParams& params_;
  uint32_t max_;
  double floor2_;
};

}  // namespace

std::vector<uint8_t> needs_full_pilot(const Pilot& probe) {
  std::vector<uint8_t> worth(probe.pixels.size());
  for (int y = 0; y < probe.height; ++y) {
    for (int x = 0; x < probe.width; ++x) {
      const PilotPixel* first = nullptr;
      bool differs = false;
      for (const Offset& offset : kOwnColor) {
        const int px = x + offset.x, py = y + offset.y;
        if (px < 0 || py < 0 || px >= probe.width || py >= probe.height) continue;
        const PilotPixel& pixel = probe.pixels[static_cast<size_t>(py * probe.width + px)];
        if (!first) first = &pixel;
        differs |= pixel.hit || pixel.variance > 0 || pixel.mean != first->mean;
      }
      worth[static_cast<size_t>(y * probe.width + x)] = differs || !first;
    }
  }
  return worth;
}

uint32_t whole_blocks(double count) {
  if (!(count > 4)) return static_cast<uint32_t>(std::ceil(std::max(0.0, count)));
  const double block = std::exp2(std::floor(std::log2(count)) - 2);
  return static_cast<uint32_t>(std::round(count / block) * block);
}

std::vector<float> two_stage_counts(const Pilot& pilot, const AdaptiveParams& params, uint32_t max) {
  std::vector<float> counts(pilot.pixels.size());
  for (int color : {0, 1}) ColorCounts(pilot, color, params, max).fill(counts);
  return counts;
}

double frame_noise(std::span<const PixelMoments> pixels) {
  double mean = 0;
  size_t count = 0;
  for (const PixelMoments& pixel : pixels) {
    if (!(pixel.squares > 0)) continue;
    mean += pixel.mean;
    ++count;
  }
  if (count == 0) return 0;
  mean /= static_cast<double>(count);
  double sum = 0;
  for (const PixelMoments& pixel : pixels) {
    if (!(pixel.squares > 0)) continue;
    sum += squared(pixel.error()) / (squared(pixel.mean) + squared(kDark * mean));
  }
  return kConfidence * std::sqrt(sum / static_cast<double>(count));
}

}  // namespace pelage
