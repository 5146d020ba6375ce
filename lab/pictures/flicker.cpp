// SPDX-License-Identifier: Apache-2.0
#include "lab/pictures/flicker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.h"

namespace pelage {
namespace {

constexpr int kFlickerBlock = 8;

/// A block in two successive frames.
struct Change {
  double unexplained = 0;  ///< (dx - da)(dx - db)
  double t = 0;
};

/// Empty when the frames differ in size.
std::optional<std::vector<FrameBlocks>> read_blocks(const std::vector<std::filesystem::path>& files,
                                                    ErrorRegion region) {
  std::vector<FrameBlocks> frames;
  for (const std::filesystem::path& file : files) {
    auto frame = frame_blocks(read_exr(file), region);
    if (!frame) return {};
    frames.push_back(std::move(*frame));
  }
  return frames;
}

bool same_size(const std::vector<FrameBlocks>& x, const std::vector<FrameBlocks>& y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(), [&](const FrameBlocks& p, const FrameBlocks& q) {
    return p.means.width == q.means.width && p.means.height == q.means.height &&
           p.means.pixels.size() == x.front().means.pixels.size();
  });
}

}  // namespace

std::optional<FrameBlocks> frame_blocks(const ExrImage& frame, ErrorRegion region) {
  const auto colors = color_planes(frame);
  const auto inside = region_of(frame, frame, region);
  if (!colors || !inside) return {};
  Plane grey(frame.width, frame.height);
  for (const Plane& channel : *colors) {
    for (size_t p = 0; p < grey.pixels.size(); ++p) grey.pixels[p] += channel.pixels[p] / 3;
  }
  return FrameBlocks{block_means(grey, kFlickerBlock), block_means(*inside, kFlickerBlock)};
}

double flicker(const std::vector<FrameBlocks>& x, const std::vector<FrameBlocks>& a,
               const std::vector<FrameBlocks>& b) {
  if (!same_size(x, a) || !same_size(x, b)) return NAN;
  std::vector<Change> changes;
  double m = 0;
  for (size_t i = 0; i + 1 < x.size(); ++i) {
    for (size_t p = 0; p < x[i].means.pixels.size(); ++p) {
      double t = 0;
      bool inside = true;
      for (const FrameBlocks* frame : {&a[i], &a[i + 1], &b[i], &b[i + 1]}) {
        t += frame->means.pixels[p] / 4;
        inside = inside && frame->region.pixels[p] > 0.5;
      }
      if (!inside) continue;
      const auto change = [&](const std::vector<FrameBlocks>& frames) {
        return frames[i + 1].means.pixels[p] - frames[i].means.pixels[p];
      };
      changes.push_back({(change(x) - change(a)) * (change(x) - change(b)), t});
      m += t;
    }
  }
  const double count = static_cast<double>(changes.size());
  if (count == 0) return NAN;
  m /= count;
  double sum = 0;
  for (const Change& change : changes) {
    if (change.unexplained != 0) sum += change.unexplained / (change.t * change.t + 0.01 * m * m);
  }
  return std::sqrt(std::max(0.0, sum / count));
}

double flicker_of_files(const std::vector<std::filesystem::path>& x,
                        const std::vector<std::filesystem::path>& a,
                        const std::vector<std::filesystem::path>& b, ErrorRegion region) {
  try {
    const auto in_x = read_blocks(x, region), in_a = read_blocks(a, region), in_b = read_blocks(b, region);
    return in_x && in_a && in_b ? flicker(*in_x, *in_a, *in_b) : NAN;
  } catch (const Error&) {
    return NAN;
  }
}

}  // namespace pelage
