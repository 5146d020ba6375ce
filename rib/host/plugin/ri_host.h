// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <span>
#include <string>

#include "base/vector.h"
#include "geom/strands.h"

namespace pelage {

// Types of the C binding of the RenderMan Interface [RISPEC 3.2, C language binding].
using RtInt = int;
using RtFloat = float;
using RtToken = char*;
using RtPointer = void*;
using RtBound = RtFloat[6];
using RtBasis = RtFloat[4][4];
using RtSubdivideFunction = void (*)(RtPointer data, RtFloat detail);
using RtFreeFunction = void (*)(RtPointer data);

/// The functions of the renderer that has loaded the plugin: RiBasis, RiCurvesV, RiMotionBeginV, RiMotionEnd,
/// RiProcedural and, if there is one, RiErrorPrint. Nothing of the renderer is needed to load the plugin.
///
/// Thread safety: all members may be called from any thread, if the renderer allows it for its functions.
class RiHost {
 public:
  /// Finds the functions. Members throw Error (kFailed) if one of the first five is missing.
  RiHost();

  /// Hands strands to the renderer, in a motion block if they have several motion keys. Frees the strands
  /// before it calls the renderer.
  void curves(Strands strands, std::span<const float> times) const;
  /// Hands a procedural to the renderer, which calls `free` once in any case.
  void procedural(RtPointer data, const Box3f& bound, RtSubdivideFunction subdivide,
                  RtFreeFunction free) const;
  /// Reports one line as an error: to RiErrorPrint, or to standard error if the renderer has no such
  /// function.
  void error(const std::string& line) const noexcept;

 private:
  void require() const;

  void (*basis_)(RtBasis, RtInt, RtBasis, RtInt) = nullptr;
  void (*curves_)(RtToken, RtInt, RtInt*, RtToken, RtInt, RtToken*, RtPointer*) = nullptr;
  void (*motion_begin_)(RtInt, RtFloat*) = nullptr;
  void (*motion_end_)() = nullptr;
  void (*procedural_)(RtPointer, RtFloat*, RtSubdivideFunction, RtFreeFunction) = nullptr;
  void (*error_print_)(RtInt, RtInt, RtToken) = nullptr;
  std::string missing_;  // names of missing functions
};

}  // namespace pelage
