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

/// A ray hit something, but all samples of the pilot are equal, for example black: the variance is unknown.
constexpr double kUnknown = -1;

/// A part of the picture whose pixels get the same count of samples.
struct Part {
  double variance;   // relative, mean over all its pixels; 0 where nothing varies
  uint32_t given;    // samples of each pixel
  double share = 1;  // fraction of its pixels that vary, if any does
};

/// Turns variances into counts of samples.
class CountRule {
 public:
  CountRule(const AdaptiveParams& params, uint32_t max) : params_(params), max_(max) {}

  /// Returns the count of each part.
  std::vector<float> counts(const std::vector<Part>& parts) const {
    double sum = 0, roots = 0, varied = 0;
    size_t known = 0;
    for (const auto& [v, given, share] : parts) {
      if (!(v > 0)) continue;
      sum += v / share;
      roots += std::sqrt(v);
      varied += share;
      ++known;
    }
    const double budget = squared(params_.noise / kConfidence);
    const bool frame = params_.goal == NoiseGoal::kFrame;
    const double factor = frame ? frame_factor(parts, budget * varied) : kExcess / budget;
    const double average =
        known == 0 ? static_cast<double>(max_) : factor * (frame ? roots : sum) / static_cast<double>(known);
    std::vector<float> counts;
    for (const auto& [v, given, share] : parts) {
      const double needed = v > 0 ? factor * (frame ? std::sqrt(v) : v / share) : 0;
      counts.push_back(static_cast<float>(v == kUnknown ? average : needed));
    }
    return counts;
  }

 private:
  /// The smallest k for which counts k sqrt(v), clamped to the allowed range, reduce the sum of v / count
  /// over the parts that vary to `goal`.
  double frame_factor(const std::vector<Part>& parts, double goal) const {
    const auto excess = [&](double k) {
      double sum = 0;
      for (const auto& [v, given, share] : parts) {
        if (v > 0)
          sum += v / std::clamp(k * std::sqrt(v), static_cast<double>(given), static_cast<double>(max_));
      }
      return sum - goal;
    };
    double low = -20, high = 60;  // powers of two
    for (int step = 0; step < 50; ++step) {
      const double middle = 0.5 * (low + high);
      (excess(std::exp2(middle)) > 0 ? low : high) = middle;
    }
    return std::exp2(high);
  }

  const AdaptiveParams& params_;
  uint32_t max_;
};

size_t index(const Pilot& pilot, int x, int y) {
  return static_cast<size_t>(y) * static_cast<size_t>(pilot.width) + static_cast<size_t>(x);
}

/// Mean of the pixels that vary, of all for which `wanted(x, y)` is true.
template <class Wanted>
double mean_where_varied(const Pilot& pilot, const Wanted& wanted) {
  double sum = 0;
  size_t count = 0;
  for (int y = 0; y < pilot.height; ++y) {
    for (int x = 0; x < pilot.width; ++x) {
      const PilotPixel& pixel = pilot.pixels[index(pilot, x, y)];
      if (!(pixel.variance > 0) || !wanted(x, y)) continue;
      sum += pixel.mean;
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

/// Variance of the pixels of the other colour around (x, y), relative to their mean. `floor2`: the square of
/// the least mean.
double relative_variance(const Pilot& pilot, int x, int y, double floor2) {
  double mean = 0, variance = 0;
  int count = 0;
  bool hit = false;
  for (const Offset& offset : kOtherColor) {
    const int px = x + offset.x, py = y + offset.y;
    if (px < 0 || py < 0 || px >= pilot.width || py >= pilot.height) continue;
    const PilotPixel& pixel = pilot.pixels[index(pilot, px, py)];
    mean += pixel.mean;
    variance += pixel.variance;
    hit |= pixel.hit;
    ++count;
  }
  if (count == 0) return kUnknown;
  mean /= count;
  variance /= count;
  if (variance > 0) return variance / (mean * mean + floor2);
  return hit ? kUnknown : 0;
}

/// Mean of the 5 x 5 pixels around (x, y).
double mean_around(const Pilot& pilot, int x, int y) {
  double sum = 0;
  int count = 0;
  for (int py = std::max(0, y - 2); py <= std::min(pilot.height - 1, y + 2); ++py) {
    for (int px = std::max(0, x - 2); px <= std::min(pilot.width - 1, x + 2); ++px) {
      sum += pilot.pixels[index(pilot, px, py)].mean;
      ++count;
    }
  }
  return sum / count;
}

/// Calls use(x0, y0, x1, y1) for each tile of the picture.
template <class Use>
void for_each_tile(const Pilot& pilot, int side, const Use& use) {
  for (int y = 0; y < pilot.height; y += side) {
    for (int x = 0; x < pilot.width; x += side)
      use(x, y, std::min(x + side, pilot.width), std::min(y + side, pilot.height));
  }
}

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
  for (int color : {0, 1}) {
    const auto is_other = [&](int x, int y) { return (x + y + color) % 2 == 1; };
    const double floor2 = squared(kDark * mean_where_varied(pilot, is_other));
    std::vector<Part> parts;
    std::vector<size_t> pixels;
    for (int y = 0; y < pilot.height; ++y) {
      for (int x = (color + y) % 2; x < pilot.width; x += 2) {
        pixels.push_back(index(pilot, x, y));
        parts.push_back({relative_variance(pilot, x, y, floor2), pilot.pixels[pixels.back()].samples});
      }
    }
    const std::vector<float> wanted = CountRule(params, max).counts(parts);
    for (size_t i = 0; i < pixels.size(); ++i) counts[pixels[i]] = wanted[i];
  }
  return counts;
}

std::vector<uint8_t> tiles_need_full_pilot(const Pilot& probe, int side) {
  std::vector<uint8_t> worth(probe.pixels.size());
  for_each_tile(probe, side, [&](int x0, int y0, int x1, int y1) {
    const float first = probe.pixels[index(probe, x0, y0)].mean;
    bool differs = false;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        const PilotPixel& pixel = probe.pixels[index(probe, x, y)];
        differs |= pixel.hit || pixel.variance > 0 || pixel.mean != first;
      }
    }
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) worth[index(probe, x, y)] = differs;
    }
  });
  return worth;
}

std::vector<float> two_stage_tile_counts(const Pilot& pilot, int side, const AdaptiveParams& params,
                                         uint32_t max) {
  const double floor2 = squared(kDark * mean_where_varied(pilot, [](int, int) { return true; }));
  std::vector<Part> parts;
  for_each_tile(pilot, side, [&](int x0, int y0, int x1, int y1) {
    double sum = 0;
    int varied = 0;
    bool hit = false;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        const PilotPixel& pixel = pilot.pixels[index(pilot, x, y)];
        hit |= pixel.hit;
        if (!(pixel.variance > 0)) continue;
        sum += pixel.variance / (squared(mean_around(pilot, x, y)) + floor2);
        ++varied;
      }
    }
    const double pixels = (x1 - x0) * (y1 - y0), unvaried = hit ? kUnknown : 0;
    const uint32_t given = pilot.pixels[index(pilot, x0, y0)].samples;
    parts.push_back(varied > 0 ? Part{sum / pixels, given, varied / pixels} : Part{unvaried, given});
  });
  const std::vector<float> wanted = CountRule(params, max).counts(parts);
  std::vector<float> counts(pilot.pixels.size());
  size_t tile = 0;
  for_each_tile(pilot, side, [&](int x0, int y0, int x1, int y1) {
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) counts[index(pilot, x, y)] = wanted[tile];
    }
    ++tile;
  });
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
