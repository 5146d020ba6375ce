// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_curves.h"

#include <algorithm>

#include "base/check.h"
#include "geom/rest_position.h"

namespace pelage {
namespace {

bool needs_phantoms(CurveBasis basis) {
  return basis == CurveBasis::kPinnedBSpline || basis == CurveBasis::kCatmullRom;
}

// Values per joint of segments are as many as the points, except for B-splines without phantom points.
const char* per_point(CurveBasis basis) { return basis == CurveBasis::kBSpline ? "vertex " : "varying "; }

/// Writes (2 a - b) of two points of (x, y, z, radius).
void add_phantom(const float* a, const float* b, float*& to) {
  for (int axis = 0; axis < 3; ++axis) *to++ = 2.0f * a[axis] - b[axis];
}

void fill_points(const Strands& strands, int key, std::vector<float>& points) {
  const bool phantoms = needs_phantoms(strands.basis());
  points.resize(3 * (strands.point_count() + (phantoms ? 2 * strands.strand_count() : 0)));
  const float* from = strands.points(key).data();
  float* to = points.data();
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    const size_t count = strands.strand_points(s);
    const float* last = from + 4 * (count - 1);
    if (phantoms) add_phantom(from, count > 1 ? from + 4 : from, to);
    for (size_t i = 0; i < count; ++i, from += 4) {
      *to++ = from[0];
      *to++ = from[1];
      *to++ = from[2];
    }
    if (phantoms) add_phantom(last, count > 1 ? last - 4 : last, to);
  }
}

void fill_widths(const Strands& strands, int key, std::vector<float>& widths) {
  widths.resize(strands.point_count());
  const std::span<const float> points = strands.points(key);
  for (size_t i = 0; i < widths.size(); ++i) widths[i] = 2.0f * points[4 * i + 3];
}

/// Letters, digits and underscores only, because a declaration is divided at blanks.
std::string ri_name(const std::string& name) {
  std::string result = name;
  for (char& c : result) {
    const bool good = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!good) c = '_';
  }
  return result;
}

std::string declaration(const StrandAttribute& attribute, CurveBasis basis) {
  std::string text = attribute.frequency == AttributeClass::kConstant    ? "constant "
                     : attribute.frequency == AttributeClass::kPerStrand ? "uniform "
                                                                         : per_point(basis);
  if (attribute.name == "color" && attribute.components == 3) return text + "color Cs";
  if (attribute.name == kRestPositions && attribute.components == 3) return text + "point Pref";
  text += attribute.components == 1 ? "float" : "float[" + std::to_string(attribute.components) + "]";
  return text + " " + ri_name(attribute.name);
}

void fill_ids(const Strands& strands, std::vector<RibParameter>& parameters) {
  RibParameter low{"uniform integer id", {}, {}}, high{"uniform integer id_high", {}, {}};
  low.integers.resize(strands.strand_count());
  bool large = false;
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    low.integers[s] = static_cast<int32_t>(static_cast<uint32_t>(strands.id(s)));
    large |= (strands.id(s) >> 32) != 0;
  }
  parameters.push_back(std::move(low));
  if (!large) return;
  for (size_t s = 0; s < strands.strand_count(); ++s)
    high.integers.push_back(static_cast<int32_t>(static_cast<uint32_t>(strands.id(s) >> 32)));
  parameters.push_back(std::move(high));
}

}  // namespace

void make_rib_curves(const Strands& strands, int key, RibCurves& curves) {
  PELAGE_CHECK(strands.basis() != CurveBasis::kBezier);
  const CurveBasis basis = strands.basis();
  curves.type = basis == CurveBasis::kLinear ? "linear" : "cubic";
  curves.basis = basis == CurveBasis::kLinear       ? nullptr
                 : basis == CurveBasis::kCatmullRom ? "catmull-rom"
                                                    : "b-spline";
  curves.vertices.resize(strands.strand_count());
  for (size_t s = 0; s < curves.vertices.size(); ++s)
    curves.vertices[s] = static_cast<int32_t>(strands.strand_points(s)) + (needs_phantoms(basis) ? 2 : 0);
  curves.parameters.resize(2);
  curves.parameters[0].declaration = "P";
  fill_points(strands, key, curves.parameters[0].numbers);
  curves.parameters[1].declaration = std::string(per_point(basis)) + "float width";
  fill_widths(strands, key, curves.parameters[1].numbers);
  fill_ids(strands, curves.parameters);
  if (!strands.arrays().root_uv.empty()) {
    RibParameter st{"uniform float[2] st", {}, {}};
    st.numbers.reserve(2 * strands.strand_count());
    for (const V2f& uv : strands.arrays().root_uv) {
      st.numbers.push_back(uv.x);
      st.numbers.push_back(uv.y);
    }
    curves.parameters.push_back(std::move(st));
  }
  for (const StrandAttribute& attribute : strands.attributes())
    curves.parameters.push_back({declaration(attribute, basis), attribute.values, {}});
}

void write_curves(RibWriter& rib, const Strands& strands, std::span<const float> times) {
  if (strands.strand_count() == 0) return;
  const int keys = strands.motion_keys();
  RibCurves curves;
  for (int key = 0; key < keys; ++key) {
    make_rib_curves(strands, key, curves);
    if (key == 0) {
      if (curves.basis) rib.request("Basis").text(curves.basis).integer(1).text(curves.basis).integer(1);
      if (keys > 1) rib.request("MotionBegin").numbers(times);
    }
    rib.request("Curves").text(curves.type).integers(curves.vertices).text("nonperiodic");
    for (const RibParameter& parameter : curves.parameters) {
      rib.parameter(parameter.declaration);
      if (parameter.integers.empty()) {
        rib.numbers(parameter.numbers);
      } else {
        rib.integers(parameter.integers);
      }
    }
  }
  if (keys > 1) rib.request("MotionEnd");
}

}  // namespace pelage
