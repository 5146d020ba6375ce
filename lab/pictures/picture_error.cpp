// SPDX-License-Identifier: Apache-2.0
#include "lab/pictures/picture_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"

namespace pelage {
namespace {

constexpr double kWeights[] = {0.2126, 0.7152, 0.0722};  // luminance
constexpr int kAround = 4;                               // pixels to each side

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

/// Mean of two pictures over the pixels around each, by rows and then by columns.
std::vector<double> blurred_mean(const std::vector<float>& a, const std::vector<float>& b, int width,
                                 int height, int around) {
  const auto along = [around](const std::vector<double>& from, int count, int lines, size_t step,
                              size_t next) {
    std::vector<double> to(from.size());
    for (int line = 0; line < lines; ++line) {
      const size_t first = static_cast<size_t>(line) * next;
      const auto at = [&](int i) { return first + static_cast<size_t>(i) * step; };
      for (int i = 0; i < count; ++i) {
        const int low = std::max(0, i - around), high = std::min(count - 1, i + around);
        double sum = 0;
        for (int j = low; j <= high; ++j) sum += from[at(j)];
        to[at(i)] = sum / (high - low + 1);
      }
    }
    return to;
  };
  std::vector<double> mean(a.size());
  for (size_t p = 0; p < a.size(); ++p) mean[p] = 0.5 * (double{a[p]} + double{b[p]});
  const auto row = static_cast<size_t>(width);
  return along(along(mean, width, height, 1, row), height, width, row, 1);
}

std::optional<PictureError> error_of(const ExrImage& x, const ExrImage& y, const ExrImage& a,
                                     const ExrImage& b, int t_around) {
  const auto cx = channels_of(x), cy = channels_of(y), ca = channels_of(a), cb = channels_of(b);
  const auto fits = [&](const ExrImage& i) { return i.width == a.width && i.height == a.height; };
  if (cx.empty() || cy.empty() || ca.empty() || cb.empty() || !fits(x) || !fits(y) || !fits(b)) return {};
  const ExrChannel* counts = x.find("samples");

  const size_t pixels = ca[3]->size();
  const auto truth = [&](size_t c, size_t p) { return 0.5 * (double{(*ca[c])[p]} + double{(*cb[c])[p]}); };
  PictureError result;
  result.samples = result.surface_samples = counts ? 0 : NAN;
  double surface = 0, mean[3] = {}, luminance_x = 0, luminance_t = 0;
  for (size_t p = 0; p < pixels; ++p) {
    result.coverage += (*ca[3])[p];
    if (counts) result.samples += counts->ids[p];
    if (!((*ca[3])[p] > 0)) continue;
    ++surface;
    if (counts) result.surface_samples += counts->ids[p];
    for (size_t c = 0; c < 3; ++c) {
      mean[c] += truth(c, p);
      luminance_x += kWeights[c] * 0.5 * (double{(*cx[c])[p]} + double{(*cy[c])[p]});
      luminance_t += kWeights[c] * truth(c, p);
    }
  }
  for (size_t c = 0; c < 3; ++c) {
    const std::vector<double> around = blurred_mean(*ca[c], *cb[c], a.width, a.height, t_around);
    for (size_t p = 0; p < pixels; ++p) {
      if (!((*ca[3])[p] > 0)) continue;
      const double t = around[p], m = mean[c] / surface, v = (*cx[c])[p], w = (*cy[c])[p];
      const double of_a = (*ca[c])[p], of_b = (*cb[c])[p];
      const double error = 0.5 * ((v - of_a) * (w - of_b) + (v - of_b) * (w - of_a));
      if (error != 0) result.rel_mse += error / (t * t + 0.01 * m * m) / 3;
    }
  }
  const auto count = static_cast<double>(pixels);
  surface = std::max(1.0, surface);
  result.coverage /= count;
  result.surface_share = surface / count;
  result.samples /= count;
  result.surface_samples /= surface;
  result.rel_mse /= surface;
  result.bias = luminance_t > 0 ? luminance_x / luminance_t - 1 : 0;
  return result;
}

}  // namespace

std::optional<PictureError> picture_error(const ExrImage& x, const ExrImage& a, const ExrImage& b) {
  return error_of(x, x, a, b, 0);
}

std::optional<PictureError> picture_error(const ExrImage& x, const ExrImage& y, const ExrImage& a,
                                          const ExrImage& b) {
  return error_of(x, y, a, b, kAround);
}

std::optional<PictureError> picture_error_of_files(const std::filesystem::path& x,
                                                   const std::filesystem::path& a,
                                                   const std::filesystem::path& b) {
  try {
    return picture_error(read_exr(x), read_exr(a), read_exr(b));
  } catch (const Error&) {
    return {};
  }
}

std::optional<PictureError> picture_error_of_files(const std::filesystem::path& x,
                                                   const std::filesystem::path& y,
                                                   const std::filesystem::path& a,
                                                   const std::filesystem::path& b) {
  try {
    return picture_error(read_exr(x), read_exr(y), read_exr(a), read_exr(b));
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
