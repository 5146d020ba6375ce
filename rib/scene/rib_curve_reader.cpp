// SPDX-License-Identifier: Apache-2.0
#include "rib/scene/rib_curve_reader.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "rib/syntax/rib_curve_layout.h"

namespace pelage {
namespace {

// kAsGiven: every point is kept, and periodic curves repeat their first points. kPinned: without the first
// and the last point, which are phantom points. kResampled: new points. In each form, curves without segments
// give no strands.
enum class Form { kAsGiven, kPinned, kResampled };

std::string wrong_size(const RibNamedValue& p, const RibCurveLayout& layout) {
  const size_t needed =
      layout.values(p.declaration.frequency) * static_cast<size_t>(p.declaration.components);
  if (p.value->size() == needed) return {};
  return fmt::format("parameter {} needs {} numbers for these curves, got {}", quote(p.name), needed,
                     p.value->size());
}

void check_size(const RibStatement& request, const RibNamedValue& p, const RibCurveLayout& layout) {
  if (const std::string why = wrong_size(p, layout); !why.empty()) request.fail(*p.value, why);
}

/// Corrects the class of a parameter whose count of values fits another class only. Exporters often declare
/// values per point as "varying", and values per curve as "constant".
void correct_class(RibNamedValue& p, const RibCurveLayout& layout) {
  if (wrong_size(p, layout).empty()) return;
  const RibClass stated = p.declaration.frequency;
  for (const RibClass other : {RibClass::kVertex, RibClass::kVarying, RibClass::kUniform}) {
    p.declaration.frequency = other;
    if (wrong_size(p, layout).empty()) return;
  }
  p.declaration.frequency = stated;
}

std::span<const float> positions(const RibStatement& request, const std::vector<RibNamedValue>& parameters,
                                 const RibCurveLayout& layout) {
  const RibNamedValue* p = find_parameter(parameters, "P");
  if (!p) request.fail("parameter \"P\" is missing");
  if (p->declaration.components != 3 || p->value->kind != RibOperand::Kind::kFloats)
    request.fail(*p->value, "parameter \"P\" must be an array of points");
  const size_t needed = 3 * layout.total_points;
  if (p->value->size() != needed)
    request.fail(*p->value, fmt::format("parameter 'P' needs {} numbers for these curves, got {}", needed,
                                        p->value->size()));
  return p->value->floats;
}

bool is_phantom(const float* phantom, const float* end, const float* next) {
  for (int axis = 0; axis < 3; ++axis) {
    if (phantom[axis] != 2.0f * end[axis] - next[axis]) return false;
  }
  return true;
}

bool has_phantoms(const RibCurveLayout& layout, std::span<const float> p) {
  for (size_t c = 0; c < layout.points.size(); ++c) {
    const uint32_t points = layout.points[c];
    const float *first = p.data(), *last = p.data() + 3 * (std::max(points, 1u) - 1);
    if (layout.segments[c] > 0 &&
        (!is_phantom(first, first + 3, first + 6) || !is_phantom(last, last - 3, last - 6)))
      return false;
    p = p.subspan(size_t(3) * points);
  }
  return true;
}

Form form_of(const RibCurveLayout& layout, const std::vector<std::span<const float>>& keys) {
  if (!layout.cubic || layout.pinned) return Form::kAsGiven;
  using Kind = RibBasis::Kind;
  const bool spline = layout.basis.kind == Kind::kBSpline, rom = layout.basis.kind == Kind::kCatmullRom;
  if (layout.basis.step != 1 || (!spline && !rom)) return Form::kResampled;
  const bool pinned = !layout.periodic && std::all_of(keys.begin(), keys.end(), [&](const auto& key) {
    return has_phantoms(layout, key);
  });
  return pinned ? Form::kPinned : spline ? Form::kAsGiven : Form::kResampled;
}

/// Converts one request.
class CurveReader {
 public:
  CurveReader(std::span<RibStatement> samples, const RibDeclarations& declarations, const RibBasis& basis)
      : request_(samples.front()), layout_(read_curve_layout(request_, basis)) {
    parameters_ = declarations.parameters(request_, 3, out_.undeclared);
    project_points(request_, parameters_);
    out_.unusable = layout_.unusable;
    for (RibNamedValue& p : parameters_) {
      if (p.declaration.frequency == RibClass::kVarying && !wrong_size(p, layout_).empty())
        layout_.fit_stray_joints(p.value->size() / static_cast<size_t>(p.declaration.components));
      correct_class(p, layout_);
    }
    all_.push_back(parameters_);
    for (RibStatement& sample : samples.subspan(1)) {
      if (read_curve_layout(sample, basis).points != layout_.points)
        sample.fail("the curves of a motion block must have the same numbers of points");
      std::vector<std::string> ignored;
      all_.push_back(declarations.parameters(sample, 3, ignored));
      project_points(sample, all_.back());
    }
    for (std::vector<RibNamedValue>& key : std::span(all_).subspan(1)) {
      for (RibNamedValue& p : key) correct_class(p, layout_);
    }
    for (size_t k = 0; k < samples.size(); ++k) keys_.push_back(positions(samples[k], all_[k], layout_));
    form_ = form_of(layout_, keys_);
  }

