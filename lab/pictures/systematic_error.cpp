// SPDX-License-Identifier: Apache-2.0
#include "lab/pictures/systematic_error.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "base/error.h"

namespace pelage {
namespace {

using Colors = std::array<Plane, 3>;

Colors means_of(const Colors& planes, int size) {
  return {block_means(planes[0], size), block_means(planes[1], size), block_means(planes[2], size)};
}

/// Sums over R, G and B of one block: of x - a, of y - b, and of t.
struct SharedBlock {
  double x_error = 0, y_error = 0, t = 0;
};

/// The error that one picture has where the other one is worst.
double worst_error(const std::vector<SharedBlock>& blocks, double m) {
  const auto error_of = [&](const SharedBlock& block, double SharedBlock::*error) {
    return block.*error == 0 ? 0 : block.*error / std::sqrt(block.t * block.t + 0.01 * m * m);
  };
  const auto worst_of = [&](double SharedBlock::*chooses, double SharedBlock::*answers) {
    return error_of(*std::max_element(blocks.begin(), blocks.end(),
                                      [&](const SharedBlock& p, const SharedBlock& q) {
                                        return std::abs(error_of(p, chooses)) <
                                               std::abs(error_of(q, chooses));
                                      }),
                    answers);
  };
  const double x = worst_of(&SharedBlock::y_error, &SharedBlock::x_error),
               y = worst_of(&SharedBlock::x_error, &SharedBlock::y_error);
  return std::abs(x) > std::abs(y) ? x : y;
}

BlockError shared_error(const std::array<Colors, 4>& pictures, const Plane& region, int size) {
  const Plane inside = block_means(region, size);
  std::array<Colors, 4> means = pictures;
  for (Colors& picture : means) picture = means_of(picture, size);
  const auto& [x, y, a, b] = means;
  double m = 0;
  for (size_t c = 0; c < 3; ++c) m += mean_over(mean_of(a[c], b[c]), inside) / 3;
  std::vector<SharedBlock> blocks;
  double sum = 0;
  for (size_t p = 0; p < inside.pixels.size(); ++p) {
    if (!(inside.pixels[p] > 0.5)) continue;
    SharedBlock block;
    for (size_t c = 0; c < 3; ++c) {
      const double x_error = x[c].pixels[p] - a[c].pixels[p], y_error = y[c].pixels[p] - b[c].pixels[p],
                   t = (a[c].pixels[p] + b[c].pixels[p]) / 2;
      if (x_error * y_error != 0) sum += x_error * y_error / (t * t + 0.01 * m * m) / 3;
      block.x_error += x_error;
      block.y_error += y_error;
      block.t += t;
    }
    blocks.push_back(block);
  }
  if (blocks.empty()) return {};
  return {std::sqrt(std::max(0.0, sum / static_cast<double>(blocks.size()))), worst_error(blocks, 3 * m)};
}

}  // namespace

std::optional<SystematicError> systematic_error(const ExrImage& x, const ExrImage& y, const ExrImage& a,
                                                const ExrImage& b, ErrorRegion region) {
  const std::optional<Plane> inside = region_of(a, b, region);
  if (!inside) return {};
  std::array<std::optional<Colors>, 4> colors;
  size_t at = 0;
  for (const ExrImage* image : {&x, &y, &a, &b}) {
    if (image->width != a.width || image->height != a.height) return {};
    if (!(colors[at++] = color_planes(*image))) return {};
  }
  const std::array<Colors, 4> pictures{*colors[0], *colors[1], *colors[2], *colors[3]};
  return SystematicError{shared_error(pictures, *inside, 8), shared_error(pictures, *inside, 32)};
}

std::optional<SystematicError> systematic_error_of_files(const std::filesystem::path& x,
                                                         const std::filesystem::path& y,
                                                         const std::filesystem::path& a,
                                                         const std::filesystem::path& b, ErrorRegion region) {
  try {
    return systematic_error(read_exr(x), read_exr(y), read_exr(a), read_exr(b), region);
  } catch (const Error&) {
    return {};
  }
}

}  // namespace pelage
