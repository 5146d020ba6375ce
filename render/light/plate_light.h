// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "image/texture.h"
#include "render/camera/camera.h"
#include "render/light/light.h"

namespace pelage {

/// A picture behind everything, stretched over the whole picture, which only the camera sees: it illuminates
/// nothing. It has the interface of a light because it takes the place of the lights that the camera sees in
/// the background, and has a layer as they have.
class PlateLight final : public Light {
 public:
  /// `width`: of the picture in pixels.
  PlateLight(std::string name, std::shared_ptr<const Texture> plate, const Camera& camera, int width)
      : Light(std::move(name), true),
        plate_(std::move(plate)),
        camera_(camera),
        is_magnified_(plate_->width() < width) {}

  bool is_infinitely_far() const override { return true; }
  std::optional<LightSample> sample(const V3f&, const V2f&) const override { return {}; }
  float pdf(const V3f&, const V3f&) const override { return 0; }
  std::optional<LightHit> intersect(const V3f&, const V3f&) const override { return {}; }
  /// Samples of a pixel average over the plate's pixels; if these are larger, they are interpolated linearly.
  std::optional<LightHit> seen(const V3f& from, const V3f& direction, float time) const override;
  float importance(const V3f&) const override { return 0; }
  std::optional<LightBall> ball() const override { return {}; }

 private:
  std::shared_ptr<const Texture> plate_;
  Camera camera_;
  bool is_magnified_;
};

}  // namespace pelage
