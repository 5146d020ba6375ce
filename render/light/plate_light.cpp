// SPDX-License-Identifier: Apache-2.0
#include "render/light/plate_light.h"

#include <algorithm>
#include <cmath>

namespace pelage {

std::optional<LightHit> PlateLight::seen(const V3f& from, const V3f& direction, float time) const {
  const int width = plate_->width(), height = plate_->height();
  const V2f place = camera_.picture_position(from, direction, time);
  float x = place.x * static_cast<float>(width), y = place.y * static_cast<float>(height);
  if (!std::isfinite(x) || !std::isfinite(y)) x = y = 0;  // the camera is beyond what floats resolve
  const auto at = [&](float column, float row) {
    return plate_->texel(static_cast<int>(std::clamp(column, 0.0f, static_cast<float>(width - 1))),
                         static_cast<int>(std::clamp(row, 0.0f, static_cast<float>(height - 1))));
  };
  LightHit hit;
  if (!is_magnified_) {
    hit.radiance = at(x, y);
    return hit;
  }
  const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
  const float s = x - 0.5f - left, t = y - 0.5f - top;
  hit.radiance = (at(left, top) * (1 - s) + at(left + 1, top) * s) * (1 - t) +
                 (at(left, top + 1) * (1 - s) + at(left + 1, top + 1) * s) * t;
  return hit;
}

}  // namespace pelage