  RibCurveSet read() {
    plan_strands();
    StrandArrays& a = out_.strands;
    a.motion_keys = static_cast<int>(keys_.size());
    a.basis = basis();
    a.points.reserve(4 * keys_.size() * a.first_point.back());
    for (size_t key = 0; key < keys_.size(); ++key) add_points(key);
    add_ids();
    for (const RibNamedValue& p : parameters_) add_attribute(p);
    out_.has_color = has_attribute("color");
    out_.has_opacity = has_attribute("opacity");
    return std::move(out_);
  }

 private:
  CurveBasis basis() const {
    if (!layout_.cubic) return CurveBasis::kLinear;
    if (form_ != Form::kPinned && !layout_.pinned) return CurveBasis::kBSpline;
    return layout_.basis.kind == RibBasis::Kind::kCatmullRom ? CurveBasis::kCatmullRom
                                                             : CurveBasis::kPinnedBSpline;
  }

  bool has_attribute(std::string_view name) const {
    const auto& attributes = out_.strands.attributes;
    return std::any_of(attributes.begin(), attributes.end(),
                       [&](const StrandAttribute& a) { return a.name == name; });
  }

  uint32_t strand_points(size_t curve) const {
    const uint32_t points = layout_.points[curve];
    if (form_ == Form::kPinned) return points - 2;
    return points + (!layout_.periodic ? 0 : layout_.cubic ? 3 : 1);
  }

  void plan_strands() {
    StrandArrays& a = out_.strands;
    a.first_point.push_back(0);
    size_t begin = 0, total = 0;
    const auto add = [&](size_t curve, size_t points) {
      total += points;
      if (total > kMaxRibCount) request_.fail("the curves have more than 1,000,000,000 points");
      a.first_point.push_back(static_cast<uint32_t>(total));
      curve_of_.push_back(static_cast<uint32_t>(curve));
    };
    starts_.resize(form_ == Form::kResampled ? layout_.points.size() : 0);
    for (size_t c = 0; c < layout_.points.size(); begin += layout_.points[c++]) {
      if (layout_.segments[c] == 0) continue;
      if (form_ != Form::kResampled) {
        add(c, strand_points(c));
        continue;
      }
      starts_[c] = strand_starts(layout_, c, keys_[0].subspan(3 * begin, size_t(3) * layout_.points[c]));
      for (size_t i = 0; i < starts_[c].size(); ++i) {
        const uint32_t end = i + 1 < starts_[c].size() ? starts_[c][i + 1] : layout_.segments[c];
        add(c, size_t(kRibSubdivision) * (end - starts_[c][i]) + 3);
      }
    }
  }

  void add_points(size_t key) {
    std::vector<float>& points = out_.strands.points;
    const std::vector<float> radii = radii_of(key);
    size_t begin = 0, radius = 0;
    std::vector<float> made;
    for (size_t c = 0; c < layout_.points.size(); ++c) {
      const auto p = keys_[key].subspan(3 * begin, size_t(3) * layout_.points[c]);
      begin += layout_.points[c];
      if (layout_.segments[c] == 0) continue;
      made.clear();
      if (form_ == Form::kResampled) {
        resample_curve(layout_, c, p, starts_[c], made);
      } else {
        const size_t skipped = form_ == Form::kPinned ? 1 : 0;
        for (size_t i = 0; i < strand_points(c); ++i) {
          const size_t from = 3 * ((i + skipped) % layout_.points[c]);
          made.insert(made.end(), {p[from], p[from + 1], p[from + 2]});
        }
      }
      for (size_t i = 0; i < made.size(); i += 3)
        points.insert(points.end(), {made[i], made[i + 1], made[i + 2], radii[radius++]});
    }
  }

