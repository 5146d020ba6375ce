// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/turning.h"

#include <algorithm>
#include <cmath>

namespace pelage {

float TurnProfile::mean(float from, float to) const {
  const auto integral = [this](float x) {
    if (x <= start) return 0.0f;
    if (x >= end) return (end - start) / (profile + 1) + (x - end);
    return (end - start) / (profile + 1) * std::pow((x - start) / (end - start), profile + 1);
  };
  if (to - from < 1e-6f) return to >= end ? 1.0f : 0.0f;
  return std::clamp((integral(to) - integral(from)) / (to - from), 0.0f, 1.0f);
}

void turn_strand(StrandBatch& batch, size_t s, const TurnProfile& profile, const Rotation& rotation) {
  if (rotation.angle == 0) return;
  const int points = batch.point_count();
  V3f before = batch.offset(0, s);
  V3f at = before;
  if (profile.end == 0) {  // all at once
    const float sine = std::sin(rotation.angle), cosine = std::cos(rotation.angle);
    for (int p = 1; p < points; ++p) {
      const V3f v = batch.offset(p, s) - before;
      const V3f turned =
          v * cosine + rotation.axis.cross(v) * sine + rotation.axis * (rotation.axis.dot(v) * (1 - cosine));
      batch.set_offset(p, s, at + turned);
    }
    return;
  }
  float length = 0;
  for (int p = 1; p < points; ++p) length += (batch.offset(p, s) - batch.offset(p - 1, s)).length();
  if (!(length > 0)) return;
  float arc = 0;
  for (int p = 1; p < points; ++p) {
    const V3f point = batch.offset(p, s);
    const V3f step = point - before;
    const float next = arc + step.length() / length;
    at += rotation.apply(step, rotation.angle * profile.mean(arc, next));
    batch.set_offset(p, s, at);
    before = point;
    arc = next;
  }
}

}  // namespace pelage
