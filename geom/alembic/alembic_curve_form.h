// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "geom/alembic/alembic_scene.h"
#include "geom/interchange/curve_form.h"

namespace pelage {

/// The first and the third byte of curveBasisAndType.
enum class AlembicCurveType : uint8_t { kCubic, kLinear, kVariableOrder };
enum class AlembicBasis : uint8_t { kNone, kBezier, kBSpline, kCatmullRom, kHermite, kPower };

/// How curves of Alembic are read.
struct AlembicCurveForm {
  CurveForm form;
  /// Whether the first and last vertex of each curve are phantom vertices, which become no points.
  bool phantom_ends = false;

  /// Returns how many varying values a curve of `n` vertices has in the file, phantoms among them.
  uint32_t varying(uint32_t n) const;
};

/// Returns the form of the curves of an object. If every knot of every B-spline has multiplicity 3, the
/// curves are Bezier curves. Other B-splines with non-uniform knots become uniform ones, with a warning. They
/// are pinned if the first or last knots of any curve have multiplicity 3, because that curve interpolates
/// its end vertex. Returns nothing, with a warning, for the bases Hermite and power, which cannot be read.
/// Throws Error (kInput) with the path of the object when the type or basis is missing or unknown.
std::optional<AlembicCurveForm> alembic_curve_form(const AlembicNode& node, ReadWarnings& warnings);

}  // namespace pelage
