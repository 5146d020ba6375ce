// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_curve_form.h"

#include <algorithm>

#include <fmt/format.h>

#include "geom/alembic/alembic_curves_file.h"
#include "geom/alembic/alembic_values.h"

namespace pelage {
namespace {

using Basis = UsdCurveForm::Basis;
using Wrap = UsdCurveForm::Wrap;

// The bytes of curveBasisAndType.
enum class AlembicCurveType { kCubic, kLinear, kVariableOrder };
enum class AlembicBasis { kNone, kBezier, kBSpline, kCatmullRom, kHermite, kPower };

bool has_phantom_ends(const AlembicNode& node) {
  const AlembicProperty* user = node.geometry.find(".userProperties");
  if (!user) return false;
  const AlembicCompound properties = node.archive.compound(*user);
  const AlembicProperty* phantoms = properties.find(kAlembicPhantomEnds);
  return phantoms && alembic_first_integer(node.archive, *phantoms) == 1;
}

bool has_clamped_knots(const AlembicNode& node) {
  const AlembicProperty* knots = node.geometry.find(".knots");
  if (!knots) return false;
  const std::vector<float> values = alembic_floats(node.archive, *knots);
  return values.size() >= 6 && values[0] == values[1] && values[1] == values[2];
}

/// Returns the common order of curves of variable order; 0 if they differ.
int64_t common_order(const AlembicNode& node) {
  const AlembicProperty* stated = node.geometry.find(".orders");
  if (!stated || !alembic_is_integer(*stated)) return 0;
  const std::vector<int64_t> orders = alembic_integers(node.archive, *stated);
  if (orders.empty()) return 0;
  const bool same = std::all_of(orders.begin(), orders.end(), [&](int64_t o) { return o == orders[0]; });
  return same ? orders[0] : 0;
}

}  // namespace

uint32_t AlembicCurveForm::varying(uint32_t n) const {
  UsdCurveForm in_file = form;
  if (phantom_ends) in_file.wrap = Wrap::kNonperiodic;
  return in_file.varying(n);
}

std::optional<AlembicCurveForm> alembic_curve_form(const AlembicNode& node, UsdWarnings& warnings) {
  const AlembicProperty* stated = node.geometry.find("curveBasisAndType");
  std::vector<int64_t> bytes;
  if (stated && alembic_is_integer(*stated) && alembic_count(node.archive, *stated) <= 4) bytes = alembic_integers(node.archive, *stated);
  if (bytes.size() < 3) node.fail("the curves have no type and basis (curveBasisAndType)");
  if (bytes[0] < 0 || bytes[0] > 2 || bytes[1] < 0 || bytes[1] > 1 || bytes[2] < 0 || bytes[2] > 5) {
    node.fail(fmt::format("unknown curves: type {}, wrap {}, basis {}", bytes[0], bytes[1], bytes[2]));
  }
  const SourcePosition place{node.archive.file().path().string(), 0, 0};
  AlembicCurveForm result;
  UsdCurveForm& form = result.form;
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
    if (form.wrap == Wrap::kNonperiodic && has_clamped_knots(node)) form.wrap = Wrap::kPinned;
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
