// SPDX-License-Identifier: Apache-2.0
#include "render/raster/depth_grid.h"

namespace pelage {
namespace {

constexpr float kDepthRounding = 1e-5f;

}  // namespace

void DepthGrid::update(const float* depths) {
  std::fill(max_.begin(), max_.end(), 0.0f);
  for (size_t line = 0; line < cell_of_line_.size(); ++line) {
    float& max = max_[cell_of_line_[line]];
    max = std::max(max, depths[line]);
  }
  far_ = 0;
  for (float& max : max_) {
    max *= 1 + kDepthRounding;
    far_ = std::max(far_, max);
  }
}

}  // namespace pelage
