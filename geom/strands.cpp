// SPDX-License-Identifier: Apache-2.0
#include "geom/strands.h"

#include <algorithm>

#include "base/check.h"

namespace pelage {
namespace {

template <class T>
size_t heap_bytes(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
}

size_t value_count(AttributeClass frequency, size_t strands, size_t points) {
  switch (frequency) {
    case AttributeClass::kConstant:
      return 1;
    case AttributeClass::kPerStrand:
      return strands;
    case AttributeClass::kPerPoint:
      return points;
  }
  return 0;
}

}  // namespace

Strands::Strands(StrandArrays arrays) : a_(std::move(arrays)) {
  const size_t strands = strand_count();
  const size_t points = point_count();
  PELAGE_CHECK(a_.motion_keys >= 1);
  PELAGE_CHECK(a_.first_point.empty() || a_.first_point.front() == 0);
  PELAGE_CHECK(std::is_sorted(a_.first_point.begin(), a_.first_point.end()));
  PELAGE_CHECK(a_.points.size() == static_cast<size_t>(a_.motion_keys) * points * 4);
  PELAGE_CHECK(a_.ids.size() == strands);
  PELAGE_CHECK(a_.roots.empty() || a_.roots.size() == strands);
  PELAGE_CHECK(a_.root_uv.empty() || a_.root_uv.size() == strands);
  for (const StrandAttribute& attribute : a_.attributes) {
    PELAGE_CHECK(attribute.components >= 1);
    PELAGE_CHECK(attribute.values.size() == value_count(attribute.frequency, strands, points) *
                                                static_cast<size_t>(attribute.components));
  }
}

const StrandAttribute* Strands::find_attribute(std::string_view name) const {
  for (const StrandAttribute& attribute : a_.attributes) {
    if (attribute.name == name) return &attribute;
  }
  return nullptr;
}

size_t Strands::bytes() const {
  size_t total = heap_bytes(a_.points) + heap_bytes(a_.first_point) + heap_bytes(a_.ids) +
                 heap_bytes(a_.roots) + heap_bytes(a_.root_uv) + heap_bytes(a_.attributes);
  for (const StrandAttribute& attribute : a_.attributes) total += heap_bytes(attribute.values);
  return total;
}

uint32_t segment_count(CurveBasis basis, uint32_t points) {
  const uint32_t lost = basis == CurveBasis::kBSpline ? 3 : 1;
  return points > lost ? points - lost : 0;
}

void interpolate_attribute(const Strands& strands, const StrandAttribute& attribute, size_t strand,
                           uint32_t segment, float t, float* out) {
  const size_t n = static_cast<size_t>(attribute.components);
  if (attribute.frequency != AttributeClass::kPerPoint) {
    const size_t index = attribute.frequency == AttributeClass::kConstant ? 0 : strand;
    std::copy_n(&attribute.values[index * n], n, out);
    return;
  }
  // A span of an unpinned B-spline lies beside the second and third of its four points.
  const size_t before = strands.basis() == CurveBasis::kBSpline ? 1 : 0;
  const float* a = &attribute.values[(strands.first_point(strand) + segment + before) * n];
  const float* b = a + n;
  for (size_t c = 0; c < n; ++c) out[c] = a[c] * (1.0f - t) + b[c] * t;
}

}  // namespace pelage
