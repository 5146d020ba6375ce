// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "geom/interchange/primvar.h"
#include "geom/usd/usd_stage.h"

namespace pelage {

/// Reads an attribute or primvar of numbers. Returns nothing if it has no value or is not of numbers, or,
/// with a warning, if its elements have more than kMaxPrimvarComponents numbers. If no interpolation is
/// stated, or the stated one does not fit the number of values (a warning), uses the one that fits. Throws
/// Error (kInput) with the place of the attribute if none fits, or if an index is out of range.
std::optional<Primvar> usd_primvar(const UsdPrim& prim, const std::string& attribute,
                                   const std::string& usual_interpolation, const PrimvarCounts& counts,
                                   ReadWarnings& warnings);

}  // namespace pelage
