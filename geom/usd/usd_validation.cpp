// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_validation.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/visible_text.h"
#include "geom/usd/usd_curve_form.h"
#include "geom/usd/usd_primvar.h"
#include "geom/usd/usd_values.h"

namespace pelage {
namespace {

/// Extents are written with fewer digits than points by some programs.
constexpr float kExtentSlack = 1e-4f;

/// All samples of an attribute: those with times, or else the default value at time NaN.
std::vector<std::pair<double, UsdText>> all_samples(const UsdValue& value) {
  std::vector<std::pair<double, UsdText>> samples;
  for (const auto& [time, text] : value.attribute->times) {
    if (!text.empty()) samples.emplace_back(time, text);
  }
  if (samples.empty()) samples.emplace_back(std::nan(""), value.text);
  return samples;
}

std::string at_time(double time) { return std::isnan(time) ? "" : fmt::format(" at time {}", time); }

class CurvesValidator {
 public:
  CurvesValidator(const UsdPrim& prim, ValidationReport& findings) : prim_(prim), findings_(findings) {}

  void check() {
    ++findings_.curves;
    const std::optional<CurveForm> form = usd_curve_form(prim_);
    if (!form) return problem("type, basis or wrap is unknown");
    const std::optional<UsdValue> counts = prim_.find("curveVertexCounts"), points = prim_.find("points");
    if (!counts || !points) return problem("it has no curveVertexCounts or no points");
    check_counts(*counts, *form);
    check_points(*points);
    check_widths();
    check_extents();
    if (!prim_.find("primvars:st")) remark("the roots have no texture coordinates (uniform primvars:st)");
    if (!prim_.find("primvars:ids") && !prim_.find("ids") && !prim_.find("primvars:id"))
      remark("the strands have no ids (uniform primvars:ids)");
  }

 private:
  std::string line(const std::string& text) const {
    return visible(to_string(prim_.position()) + ": <" + prim_.path + ">: " + text);
  }
  void problem(const std::string& text) { findings_.problems.push_back(line(text)); }
  void remark(const std::string& text) { findings_.remarks.push_back(line(text)); }

  void check_counts(const UsdValue& counts, const CurveForm& form) {
    size_t few = 0, one = 0;
    for (const int64_t n : usd_integers(*counts.layer, counts.text)) {
      const auto count = static_cast<uint32_t>(std::clamp<int64_t>(n, 0, UINT32_MAX));
      one += count == 1;
      few += form.segments(count) == 0;
      vertices_ += count;
      varying_ += form.varying(count);
      ++curves_;
    }
    findings_.strands += curves_;
    if (one > 0) problem(fmt::format("{} strands have one point", one));
    if (few > one) problem(fmt::format("{} strands have too few points for their basis", few - one));
    if (counts.attribute->times.size() > 1) {
      const std::vector<int64_t> first = usd_integers(*counts.layer, counts.text);
      for (const auto& [time, text] : all_samples(counts)) {
        if (usd_integers(*counts.layer, text) == first) continue;
        problem(fmt::format("curveVertexCounts change{}", at_time(time)));
        break;
      }
    }
  }

  void check_points(const UsdValue& points) {
    findings_.points += vertices_;
    for (const auto& [time, text] : all_samples(points)) {
      const std::vector<float> numbers = usd_floats(*points.layer, text, 3);
      if (numbers.size() != 3 * vertices_) {
        problem(fmt::format("there are {} points{}, but curveVertexCounts add up to {}", numbers.size() / 3,
                            at_time(time), vertices_));
      }
      const auto bad =
          std::count_if(numbers.begin(), numbers.end(), [](float x) { return !std::isfinite(x); });
      if (bad > 0) problem(fmt::format("{} coordinates of points are not finite{}", bad, at_time(time)));
      Box3f box;
      for (size_t i = 0; i + 2 < numbers.size(); i += 3) {
        const V3f p(numbers[i], numbers[i + 1], numbers[i + 2]);
        if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) box.extendBy(p);
      }
      boxes_[key(time)] = box;
    }
  }

  void check_widths() {
    const std::string name = prim_.find("primvars:widths") ? "primvars:widths" : "widths";
    const std::optional<UsdValue> value = prim_.find(name);
    if (!value) return problem("it has no widths; hosts choose their own, often 1");
    if (prim_.interpolation(name).empty()) remark("the interpolation of the widths is not stated");
    for (const auto& [time, text] : all_samples(*value))
      check_widths(usd_floats(*value->layer, text, 1), at_time(time));
  }

  void check_widths(const std::vector<float>& widths, const std::string& when) {
    const size_t count = widths.size();
    if (count != 1 && count != curves_ && count != varying_ && count != vertices_) {
      problem(fmt::format("it has {} widths{}; {} curves have {} vertices and {} varying values", count, when,
                          curves_, vertices_, varying_));
    }
    const auto bad =
        std::count_if(widths.begin(), widths.end(), [](float w) { return !(w >= 0) || std::isinf(w); });
    if (bad > 0) problem(fmt::format("{} widths are negative or not finite{}", bad, when));
    const bool thin = std::all_of(widths.begin(), widths.end(), [](float w) { return w == 0; });
    if (thin) problem("all widths are 0" + when);
    for (const float w : widths) {
      if (std::isfinite(w)) widest_ = std::max(widest_, w);
    }
  }

  void check_extents() {
    const std::optional<UsdValue> value = prim_.find("extent");
    if (!value) return problem("it has no extent; viewers compute it, or do not draw the strands");
    for (const auto& [time, text] : all_samples(*value)) {
      const std::vector<float> e = usd_floats(*value->layer, text, 3);
      if (e.size() != 6) {
        problem("the extent is not two points");
        return;
      }
      // An extent without a time is for all times.
      Box3f box;
      for (const auto& [at, samples] : boxes_) {
        if (std::isnan(time) || at == key(time)) box.extendBy(samples);
      }
      if (box.isEmpty()) continue;
      const float slack = kExtentSlack * box.size().length();
      for (int axis = 0; axis < 3; ++axis) {
        const float least = box.min[axis] - 0.5f * widest_, most = box.max[axis] + 0.5f * widest_;
        if (e[static_cast<size_t>(axis)] <= least + slack && e[static_cast<size_t>(3 + axis)] >= most - slack)
          continue;
        return problem(
            fmt::format("the extent is smaller than the strands with half their width{}", at_time(time)));
      }
    }
    if (!value->attribute->times.empty() && value->attribute->times.size() < boxes_.size())
      problem("the extent has fewer time samples than the points");
  }

  /// Times as keys of a map; the default value is first.
  static double key(double time) { return std::isnan(time) ? -1e300 : time; }

  const UsdPrim& prim_;
  ValidationReport& findings_;
  size_t vertices_ = 0, varying_ = 0, curves_ = 0;
  float widest_ = 0;
  std::map<double, Box3f> boxes_;
};

}  // namespace

ValidationReport validate_usd(const std::filesystem::path& path) {
  ValidationReport findings;
  ReadWarnings warnings;
  UsdStage stage(path, warnings);
  stage.visit([&](const UsdPrim& prim) {
    findings.meshes += prim.type == "Mesh";
    if (prim.type == "BasisCurves") CurvesValidator(prim, findings).check();
  });
  if (findings.curves == 0) findings.problems.push_back(visible(path.string()) + ": has no curves");
  for (const std::string& line : warnings.lines()) findings.remarks.push_back(line);
  return findings;
}

}  // namespace pelage
