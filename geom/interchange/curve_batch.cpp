// SPDX-License-Identifier: Apache-2.0
#include "geom/interchange/curve_batch.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "geom/interchange/strand_order.h"

namespace pelage {
namespace {

AttributeClass frequency_of(const Primvar& primvar) {
  if (primvar.interpolation == "constant") return AttributeClass::kConstant;
  if (primvar.interpolation == "uniform") return AttributeClass::kPerStrand;
  return AttributeClass::kPerPoint;
}

/// Places of one curve in the arrays of its prim.
struct CurvePlace {
  size_t curve = 0, first_vertex = 0, first_varying = 0;
};

/// Writes the value of a primvar at a point of a curve.
void value_at(const Primvar& primvar, const CurvePlace& place, const CurvePoint& point, float* out) {
  const size_t n = primvar.components;
  const auto element = [&](size_t index) { return &primvar.values[index * n]; };
  if (primvar.interpolation == "constant" || primvar.interpolation == "uniform") {
    std::copy_n(element(primvar.interpolation == "uniform" ? place.curve : 0), n, out);
  } else if (primvar.interpolation == "vertex") {
    for (size_t c = 0; c < n; ++c) {
      out[c] = point.weight[0] == 1 ? element(place.first_vertex + point.vertex[0])[c] : 0;
      for (size_t k = 0; k < 4 && point.weight[0] != 1; ++k) {
        if (point.weight[k] != 0)
          out[c] += point.weight[k] * element(place.first_vertex + point.vertex[k])[c];
      }
    }
  } else {
    const float *a = element(place.first_varying + point.varying[0]),
                *b = element(place.first_varying + point.varying[1]);
    for (size_t c = 0; c < n; ++c) out[c] = interpolate(a[c], b[c], point.along);
  }
}

class CurveJoiner {
 public:
  explicit CurveJoiner(std::vector<CurveBatch> batches) : batches_(std::move(batches)) {
    constexpr CurveBasis kNone = CurveBasis::kBezier;  // which strands never have
    const CurveBasis common = batches_.front().form.native().value_or(kNone);
    for (const CurveBatch& batch : batches_) {
      resample_ |= common == kNone || batch.form.native().value_or(kNone) != common;
      has_uv_ |= !batch.root_uv.values.empty();
      for (const auto& [name, primvar] : batch.attributes) declare(name, primvar);
    }
    arrays_.basis = resample_ ? CurveBasis::kCatmullRom : common;
    arrays_.first_point.push_back(0);
  }

  /// The max memory that join() takes beside the batches: the result, and either the points of one curve or,
  /// after the batches are freed, what sorting copies.
  int64_t bytes() const {
    const JoinedSize size = joined_size();
    const size_t points = 4 * size.points * sizeof(float),
                 strands = size.strands * (sizeof(uint32_t) + 2 * sizeof(uint64_t) + sizeof(V2f));
    size_t attributes = 0, largest = 0, batches = 0;
    for (const StrandAttribute& attribute : arrays_.attributes) {
      const size_t values = size.numbers(attribute) * sizeof(float);
      attributes += values;
      largest = std::max(largest, values);
    }
    for (const CurveBatch& batch : batches_) batches += batch.bytes();
    const size_t one_curve = 2 * size.longest * sizeof(CurvePoint);  // a vector that grew
    const size_t sorted = points + largest + 2 * strands;
    return static_cast<int64_t>(points + strands + attributes +
                                std::max(one_curve, sorted > batches ? sorted - batches : 0));
  }

  StrandArrays join() {
    reserve();
    for (CurveBatch& batch : batches_) {
      add(batch);
      batch = {};
    }
    sort_by_id(ids_, arrays_);
    for (size_t i = 0; i + 1 < arrays_.first_point.size(); ++i) arrays_.ids.push_back(i);
    return std::move(arrays_);
  }

 private:
  StrandAttribute* find(const std::string& name) {
    for (StrandAttribute& attribute : arrays_.attributes) {
      if (attribute.name == name) return &attribute;
    }
    return nullptr;
  }

  void declare(const std::string& name, const Primvar& primvar) {
    const auto components = static_cast<int>(primvar.components);
    // Constant values of several prims may differ.
    const AttributeClass frequency = std::max(
        frequency_of(primvar), batches_.size() > 1 ? AttributeClass::kPerStrand : AttributeClass::kConstant);
    if (StrandAttribute* known = find(name)) {
      known->frequency = std::max(known->frequency, frequency);
      known->components = std::max(known->components, components);
    } else {
      arrays_.attributes.push_back({name, frequency, components, {}});
    }
  }

