// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <utility>

#include "geom/curve_bounds.h"
#include "procedurals/bounds/procedural.h"
#include "procedurals/bounds/segment_parts.h"
#include "procedurals/skin/deferred_skin.h"

namespace pelage {

/// A procedural whose strands are given to the constructor instead of being grown.
class FixedStrands final : public Procedural {
 public:
  explicit FixedStrands(Strands strands) : strands_(std::move(strands)) {}
  Box3f bound(BoundSpan) const override { return pelage::exact_bounds(strands_); }
  Strands generate() const override { return strands_; }
  StrandCounts counts() const override {
    StrandCounts counts;
    counts.strands = strands_.strand_count();
    counts.points = strands_.point_count();
    counts.motion_keys = static_cast<size_t>(strands_.motion_keys());
    for (size_t i = 0; i < counts.strands; ++i)
      counts.segments += segment_count(strands_.basis(), strands_.strand_points(i));
    for (const StrandAttribute& a : strands_.attributes()) counts.attribute_floats += a.values.size();
    return counts;
  }
  StrandScale scale() const override {
    float radius = 0;
    for (size_t i = 0; i < strands_.point_count(); ++i) radius = std::max(radius, strands_.radius(i));
    return {2 * radius, strands_.point_count() > 0 ? strands_.point(0) : V3f(0), 2 * radius};
  }
  ChunkBounds exact_bounds(BoundSpan, int keys) const override {
    return SegmentParts(strands_).exact_bounds(keys);
  }

 private:
  Strands strands_;
};

/// A skin whose triangles are given to the constructor. It has a single piece.
class FixedSkin final : public DeferredSkin {
 public:
  explicit FixedSkin(SkinMesh mesh) : mesh_(std::move(mesh)) {}
  std::vector<SkinPiece> divide(const View&, size_t, const Job&) const override {
    return {{{}, mesh_.vertex_count(), mesh_.triangle_count()}};
  }
  Box3f bound(const SkinPiece&, BoundSpan) const override {
    Box3f box;
    for (int key = 0; key < mesh_.motion_keys; ++key) {
      for (size_t i = 0; i < mesh_.vertex_count(); ++i) box.extendBy(mesh_.position(i, key));
    }
    return box;
  }
  int motion_keys() const override { return mesh_.motion_keys; }
  SkinMesh tessellate(const SkinPiece&, const View&) const override { return mesh_; }
  size_t temporary_bytes(const SkinPiece&) const override { return 0; }
  uint32_t face_count() const override {
    return mesh_.faces.empty() ? 0 : *std::max_element(mesh_.faces.begin(), mesh_.faces.end()) + 1;
  }

 private:
  SkinMesh mesh_;
};

}  // namespace pelage
