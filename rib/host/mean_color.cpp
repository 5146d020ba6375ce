// SPDX-License-Identifier: Apache-2.0
#include "rib/host/mean_color.h"

namespace pelage {

Rgb mean_color(const Field& color, const LimitSurface& rest) {
  if (color.is_constant()) return color.color({});
  const SurfaceTopology& topology = rest.topology();
  const float middle = topology.is_triangular() ? 1.0f / 3 : 0.5f;
  Imath::V3d weighted(0), sum(0);
  double area = 0, faces = 0;
  for (uint32_t face = 0; face < topology.face_count(); ++face) {
    if (topology.is_hole(face)) continue;
    const SurfacePoint at = rest.evaluate(face, middle, middle);
    const V2f uv = topology.texture_coordinates(face, middle, middle);
    FieldPoint point;
    point.rest = at.position;
    point.u = uv.x;
    point.v = uv.y;
    const Rgb value = color.color(point);
    const auto size = static_cast<double>(at.du.cross(at.dv).length());
    weighted += size * Imath::V3d(value.x, value.y, value.z);
    sum += Imath::V3d(value.x, value.y, value.z);
    area += size;
    ++faces;
  }
  if (faces == 0) return color.color({});
  const Imath::V3d mean = area > 0 ? weighted / area : sum / faces;
  return {static_cast<float>(mean.x), static_cast<float>(mean.y), static_cast<float>(mean.z)};
}

}  // namespace pelage
