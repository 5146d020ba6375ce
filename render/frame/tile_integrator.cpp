// SPDX-License-Identifier: Apache-2.0
#include "render/frame/tile_integrator.h"

#include <limits>

namespace pelage {

bool SampleIntegrator::trace_tile(const TileTask& task, SampleScratch& scratch) const {
  // Splatted samples of several pixels enter the same sum. They are traced sample by sample, so that the
  // order of the sum does not depend on how many samples a pass takes. If they were interrupted within a
  // sample, the pixels that lack it come first.
  const Film& film = task.film();
  const bool in_step = film.layers().splat.has_value();
  uint64_t traced = 0;
  bool stopped = false;
  for (bool more = true; more && !stopped;) {
    more = false;
    const uint32_t fewest = in_step ? film.min_samples(task.tile) : std::numeric_limits<uint32_t>::max();
    for (int y = task.tile.y0; y < task.tile.y1 && !stopped; ++y) {
      for (int x = task.tile.x0; x < task.tile.x1 && !stopped; ++x) {
        const uint32_t given = film.samples(x, y);
        if (given > fewest) continue;
        const uint32_t goal = task.goal(x, y);
        if (given >= goal) continue;
        stopped = !trace_pixel(task, x, y, in_step ? given + 1 : goal, scratch);
        traced += film.samples(x, y) - given;
        more = in_step;
      }
    }
  }
  task.advance(traced);
  return !stopped;
}

/// Returns false if the task had to stop before the pixel has `goal` samples.
bool SampleIntegrator::trace_pixel(const TileTask& task, int x, int y, uint32_t goal,
                                   SampleScratch& scratch) const {
  constexpr uint32_t kSamplesPerCheck = 16;  // a tile of many samples takes minutes
  for (uint32_t sample = task.film().samples(x, y); sample < goal; ++sample) {
    if (sample % kSamplesPerCheck == 0 && task.must_stop()) return false;
    trace(task.left() + x, task.top() + y, sample, scratch);
    if (task.add(x, y, scratch) && task.film().layers().noise)
      task.film().add_estimate(x, y, luminance(scratch.sample.radiance), 1);
  }
  return true;
}

}  // namespace pelage
