// SPDX-License-Identifier: Apache-2.0
#include "geom/interchange/primvar.h"

#include <cstdint>

namespace pelage {

size_t PrimvarCounts::of(std::string_view interpolation) const {
  if (interpolation == "constant") return 1;
  if (interpolation == "uniform") return uniform;
  if (interpolation == "varying") return varying;
  if (interpolation == "vertex") return vertex;
  if (interpolation == "faceVarying") return face_varying;
  return SIZE_MAX;
}

const char* PrimvarCounts::interpolation_of(size_t count) const {
  for (const char* interpolation : {"vertex", "varying", "uniform", "constant", "faceVarying"}) {
    if (of(interpolation) == count) return interpolation;
  }
  return nullptr;
}

}  // namespace pelage
