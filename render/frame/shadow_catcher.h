// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render/accel/accel.h"
#include "render/frame/sample_scratch.h"
#include "render/light/direct_light.h"
#include "render/sampling/sample_stream.h"
#include "render/scene/frame_scene.h"

namespace pelage {

/// Skins that the camera sees only by the shadows on them (LambertParams::shadow_catcher), for animals that
/// are composited over a photograph. Where a camera sample hits such a skin, it sees the background behind
/// everything, times the fraction of direct light that arrives at the skin. Its alpha is the fraction that is
/// blocked, so that `over` darkens any other background in the same way. All other rays meet an ordinary
/// diffuse skin. Thread safety: const members may be called from any thread, each with its own scratch.
class ShadowCatcher {
 public:
  /// Keeps references to its arguments.
  ShadowCatcher(const FrameScene& scene, const Accel& accel);

  bool is_catcher(const Hit& hit) const { return any_ && hit.kind == HitKind::kSkin && of_skin_[hit.part]; }

  struct Blocked {
    Rgb fraction{0};  ///< by channel; noise may bring it below 0 or above 1
    float alpha = 0;  ///< of the luminance, 0 to 1
  };
  /// Estimates the fraction of the irradiance of a catcher that something blocks. The estimate is 0 where
  /// nothing blocks any light. It is the ratio of two sums over the same points on lights, so it has the
  /// small bias of such ratios. `ray`: of the camera; `scratch` has the geometry of its hit. `stream`: of the
  /// sample.
  Blocked blocked(const Ray& ray, const Hit& hit, SampleStream& stream, DirectLightScratch& lights,
                  SampleScratch& scratch) const;

 private:
  const Accel& accel_;
  DirectLight direct_;
  std::vector<bool> of_skin_;  // whether each skin is a catcher
  bool any_ = false;
};

}  // namespace pelage
