// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_validation.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "base/visible_text.h"
#include "geom/alembic/alembic_curve_form.h"
#include "geom/alembic/alembic_param.h"
#include "geom/alembic/alembic_values.h"

namespace pelage {
namespace {

/// Fraction of the diagonal of a box by which it may be too small. Programs that compute bounds in single
/// precision round coordinates by 2^-24 of their size, which may be a thousand times that of the strands.
constexpr double kBoundsSlack = 1e-4;

/// Numbers are checked as long as they have no more bytes than 64 times the file: objects and samples may
/// share them, as libraries write equal arrays once, but checks must end.
constexpr uint64_t kMaxCheckedFiles = 64;
constexpr size_t kMaxFindings = 1000;

class AlembicCurvesValidator {
 public:
  AlembicCurvesValidator(const AlembicNode& node, ReadWarnings& warnings, ValidationReport& findings,
                         uint64_t& bytes_left)
      : node_(node), warnings_(warnings), findings_(findings), bytes_left_(bytes_left) {}

  void check() {
    ++findings_.curves;
    if (findings_.problems.size() + findings_.remarks.size() > kMaxFindings) return skip_rest();
    const uint64_t needed = first_sample_bytes();
    if (needed > bytes_left_) return skip_rest();
    bytes_left_ -= needed;
    const std::optional<AlembicCurveForm> form = alembic_curve_form(node_, warnings_);
    if (!form) return problem("its basis is not supported");
    const AlembicProperty *counts = node_.geometry.find("nVertices"), *points = node_.geometry.find("P");
    if (!counts || !points || counts->stored == 0 || points->stored == 0)
      return problem("it has no nVertices or no P");
    check_counts(*counts, *form);
    check_points(*points);
    const AlembicProperty* arbitrary = node_.geometry.find(".arbGeomParams");
    const AlembicCompound params = arbitrary ? node_.archive.compound(*arbitrary) : AlembicCompound();
    const AlembicProperty* width = node_.geometry.find("width");
    check_widths(width ? width : params.find("groom_width"));
    check_bounds();
    if (!node_.geometry.find("uv") && !params.find("groom_root_uv"))
      remark("the roots have no texture coordinates (groom_root_uv or uv)");
    if (!params.find("groom_id") && !params.find("ids") && !params.find("id"))
      remark("the strands have no ids (groom_id)");
  }

 private:
  void skip_rest() {
    warnings_.add("curves beyond the first ones are not checked",
                  {node_.archive.file().path().string(), 0, 0});
  }
  /// Bytes of the numbers that are checked even if they are shared.
  uint64_t first_sample_bytes() const {
    uint64_t bytes = 0;
    for (const AlembicProperty& property : node_.geometry.properties)
      bytes += alembic_param_bytes(node_.archive, property);
    const AlembicProperty* arbitrary = node_.geometry.find(".arbGeomParams");
    const AlembicCompound params = arbitrary ? node_.archive.compound(*arbitrary) : AlembicCompound();
    if (const AlembicProperty* width = params.find("groom_width"))
      bytes += alembic_param_bytes(node_.archive, *width);
    return bytes;
  }
  /// Whether a sample is to be read: the first one, or one whose block no earlier sample has. `known`: the
  /// positions of the blocks of earlier samples.
  bool is_new(const AlembicProperty& property, uint32_t sample, std::set<uint64_t>& known) {
    const OgawaBlock block = node_.archive.sample(property, sample);
    if (!known.insert(block.position).second || sample == 0) return sample == 0;
    if (block.size > bytes_left_) {
      skip_rest();
      return false;
    }
    bytes_left_ -= block.size;
    return true;
  }

  std::string line(const std::string& text) const {
    return visible(node_.archive.file().path().string() + ": <" + node_.path + ">: " + text);
  }
  void problem(const std::string& text) { findings_.problems.push_back(line(text)); }
  void remark(const std::string& text) { findings_.remarks.push_back(line(text)); }

