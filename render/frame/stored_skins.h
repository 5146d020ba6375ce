// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "base/content_store.h"
#include "base/job.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// A chunk of a frame that is a piece of a skin.
struct SkinChunk {
  uint32_t skin = 0;  ///< index in RenderScene::skins
  SkinPiece piece;
  size_t temporary_bytes = 0;  ///< temporary memory of tessellating the piece
};

/// The skins of a frame in a file: their pieces and the triangles of each piece, as an entry of kind "skins"
/// in a content store. The regions of a frame read it instead of posing, dividing and tessellating all skins
/// again. Every part of a piece has a checksum, which mesh() verifies.
///
/// Thread safety: const members may be called from any thread.
class StoredSkins {
 public:
  /// Version of the stored data. Must be raised by every change that gives other pieces or triangles for the
  /// same skins. tests/render/frame/stored_versions_test.cpp fails when they change and the version does not.
  static constexpr uint32_t kVersion = 2;

  /// Hash of everything on which pieces and triangles depend. Empty when a skin has no hash.
  static std::optional<ContentHash> key(const RenderScene& scene, size_t max_cost);
  /// Opens the entry of a frame. Returns null if it is missing or does not fit the scene; calls `warn` in the
  /// second case. Keeps `warn`.
  static std::unique_ptr<const StoredSkins> open(const ContentStore& store, const ContentHash& key,
                                                 const RenderScene& scene, const WarningSink& warn);
  /// Tessellates all pieces, a few at a time, and writes the entry. Returns false if they do not fit
  /// `render.memory`, when the job is cancelled, and when the file cannot be written.
  static bool write(const ContentStore& store, const ContentHash& key, const RenderScene& scene,
                    const std::vector<SkinChunk>& pieces, const Job& job);

  StoredSkins(StoredSections file, const RenderScene& scene, WarningSink warn);

  /// The pieces of all skins, in their order.
  const std::vector<SkinChunk>& pieces() const { return pieces_; }
  /// Reads the triangles of a piece. Returns nothing when the file is damaged: the piece must be tessellated.
  /// The first damage is reported, and deletes the file.
  std::optional<SkinMesh> mesh(size_t piece) const;
  /// Bytes of memory that this object holds.
  size_t bytes() const;

 private:
  SkinMesh read(size_t piece) const;

  StoredSections file_;
  WarningSink warn_;
  std::vector<SkinChunk> pieces_;
  std::vector<uint32_t> face_counts_;  // by skin
  std::vector<int> motion_keys_;       // by skin
  mutable std::atomic<bool> is_damaged_{false};
};

}  // namespace pelage