  /// How many points and strands the result has.
  struct JoinedSize {
    size_t points = 0, strands = 0, longest = 0;
    size_t numbers(const StrandAttribute& attribute) const {
      const size_t count = attribute.frequency == AttributeClass::kPerPoint    ? points
                           : attribute.frequency == AttributeClass::kPerStrand ? strands
                                                                               : 1;
      return count * static_cast<size_t>(attribute.components);
    }
  };
  JoinedSize joined_size() const {
    JoinedSize size;
    for (const CurveBatch& batch : batches_) {
      for (const uint32_t n : batch.counts) {
        const uint32_t points = batch.form.points(n, resample_);
        size.points += points;
        size.longest = std::max<size_t>(size.longest, points);
      }
      size.strands += batch.counts.size();
    }
    return size;
  }

  void reserve() {
    const JoinedSize size = joined_size();
    arrays_.points.reserve(4 * size.points);
    arrays_.first_point.reserve(size.strands + 1);
    arrays_.ids.reserve(size.strands);
    if (has_uv_) arrays_.root_uv.reserve(size.strands);
    const auto with_ids = [](const CurveBatch& batch) { return !batch.ids.empty(); };
    if (std::any_of(batches_.begin(), batches_.end(), with_ids)) ids_.reserve(size.strands);
    for (StrandAttribute& attribute : arrays_.attributes) attribute.values.reserve(size.numbers(attribute));
  }

  void add(const CurveBatch& batch) {
    CurvePlace place;
    std::vector<CurvePoint> points;
    const bool plain = is_plain(batch);
    const std::vector<const Primvar*> sources = sources_of(batch);
    for (const uint32_t n : batch.counts) {
      const uint32_t count = batch.form.points(n, resample_);
      if (arrays_.first_point.back() > UINT32_MAX - count)
        throw Error(ErrorKind::kInput, "the curves have more than 4,294,967,295 points");
      if (plain) {
        add_plain(batch, place, count);
        add_plain_attributes(sources, place, count);
      } else {
        points.clear();
        points.reserve(count);
        for (uint32_t i = 0; i < count; ++i) points.push_back(curve_point(batch.form, n, i, resample_));
        add_points(batch, place, points);
        add_attributes(sources, place, points);
      }
      if (has_uv_) add_uv(batch, place, n);
      if (!batch.ids.empty()) ids_.push_back(batch.ids[place.curve]);
      arrays_.first_point.push_back(arrays_.first_point.back() + count);
      ++place.curve;
      place.first_vertex += n;
      place.first_varying += batch.form.varying(n);
    }
  }

  /// Whether points are vertices, and all values of points those of vertices: most curves of large files.
  bool is_plain(const CurveBatch& batch) const {
    // Other curves than B-splines without phantom vertices have a varying value at each vertex, too.
    const bool varying = batch.form.native() != CurveBasis::kBSpline;
    const auto per_vertex = [&](const Primvar& values) {
      return values.interpolation == "vertex" || values.values.empty() ||
             (varying && values.interpolation != "constant" && values.interpolation != "uniform");
    };
    const bool vertex_widths = batch.widths.values.empty() || batch.widths.interpolation == "vertex";
    return !resample_ && batch.form.wrap != CurveForm::Wrap::kPeriodic && vertex_widths &&
           batch.to_world == M44f() &&
           std::all_of(batch.attributes.begin(), batch.attributes.end(), [&](const auto& attribute) {
             return per_vertex(attribute.second) ||
                    frequency_of(attribute.second) != AttributeClass::kPerPoint;
           });
  }

  /// The values in a batch of each attribute of the result; null where it has none.
  std::vector<const Primvar*> sources_of(const CurveBatch& batch) const {
    std::vector<const Primvar*> sources;
    for (const StrandAttribute& to : arrays_.attributes) {
      sources.push_back(nullptr);
      for (const auto& [name, primvar] : batch.attributes) {
        if (name == to.name && !primvar.values.empty()) sources.back() = &primvar;
      }
    }
    return sources;
  }

  /// Adds the values of a curve whose points are its vertices.
  void add_plain_attributes(const std::vector<const Primvar*>& sources, const CurvePlace& place,
                            uint32_t count) {
    for (size_t i = 0; i < sources.size(); ++i) {
      StrandAttribute& to = arrays_.attributes[i];
      if (to.frequency == AttributeClass::kConstant && !to.values.empty()) continue;
      const Primvar* from = sources[i];
      const auto components = static_cast<size_t>(to.components);
      const size_t rows = to.frequency == AttributeClass::kPerPoint ? count : 1, before = to.values.size();
      to.values.resize(before + rows * components);
      if (!from) continue;
      const bool once = frequency_of(*from) != AttributeClass::kPerPoint;
      size_t first = place.first_varying;
      if (from->interpolation == "constant") first = 0;
      if (from->interpolation == "uniform") first = place.curve;
      if (from->interpolation == "vertex") first = place.first_vertex;
      for (size_t row = 0; row < rows; ++row) {
        const float* values = &from->values[(first + (once ? 0 : row)) * from->components];
        std::copy_n(values, from->components, &to.values[before + row * components]);
      }
    }
  }

