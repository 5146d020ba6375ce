// SPDX-License-Identifier: Apache-2.0
#include "lab/pictures/picture_error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/error.h"
#include "lab/pictures/plane.h"

namespace pelage {
namespace {

constexpr double kWeights[] = {0.2126, 0.7152, 0.0722};  // luminance
constexpr int kAround = 4, kBlockAround = 1;             // pixels, or blocks, to each side
constexpr int kSquare = 16;
constexpr double kTopFraction = 0.999;

/// R, G, B, A of a picture; empty when one is missing.
std::vector<const std::vector<float>*> channels_of(const ExrImage& image) {
  std::vector<const std::vector<float>*> channels;
  for (const char* name : {"R", "G", "B", "A"}) {
    const ExrChannel* channel = image.find(name);
    if (!channel || channel->pixels.empty()) return {};
    channels.push_back(&channel->pixels);
  }
  return channels;
}

/// One channel of the tested pictures x and y and of the references a and b.
struct Compared {
  Plane x, y, a, b;
};

struct RelativeError {
  double mean = NAN, deviation = NAN;
};

/// Sums over squares of kSquare x kSquare pixels, for the standard error.
struct Squares {
  struct Sum {
    double error = 0, count = 0;
  };
  std::map<std::pair<int, int>, Sum> sums;

  RelativeError result() const {
    double error = 0, count = 0, squares = 0;
    for (const auto& [place, sum] : sums) {
      error += sum.error;
      count += sum.count;
    }
    if (count == 0) return {};
    const double mean = error / count, n = static_cast<double>(sums.size());
    for (const auto& [place, sum] : sums) squares += std::pow(sum.error - mean * sum.count, 2);
    return {mean, n > 1 ? std::sqrt(squares * n / (n - 1)) / count : NAN};
  }
};

/// Relative squared error of each pixel of the region, as a mean over channels; 0 elsewhere.
Plane squared_errors(const std::vector<Compared>& channels, const Plane& region, int around) {
  Plane errors(region.width, region.height);
  for (const auto& [x, y, a, b] : channels) {
    const Plane t = blurred(mean_of(a, b), around);
    const double m = mean_over(t, region);
    for (size_t p = 0; p < errors.pixels.size(); ++p) {
      if (!(region.pixels[p] > 0.5)) continue;
      const double error = 0.5 * ((x.pixels[p] - a.pixels[p]) * (y.pixels[p] - b.pixels[p]) +
                                  (x.pixels[p] - b.pixels[p]) * (y.pixels[p] - a.pixels[p]));
      if (error != 0)
        errors.pixels[p] +=
            error / (t.pixels[p] * t.pixels[p] + 0.01 * m * m) / static_cast<double>(channels.size());
    }
  }
  return errors;
}

RelativeError mean_error(const Plane& errors, const Plane& region) {
  Squares squares;
  for (int v = 0; v < region.height; ++v) {
    for (int u = 0; u < region.width; ++u) {
      if (!(region.at(u, v) > 0.5)) continue;
      Squares::Sum& sum = squares.sums[{u / kSquare, v / kSquare}];
      sum.error += errors.at(u, v);
      ++sum.count;
    }
  }
  return squares.result();
}

double top_error(const Plane& errors, const Plane& region) {
  std::vector<double> values;
  for (size_t p = 0; p < errors.pixels.size(); ++p) {
    if (region.pixels[p] > 0.5) values.push_back(errors.pixels[p]);
  }
  if (values.empty()) return NAN;
  const auto top = values.begin() + std::lround(kTopFraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), top, values.end());
  return std::sqrt(std::max(0.0, *top));
}

double block_mse(const std::vector<Compared>& pixels, const Plane& region, int size) {
  std::vector<Compared> blocks;
  for (const auto& [x, y, a, b] : pixels)
    blocks.push_back(
        {block_means(x, size), block_means(y, size), block_means(a, size), block_means(b, size)});
  const Plane inside = block_means(region, size);
  return mean_error(squared_errors(blocks, inside, kBlockAround), inside).mean;
}

double luminance_over(const std::vector<Compared>& channels, const Plane& region, bool of_references) {
  double sum = 0;
  for (size_t c = 0; c < channels.size(); ++c) {
    const auto& [x, y, a, b] = channels[c];
    sum += kWeights[c] * mean_over(of_references ? mean_of(a, b) : mean_of(x, y), region);
  }
  return sum;
}

}  // namespace

