// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/strand_batch.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace pelage {

void RootRows::set(size_t strand, const V3f& position_of_root, const Frame& frame) {
  set_vector(position, strand, position_of_root);
  set_vector(tangent, strand, frame.tangent);
  set_vector(bitangent, strand, frame.bitangent);
  set_vector(normal, strand, frame.normal);
}

void start_strands(StrandBatch& batch, int points) {
  PELAGE_CHECK(points >= 2);
  batch.points.resize(static_cast<size_t>(points));
  batch.current = batch.rest;
  batch.scale = 1;
  batch.skin = nullptr;
  batch.posed = false;
  for (int p = 0; p < points; ++p) {
    StrandBatch::PointRows& rows = batch.points[static_cast<size_t>(p)];
    const float along = batch.along(p);
    for (size_t axis = 0; axis < 3; ++axis) {
      const float* normal = batch.rest.normal[axis].data();
      float* offset = rows.offset[axis].data();
      for (size_t s = 0; s < batch.count; ++s) offset[s] = normal[s] * along;
    }
  }
  clear_attributes(batch);
}

void clear_attributes(StrandBatch& batch) {
  for (StrandBatch::PointRows& rows : batch.points) std::fill_n(rows.radius.data(), batch.count, 0.0f);
  for (VectorRow& color : batch.colors) {
    for (StrandRow& channel : color) std::fill_n(channel.data(), batch.count, 1.0f);
  }
}

void scale_radii(StrandBatch& batch, float scale) {
  for (StrandBatch::PointRows& rows : batch.points) {
    for (size_t s = 0; s < batch.count; ++s) rows.radius[s] *= scale;
  }
}

void carry_to_pose(StrandBatch& batch, float scale) {
  batch.scale = scale;
  batch.posed = true;
  // Rotation of each root, current * transposed rest, times the scale.
  std::array<VectorRow, 3> matrix;
  for (size_t row = 0; row < 3; ++row) {
    for (size_t column = 0; column < 3; ++column) {
      float* m = matrix[row][column].data();
      const float* ht = batch.current.tangent[row].data();
      const float* hb = batch.current.bitangent[row].data();
      const float* hn = batch.current.normal[row].data();
      const float* rt = batch.rest.tangent[column].data();
      const float* rb = batch.rest.bitangent[column].data();
      const float* rn = batch.rest.normal[column].data();
      for (size_t s = 0; s < batch.count; ++s) m[s] = scale * (ht[s] * rt[s] + hb[s] * rb[s] + hn[s] * rn[s]);
    }
  }
  for (StrandBatch::PointRows& rows : batch.points) {
    float* __restrict x = rows.offset[0].data();
    float* __restrict y = rows.offset[1].data();
    float* __restrict z = rows.offset[2].data();
    float* __restrict radius = rows.radius.data();
    for (size_t s = 0; s < batch.count; ++s) {
      const float a = x[s], b = y[s], c = z[s];
      x[s] = matrix[0][0][s] * a + matrix[0][1][s] * b + matrix[0][2][s] * c;
      y[s] = matrix[1][0][s] * a + matrix[1][1][s] * b + matrix[1][2][s] * c;
      z[s] = matrix[2][0][s] * a + matrix[2][1][s] * b + matrix[2][2][s] * c;
      radius[s] *= scale;
    }
  }
}

void arc_lengths(const StrandBatch& batch, StrandRow& lengths) {
  float* __restrict total = lengths.data();
  for (size_t s = 0; s < batch.count; ++s) total[s] = 0;
  for (size_t p = 1; p < batch.points.size(); ++p) {
    const VectorRow& a = batch.points[p - 1].offset;
    const VectorRow& b = batch.points[p].offset;
    for (size_t s = 0; s < batch.count; ++s) {
      const float dx = b[0][s] - a[0][s], dy = b[1][s] - a[1][s], dz = b[2][s] - a[2][s];
      total[s] += std::sqrt(dx * dx + dy * dy + dz * dz);
    }
  }
}

}  // namespace pelage
