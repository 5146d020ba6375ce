// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "geom/interchange/curve_form.h"
#include "geom/usd/usd_stage.h"

namespace pelage {

/// Returns the form that the type, basis and wrap of a BasisCurves prim name, or the defaults of USD. Returns
/// nothing if one of these tokens is unknown.
std::optional<CurveForm> usd_curve_form(const UsdPrim& prim);

}  // namespace pelage
