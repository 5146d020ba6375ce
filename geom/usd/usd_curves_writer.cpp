// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_curves_writer.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "geom/interchange/unique_names.h"

namespace pelage {
namespace {

constexpr UsdWriter::Layout kPointLayout{3, 4};

struct UsdCurveTokens {
  const char *type, *basis, *wrap;
};

UsdCurveTokens form_of(CurveBasis basis) {
  switch (basis) {
    case CurveBasis::kLinear:
      return {"linear", "bspline", "nonperiodic"};
    case CurveBasis::kPinnedBSpline:
      return {"cubic", "bspline", "pinned"};
    case CurveBasis::kBSpline:
      return {"cubic", "bspline", "nonperiodic"};
    case CurveBasis::kCatmullRom:
      return {"cubic", "catmullRom", "pinned"};
    case CurveBasis::kBezier:
      return {"cubic", "bezier", "nonperiodic"};
  }
  return {"linear", "bspline", "nonperiodic"};
}

std::vector<float> diameters(const Strands& strands, int key) {
  std::vector<float> widths(strands.point_count());
  for (size_t p = 0; p < widths.size(); ++p) widths[p] = 2 * strands.radius(p, key);
  return widths;
}

const char* type_of(const StrandAttribute& attribute) {
  if (attribute.name == "color" && attribute.components == 3) return "color3f";
  constexpr const char* kTypes[] = {"float", "float2", "float3", "float4"};
  return attribute.components <= 4 ? kTypes[attribute.components - 1] : "float";
}

const char* interpolation_of(AttributeClass frequency, CurveBasis basis) {
  if (frequency == AttributeClass::kConstant) return "constant";
  if (frequency == AttributeClass::kPerStrand) return "uniform";
  return basis == CurveBasis::kBSpline ? "vertex" : "varying";
}

/// Names of primvars that write_usd_curves() writes itself.
bool is_own_primvar(const std::string& name) {
  return name == "ids" || name == "st" || name == "widths" || name.starts_with("groom:");
}

void write_attribute(UsdWriter& usd, const StrandAttribute& attribute, CurveBasis basis) {
  std::string name = attribute.name;
  if (is_own_primvar(name)) return;
  std::string type = type_of(attribute);
  if (name == "color" && attribute.components == 3) name = "displayColor";
  if (name == "opacity" && attribute.components == 1) name = "displayOpacity";
  std::string metadata =
      fmt::format(" (interpolation = \"{}\")", interpolation_of(attribute.frequency, basis));
  auto components = static_cast<size_t>(attribute.components);
  if (components > 4) {
    metadata = fmt::format(" (elementSize = {}; {}", components, metadata.substr(2));
    components = 1;
  }
  std::string namespaced;
  for (size_t begin = 0; begin <= name.size();) {
    const size_t end = std::min(name.find(':', begin), name.size());
    namespaced += (begin > 0 ? ":" : "") + identifier(name.substr(begin, end - begin));
    begin = end + 1;
  }
  usd.array(fmt::format("{}[] primvars:{} = ", type, namespaced), attribute.values, {components, components},
            metadata);
}

void write_roots(UsdWriter& usd, const Strands& strands) {
  const StrandArrays& a = strands.arrays();
  constexpr std::string_view kUniform = " (interpolation = \"uniform\")";
  // Hosts read int more often than int64, and some readers cut the latter off after the first digit.
  const bool small = std::all_of(a.ids.begin(), a.ids.end(), [](uint64_t id) { return id <= INT32_MAX; });
  if (small) {
    const std::vector<uint32_t> ids(a.ids.begin(), a.ids.end());
    usd.array("int[] primvars:ids = ", std::span(ids), kUniform);
  } else {
    usd.array("int64[] primvars:ids = ", std::span(a.ids), kUniform);
  }
  if (!a.root_uv.empty()) {
    usd.array("texCoord2f[] primvars:st = ", {&a.root_uv[0].x, 2 * a.root_uv.size()}, {2, 2}, kUniform);
  }
  if (a.roots.empty()) return;
  std::vector<uint32_t> faces;
  std::vector<float> uv;
  for (const RootAddress& root : a.roots) {
    faces.push_back(root.face);
    uv.insert(uv.end(), {root.u, root.v});
  }
  usd.array("int[] primvars:groom:face = ", std::span<const uint32_t>(faces), kUniform);
  usd.array("float2[] primvars:groom:faceUv = ", uv, {2, 2}, kUniform);
}

void write_facts(UsdWriter& usd, const UsdCurvesFacts& facts) {
  constexpr std::string_view kConstant = " (interpolation = \"constant\")";
  if (!facts.coat.empty())
    usd.line(fmt::format("string primvars:groom:coat = {}{}", usd_string(facts.coat), kConstant));
  if (!facts.role.empty())
    usd.line(fmt::format("token primvars:groom:role = {}{}", usd_string(facts.role), kConstant));
  if (!facts.priority.empty()) {
    usd.array("float[] primvars:groom:priority = ", facts.priority, {1, 1}, " (interpolation = \"uniform\")");
  }
}

/// Whether two samples have the same radii at all points and keys.
bool same_widths(const Strands& a, const std::vector<float>& widths) {
  for (int key = 0; key < a.motion_keys(); ++key) {
    for (size_t p = 0; p < widths.size(); ++p) {
      if (2 * a.radius(p, key) != widths[p]) return false;
    }
  }
  return true;
}

class CurvesPrim {
 public:
  CurvesPrim(UsdWriter& usd, const UsdCurvesFacts& facts, size_t count,
             const std::function<UsdCurvesSample(size_t)>& sample)
      : usd_(usd), facts_(facts), count_(count), sample_(sample) {}

