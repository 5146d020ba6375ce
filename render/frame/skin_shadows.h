// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "base/job.h"
#include "geom/skin_balls.h"
#include "render/accel/accel.h"
#include "render/light/skin_shadow.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// The balls inside all skins of a frame (SkinBalls). They depend on the scene only: not on `render.memory`,
/// threads or chunks. Thread safety: const members may be called from any thread.
class SkinShadows {
 public:
  /// Tessellates each skin and finds its balls. Keeps a reference to `scene`. Throws Error (kMemory) if the
  /// triangles of a skin do not fit `render.memory`, and Error (kStopped) when the job is stopped.
  SkinShadows(const RenderScene& scene, const Job& job);

  /// Returns the ball below the root of a strand, or below a hit on a skin, at the time of the ray. Proves
  /// nothing if there is no ball. `hit_geometry`: the geometry of the hit.
  SkinShadow below(const Hit& hit, const HitGeometry& hit_geometry, float time) const;

 private:
  std::unique_ptr<const SkinBalls> make(size_t skin, const Job& job);

  const RenderScene& scene_;
  std::vector<std::unique_ptr<const SkinBalls>> balls_;  // by skin
  std::vector<MemoryCharge> charges_;                    // by skin: its balls
};

}  // namespace pelage
