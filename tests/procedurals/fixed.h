// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <utility>

#include "procedurals/fixed_strands.h"
#include "procedurals/skin/deferred_skin.h"

namespace pelage {

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