  Box3f write(const std::string& name) {
    UsdCurvesSample first = sample_(0);
    const Strands& strands = first.strands;
    counts_ = counts_of(strands);
    widths_ = diameters(strands, 0);
    const UsdCurveTokens form = form_of(strands.basis());
    usd_.open(fmt::format("def BasisCurves {}", usd_string(name)));
    usd_.line(fmt::format("uniform token type = \"{}\"", form.type));
    usd_.line(fmt::format("uniform token basis = \"{}\"", form.basis));
    usd_.line(fmt::format("uniform token wrap = \"{}\"", form.wrap));
    usd_.array("int[] curveVertexCounts = ", std::span<const uint32_t>(counts_));
    write_roots(usd_, strands);
    write_facts(usd_, facts_);
    for (const StrandAttribute& attribute : strands.attributes())
      write_attribute(usd_, attribute, strands.basis());
    moves_ = !first.times.empty();
    write_points(std::move(first));
    write_extents();
    if (facts_.widths) write_widths();
    usd_.close();
    return whole_;
  }

 private:
  static std::vector<uint32_t> counts_of(const Strands& strands) {
    std::vector<uint32_t> counts;
    for (size_t s = 0; s < strands.strand_count(); ++s) counts.push_back(strands.strand_points(s));
    return counts;
  }

  void write_points(UsdCurvesSample current) {
    if (moves_) usd_.open_samples("point3f[] points");
    for (size_t i = 0; i < count_; ++i) {
      if (i > 0) current = sample_(i);
      if (i > 0 && counts_of(current.strands) != counts_)
        throw Error(ErrorKind::kFailed, "the points of strands are not the same in all frames");
      widths_move_ |= !same_widths(current.strands, widths_);
      for (int key = 0; key < current.strands.motion_keys(); ++key) {
        const Box3f extent = usd_extent(current.strands, key);
        whole_.extendBy(extent);
        if (!moves_) {
          usd_.array("point3f[] points = ", current.strands.points(key), kPointLayout);
          extents_.push_back({0, extent});
          return;
        }
        const double time = current.times[static_cast<size_t>(key)];
        if (!extents_.empty() && time <= extents_.back().first) continue;  // shutters of frames that touch
        extents_.push_back({time, extent});
        usd_.array(fmt::format("{}: ", time), current.strands.points(key), kPointLayout, ",");
      }
    }
    if (moves_) usd_.close();
  }

  void write_extents() {
    if (!moves_) return usd_.box("float3[] extent = ", whole_);
    usd_.open_samples("float3[] extent");
    for (const auto& [time, extent] : extents_) usd_.box(fmt::format("{}: ", time), extent, ",");
    usd_.close();
  }

  void write_widths() {
    constexpr std::string_view kVertex = " (interpolation = \"vertex\")";
    usd_.array("float[] widths = ", widths_, {1, 1}, kVertex);
    if (!moves_ || !widths_move_) return;
    usd_.open_samples("float[] widths");
    double last = 0;
    bool any = false;
    for (size_t i = 0; i < count_; ++i) {
      const UsdCurvesSample current = sample_(i);
      for (int key = 0; key < current.strands.motion_keys(); ++key) {
        const double time = current.times[static_cast<size_t>(key)];
        if (any && time <= last) continue;
        usd_.array(fmt::format("{}: ", time), diameters(current.strands, key), {1, 1}, ",");
        last = time;
        any = true;
      }
    }
    usd_.close();
  }

  UsdWriter& usd_;
  const UsdCurvesFacts& facts_;
  const size_t count_;
  const std::function<UsdCurvesSample(size_t)>& sample_;
  std::vector<uint32_t> counts_;
  std::vector<float> widths_;
  std::vector<std::pair<double, Box3f>> extents_;
  Box3f whole_;
  bool moves_ = false, widths_move_ = false;
};

}  // namespace

Box3f usd_extent(const Strands& strands, int key) {
  Box3f box;
  float radius = 0;
  const std::span<const float> points = strands.points(key);
  for (size_t i = 0; i < points.size(); i += 4) {
    box.extendBy(V3f(points[i], points[i + 1], points[i + 2]));
    radius = std::max(radius, points[i + 3]);
  }
  if (strands.basis() == CurveBasis::kCatmullRom) {
    // The curve leaves the hull of its points, but not that of its Bezier points.
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      const size_t first = strands.first_point(s), last = first + strands.strand_points(s) - 1;
      for (size_t p = first + 1; p < last; ++p) {
        const V3f step = (strands.point(p + 1, key) - strands.point(p - 1, key)) / 6;
        box.extendBy(strands.point(p, key) + step);
        box.extendBy(strands.point(p, key) - step);
      }
    }
  }
  if (box.isEmpty()) return Box3f(V3f(0), V3f(0));
  box.min -= V3f(radius);
  box.max += V3f(radius);
  return box;
}

Box3f write_usd_curves(UsdWriter& usd, const std::string& name, const UsdCurvesFacts& facts, size_t count,
                       const std::function<UsdCurvesSample(size_t)>& sample) {
  return CurvesPrim(usd, facts, count, sample).write(name);
}

}  // namespace pelage
