// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "base/value_readers.h"
#include "base/vector.h"
#include "geom/strands.h"
#include "groom/operators/operator.h"
#include "groom/strands/root_grid.h"

namespace pelage {

/// Returns the control points of a pinned uniform cubic B-spline with `count` points. The knots of this
/// spline lie on strand `strand`, at equal distances of arc length.
std::vector<V3f> resample_strand(const Strands& strands, size_t strand, int count);

struct GuideFile {
  AssetPath file;
  std::optional<CurveBasis> basis;
  float scale = 1;
  V3f translate{0};
  /// Normal of a plane through the origin; not 0. The mirror image of every guide is added.
  std::optional<V3f> mirror = {};
};

/// Guide strands in rest space. They are bound to the rest skin and resampled to a common number of points.
/// Of guides with nearly the same root and shape, only the first is kept. Immutable. Thread safety: const
/// members may be called from any thread.
class GuideSet {
 public:
  /// Reads the guides. Throws Error (kInput) when the file cannot be read or contains no usable strand, or
  /// when all faces of the skin are holes.
  GuideSet(const GuideFile& source, const PrepareContext& context);

  size_t size() const { return normals_.size(); }
  int points() const { return points_; }
  const std::vector<V3f>& roots() const { return roots_; }      ///< nearest points of the skin
  const std::vector<V3f>& normals() const { return normals_; }  ///< normals of the skin at the roots
  /// Returns control point `p` of guide `g` as an offset from control point 0, along the axes of rest space.
  const V3f& offset(size_t g, int p) const {
    return offsets_[g * static_cast<size_t>(points_) + static_cast<size_t>(p)];
  }
  /// Returns the direction from the root of guide `g` to the mean of its control points; 0 if they coincide.
  const V3f& lean(size_t g) const { return leans_[g]; }
  float length(size_t g) const { return lengths_[g]; }  ///< length of the control polygon of guide g
  /// Max of length() over all guides.
  float longest() const { return longest_; }
  /// Median over the guides of the distance from a guide's root to the nearest other root on the same side of
  /// the skin, apart from copies at nearly the same place; 0 if there is none. If there are many guides, uses
  /// a sample of about a thousand.
  float spacing() const { return spacing_; }
  size_t bytes() const;

 private:
  /// Drops each guide whose root lies within `apart` of the root of an earlier, similar guide.
  void drop_twins(float apart);

  int points_ = 0;
  float longest_ = 0;
  float spacing_ = 0;
  std::vector<V3f> roots_;
  std::vector<V3f> normals_;
  std::vector<V3f> offsets_;
  std::vector<V3f> leans_;
  std::vector<float> lengths_;
};

}  // namespace pelage
