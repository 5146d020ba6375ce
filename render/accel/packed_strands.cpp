// SPDX-License-Identifier: Apache-2.0
#include "render/accel/packed_strands.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pelage {
namespace {

constexpr float kUnormSteps = 65535.0f;

bool is_unit(float x) { return x >= 0.0f && x <= 1.0f; }
uint32_t step_of(float x) { return static_cast<uint32_t>(std::lround(x * kUnormSteps)); }

}  // namespace

float packed_value(float x) { return is_unit(x) ? static_cast<float>(step_of(x)) / kUnormSteps : x; }

Precision coarsest_precision(std::span<const float> values) {
  Precision precision = Precision::kUnorm8;
  for (float x : values) {
    // Compared bitwise, because -0 must differ from 0.
    if (!is_unit(x) || std::bit_cast<uint32_t>(packed_value(x)) != std::bit_cast<uint32_t>(x)) {
      return Precision::kFloat;
    }
    if (step_of(x) % 257 != 0) precision = Precision::kUnorm16;
  }
  return precision;
}

void pack_values(std::span<const float> values, Precision precision, std::byte* out) {
  switch (precision) {
    case Precision::kFloat:
      std::copy(values.begin(), values.end(), reinterpret_cast<float*>(out));
      break;
    case Precision::kUnorm16:
      for (float x : values) *reinterpret_cast<uint16_t*>(out) = static_cast<uint16_t>(step_of(x)), out += 2;
      break;
    case Precision::kUnorm8:
      for (float x : values) *reinterpret_cast<uint8_t*>(out++) = static_cast<uint8_t>(step_of(x) / 257);
      break;
  }
}

PackedStrands::Place PackedStrands::search(uint32_t primitive) const {
  const auto* begin = at<uint32_t>(first_segments_);
  const auto* above = std::upper_bound(begin, begin + strand_count_, primitive);
  const auto strand = static_cast<uint32_t>(above - begin - 1);
  return {strand, primitive - begin[strand]};
}

uint32_t PackedStrands::strand_points(uint32_t strand) const {
  return strand_segments(strand) + extra_ - phantoms_;
}

size_t PackedStrands::first_point(uint32_t strand) const {
  return first_segment(strand) + static_cast<size_t>(extra_ - phantoms_) * strand;
}

float PackedStrands::opacity(Place place, float u) const {
  if (opaque_) return 1;
  if (opacity_.frequency == AttributeClass::kConstant) return value(opacity_, 0);
  if (opacity_.frequency == AttributeClass::kPerStrand) return value(opacity_, place.strand);
  // A span of an unpinned B-spline lies between its second and third points.
  const size_t before = basis_ == CurveBasis::kBSpline ? 1 : 0;
  const size_t index = first_point(place.strand) + place.segment + before;
  return interpolate(value(opacity_, index), value(opacity_, index + 1), u);
}

void PackedStrands::copy_strand(uint32_t strand, Strands& out) const {
  StrandArrays a = std::move(out).release();
  const uint32_t count = strand_points(strand);
  const size_t first_vertex = first_segment(strand) + static_cast<size_t>(extra_) * strand + phantoms_ / 2;
  a.basis = basis_;
  a.points.clear();
  for (int key = 0; key < motion_keys_; ++key) {
    const float* points = vertices(key) + 4 * first_vertex;
    a.points.insert(a.points.end(), points, points + size_t(4) * count);
  }
  copy_rest(strand, {first_point(strand), count, 1}, a);
  out = Strands(std::move(a));
}

StrandArrays PackedStrands::bezier_strand(uint32_t strand, StrandArrays a) const {
  const uint32_t segments = strand_segments(strand);
  // A span of an unpinned B-spline lies between its second and third points.
  const size_t before = basis_ == CurveBasis::kBSpline ? 1 : 0;
  a.basis = CurveBasis::kBezier;
  a.points.resize(static_cast<size_t>(motion_keys_) * 4 * (3 * segments + 1));
  copy_rest(strand, {first_point(strand) + before, segments + 1, 3}, a);
  return a;
}

