// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "geom/alembic/alembic_scene.h"
#include "geom/usd/usd_curve_form.h"

namespace pelage {

/// The first and the third byte of curveBasisAndType.
enum class AlembicCurveType : uint8_t { kCubic, kLinear, kVariableOrder };
enum class AlembicBasis : uint8_t { kNone, kBezier, kBSpline, kCatmullRom, kHermite, kPower };

/// How curves of Alembic are read.
struct AlembicCurveForm {
  UsdCurveForm form;
  /// Whether the first and last vertex of each curve are phantoms, which are not points of ours.
  bool phantom_ends = false;

  /// Returns how many varying values a curve of `n` vertices has in the file, phantoms among them.
  uint32_t varying(uint32_t n) const;
};

/// Returns the form of the curves of an object. B-splines whose knots are all threefold are Bezier curves.
/// Curves with other knots that are not uniform are approximated: by pinned B-splines if any of them has a
/// threefold knot at an end, so passes through its end vertex. `warnings`: receives what is approximated.
/// Empty for curves that cannot be read: those with the bases Hermite and power. Throws Error (kInput) with
/// the path of the object when the type or basis is missing or unknown.
std::optional<AlembicCurveForm> alembic_curve_form(const AlembicNode& node, UsdWarnings& warnings);

}  // namespace pelage
