// SPDX-License-Identifier: Apache-2.0
#include "geom/strands.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"

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
  const size_t strands = strand_count(), points = point_count();
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw Error(ErrorKind::kInput, std::string("inconsistent strands: ") + what);
  };
  const auto require_size = [](const char* name, size_t size, size_t expected) {
    if (size != expected)
      throw Error(ErrorKind::kInput, fmt::format("inconsistent strands: `{}` has {} entries instead of {}",
                                                 name, size, expected));
  };
  require(a_.motion_keys >= 1, "`motion_keys` is less than 1");
  require(a_.first_point.empty() || a_.first_point.front() == 0, "`first_point` does not begin with 0");
  require(std::is_sorted(a_.first_point.begin(), a_.first_point.end()), "`first_point` does not ascend");
  require_size("points", a_.points.size(), static_cast<size_t>(a_.motion_keys) * points * 4);
  require_size("ids", a_.ids.size(), strands);
  if (!a_.roots.empty()) require_size("roots", a_.roots.size(), strands);
  if (!a_.root_uv.empty()) require_size("root_uv", a_.root_uv.size(), strands);
  for (const StrandAttribute& attribute : a_.attributes) {
    require(attribute.components >= 1, "an attribute has less than one component");
    require_size(
        attribute.name.c_str(), attribute.values.size(),
        value_count(attribute.frequency, strands, points) * static_cast<size_t>(attribute.components));
  }
}

const StrandAttribute* Strands::find_attribute(std::string_view name) const {
  for (const StrandAttribute& attribute : a_.attributes) {
    if (attribute.name == name) return &attribute;
  }
  return nullptr;
}

void Strands::assign_strand(const Strands& source, size_t strand) {
  const StrandArrays& from = source.a_;
  const size_t first = from.first_point[strand], count = from.first_point[strand + 1] - first;
  a_.basis = from.basis;
  a_.motion_keys = from.motion_keys;
  a_.points.clear();
  for (int key = 0; key < from.motion_keys; ++key) {
    const float* points = source.points(key).data() + 4 * first;
    a_.points.insert(a_.points.end(), points, points + 4 * count);
  }
  a_.first_point.assign({0, static_cast<uint32_t>(count)});
  a_.ids.assign({from.ids[strand]});
  a_.roots.clear();
  a_.root_uv.clear();
  if (!from.roots.empty()) a_.roots.push_back(from.roots[strand]);
  if (!from.root_uv.empty()) a_.root_uv.push_back(from.root_uv[strand]);
  a_.attributes.resize(from.attributes.size());
  for (size_t i = 0; i < from.attributes.size(); ++i) {
    const StrandAttribute& attribute = from.attributes[i];
    const size_t begin = attribute.frequency == AttributeClass::kConstant    ? 0
                         : attribute.frequency == AttributeClass::kPerStrand ? strand
                                                                             : first;
    const size_t values = attribute.frequency == AttributeClass::kPerPoint ? count : 1;
    const auto components = static_cast<size_t>(attribute.components);
    const float* value = attribute.values.data() + begin * components;
    a_.attributes[i].name = attribute.name;
    a_.attributes[i].frequency = attribute.frequency;
    a_.attributes[i].components = attribute.components;
    a_.attributes[i].values.assign(value, value + values * components);
  }
}

size_t Strands::bytes() const {
  size_t total = heap_bytes(a_.points) + heap_bytes(a_.first_point) + heap_bytes(a_.ids) +
                 heap_bytes(a_.roots) + heap_bytes(a_.root_uv) + heap_bytes(a_.attributes);
  for (const StrandAttribute& attribute : a_.attributes) total += heap_bytes(attribute.values);
  return total;
}

uint32_t segment_count(CurveBasis basis, uint32_t points) {
  if (basis == CurveBasis::kBezier) return points > 0 ? (points - 1) / 3 : 0;
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
  // A span of an unpinned B-spline lies between the second and third of its four points.
  const size_t before = strands.basis() == CurveBasis::kBSpline ? 1 : 0;
  const size_t stride = strands.basis() == CurveBasis::kBezier ? 3 : 1;
  const float* a = &attribute.values[(strands.first_point(strand) + segment * stride + before) * n];
  const float* b = a + stride * n;
  for (size_t c = 0; c < n; ++c) out[c] = interpolate(a[c], b[c], t);
}

}  // namespace pelage
