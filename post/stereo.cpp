// SPDX-License-Identifier: Apache-2.0
#include "post/stereo.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "post/box_resolve.h"
#include "post/fill_holes.h"
#include "post/lanczos_resolve.h"

namespace pelage {
namespace {

constexpr float kOtherEye = 1;  // time

struct StripScratch {
  StripScratch(const StereoJob& job, const PostLayers& layers)
      : box(layers, job.filter == StereoFilter::kBox), lanczos(layers, job.target.scale) {}
  WorkBuffer buffer{PixelBox{}, 1};
  std::vector<uint8_t> invented;  // a row of samples
  std::vector<uint32_t> filled;   // samples by pixel of the strip's own rows
  std::vector<uint32_t> empty;
  BoxResolve box;
  LanczosResolve lanczos;
};

/// Fills the gaps of all rows of the buffer, and counts samples per pixel in the rows of the strip.
void fill_strip(const StereoJob& job, int y0, int y1, StripScratch& scratch) {
  const int s = job.target.scale;
  const auto width = static_cast<size_t>(job.width);
  // Nothing moves into the picture from farther away.
  const Flow low = job.field->low(), high = job.field->high();
  const float longest = std::ceil(std::max(std::abs(low.x), std::abs(high.x)));
  const int beyond = std::min(job.longest_fill, static_cast<int>(longest));
  const PixelBox& samples = scratch.buffer.samples();
  scratch.filled.assign(width * static_cast<size_t>(y1 - y0), 0);
  scratch.empty.assign(scratch.filled.size(), 0);
  for (int row = samples.y0; row < samples.y1; ++row) {
    const std::span<Sample> line(scratch.buffer.row(row), static_cast<size_t>(samples.width()));
    scratch.invented.assign(line.size(), 0);
    extend_sides(*job.field, job.target, job.ends, beyond, row, line, scratch.invented);
    // With a limit, the sides are not extended.
    const RowEnds ends = job.longest_fill < kFillEverything ? RowEnds{false, false} : job.ends;
    fill_gaps(line, scratch.invented, job.longest_fill * s, ends);
    const int y = row / s;
    if (y < y0 || y >= y1) continue;
    const size_t first = static_cast<size_t>(y - y0) * width;
    for (size_t i = 0; i < line.size(); ++i) {
      scratch.filled[first + i / static_cast<size_t>(s)] += scratch.invented[i] != 0;
      scratch.empty[first + i / static_cast<size_t>(s)] += line[i].is_empty();
    }
  }
}

void write_parts(const std::optional<Plane>& plane, const std::vector<uint32_t>& counts, int width, int y0,
                 int scale) {
  if (!plane) return;
  for (size_t i = 0; i < counts.size(); ++i) {
    const int x = static_cast<int>(i) % width, y = y0 + static_cast<int>(i) / width;
    plane->at(x, y) = static_cast<float>(counts[i]) / static_cast<float>(scale * scale);
  }
}

void stereo_strip(const StereoJob& job, const Warp& warp, int y0, int y1, StripScratch& scratch) {
  const int s = job.target.scale, margin = stereo_margin(job.filter);
  scratch.buffer.reset({0, std::max(0, y0 - margin), job.width, std::min(job.height, y1 + margin)}, s);
  for (const FlowField::Block* block : warp.reaching(scratch.buffer.samples(), kOtherEye, kOtherEye)) {
    warp.draw(*block, kOtherEye, scratch.buffer);
  }
  fill_strip(job, y0, y1, scratch);
  write_parts(job.invented, scratch.filled, job.width, y0, s);
  write_parts(job.missing, scratch.empty, job.width, y0, s);
  scratch.box.begin({0, y0, job.width, y1}, s);
  scratch.box.add(scratch.buffer);
  scratch.box.finish();
  if (job.filter == StereoFilter::kBox) return;
  for (int y = y0; y < y1; ++y) scratch.lanczos.write_row(scratch.buffer, y);
}

}  // namespace

std::vector<Flow> parallax_field(const std::vector<float>& depth, const StereoCamera& camera) {
  std::vector<Flow> vectors;
  vectors.reserve(depth.size());
  for (const float z : depth) {
    const float distance = std::abs(z) > 0 ? std::abs(z) : std::numeric_limits<float>::infinity();
    vectors.push_back({parallax(camera, distance), 0});
  }
  return vectors;
}

int stereo_margin(StereoFilter filter) {
  return filter == StereoFilter::kLanczos ? LanczosResolve::kReach : 0;
}

void stereo_rows(const StereoJob& job, const PostLayers& layers, int strip_rows, const Workers& workers,
                 Progress& progress) {
  WarpTarget target = job.target;
  target.longest_seam = static_cast<float>(job.longest_fill);
  const Warp warp(*job.field, target);
  strip_rows = std::max(1, strip_rows);
  const int strips = (job.last_row - job.first_row + strip_rows - 1) / strip_rows;
  std::vector<std::unique_ptr<StripScratch>> scratch(static_cast<size_t>(workers.thread_count()));
  workers.for_each(static_cast<size_t>(strips), 1, [&](WorkRange range) {
    if (progress.cancelled()) return;
    auto& mine = scratch[static_cast<size_t>(range.worker)];
    if (!mine) mine = std::make_unique<StripScratch>(job, layers);
    const int y0 = job.first_row + static_cast<int>(range.begin) * strip_rows;
    const int y1 = std::min(y0 + strip_rows, job.last_row);
    stereo_strip(job, warp, y0, y1, *mine);
    progress.advance(y1 - y0);
  });
}

}  // namespace pelage
