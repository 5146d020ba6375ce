// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <functional>
#include <vector>

#include "base/hash.h"
#include "post/motion_blur.h"
#include "post/stereo.h"

namespace pelage {

/// A picture in memory: one colour, where it moves, how far away it is, and a number of data.
struct Picture {
  int width, height;
  std::vector<float> color, depth, data;
  std::vector<Flow> motion;

  Picture(int w, int h) : width(w), height(h) {
    const size_t pixels = static_cast<size_t>(w) * static_cast<size_t>(h);
    color.resize(pixels);
    data.resize(pixels);
    depth.assign(pixels, 1);
    motion.resize(pixels);
    for (size_t i = 0; i < pixels; ++i) {
      color[i] = 0.1f + unit_float(hash64(i, random_use("color")));
      data[i] = static_cast<float>(i);
    }
  }
  size_t at(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
  void each(const std::function<void(int x, int y, size_t i)>& set) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) set(x, y, at(x, y));
    }
  }
};

struct Result {
  std::vector<float> color, data, depth, invented, missing;
};

inline PostLayers layers_of(Picture& picture, Result& result) {
  const size_t pixels = picture.color.size();
  for (auto* plane : {&result.color, &result.data, &result.depth, &result.invented, &result.missing})
    plane->assign(pixels, -1);
  const ptrdiff_t row = picture.width;
  PostLayers layers;
  layers.channels = {
      {LayerRole::kColor, {picture.color.data(), 1, row, 0}, {result.color.data(), 1, row, 0}},
      {LayerRole::kData, {picture.data.data(), 1, row, 0}, {result.data.data(), 1, row, 0}},
      {LayerRole::kDepth, {picture.depth.data(), 1, row, 0}, {result.depth.data(), 1, row, 0}}};
  return layers;
}

struct BlurSetup {
  int scale = 4;
  std::vector<float> times{0};
  PostTiling tiling;
  int threads = 2;
  float largest_time = 1;
  float longest_seam = 0;
};

inline Result blurred(Picture picture, const BlurSetup& setup) {
  const Workers workers(setup.threads);
  LinkLimits limits;
  limits.largest_time = setup.largest_time;
  const FlowField field(picture.width, picture.height, picture.motion, picture.depth, limits, workers);
  Result result;
  const PostLayers layers = layers_of(picture, result);
  NoProgress progress;
  blur_rows({&field, {setup.scale, 0, 0, setup.longest_seam}, setup.times, picture.width, 0, picture.height},
            layers, setup.tiling, workers, progress);
  return result;
}

struct StereoSetup {
  int scale = 6;
  StereoFilter filter = StereoFilter::kLanczos;
  int longest_fill = 0;
  int strip_rows = 16;
  int threads = 2;
};

/// The picture's own vectors are the parallax.
inline Result other_eye(Picture picture, const StereoSetup& setup) {
  const Workers workers(setup.threads);
  const FlowField field(picture.width, picture.height, picture.motion, picture.depth, LinkLimits(), workers);
  Result result;
  const PostLayers layers = layers_of(picture, result);
  NoProgress progress;
  StereoJob job;
  job.field = &field;
  job.target.scale = setup.scale;
  job.filter = setup.filter;
  job.longest_fill = setup.longest_fill;
  job.width = picture.width;
  job.height = job.last_row = picture.height;
  job.invented = Plane{result.invented.data(), 1, picture.width, 0};
  job.missing = Plane{result.missing.data(), 1, picture.width, 0};
  stereo_rows(job, layers, setup.strip_rows, workers, progress);
  return result;
}

/// Bits, so that NaN equals itself and 0 is not -0.
inline std::vector<uint32_t> bits(const std::vector<float>& values) {
  std::vector<uint32_t> result(values.size());
  for (size_t i = 0; i < values.size(); ++i) result[i] = std::bit_cast<uint32_t>(values[i]);
  return result;
}

}  // namespace pelage
