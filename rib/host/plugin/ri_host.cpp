// SPDX-License-Identifier: Apache-2.0
#include "rib/host/plugin/ri_host.h"

#include <cstdio>
#include <cstring>

#include "base/error.h"
#include "base/module.h"
#include "rib/syntax/rib_curves.h"

namespace pelage {
namespace {

constexpr RtInt kSystemError = 2, kSevere = 2;  // RIE_SYSTEM, RIE_ERROR

// Rows are powers of the parameter, from the cube to the constant; columns are points.
constexpr RtBasis kBSpline = {{-1.0f / 6, 3.0f / 6, -3.0f / 6, 1.0f / 6},
                              {3.0f / 6, -6.0f / 6, 3.0f / 6, 0},
                              {-3.0f / 6, 0, 3.0f / 6, 0},
                              {1.0f / 6, 4.0f / 6, 1.0f / 6, 0}};
constexpr RtBasis kCatmullRom = {
    {-0.5f, 1.5f, -1.5f, 0.5f}, {1, -2.5f, 2, -0.5f}, {-0.5f, 0, 0.5f, 0}, {0, 1, 0, 0}};

template <class Function>
void find(const char* name, Function& function, std::string* missing) {
  function = reinterpret_cast<Function>(program_symbol(name));
  if (!function && missing) *missing += (missing->empty() ? "" : ", ") + std::string(name);
}

RtToken token(const char* text) { return const_cast<RtToken>(text); }

}  // namespace

RiHost::RiHost() {
  find("RiBasis", basis_, &missing_);
  find("RiCurvesV", curves_, &missing_);
  find("RiMotionBeginV", motion_begin_, &missing_);
  find("RiMotionEnd", motion_end_, &missing_);
  find("RiProcedural", procedural_, &missing_);
  find("RiErrorPrint", error_print_, nullptr);
}

void RiHost::require() const {
  if (!missing_.empty())
    throw Error(ErrorKind::kFailed, "the renderer has no function " + missing_ + "; no hair is made");
}

void RiHost::curves(Strands strands, std::span<const float> times) const {
  require();
  if (strands.strand_count() == 0) return;
  const int keys = strands.motion_keys();
  std::vector<RibCurves> curves(static_cast<size_t>(keys));
  for (int key = 0; key < keys; ++key) make_rib_curves(strands, key, curves[static_cast<size_t>(key)]);
  strands = {};  // the renderer makes its own copy, so one copy of the points less
  if (curves[0].basis) {
    RtBasis basis;
    std::memcpy(basis, std::strcmp(curves[0].basis, "b-spline") == 0 ? kBSpline : kCatmullRom, sizeof(basis));
    basis_(basis, 1, basis, 1);
  }
  if (keys > 1) {
    std::vector<RtFloat> copy(times.begin(), times.end());
    motion_begin_(keys, copy.data());
  }
  for (RibCurves& one : curves) {
    std::vector<RtToken> tokens;
    std::vector<RtPointer> values;
    for (RibParameter& parameter : one.parameters) {
      tokens.push_back(parameter.declaration.data());
      values.push_back(parameter.integers.empty() ? static_cast<RtPointer>(parameter.numbers.data())
                                                  : static_cast<RtPointer>(parameter.integers.data()));
    }
    curves_(token(one.type), static_cast<RtInt>(one.vertices.size()), one.vertices.data(),
            token("nonperiodic"), static_cast<RtInt>(tokens.size()), tokens.data(), values.data());
    one = {};
  }
  if (keys > 1) motion_end_();
}

void RiHost::procedural(RtPointer data, const Box3f& box, RtSubdivideFunction subdivide,
                        RtFreeFunction free) const {
  if (!missing_.empty()) free(data);
  require();
  RtBound bound = {box.min.x, box.max.x, box.min.y, box.max.y, box.min.z, box.max.z};
  procedural_(data, bound, subdivide, free);
}

void RiHost::error(const std::string& line) const noexcept {
  if (error_print_) {
    error_print_(kSystemError, kSevere, const_cast<RtToken>(line.c_str()));
  } else {
    std::fprintf(stderr, "%s\n", line.c_str());
  }
}

}  // namespace pelage
