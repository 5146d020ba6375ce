// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// How the points of a strand define a curve.
///
/// kPinnedBSpline: a uniform cubic B-spline that interpolates its first and last points, the basis of grown
/// strands. The phantom points P[-1] = 2 P[0] - P[1] and P[n] = 2 P[n-1] - P[n-2] are computed only where
/// needed, so n points give n - 1 segments.
///
/// kBSpline: a uniform cubic B-spline without phantom points, for strands from files; n points give n - 3
/// segments.
///
/// kCatmullRom: interpolates all its points, with the same phantom points as kPinnedBSpline; n points give
/// n - 1 segments.
///
/// kBezier: cubic Bezier segments; 3 n + 1 points give n segments. Used only while rendering, never in files
/// or grooms. Only the values of per-point attributes at the ends of segments are used.
enum class CurveBasis { kLinear, kPinnedBSpline, kBSpline, kCatmullRom, kBezier };

/// Root of a strand on a skin: a ptex face and parameters in [0, 1]^2.
struct RootAddress {
  uint32_t face = 0;
  float u = 0;
  float v = 0;
};

/// How many values an attribute has.
enum class AttributeClass {
  kConstant,   ///< one value for all strands
  kPerStrand,  ///< one per strand
  kPerPoint,   ///< one per point; between two points of a segment, linear in the curve parameter
};

struct StrandAttribute {
  std::string name;
  AttributeClass frequency = AttributeClass::kPerStrand;
  int components = 1;
  std::vector<float> values;
};

/// The arrays of a batch of strands under construction.
///
/// `points` holds motion_keys x point_count x (x, y, z, radius): first all points of key 0, then all of key
/// 1, and so on. Key k is at the fraction k / (motion_keys - 1) of the shutter time. Positions are in world
/// space or in the space of a file, in scene units. The radius is half the width.
struct StrandArrays {
  CurveBasis basis = CurveBasis::kPinnedBSpline;
  int motion_keys = 1;
  std::vector<float> points;
  /// Strand i has the points first_point[i] .. first_point[i + 1] - 1; strand_count + 1 entries.
  std::vector<uint32_t> first_point;
  std::vector<uint64_t> ids;       ///< one per strand; an id never changes (law 2)
  std::vector<RootAddress> roots;  ///< one per strand, or empty when the strands do not grow on a skin
  std::vector<V2f> root_uv;        ///< texture coordinates of the roots, or empty
  std::vector<StrandAttribute> attributes;
};

/// An immutable batch of strands: the result of grooms and the input of renderers. A strand is rendered as a
/// ribbon that faces the ray and represents a fibre of circular cross-section. Its parameters are h across
/// the ribbon and v along it (0 at the root, 1 at the tip).
class Strands {
 public:
  Strands() = default;
  /// Takes ownership of the arrays. Throws Error (kInput) if their sizes are inconsistent. Does not check
  /// their contents: geom/io repairs the contents of files before it calls this constructor.
  explicit Strands(StrandArrays arrays);

  size_t strand_count() const { return a_.first_point.empty() ? 0 : a_.first_point.size() - 1; }
  size_t point_count() const { return a_.first_point.empty() ? 0 : a_.first_point.back(); }
  int motion_keys() const { return a_.motion_keys; }
  CurveBasis basis() const { return a_.basis; }

  uint32_t first_point(size_t strand) const { return a_.first_point[strand]; }
  uint32_t strand_points(size_t strand) const { return a_.first_point[strand + 1] - a_.first_point[strand]; }
  uint64_t id(size_t strand) const { return a_.ids[strand]; }
  /// All points of one motion key as (x, y, z, radius).
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
  /// Texture coordinates of a root; (0, 0) when the strands have none.
  V2f root_uv(size_t strand) const { return a_.root_uv.empty() ? V2f(0) : a_.root_uv[strand]; }
  const std::vector<StrandAttribute>& attributes() const { return a_.attributes; }
  /// Returns the attribute of this name; null when there is none.
  const StrandAttribute* find_attribute(std::string_view name) const;

  /// Turns this batch into a copy of a single strand of `source`, with all its motion keys and attributes.
  /// Reuses the memory of this batch: allocates only if this memory is too small.
  void assign_strand(const Strands& source, size_t strand);

  const StrandArrays& arrays() const { return a_; }
  /// Moves the arrays out of this batch, so that the caller can reuse their memory.
  StrandArrays release() && { return std::move(a_); }
  /// Heap bytes of all arrays.
  size_t bytes() const;

 private:
  StrandArrays a_;
};

/// Returns the number of segments of a strand of `points` points in `basis`; 0 when there are too few points.
uint32_t segment_count(CurveBasis basis, uint32_t points);
/// Interpolates linearly. Returns exactly a if a and b are equal, so that a constant value stays
/// bit-identical for any number of points.
inline float interpolate(float a, float b, float t) { return a == b ? a : a * (1.0f - t) + b * t; }
/// Evaluates an attribute at parameter `t` of segment `segment` of a strand. Writes its `components` values
/// to `out`. Interpolates per-point values linearly between the two points of the segment. Copies constant
/// and per-strand values.
void interpolate_attribute(const Strands& strands, const StrandAttribute& attribute, size_t strand,
                           uint32_t segment, float t, float* out);

}  // namespace pelage