  std::vector<float> radii_of(size_t key) {
    const RibNamedValue* width = find_parameter(all_[key], "width");
    if (!width) width = find_parameter(all_[key], "constantwidth");
    if (!width) width = find_parameter(parameters_, "width");
    if (!width) width = find_parameter(parameters_, "constantwidth");
    out_.has_width |= width != nullptr;
    std::vector<float> radii(out_.strands.first_point.back(), 0.5f);
    if (!width) return radii;
    if (width->declaration.components != 1 || !width->value->is_number())
      request_.fail(*width->value, "a width must be a float");
    const std::vector<float> values = per_point(*width, true);
    for (size_t i = 0; i < radii.size(); ++i) {
      radii[i] = 0.5f * values[i];
      out_.negative_widths |= values[i] < 0;
    }
    return radii;
  }

  /// Returns the values of a parameter of any class, one per point of the strands. `extrapolate`: for widths,
  /// which the points of a B-spline without phantom points carry beyond its ends.
  std::vector<float> per_point(const RibNamedValue& p, bool extrapolate) {
    check_size(request_, p, layout_);
    const auto n = static_cast<size_t>(p.declaration.components);
    std::vector<float> out;
    out.reserve(n * out_.strands.first_point.back());
    size_t strand = 0, joint = 0, vertex = 0;
    std::vector<float> joints;
    for (size_t c = 0; c < layout_.points.size();
         joint += layout_.joints(c), vertex += layout_.points[c], ++c) {
      if (layout_.segments[c] == 0) continue;
      const bool closes = layout_.periodic;
      joints.clear();
      const auto value = [&](size_t index, size_t k) { return p.value->number(index * n + k); };
      const RibClass frequency = p.declaration.frequency;
      const bool direct = frequency == RibClass::kVertex && form_ != Form::kResampled;
      const uint32_t count = direct ? layout_.points[c] : layout_.segments[c] + 1;
      for (uint32_t j = 0; j < count; ++j) {
        for (size_t k = 0; k < n; ++k) {
          if (frequency == RibClass::kConstant || frequency == RibClass::kUniform) {
            joints.push_back(value(frequency == RibClass::kConstant ? 0 : c, k));
          } else if (direct) {
            joints.push_back(value(vertex + j, k));
          } else if (frequency == RibClass::kVertex) {
            joints.push_back(at_joint(p, n, vertex, c, j, k));
          } else {
            joints.push_back(value(joint + (closes ? j % layout_.segments[c] : j), k));
          }
        }
      }
      append_points(c, joints, n, direct, extrapolate, strand, out);
    }
    return out;
  }

  /// Component `k` of a vertex parameter at joint `j` of curve `c`, whose first vertex is `vertex`.
  float at_joint(const RibNamedValue& p, size_t n, size_t vertex, size_t c, uint32_t j, size_t k) const {
    const uint32_t segment = std::min(j, layout_.segments[c] - 1);
    const auto weights = layout_.basis.weights(j == segment ? 0.0f : 1.0f);
    float sum = 0;
    for (size_t i = 0; i < 4; ++i) {
      const size_t at = (segment * static_cast<size_t>(layout_.basis.step) + i) % layout_.points[c];
      sum += weights[i] * p.value->number((vertex + at) * n + k);
    }
    return sum;
  }

  /// Appends the values of the points of curve `c`. `values`: one per joint, or one per point of the request.
  void append_points(size_t c, const std::vector<float>& values, size_t n, bool direct, bool extrapolate,
                     size_t& strand, std::vector<float>& out) const {
    const size_t count = values.size() / n;
    const auto put = [&](float at) {
      const auto low = static_cast<size_t>(std::clamp(at, 0.0f, static_cast<float>(count - 1)));
      const size_t high = std::min(low + 1, count - 1);
      const float t = at - static_cast<float>(low);
      const bool inside = t >= 0 && low < count - 1;
      for (size_t k = 0; k < n; ++k) {
        if (inside || !extrapolate || count < 2) {
          out.push_back(interpolate(values[low * n + k], values[high * n + k], inside ? t : 0.0f));
        } else {
          const size_t near = t < 0 ? 0 : count - 1, next = t < 0 ? 1 : count - 2;
          const float beyond = t < 0 ? -t : t;
          const float step = beyond * (values[near * n + k] - values[next * n + k]);
          out.push_back(std::max(0.0f, values[near * n + k] + step));
        }
      }
    };
    if (form_ == Form::kResampled) {
      for (size_t i = 0; i < starts_[c].size(); ++i, ++strand) {
        const size_t points = out_.strands.first_point[strand + 1] - out_.strands.first_point[strand];
        for (size_t j = 0; j < points; ++j)
          put(static_cast<float>(starts_[c][i]) +
              (static_cast<float>(j) - 1) / static_cast<float>(kRibSubdivision));
      }
      return;
    }
    // Points of B-splines without phantom points begin before the first joint.
    const float shift =
        direct ? (form_ == Form::kPinned ? 1.0f : 0.0f) : (basis() == CurveBasis::kBSpline ? -1.0f : 0.0f);
    for (size_t j = 0; j < strand_points(c); ++j) {
      const float at = static_cast<float>(j) + shift;
      put(direct && layout_.periodic ? static_cast<float>(j % layout_.points[c]) : at);
    }
  }