  void add_plain(const CurveBatch& batch, const CurvePlace& place, uint32_t count) {
    const size_t first = arrays_.points.size();
    arrays_.points.resize(first + 4 * size_t{count});
    for (size_t i = 0; i < count; ++i) {
      float* to = &arrays_.points[first + 4 * i];
      std::copy_n(&batch.points[3 * (place.first_vertex + i)], 3, to);
      if (!batch.widths.values.empty()) to[3] = batch.widths.values[place.first_vertex + i];
    }
  }

  void add_points(const CurveBatch& batch, const CurvePlace& place, const std::vector<CurvePoint>& points) {
    const bool still = batch.to_world == M44f();
    for (const CurvePoint& point : points) {
      V3f p(0);
      if (point.weight[0] == 1) {
        std::copy_n(&batch.points[3 * (place.first_vertex + point.vertex[0])], 3, &p.x);
      } else {
        for (size_t k = 0; k < 4; ++k) {
          if (point.weight[k] == 0) continue;
          const float* vertex = &batch.points[3 * (place.first_vertex + point.vertex[k])];
          p += point.weight[k] * V3f(vertex[0], vertex[1], vertex[2]);
        }
      }
      if (!still) p = p * batch.to_world;
      float radius = 0;
      if (!batch.widths.values.empty()) value_at(batch.widths, place, point, &radius);
      arrays_.points.insert(arrays_.points.end(), {p.x, p.y, p.z, radius});
    }
  }

  void add_attributes(const std::vector<const Primvar*>& sources, const CurvePlace& place,
                      const std::vector<CurvePoint>& points) {
    std::vector<float> value;
    for (size_t index = 0; index < sources.size(); ++index) {
      StrandAttribute& to = arrays_.attributes[index];
      const Primvar* from = sources[index];
      const bool once = to.frequency == AttributeClass::kConstant;
      if (once && !to.values.empty()) continue;
      const size_t count = to.frequency == AttributeClass::kPerPoint ? points.size() : 1;
      const auto components = static_cast<size_t>(to.components);
      for (size_t i = 0; i < count; ++i) {
        value.assign(std::max(components, from ? from->components : 0), 0.0f);
        // Curves without points still have uniform values.
        if (from) value_at(*from, place, points.empty() ? CurvePoint() : points[i], value.data());
        to.values.insert(to.values.end(), value.begin(), value.begin() + static_cast<ptrdiff_t>(components));
      }
    }
  }

  void add_uv(const CurveBatch& batch, const CurvePlace& place, uint32_t n) {
    float uv[2] = {0, 0};
    const bool has_root = batch.form.segments(n) > 0;
    if (!batch.root_uv.values.empty() &&
        (has_root || frequency_of(batch.root_uv) != AttributeClass::kPerPoint))
      value_at(batch.root_uv, place, CurvePoint(), uv);
    arrays_.root_uv.emplace_back(uv[0], uv[1]);
  }

  std::vector<CurveBatch> batches_;
  StrandArrays arrays_;
  std::vector<uint64_t> ids_;
  bool resample_ = false, has_uv_ = false;
};

}  // namespace

void CurveBatch::set_widths(Primvar stated) {
  // Widths have no direction, so they scale by the cube root of the factor of volumes.
  const float factor = 0.5f * std::cbrt(std::abs(to_world.determinant()));
  for (float& width : stated.values) width *= factor;
  widths = std::move(stated);
}

size_t CurveBatch::bytes() const {
  size_t numbers = counts.capacity() + points.capacity() + widths.values.capacity() +
                   root_uv.values.capacity() + 2 * ids.capacity();
  for (const auto& [name, primvar] : attributes) numbers += primvar.values.capacity();
  return numbers * sizeof(float);
}

CurvesFile join_curves(std::vector<CurveBatch> batches, const SourcePosition& file, ReadBudget& budget,
                       ReadWarnings& warnings) {
  CurvesFile result;
  const auto with_widths = std::count_if(batches.begin(), batches.end(),
                                         [](const CurveBatch& b) { return !b.widths.values.empty(); });
  if (with_widths > 0 && with_widths < static_cast<ptrdiff_t>(batches.size()))
    warnings.add("some curves have no widths; they get the default", file);
  result.has_widths = with_widths > 0;
  CurveJoiner joiner(std::move(batches));
  budget.charge(joiner.bytes(), file);
  result.strands = joiner.join();
  result.warnings = warnings.lines();
  return result;
}

}  // namespace pelage
