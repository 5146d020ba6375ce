// SPDX-License-Identifier: Apache-2.0
#include "render/shadow_estimate.h"

#include <algorithm>
#include <vector>

#include "base/process_usage.h"
#include "geom/skin_balls.h"
#include "render/path/visibility_pilots.h"
#include "render/weighted_selection.h"

namespace pelage {
namespace {

constexpr size_t kSkinsWithBalls = 4;  // whose balls are found
// Rough CPU seconds of a pilot ray, with its share of shading.
constexpr double kPilotRay_s = 2e-6;
// Bytes that pilots reserve, per byte that they use: most pilots end early, and a table has few cells
// (docs/lab/FARM.md).
constexpr int64_t kReserved = 8;

/// Finds the balls of some skins, and adds what the balls of all skins need.
void add_balls(const RenderScene& scene, const Job& job, ShadowEstimate& estimate) {
  std::vector<double> sizes;
  for (const SkinPart& part : scene.skins)
    sizes.push_back(static_cast<double>(part.skin->temporary_bytes({})));
  double held = 0;
  for (const SelectedItem& item : select_by_weight(sizes, kSkinsWithBalls)) {
    job.check_stop();
    const double began = cpu_seconds();
    const SkinMesh mesh = scene.skins[item.index].skin->tessellate({}, scene.camera.view());
    const SkinBalls balls(mesh, job);
    held += item.scale * static_cast<double>(balls.bytes());
    estimate.cpu_s += item.scale * (cpu_seconds() - began);
    estimate.making_bytes = std::max(estimate.making_bytes,
                                     static_cast<int64_t>(mesh.bytes() + SkinBalls::temporary_bytes(mesh)));
  }
  estimate.held_bytes += static_cast<int64_t>(held);
  // Many skins are worked on concurrently.
  const int threads = job.workers.thread_count();
  if (scene.skins.size() >= 4 * static_cast<size_t>(threads)) estimate.making_bytes *= threads;
}

}  // namespace

ShadowEstimate estimate_shadows(const RenderScene& scene, const Job& job) {
  ShadowEstimate estimate;
  const SkinBallUse use = scene.render.ball_use(scene.skins.size());
  if (use != SkinBallUse::kOff && !scene.skins.empty()) add_balls(scene, job, estimate);
  if (scene.lights.size() == 0) return estimate;
  if (scene.render.learned_visibility != LearnedUse::kOff) {
    const PilotNeeds table = VisibilityPilots::needs_of_table(scene);
    estimate.learning_bytes = std::max(estimate.learning_bytes, table.tracing_bytes / kReserved);
    estimate.held_bytes += table.held_bytes / kReserved;
    estimate.cpu_s += kPilotRay_s * static_cast<double>(table.rays);
  }
  return estimate;
}

}  // namespace pelage