  void check_counts(const AlembicProperty& counts, const AlembicCurveForm& form) {
    size_t few = 0, one = 0;
    const std::vector<int64_t> first = alembic_integers(node_.archive, counts);
    for (const int64_t n : first) {
      const auto count = static_cast<uint32_t>(std::clamp<int64_t>(n, 0, UINT32_MAX));
      const uint32_t own = form.phantom_ends ? std::max(count, 2u) - 2 : count;
      one += own == 1;
      few += form.form.segments(own) == 0;
      findings_.points += own;
      sizes_.vertex += count;
      sizes_.varying += form.varying(count);
      ++sizes_.uniform;
    }
    sizes_.face_varying = sizes_.varying;
    findings_.strands += sizes_.uniform;
    if (one > 0) problem(fmt::format("{} strands have one point", one));
    if (few > one) problem(fmt::format("{} strands have too few points for their basis", few - one));
    std::set<uint64_t> known{node_.archive.sample(counts).position};
    for (uint32_t sample = 1; sample < counts.stored; ++sample) {
      if (!is_new(counts, sample, known)) continue;
      if (alembic_integers(node_.archive, counts, sample) == first) continue;
      counts_change_ = true;
      return problem(fmt::format("nVertices change at sample {}", sample));
    }
  }

  void check_points(const AlembicProperty& points) {
    if (points.extent != 3) return problem(fmt::format("its points have {} coordinates", points.extent));
    std::set<uint64_t> known;
    for (uint32_t sample = 0; sample < points.stored; ++sample) {
      if (!is_new(points, sample, known)) continue;
      const std::vector<float> numbers = alembic_floats(node_.archive, points, sample);
      const std::string when = sample > 0 ? fmt::format(" at sample {}", sample) : "";
      if (numbers.size() != 3 * sizes_.vertex && !(sample > 0 && counts_change_)) {
        problem(fmt::format("there are {} points{}, but nVertices add up to {}", numbers.size() / 3, when,
                            sizes_.vertex));
      }
      const auto bad =
          std::count_if(numbers.begin(), numbers.end(), [](float x) { return !std::isfinite(x); });
      if (bad > 0) problem(fmt::format("{} coordinates of points are not finite{}", bad, when));
      for (size_t i = 0; sample == 0 && i + 2 < numbers.size(); i += 3) {
        const V3f p(numbers[i], numbers[i + 1], numbers[i + 2]);
        if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) box_.extendBy(p);
      }
    }
  }

  void check_widths(const AlembicProperty* property) {
    std::optional<Primvar> widths;
    try {
      if (property) widths = alembic_param(node_, *property, sizes_, warnings_, true);
    } catch (const Error& error) {
      return findings_.problems.push_back(error.what());
    }
    if (!widths) return problem("it has no widths; programs choose their own, often 1");
    const auto bad = std::count_if(widths->values.begin(), widths->values.end(),
                                   [](float w) { return !(w >= 0) || std::isinf(w); });
    if (bad > 0) problem(fmt::format("{} widths are negative or not finite", bad));
    if (std::all_of(widths->values.begin(), widths->values.end(), [](float w) { return w == 0; }))
      problem("all widths are 0");
  }

  void check_bounds() {
    const AlembicProperty* property = node_.geometry.find(".selfBnds");
    if (!property) return problem("it has no bounds (.selfBnds), which programs need");
    const std::vector<double> b = alembic_doubles(node_.archive, *property);
    if (b.size() != 6) return problem("its bounds (.selfBnds) are not two points");
    if (box_.isEmpty()) return;
    const double slack = kBoundsSlack * box_.size().length();
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<size_t>(axis);
      if (b[i] <= box_.min[axis] + slack && b[i + 3] >= box_.max[axis] - slack) continue;
      return problem("its bounds (.selfBnds) are smaller than the strands");
    }
  }

  const AlembicNode& node_;
  ReadWarnings& warnings_;
  ValidationReport& findings_;
  uint64_t& bytes_left_;
  PrimvarCounts sizes_;
  Box3f box_;  // of the points at the earliest sample
  bool counts_change_ = false;
};

}  // namespace

ValidationReport validate_alembic(const std::filesystem::path& path) {
  ValidationReport findings;
  ReadWarnings warnings;
  AlembicScene scene(path, warnings);
  uint64_t bytes_left = kMaxCheckedFiles * scene.archive().file().size();
  scene.visit([&](const AlembicNode& node) {
    findings.meshes += node.is_mesh();
    if (node.is_curves()) AlembicCurvesValidator(node, warnings, findings, bytes_left).check();
  });
  if (findings.curves == 0) findings.problems.push_back(visible(path.string()) + ": has no curves");
  for (const std::string& line : warnings.lines()) findings.remarks.push_back(line);
  return findings;
}

}  // namespace pelage
