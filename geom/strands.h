// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// How the points of a strand define a curve. Grown strands are uniform cubic B-splines that interpolate
/// their first and last points: the phantom points P[-1] = 2 P[0] - P[1] and P[n] = 2 P[n-1] - P[n-2] are
/// computed only where needed, so n points give n - 1 segments. `kBSpline` (files) has no phantom points: n
/// points give n - 3 segments. `kCatmullRom` uses the same phantom points and interpolates all its points.
/// `kBezier` is used while rendering only, never in files or grooms: 3 n + 1 points give n segments, and
/// per-point attributes are read only at the ends of segments.
enum class CurveBasis { kLinear, kPinnedBSpline, kBSpline, kCatmullRom, kBezier };

/// Root of a strand on a skin: ptex face and parameters in [0, 1]^2.
struct RootAddress {
  uint32_t face = 0;
  float u = 0;
  float v = 0;
};

/// How often the value of an attribute changes.
enum class AttributeClass {
  kConstant,   ///< one value for all strands
  kPerStrand,  ///< one per strand
  kPerPoint,   ///< one per point; linear in the curve parameter between the points of a segment
};

struct StrandAttribute {
  std::string name;
  AttributeClass frequency = AttributeClass::kPerStrand;
  int components = 1;
  std::vector<float> values;
};

/// The arrays of a batch of strands under construction.
///
/// points: motion_keys x point_count x (x, y, z, radius), all of key 0 first; key k is at time k /
/// (motion_keys - 1) of the shutter. World space or file space, in scene units; the radius is half the width.
struct StrandArrays {
  CurveBasis basis = CurveBasis::kPinnedBSpline;
  int motion_keys = 1;
  std::vector<float> points;
  std::vector<uint32_t>
      first_point;                 ///< strand_count + 1 entries: strand i has points first[i] .. first[i+1]-1
  std::vector<uint64_t> ids;       ///< one per strand, never changes (law 2)
  std::vector<RootAddress> roots;  ///< one per strand, or empty when the strands do not grow on a skin
  std::vector<V2f> root_uv;        ///< texture coordinates of the roots, or empty
  std::vector<StrandAttribute> attributes;
};

/// An immutable batch of strands: what grooms produce and renderers consume. Curves are ray-facing ribbons of
/// circular fibres: h across, v along (0 at the root, 1 at the tip).
class Strands {
 public:
  Strands() = default;
  /// Takes ownership of the arrays. Their sizes must be consistent (checked; a mismatch is a bug of the
  /// caller). geom/io repairs the contents of files before it calls this.
  explicit Strands(StrandArrays arrays);

  size_t strand_count() const { return a_.first_point.empty() ? 0 : a_.first_point.size() - 1; }
  size_t point_count() const { return a_.first_point.empty() ? 0 : a_.first_point.back(); }
  int motion_keys() const { return a_.motion_keys; }
  CurveBasis basis() const { return a_.basis; }

  uint32_t first_point(size_t strand) const { return a_.first_point[strand]; }
  uint32_t strand_points(size_t strand) const { return a_.first_point[strand + 1] - a_.first_point[strand]; }
  uint64_t id(size_t strand) const { return a_.ids[strand]; }
  /// All points of one motion key, 4 floats each.
  std::span<const float> points(int key = 0) const {
    return std::span(a_.points).subspan(static_cast<size_t>(key) * point_count() * 4, point_count() * 4);
  }
  V3f point(size_t index, int key = 0) const {
    const float* p = &a_.points[(static_cast<size_t>(key) * point_count() + index) * 4];
    return {p[0], p[1], p[2]};
  }
  float radius(size_t index, int key = 0) const {
    return a_.points[(static_cast<size_t>(key) * point_count() + index) * 4 + 3];
  }
  bool has_roots() const { return !a_.roots.empty(); }
  const RootAddress& root(size_t strand) const { return a_.roots[strand]; }
  V2f root_uv(size_t strand) const { return a_.root_uv.empty() ? V2f(0) : a_.root_uv[strand]; }
  const std::vector<StrandAttribute>& attributes() const { return a_.attributes; }
  const StrandAttribute* find_attribute(std::string_view name) const;

  /// Becomes a copy of strand `strand` of `source`, with all its motion keys and attributes. Reuses its
  /// memory: does not allocate once it is large enough.
  void assign_strand(const Strands& source, size_t strand);

  const StrandArrays& arrays() const { return a_; }
  /// Moves the arrays out, so that the next batch can reuse their memory.
  StrandArrays release() && { return std::move(a_); }
  /// Heap bytes of all arrays.
  size_t bytes() const;

 private:
  StrandArrays a_;
};

/// Segments of a strand of `points` points in `basis`; 0 when there are too few.
uint32_t segment_count(CurveBasis basis, uint32_t points);
/// Linear interpolation. If a and b are equal, returns exactly a. So a constant value stays bit-identical for
/// any number of points.
inline float interpolate(float a, float b, float t) { return a == b ? a : a * (1.0f - t) + b * t; }
/// Writes the `components` values of an attribute at parameter `t` of segment `segment` of a strand to `out`.
/// Per-point values are interpolated linearly between the two points of the segment; constant and per-strand
/// values are copied.
void interpolate_attribute(const Strands& strands, const StrandAttribute& attribute, size_t strand,
                           uint32_t segment, float t, float* out);

}  // namespace pelage