  void add_ids() {
    StrandArrays& a = out_.strands;
    a.ids.resize(curve_of_.size());
    std::iota(a.ids.begin(), a.ids.end(), uint64_t(0));
    const RibNamedValue *id = find_parameter(parameters_, "id"),
                        *high = find_parameter(parameters_, "id_high");
    // A curve with gaps became several strands, which need different ids.
    if (!id || id->declaration.frequency != RibClass::kUniform ||
        curve_of_.size() != layout_.points.size() - layout_.unusable)
      return;
    check_size(request_, *id, layout_);
    const bool whole = id->value->kind == RibOperand::Kind::kIntegers;
    for (size_t s = 0; s < a.ids.size(); ++s) {
      const uint32_t c = curve_of_[s];
      const float number = whole ? 0 : id->value->floats[c];
      if (!whole && !(number >= 0 && number <= 16777216.0f)) return;
      a.ids[s] = whole ? static_cast<uint32_t>(id->value->integers[c]) : static_cast<uint64_t>(number);
    }
    out_.has_ids = true;
    if (!high || high->value->size() != layout_.points.size() ||
        high->value->kind != RibOperand::Kind::kIntegers)
      return;
    for (size_t s = 0; s < a.ids.size(); ++s)
      a.ids[s] |= static_cast<uint64_t>(static_cast<uint32_t>(high->value->integers[curve_of_[s]])) << 32;
  }

  /// The means of the channels of Os.
  static StrandAttribute opacity_of(const StrandAttribute& channels) {
    StrandAttribute opacity{"opacity", channels.frequency, 1, {}};
    const auto n = static_cast<size_t>(channels.components);
    for (size_t i = 0; i + n <= channels.values.size(); i += n) {
      float sum = 0;
      for (size_t k = 0; k < n; ++k) sum += channels.values[i + k];
      opacity.values.push_back(sum / static_cast<float>(n));
    }
    return opacity;
  }

  void add_attribute(const RibNamedValue& p) {
    for (const char* known : {"P", "width", "constantwidth", "id", "id_high"}) {
      if (p.name == known) return;
    }
    out_.ribbons |= p.name == "N";
    if (!p.value->is_number()) {
      out_.unsupported.push_back(p.name);
      return;
    }
    if (std::string why = wrong_size(p, layout_); !why.empty()) {
      out_.misfits.push_back(std::move(why));
      return;
    }
    StrandArrays& a = out_.strands;
    if (p.name == "st" && p.declaration.components == 2) {
      const std::vector<float> st = per_point(p, false);
      for (size_t s = 0; s < curve_of_.size(); ++s)
        a.root_uv.emplace_back(st[2 * a.first_point[s]], st[2 * a.first_point[s] + 1]);
      return;
    }
    StrandAttribute attribute{
        p.name == "Cs" ? "color" : p.name, AttributeClass::kPerPoint, p.declaration.components, {}};
    const auto n = static_cast<size_t>(attribute.components);
    if (p.declaration.frequency == RibClass::kConstant) {
      attribute.frequency = AttributeClass::kConstant;
      for (size_t k = 0; k < n; ++k) attribute.values.push_back(p.value->number(k));
    } else if (p.declaration.frequency == RibClass::kUniform) {
      attribute.frequency = AttributeClass::kPerStrand;
      for (const uint32_t c : curve_of_) {
        for (size_t k = 0; k < n; ++k) attribute.values.push_back(p.value->number(c * n + k));
      }
    } else {
      attribute.values = per_point(p, false);
    }
    if (p.name == "Os") attribute = opacity_of(attribute);
    if (!has_attribute(attribute.name)) a.attributes.push_back(std::move(attribute));
  }

  RibStatement& request_;
  RibCurveLayout layout_;
  std::vector<RibNamedValue> parameters_;        // of the first sample
  std::vector<std::vector<RibNamedValue>> all_;  // of all samples
  std::vector<std::span<const float>> keys_;     // positions
  Form form_ = Form::kAsGiven;
  std::vector<std::vector<uint32_t>> starts_;  // of each resampled curve: strand_starts()
  std::vector<uint32_t> curve_of_;             // by strand
  RibCurveSet out_;
};

}  // namespace

RibCurveSet read_curves(std::span<RibStatement> samples, const RibDeclarations& declarations,
                        const RibBasis& basis) {
  return CurveReader(samples, declarations, basis).read();
}

}  // namespace pelage
