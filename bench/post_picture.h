// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "base/hash.h"
#include "post/motion_blur.h"
#include "post/stereo.h"

namespace pelage {

/// A frame of 2048 x 1556 pixels: a turning ball in front of a panning background. It has twenty layers of
/// three colour channels.
struct BenchPicture {
  static constexpr int kWidth = 2048, kHeight = 1556, kColors = 60;
  std::vector<float> colors, targets, depth;
  std::vector<Flow> motion;

  BenchPicture() {
    const auto pixels = static_cast<size_t>(kWidth) * kHeight;
    colors.resize(pixels * kColors);
    targets.resize(pixels * kColors);
    depth.resize(pixels);
    motion.resize(pixels);
    for (size_t i = 0; i < colors.size(); ++i) colors[i] = unit_float(hash64(i, 1));
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const float dx = static_cast<float>(x - kWidth / 2), dy = static_cast<float>(y - kHeight / 2);
        const bool is_ball = dx * dx + dy * dy < 600.0f * 600.0f;
        const size_t i = static_cast<size_t>(y) * kWidth + static_cast<size_t>(x);
        depth[i] = is_ball ? 5 - std::sqrt(600 * 600 - dx * dx - dy * dy) / 600 : 20;
        motion[i] = is_ball ? Flow{8 - 0.04f * dy, 3 + 0.04f * dx} : Flow{-14, 1.5f};
      }
    }
  }
  PostLayers layers() {
    PostLayers layers;
    const auto pixels = static_cast<size_t>(kWidth) * kHeight;
    for (size_t c = 0; c < kColors; ++c) {
      layers.channels.push_back({LayerRole::kColor,
                                 {colors.data() + c * pixels, 1, kWidth, 0},
                                 {targets.data() + c * pixels, 1, kWidth, 0}});
    }
    return layers;
  }
};

}  // namespace pelage
