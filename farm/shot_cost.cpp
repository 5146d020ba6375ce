// SPDX-License-Identifier: Apache-2.0
#include "farm/shot_cost.h"

#include <algorithm>

namespace pelage {
namespace {

/// Factor of the memory to reserve, for what the estimate does not count: pages of files, and frames that are
/// not estimated.
constexpr double kReserve = 1.2;

/// CPU time of reading a chunk from render.bvh.file, as a fraction of growing it (docs/lab/FARM.md).
constexpr double kReading = 1.0 / 6;

}  // namespace

std::vector<int> frames_to_estimate(const std::vector<int>& frames) {
  std::vector<int> sampled;
  for (const size_t i : {size_t(0), frames.size() / 2, frames.size() - 1}) {
    if (std::find(sampled.begin(), sampled.end(), frames[i]) == sampled.end()) sampled.push_back(frames[i]);
  }
  return sampled;
}

ShotCost shot_cost(const FarmRequest& request, const RunEstimate& estimate, bool stores) {
  const auto sampled = static_cast<double>(estimate.frames.size());
  double repeated_s = estimate.loading_cpu_s + estimate.posing_cpu_s / sampled;
  for (const FrameEstimate& frame : estimate.estimates)
    repeated_s += ((request.grows ? 0 : frame.measuring_cpu_s) +
                   (stores ? kReading : 1) * frame.growing_cpu_s + frame.shadows.cpu_s) /
                  sampled;
  const auto regions = divide_picture(request.width, request.height, request.columns, request.rows).size();
  const auto frames = static_cast<double>(request.frames.size());
  ShotCost cost;
  for (size_t i = 0; i < estimate.frames.size(); ++i) cost.whole_s += estimate.cpu_s(i) * frames / sampled;
  cost.repeated_s = repeated_s * static_cast<double>(regions - 1) * frames;
  return cost;
}

uint64_t reserved_bytes(const RunEstimate& estimate) {
  return static_cast<uint64_t>(kReserve * static_cast<double>(estimate.peak_bytes()));
}

}  // namespace pelage
