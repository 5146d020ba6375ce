// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geom/usd/usd_stage.h"

namespace pelage {

/// The elements of a primvar, with its indices applied.
struct UsdPrimvar {
  std::string interpolation;  ///< constant, uniform, varying, vertex or faceVarying
  size_t components = 1;      ///< of an element, with elementSize
  std::vector<float> values;
  size_t count() const { return values.size() / components; }
};

/// How many elements a primvar has under each interpolation.
struct UsdPrimvarCounts {
  size_t uniform = 0, varying = 0, vertex = 0, face_varying = 0;
};

/// Reads an attribute or primvar of numbers; empty if it has no value, is not of numbers,
/// or has elements of more than 16 numbers, which gives a warning. Without a stated
/// interpolation, or with one that does not fit its size, the interpolation is the one that fits; a warning
/// tells the second case. Throws Error (kInput) with the place of the attribute if no interpolation fits, or
/// if an index is out of range.
std::optional<UsdPrimvar> usd_primvar(const UsdPrim& prim, const std::string& attribute,
                                      const std::string& usual_interpolation, const UsdPrimvarCounts& counts,
                                      UsdWarnings& warnings);

}  // namespace pelage