void PackedStrands::copy_rest(uint32_t strand, const PointRange& range, StrandArrays& a) const {
  const uint32_t points = range.stride * (range.count - 1) + 1;
  a.motion_keys = motion_keys_;
  a.first_point.assign({0, points});
  a.ids.assign({id(strand)});
  a.roots.clear();
  a.root_uv.clear();
  const size_t pair = size_t(2) * strand;
  const auto both = [&](const Values& values) {
    const size_t i = values.frequency == AttributeClass::kConstant ? 0 : pair;
    return V2f(value(values, i), value(values, i + 1));
  };
  if (has_roots_) {
    const uint32_t face = wide_faces_ ? at<uint32_t>(faces_)[strand] : at<uint16_t>(faces_)[strand];
    const V2f uv = both(root_place_);
    a.roots.push_back({first_face_ + face, uv.x, uv.y});
  }
  if (has_root_uv_) a.root_uv.push_back(both(root_uv_));

  a.attributes.resize(attributes_.size());
  for (size_t i = 0; i < attributes_.size(); ++i) {
    const Values& values = attributes_[i].values;
    StrandAttribute& attribute = a.attributes[i];
    const size_t n = values.components;
    attribute.name = attributes_[i].name;
    attribute.frequency = values.frequency;
    attribute.components = static_cast<int>(n);
    if (values.frequency != AttributeClass::kPerPoint) {
      const size_t begin = values.frequency == AttributeClass::kConstant ? 0 : strand * n;
      attribute.values.resize(n);
      for (size_t k = 0; k < n; ++k) attribute.values[k] = value(values, begin + k);
      continue;
    }
    attribute.values.resize(n * points);
    for (size_t p = 0; p < range.count; ++p) {
      float* out = &attribute.values[p * range.stride * n];
      for (size_t k = 0; k < n; ++k) out[k] = value(values, (range.first + p) * n + k);
    }
  }
}

void PackedStrands::fetch_ahead(uint32_t primitive) const {
#if defined(__GNUC__)
  if (segments_per_strand_ == 0) return;
  const uint32_t strand = primitive / segments_per_strand_;
  const size_t stride = segments_per_strand_ + extra_;
  const float* points = vertices(0) + 4 * stride * strand;
  for (uint32_t i = 0; i < stride; i += 4) __builtin_prefetch(points + size_t(4) * i);
  __builtin_prefetch(points + 4 * (stride - 1));
  __builtin_prefetch(wide_ids_ ? static_cast<const void*>(at<uint64_t>(ids_) + strand)
                               : static_cast<const void*>(at<uint32_t>(ids_) + strand));
#endif
}

size_t PackedStrands::bytes() const {
  size_t total = sizeof(*this) + block_.bytes() + attributes_.capacity() * sizeof(Attribute);
  for (const Attribute& attribute : attributes_) {
    if (attribute.name.capacity() > std::string().capacity()) total += attribute.name.capacity() + 1;
  }
  return total;
}

namespace {

constexpr size_t kArrays = 12;                                // without the attributes
constexpr size_t kMaxAttributes = 16, kAttributeBytes = 256;  // generous, for bytes_bound()

/// For attributes, opacities and roots.
size_t numbers_bound(const ChunkCounts& n) { return n.attribute_floats + n.points + 4 * n.strands; }

}  // namespace

size_t PackedStrands::bytes_bound(const ChunkCounts& n, PackedPoints points) {
  const auto keys = static_cast<size_t>(n.motion_keys);
  const size_t vertices = 16 * keys * (n.points + 2 * n.strands) + sizeof(uint32_t) * n.segments;
  const size_t block = (points == PackedPoints::kInPlace ? vertices : 0) +
                       n.strands * (sizeof(uint64_t) + sizeof(uint32_t)) +
                       sizeof(uint32_t) * (n.strands + 1) + sizeof(float) * numbers_bound(n);
  // Per attribute: its name and positions, the end of its array.
  const size_t named = kAttributeBytes * (kArrays + std::min(n.attribute_floats, kMaxAttributes));
  return sizeof(PackedStrands) + PageBlock::held_bytes(block) + named;
}

size_t PackedStrands::scratch_bytes_bound(const ChunkCounts& n) {
  return sizeof(float) * numbers_bound(n) + sizeof(uint32_t) * 2 * n.strands;
}

}  // namespace pelage
