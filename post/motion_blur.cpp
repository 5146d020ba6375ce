// SPDX-License-Identifier: Apache-2.0
#include "post/motion_blur.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "post/box_resolve.h"
#include "post/step_lists.h"

namespace pelage {
namespace {

constexpr int kFewestSteps = 8, kMaxSteps = 64;

/// State of a worker between tiles.
struct Scratch {
  explicit Scratch(const PostLayers& layers) : resolve(layers) {}
  WorkBuffer buffer{PixelBox{}, 1};
  BoxResolve resolve;
  StepLists lists;
};

bool is_still(const std::vector<const FlowField::Block*>& blocks) {
  return std::all_of(blocks.begin(), blocks.end(),
                     [](const FlowField::Block* b) { return b->low == Flow{} && b->high == Flow{}; });
}

void blur_piece(const BlurJob& job, const Warp& warp, const PixelBox& box, Scratch& scratch) {
  const auto [first, last] = std::minmax_element(job.times.begin(), job.times.end());
  scratch.buffer.reset(box, job.target.scale);
  scratch.resolve.begin(box, job.target.scale);
  const PixelBox samples = scratch.buffer.samples();
  std::vector<const FlowField::Block*> blocks = warp.reaching(samples, *first, *last);
  // Corners may get motion from outside a block, but not if all links contain no motion.
  const bool still = is_still(blocks);
  const size_t steps = still ? 1 : job.times.size();
  if (!still) scratch.lists.gather(warp, job.times, samples, blocks);
  for (size_t step = 0; step < steps; ++step) {
    if (step > 0) scratch.buffer.clear();
    const float time = still ? 0 : job.times[step];
    for (const FlowField::Block* block : blocks) {
      if (warp.reaches(*block, samples, time)) warp.draw(*block, time, scratch.buffer);
    }
    if (!still) {
      for (const StepLists::Pixel& p : scratch.lists.at(step)) warp.draw(p.x, p.y, time, scratch.buffer);
    }
    scratch.resolve.add(scratch.buffer, still ? static_cast<int>(job.times.size()) : 1);
  }
  scratch.resolve.finish();
}

}  // namespace

std::vector<float> shutter_times(const ShutterParams& shutter, float longest) {
  int steps = shutter.steps;
  if (steps <= 0) {
    const float pixels = std::ceil(longest * std::abs(shutter.length));
    steps = pixels > 0 ? static_cast<int>(std::clamp<float>(pixels, kFewestSteps, kMaxSteps)) : 1;
  }
  std::vector<float> times;
  for (int k = 0; k < steps; ++k) {
    const double middle = (k + 0.5) / steps - 0.5;
    times.push_back(static_cast<float>(shutter.centre + middle * shutter.length));
  }
  return times;
}

void blur_rows(const BlurJob& job, const PostLayers& layers, PostTiling tiling, const Workers& workers,
               Progress& progress) {
  const Warp warp(*job.field, job.target);
  const int columns = std::max(1, tiling.columns), rows = std::max(1, tiling.rows);
  const int across = (job.width + columns - 1) / columns;
  const int down = (job.last_row - job.first_row + rows - 1) / rows;
  std::vector<std::unique_ptr<Scratch>> scratch(static_cast<size_t>(workers.thread_count()));
  workers.for_each(static_cast<size_t>(across) * static_cast<size_t>(down), 1, [&](WorkRange range) {
    if (progress.cancelled()) return;
    auto& mine = scratch[static_cast<size_t>(range.worker)];
    if (!mine) mine = std::make_unique<Scratch>(layers);
    const int i = static_cast<int>(range.begin) % across, j = static_cast<int>(range.begin) / across;
    const int x0 = i * columns, y0 = job.first_row + j * rows;
    const PixelBox box{x0, y0, std::min(x0 + columns, job.width), std::min(y0 + rows, job.last_row)};
    blur_piece(job, warp, box, *mine);
    progress.advance(static_cast<double>(box.height()) / across);
  });
}

RowRange rows_reaching(const FlowField& field, const WarpTarget& target, int width, int first_row,
                       int last_row, const std::vector<float>& times) {
  const auto [first, last] = std::minmax_element(times.begin(), times.end());
  const int s = target.scale;
  const Warp warp(field, target);
  RowRange range;
  for (const FlowField::Block* b :
       warp.reaching({0, first_row * s, width * s, last_row * s}, *first, *last)) {
    if (range.last == 0) range.first = b->y0;
    range.first = std::min(range.first, b->y0);
    range.last = std::max(range.last, b->y1);
  }
  return range;
}

Overhang overhang(const FlowField& field, const std::vector<float>& times) {
  const auto [first, last] = std::minmax_element(times.begin(), times.end());
  const auto out = [](float pixels) { return static_cast<int>(std::ceil(std::max(pixels, 0.0f))); };
  Overhang grown;
  for (const float t : {*first, *last}) {
    grown.left = std::max({grown.left, out(-t * field.low().x), out(-t * field.high().x)});
    grown.right = std::max({grown.right, out(t * field.low().x), out(t * field.high().x)});
    grown.top = std::max({grown.top, out(-t * field.low().y), out(-t * field.high().y)});
    grown.bottom = std::max({grown.bottom, out(t * field.low().y), out(t * field.high().y)});
  }
  return grown;
}

}  // namespace pelage
