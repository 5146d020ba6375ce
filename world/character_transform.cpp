// SPDX-License-Identifier: Apache-2.0
#include "world/character_transform.h"

#include <numbers>

namespace pelage {

M44f character_matrix(const TransformParams& transform, double frame) {
  const float to_radians = std::numbers::pi_v<float> / 180;
  M44f scale, rotation, translation;
  scale.setScale(transform.scale.at(frame));
  rotation.setEulerAngles(transform.rotate.at(frame) * to_radians);
  translation.setTranslation(transform.translate.at(frame));
  return scale * rotation * translation;
}

bool moves(const TransformParams& transform) {
  return !transform.translate.is_constant() || !transform.rotate.is_constant() ||
         !transform.scale.is_constant();
}

}  // namespace pelage
