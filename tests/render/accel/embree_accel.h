// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "render/accel/accel.h"
#include "tests/render/accel/embree_scene.h"

namespace pelage {

/// One Embree scene over everything: an oracle for chunks, and a yardstick. Based on Intel Embree [Wald14].
/// Flat curves are ribbons that face the ray. Embree ignores hits on flat curves within two radii of the
/// ray's origin. Because this class does not use Ray::start, such hits are lost on all strands. EmbreeChunk
/// ignores them only on the strand that the ray starts on.
class EmbreeAccel final : public Accel {
 public:
  /// `strands` and `skins` must outlive the accelerator.
  EmbreeAccel(const std::vector<AccelStrands>& strands, const std::vector<const SkinMesh*>& skins,
              const EmbreeOptions& options, const Workers& workers)
      : scene_(std::make_unique<EmbreeScene>(strands, skins, options, workers)) {}

  Hit closest(const Ray& ray, TraceThread& thread) const override;
  float transmittance(const Ray& ray, TraceThread& thread) const override;
  StrandCount strands_crossed(const Ray& ray, uint32_t max, TraceThread& thread) const override;
  bool opaque() const override;
  Box3f bounds() const override;

 private:
  std::unique_ptr<EmbreeScene> scene_;
};

}  // namespace pelage
