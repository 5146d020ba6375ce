// SPDX-License-Identifier: Apache-2.0
#include "render/frame/frame_statistics.h"

namespace pelage {

FrameStatistics& FrameStatistics::operator+=(const FrameStatistics& other) {
  growth += other.growth;
  residency += other.residency;
  reads += other.reads;
  trace += other.trace;
  rays += other.rays;
  occlusion += other.occlusion;
  cpu_s += other.cpu_s;
  samples_rejected += other.samples_rejected;
  knots += other.knots;
  reflections += other.reflections;
  for (const auto& [stage, seconds] : other.stages_s) stages_s[stage] += seconds;
  return *this;
}

}  // namespace pelage
