// SPDX-License-Identifier: Apache-2.0
#include "render/shadow_estimate.h"

#include <algorithm>
#include <vector>

#include "base/process_usage.h"
#include "geom/skin_balls.h"
#include "render/weighted_selection.h"

namespace pelage {
namespace {

constexpr size_t kSkinsWithBalls = 4;  // whose balls are found

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
  return estimate;
}

}  // namespace pelage