std::optional<PictureError> picture_error(const ExrImage& x, const ExrImage& y, const ExrImage& a,
                                          const ExrImage& b, ErrorRegion region) {
  const ExrImage* images[] = {&x, &y, &a, &b};
  std::vector<std::vector<const std::vector<float>*>> channels;
  for (const ExrImage* image : images) {
    channels.push_back(channels_of(*image));
    if (channels.back().empty() || image->width != a.width || image->height != a.height) return {};
  }
  const std::optional<Plane> inside = region_of(a, b, region);
  if (!inside) return {};
  std::vector<Compared> pixels;
  for (size_t c = 0; c < 3; ++c) {
    const auto plane = [&](size_t image) { return Plane(a.width, a.height, *channels[image][c]); };
    pixels.push_back({plane(0), plane(1), plane(2), plane(3)});
  }

  PictureError result;
  const Plane errors = squared_errors(pixels, *inside, kAround);
  const RelativeError error = mean_error(errors, *inside);
  result.rel_mse = error.mean;
  result.rel_mse_deviation = error.deviation;
  result.top_error = top_error(errors, *inside);
  result.rel_mse_4 = block_mse(pixels, *inside, 4);
  result.rel_mse_16 = block_mse(pixels, *inside, 16);
  const double truth = luminance_over(pixels, *inside, true);
  result.bias = truth != 0 ? luminance_over(pixels, *inside, false) / truth - 1 : 0;
  const Plane everywhere(a.width, a.height, 1);
  result.coverage = mean_over(Plane(a.width, a.height, *channels[2][3]), everywhere);
  result.region_share = mean_over(*inside, everywhere);
  result.samples = result.region_samples = NAN;
  if (const ExrChannel* counts = x.find("samples")) {
    Plane samples(x.width, x.height);
    samples.pixels.assign(counts->ids.begin(), counts->ids.end());
    result.samples = mean_over(samples, everywhere);
    result.region_samples = mean_over(samples, *inside);
  }
  return result;
}

std::optional<PictureError> picture_error(const ExrImage& x, const ExrImage& a, const ExrImage& b,
                                          ErrorRegion region) {
  return picture_error(x, x, a, b, region);
}

std::optional<PictureError> picture_error_of_files(const std::filesystem::path& x,
                                                   const std::filesystem::path& a,
                                                   const std::filesystem::path& b, ErrorRegion region) {
  return picture_error_of_files(x, x, a, b, region);
}

std::optional<PictureError> picture_error_of_files(const std::filesystem::path& x,
                                                   const std::filesystem::path& y,
                                                   const std::filesystem::path& a,
                                                   const std::filesystem::path& b, ErrorRegion region) {
  try {
    return picture_error(read_exr(x), read_exr(y), read_exr(a), read_exr(b), region);
  } catch (const Error&) {
    return {};
  }
}

BestGain best_gain(const ExrImage& picture) {
  const auto channels = channels_of(picture);
  const ExrChannel *counts = picture.find("samples"), *noise = picture.find("noise");
  if (channels.empty() || !counts || !noise) return {NAN, NAN};
  const size_t pixels = channels[3]->size();
  const auto seen = [&](size_t p) { return (*channels[3])[p] > 0; };
  const auto light = [&](size_t p) {
    return kWeights[0] * (*channels[0])[p] + kWeights[1] * (*channels[1])[p] +
           kWeights[2] * (*channels[2])[p];
  };
  double surface = 0, mean = 0, sum = 0, roots = 0;
  for (size_t p = 0; p < pixels; ++p) {
    if (!seen(p)) continue;
    ++surface;
    mean += light(p);
  }
  mean /= surface;
  for (size_t p = 0; p < pixels; ++p) {
    if (!seen(p)) continue;
    const double v = counts->ids[p] * double{noise->pixels[p]} * noise->pixels[p] /
                     (light(p) * light(p) + 0.01 * mean * mean);
    sum += v;
    roots += std::sqrt(v);
  }
  const double gain = sum * surface / (roots * roots);
  return {gain, gain * static_cast<double>(pixels) / surface};
}

}  // namespace pelage
