// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_curve_form.h"

namespace pelage {
namespace {

using Basis = CurveForm::Basis;
using Wrap = CurveForm::Wrap;

}  // namespace

std::optional<CurveForm> usd_curve_form(const UsdPrim& prim) {
  const std::string type = prim.token("type", "cubic"), basis = prim.token("basis", "bezier"),
                    wrap = prim.token("wrap", "nonperiodic");
  CurveForm form;
  if (type != "cubic" && type != "linear") return {};
  form.cubic = type == "cubic";
  if (basis == "bspline") {
    form.basis = Basis::kBSpline;
  } else if (basis == "catmullRom") {
    form.basis = Basis::kCatmullRom;
  } else if (basis != "bezier") {
    return {};
  }
  if (wrap == "pinned") {
    form.wrap = Wrap::kPinned;
  } else if (wrap == "periodic") {
    form.wrap = Wrap::kPeriodic;
  } else if (wrap != "nonperiodic") {
    return {};
  }
  // Linear and Bezier curves begin at their first vertex anyway.
  if (form.wrap == Wrap::kPinned && (!form.cubic || form.basis == Basis::kBezier))
    form.wrap = Wrap::kNonperiodic;
  return form;
}

}  // namespace pelage
