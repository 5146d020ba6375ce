// SPDX-License-Identifier: Apache-2.0
#include "geom/root_detail.h"

#include <cmath>

#include "base/check.h"

namespace pelage {
namespace {

constexpr const char* kName = "root detail";

}  // namespace

RootDetail::RootDetail(const V3f& normal, float share)
    : line_(packed_line(normal)), root_of_share_(std::round(255 * std::sqrt(share)) / 255) {}

V3f RootDetail::normal() const { return unpacked_line(line_); }

Strands RootDetail::added(Strands strands, const std::vector<RootDetail>& details) {
  PELAGE_CHECK(details.size() == strands.strand_count());
  std::vector<float> values;
  values.reserve(kFloats * details.size());
  for (const RootDetail& d : details) values.insert(values.end(), {d.line_.x, d.line_.y, d.root_of_share_});
  StrandArrays arrays = std::move(strands).release();
  arrays.attributes.push_back(
      {kName, AttributeClass::kPerStrand, static_cast<int>(kFloats), std::move(values)});
  return Strands(std::move(arrays));
}

std::optional<RootDetail> RootDetail::of(const Strands& strands, size_t strand) {
  const StrandAttribute* packed = strands.find_attribute(kName);
  if (!packed || packed->components != static_cast<int>(kFloats) ||
      packed->frequency == AttributeClass::kPerPoint) {
    return std::nullopt;
  }
  const size_t first = packed->frequency == AttributeClass::kConstant ? 0 : kFloats * strand;
  const float* v = &packed->values[first];
  return RootDetail(V2f(v[0], v[1]), v[2]);
}

}  // namespace pelage
