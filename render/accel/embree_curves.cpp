// SPDX-License-Identifier: Apache-2.0
#include "render/accel/embree_curves.h"

#include <algorithm>

#include "base/check.h"

namespace pelage {
namespace {

bool needs_phantoms(CurveBasis basis) {
  return basis == CurveBasis::kPinnedBSpline || basis == CurveBasis::kCatmullRom;
}

}  // namespace

EmbreeCurves::EmbreeCurves(const AccelStrands& source) : source_(source) {
  const Strands& strands = *source_.strands;
  PELAGE_CHECK(source_.opacity.empty() || source_.opacity.size() == strands.point_count());
  const size_t count = strands.strand_count();
  const bool phantoms = needs_phantoms(strands.basis());
  vertex_count_ = strands.point_count() + (phantoms ? 2 * count : 0);

  size_t total = 0;
  bool uniform = true;
  for (size_t s = 0; s < count; ++s) {
    const uint32_t segments = segment_count(strands.basis(), strands.strand_points(s));
    uniform &= segments == segment_count(strands.basis(), strands.strand_points(0));
    total += segments;
  }
  first_vertex_.reserve(total);
  if (uniform && count > 0) {
    segments_per_strand_ = static_cast<uint32_t>(total / count);
    points_per_strand_ = strands.strand_points(0);
  } else {
    strand_of_segment_.reserve(total);
    first_segment_.reserve(count);
  }
  for (size_t s = 0; s < count; ++s) {
    const uint32_t segments = segment_count(strands.basis(), strands.strand_points(s));
    const uint32_t base = strands.first_point(s) + (phantoms ? 2 * static_cast<uint32_t>(s) : 0);
    if (!uniform) {
      first_segment_.push_back(static_cast<uint32_t>(first_vertex_.size()));
      strand_of_segment_.insert(strand_of_segment_.end(), segments, static_cast<uint32_t>(s));
    }
    for (uint32_t i = 0; i < segments; ++i) first_vertex_.push_back(base + i);
  }
  if (phantoms) copy_with_phantoms();
}

void EmbreeCurves::copy_with_phantoms() {
  const Strands& strands = *source_.strands;
  copy_.resize(vertex_count_ * 4 * static_cast<size_t>(strands.motion_keys()));
  float* out = copy_.data();
  for (int key = 0; key < strands.motion_keys(); ++key) {
    const float* points = strands.points(key).data();
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      const uint32_t n = strands.strand_points(s);
      const float* p = points + size_t(4) * strands.first_point(s);
      const float* last = p + size_t(4) * (n - 1);
      for (int c = 0; c < 4; ++c) out[c] = n > 1 ? 2 * p[c] - p[4 + c] : 0;
      std::copy_n(p, size_t(4) * n, out + 4);
      out += size_t(4) * (n + 1);
      for (int c = 0; c < 4; ++c) out[c] = n > 1 ? 2 * last[c] - last[c - 4] : 0;
      out += 4;
    }
  }
}

const float* EmbreeCurves::vertices(int key) const {
  if (copy_.empty()) return strands().points(key).data();
  return copy_.data() + static_cast<size_t>(key) * vertex_count_ * 4;
}

EmbreeCurves::Place EmbreeCurves::locate(uint32_t primitive) const {
  if (strand_of_segment_.empty()) {
    const uint32_t strand = primitive / segments_per_strand_;
    return {strand, primitive - strand * segments_per_strand_};
  }
  const uint32_t strand = strand_of_segment_[primitive];
  return {strand, primitive - first_segment_[strand]};
}

float EmbreeCurves::opacity(Place place, float u) const {
  if (opaque()) return 1;
  // As in interpolate_attribute(): a span of an unpinned B-spline lies between its second and third points.
  const size_t before = strands().basis() == CurveBasis::kBSpline ? 1 : 0;
  const float* o = &source_.opacity[strands().first_point(place.strand) + place.segment + before];
  return interpolate(o[0], o[1], u);
}

void EmbreeCurves::fetch_ahead(uint32_t primitive) const {
#if defined(__GNUC__)
  if (segments_per_strand_ == 0) return;
  const size_t strand = primitive / segments_per_strand_;
  const StrandArrays& arrays = strands().arrays();
  const float* points = &arrays.points[4 * strand * points_per_strand_];
  for (uint32_t i = 0; i < points_per_strand_; i += 4) __builtin_prefetch(points + 4 * i);
  __builtin_prefetch(points + 4 * (points_per_strand_ - 1));
  __builtin_prefetch(&arrays.first_point[strand]);
  __builtin_prefetch(&arrays.ids[strand]);
#endif
}

size_t EmbreeCurves::bytes() const {
  return copy_.capacity() * sizeof(float) +
         (first_vertex_.capacity() + strand_of_segment_.capacity() + first_segment_.capacity()) *
             sizeof(uint32_t);
}

}  // namespace pelage
