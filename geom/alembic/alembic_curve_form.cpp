// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_curve_form.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geom/alembic/alembic_curves_file.h"
#include "geom/alembic/alembic_values.h"

namespace pelage {
namespace {

using Basis = CurveForm::Basis;
using Wrap = CurveForm::Wrap;

bool has_phantom_ends(const AlembicNode& node) {
  const AlembicProperty* user = node.geometry.find(".userProperties");
  if (!user) return false;
  const AlembicCompound properties = node.archive.compound(*user);
  const AlembicProperty* phantoms = properties.find(kAlembicPhantomEnds);
  return phantoms && alembic_first_integer(node.archive, *phantoms) == 1;
}

/// Kinds of knot vectors of a cubic B-spline.
enum class KnotKind { kUniform, kBezier, kClamped, kOther };

/// `t`: the knots without the first and the last one, on which no point of the curve depends.
KnotKind knot_kind(std::span<const float> t) {
  bool uniform = true, triples = t.size() % 3 == 0;
  for (size_t i = 1; i < t.size(); ++i) {
    // Programs compute knots in single precision.
    constexpr float kSame = 1e-4f;
    uniform &= t[i] > t[i - 1] && std::abs(t[i] - t[i - 1] - (t[1] - t[0])) <= kSame * (t[1] - t[0]);
    triples &= i % 3 == 0 || t[i] == t[i - 1];
  }
  if (uniform) return KnotKind::kUniform;
  if (triples) return KnotKind::kBezier;  // Bezier segments that share their ends
  const size_t n = t.size();
  return t[0] == t[2] || t[n - 3] == t[n - 1] ? KnotKind::kClamped : KnotKind::kOther;
}

/// Sets the basis and wrap that the knots of the curves imply. If curves differ, or their knots are not
/// uniform, chooses the nearest form and adds a warning.
void apply_knots(const AlembicNode& node, CurveForm& form, ReadWarnings& warnings) {
  const AlembicProperty *knots = node.geometry.find(".knots"), *counts = node.geometry.find("nVertices"),
                        *points = node.geometry.find("P");
  const size_t stated = knots ? alembic_count(node.archive, *knots) : 0;
  if (stated == 0 || !counts || !points || !alembic_is_integer(*counts)) return;
  const SourcePosition place{node.archive.file().path().string(), 0, 0};
  const size_t curves = alembic_count(node.archive, *counts),
               vertices = alembic_count(node.archive, *points) / 3;
  // Some programs leave the first and last knot out.
  const bool all = stated == vertices + 4 * curves;
  if (!all && stated != vertices + 2 * curves)
    return warnings.add("knots that do not fit the points of the curves are ignored", place);
  const std::vector<float> values = alembic_floats(node.archive, *knots);
  size_t found[4] = {0, 0, 0, 0}, next = 0;
  for (const int64_t n : alembic_integers(node.archive, *counts)) {
    const size_t size = static_cast<size_t>(std::clamp<int64_t>(n, 0, UINT32_MAX)) + (all ? 4 : 2);
    if (size > values.size() - next) return;  // counts that the reader refuses
    const std::span<const float> own = std::span(values).subspan(next, size);
    if (n >= 4) ++found[static_cast<size_t>(knot_kind(all ? own.subspan(1, size - 2) : own))];
    next += size;
  }
  const auto [uniform, bezier, clamped, other] = found;
  if (bezier > 0 && uniform + clamped + other == 0) {
    form.basis = Basis::kBezier;
    return;
  }
  if (bezier + clamped + other == 0) return;
  if (bezier + clamped > 0) form.wrap = Wrap::kPinned;
  warnings.add("curves with knots that are not uniform are approximated by uniform B-splines", place);
}

/// Returns the common order of curves of variable order; 0 if they differ.
int64_t common_order(const AlembicNode& node) {
  const AlembicProperty *stated = node.geometry.find(".orders"), *counts = node.geometry.find("nVertices");
  if (!stated || !counts || !alembic_is_integer(*stated)) return 0;
  if (alembic_count(node.archive, *stated) > alembic_count(node.archive, *counts)) return 0;
  const std::vector<int64_t> orders = alembic_integers(node.archive, *stated);
  if (orders.empty()) return 0;
  const bool same = std::all_of(orders.begin(), orders.end(), [&](int64_t o) { return o == orders[0]; });
  return same ? orders[0] : 0;
}

}  // namespace

uint32_t AlembicCurveForm::varying(uint32_t n) const {
  CurveForm in_file = form;
  if (phantom_ends) in_file.wrap = Wrap::kNonperiodic;
  return in_file.varying(n);
}

std::optional<AlembicCurveForm> alembic_curve_form(const AlembicNode& node, ReadWarnings& warnings) {
  const AlembicProperty* stated = node.geometry.find("curveBasisAndType");
  std::vector<int64_t> bytes;
  if (stated && alembic_is_integer(*stated) && alembic_count(node.archive, *stated) <= 4)
    bytes = alembic_integers(node.archive, *stated);
  if (bytes.size() < 3) node.fail("the curves have no type and basis (curveBasisAndType)");
  if (bytes[0] < 0 || bytes[0] > 2 || bytes[1] < 0 || bytes[1] > 1 || bytes[2] < 0 || bytes[2] > 5) {
    node.fail(fmt::format("unknown curves: type {}, wrap {}, basis {}", bytes[0], bytes[1], bytes[2]));
  }
  const SourcePosition place{node.archive.file().path().string(), 0, 0};
  AlembicCurveForm result;
  CurveForm& form = result.form;
  form.cubic = bytes[0] != static_cast<int64_t>(AlembicCurveType::kLinear);
  form.wrap = bytes[1] == 1 ? Wrap::kPeriodic : Wrap::kNonperiodic;
  auto basis = static_cast<AlembicBasis>(bytes[2]);
  if (bytes[0] == static_cast<int64_t>(AlembicCurveType::kVariableOrder)) {
    form.cubic = common_order(node) == 4;
    basis = AlembicBasis::kBSpline;
    if (!form.cubic && common_order(node) != 2)
      warnings.add("curves of other orders than 2 and 4 are read as linear", place);
  }
  if (!form.cubic) return result;
  if (basis == AlembicBasis::kBSpline) {
    form.basis = Basis::kBSpline;
    if (form.wrap == Wrap::kNonperiodic) apply_knots(node, form, warnings);
  } else if (basis == AlembicBasis::kCatmullRom) {
    form.basis = Basis::kCatmullRom;
  } else if (basis == AlembicBasis::kNone) {
    form.cubic = false;
    warnings.add("curves without a basis are read as linear", place);
  } else if (basis != AlembicBasis::kBezier) {
    warnings.add("curves with the bases Hermite and power are skipped", place);
    return {};
  }
  if (form.cubic && form.basis != Basis::kBezier && form.wrap == Wrap::kNonperiodic &&
      has_phantom_ends(node)) {
    form.wrap = Wrap::kPinned;
    result.phantom_ends = true;
  }
  return result;
}

}  // namespace pelage
