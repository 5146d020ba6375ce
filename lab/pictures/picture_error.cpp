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

/// 1 in the region, 0 elsewhere; empty when a layer is missing.
std::optional<Plane> region_of(const ExrImage& image, ErrorRegion region) {
  const bool fur = region == ErrorRegion::kFur;
  Plane plane(image.width, image.height);
  for (const char* name : fur ? std::vector<const char*>{"tangent.X", "tangent.Y", "tangent.Z"}
                              : std::vector<const char*>{"A"}) {
    const ExrChannel* channel = image.find(name);
    if (!channel || channel->pixels.size() != plane.pixels.size()) return {};
    for (size_t p = 0; p < plane.pixels.size(); ++p) {
      const float value = channel->pixels[p];
      if (fur ? value != 0 : value > 0) plane.pixels[p] = 1;
    }
  }
  return plane;
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

RelativeError relative_error(const std::vector<Compared>& channels, const Plane& region, int around) {
  Squares squares;
  for (const auto& [x, y, a, b] : channels) {
    const Plane t = blurred(mean_of(a, b), around);
    const double m = mean_over(t, region);
    for (int v = 0; v < region.height; ++v) {
      for (int u = 0; u < region.width; ++u) {
        if (!(region.at(u, v) > 0.5)) continue;
        const double error = 0.5 * ((x.at(u, v) - a.at(u, v)) * (y.at(u, v) - b.at(u, v)) +
                                    (x.at(u, v) - b.at(u, v)) * (y.at(u, v) - a.at(u, v)));
        Squares::Sum& sum = squares.sums[{u / kSquare, v / kSquare}];
        if (error != 0) sum.error += error / (t.at(u, v) * t.at(u, v) + 0.01 * m * m);
        ++sum.count;
      }
    }
  }
  return squares.result();
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
  const std::optional<Plane> inside = region_of(a, region);
  if (!inside) return {};
  std::vector<Compared> pixels, blocks;
  for (size_t c = 0; c < 3; ++c) {
    const auto plane = [&](size_t image) { return Plane(a.width, a.height, *channels[image][c]); };
    pixels.push_back({plane(0), plane(1), plane(2), plane(3)});
    const auto& [px, py, pa, pb] = pixels.back();
    blocks.push_back({block_means(px), block_means(py), block_means(pa), block_means(pb)});
  }

  PictureError result;
  const RelativeError error = relative_error(pixels, *inside, kAround);
  result.rel_mse = error.mean;
  result.rel_mse_deviation = error.deviation;
  result.block_rel_mse = relative_error(blocks, block_means(*inside), kBlockAround).mean;
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
