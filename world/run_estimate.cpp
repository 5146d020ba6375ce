// SPDX-License-Identifier: Apache-2.0
#include "world/run_estimate.h"

#include <algorithm>

#include "base/process_usage.h"
#include "base/progress.h"
#include "world/compose.h"
#include "world/world.h"

namespace pelage {
namespace {

template <class Work>
auto stage(const char* name, const Job& job, Work&& work) {
  const ProgressStage shown(job.progress, name, 1);
  return work();
}

}  // namespace

int64_t RunEstimate::peak_bytes() const {
  int64_t peak = 0;
  for (const FrameEstimate& e : estimates) peak = std::max(peak, e.peak_bytes());
  return peak;
}

double RunEstimate::cpu_s() const {
  double sum = loading_cpu_s + posing_cpu_s;
  for (const FrameEstimate& e : estimates) sum += e.cpu_s();
  return sum;
}

double RunEstimate::cpu_s(size_t i) const {
  return loading_cpu_s + posing_cpu_s / static_cast<double>(std::max<size_t>(1, frames.size())) +
         estimates[i].cpu_s();
}

RunEstimate estimate_run(const SceneDescription& scene, const std::vector<int>& frames,
                         const std::optional<PixelBox>& region, const Job& job) {
  RunEstimate estimate;
  const double began = cpu_seconds();
  MemoryCharge film = reserve_film(scene, job, region);
  const auto assets = stage("read", job, [&] { return load_assets(scene, job); });
  film = {};  // estimate_frame() counts it
  estimate.loading_cpu_s = cpu_seconds() - began;
  for (const int frame : frames) {
    const double posing = cpu_seconds();
    const World world = stage("pose", job, [&] { return compose(scene, *assets, frame, job); });
    estimate.posing_cpu_s += cpu_seconds() - posing;
    estimate.frames.push_back(frame);
    estimate.estimates.push_back(
        stage("estimate", job, [&] { return estimate_frame(world.scene, job, region); }));
  }
  return estimate;
}

}  // namespace pelage
