// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/transported_frame.h"

#include <algorithm>
#include <cmath>

#include "groom/strands/rotation.h"

namespace pelage {

TransportedFrame::TransportedFrame(const StrandBatch& batch) : previous_(batch.points.front().offset) {
  for (size_t s = 0; s < batch.count; ++s) {
    const Frame frame = batch.current.frame(s);
    V3f direction = frame.normal;
    for (int p = 1; p < batch.point_count(); ++p) {
      const V3f step = batch.offset(p, s) - batch.offset(0, s);
      if (step.dot(step) > 1e-24f) {
        direction = normalised_or(step, frame.normal);
        break;
      }
    }
    V3f first = frame.tangent - direction * direction.dot(frame.tangent);
    if (first.dot(first) < 0.01f) first = frame.bitangent - direction * direction.dot(frame.bitangent);
    set_vector(along_, s, direction);
    set_vector(first_, s, normalised_or(first, frame.bitangent));
  }
}

void TransportedFrame::advance(const StrandBatch& batch) {
  ++point_;
  const VectorRow& offset = batch.points[static_cast<size_t>(point_)].offset;
  float* __restrict ax = along_[0].data();
  float* __restrict ay = along_[1].data();
  float* __restrict az = along_[2].data();
  float* __restrict fx = first_[0].data();
  float* __restrict fy = first_[1].data();
  float* __restrict fz = first_[2].data();
  float* __restrict px = previous_[0].data();
  float* __restrict py = previous_[1].data();
  float* __restrict pz = previous_[2].data();
  const float* x = offset[0].data();
  const float* y = offset[1].data();
  const float* z = offset[2].data();
  for (size_t s = 0; s < batch.count; ++s) {
    float dx = x[s] - px[s], dy = y[s] - py[s], dz = z[s] - pz[s];
    const float length2 = dx * dx + dy * dy + dz * dz;
    const bool moves = length2 > 1e-24f;
    const float inverse = moves ? 1.0f / std::sqrt(length2) : 0.0f;
    dx = moves ? dx * inverse : ax[s];
    dy = moves ? dy * inverse : ay[s];
    dz = moves ? dz * inverse : az[s];
    // The smallest rotation from a to d maps f, perpendicular to a, to f - (f.d) / (1 + a.d) (a + d).
    const float cosine = 1.0f + ax[s] * dx + ay[s] * dy + az[s] * dz;
    const float along = fx[s] * dx + fy[s] * dy + fz[s] * dz;
    const float k = cosine > 1e-4f ? along / cosine : 0.0f;
    const float gx = fx[s] - k * (ax[s] + dx), gy = fy[s] - k * (ay[s] + dy), gz = fz[s] - k * (az[s] + dz);
    // Rounding drifts, and where a strand reverses there is no smallest rotation: orthogonalise.
    const float rest = gx * dx + gy * dy + gz * dz;
    const float hx = gx - rest * dx, hy = gy - rest * dy, hz = gz - rest * dz;
    const float scale = 1.0f / std::sqrt(std::max(hx * hx + hy * hy + hz * hz, 1e-12f));
    ax[s] = dx;
    ay[s] = dy;
    az[s] = dz;
    fx[s] = hx * scale;
    fy[s] = hy * scale;
    fz[s] = hz * scale;
    px[s] = x[s];
    py[s] = y[s];
    pz[s] = z[s];
  }
}

void TransportedFrame::displace(StrandBatch& batch, int point, const StrandRow& a, const StrandRow& b) const {
  VectorRow& offset = batch.points[static_cast<size_t>(point)].offset;
  for (size_t axis = 0; axis < 3; ++axis) {
    const size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
    float* __restrict out = offset[axis].data();
    const float* f = first_[axis].data();
    const float* a1 = along_[next].data();
    const float* a2 = along_[last].data();
    const float* f1 = first_[next].data();
    const float* f2 = first_[last].data();
    for (size_t s = 0; s < batch.count; ++s) out[s] += a[s] * f[s] + b[s] * (a1[s] * f2[s] - a2[s] * f1[s]);
  }
}

}  // namespace pelage
