// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "base/job.h"
#include "procedurals/bounds/bounding.h"
#include "render/accel/chunk_grower.h"
#include "render/frame/stored_skins.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// The chunks of a frame, and their contents on demand. A chunk is a leaf of a coat (a procedural that is not
/// split further) or a piece of a skin. Leaves come first. The scene must outlive this object.
class FrameChunks final : public ChunkGrower {
 public:
  /// Splits every coat into leaves and divides every skin into pieces, or reads the pieces that store_skins()
  /// has stored. To divide skins, the constructor poses whole skins, a few at a time. The ledger is charged
  /// with their memory until all skins are divided. Throws Error (kInput) for a coat whose material is not
  /// for fibres, and Error (kMemory) when a single skin does not fit `render.memory`.
  FrameChunks(const RenderScene& scene, const Job& job);

  /// Stores the pieces of skins and their triangles in the folder `render.bvh.file` for later runs, unless
  /// they are stored.
  void store_skins(const Job& job);

  ChunkContents grow(uint32_t chunk) const override;
  bool is_skin(uint32_t chunk) const override { return chunk >= leaves_.size(); }
  uint32_t part(uint32_t chunk) const override {
    return is_skin(chunk) ? pieces()[chunk - leaves_.size()].skin : parts_[chunk];
  }
  ChunkCounts counts(uint32_t chunk) const override;
  StrandScale scale(uint32_t chunk) const override;
  /// Returns the name of the chunk's coat or skin, such as "walker.under".
  std::string name(uint32_t chunk) const override;

  /// Returns the count of chunks.
  size_t size() const { return leaves_.size() + pieces().size(); }
  /// Returns the leaves of all coats, which are the chunks 0, 1, 2 ...
  const std::vector<const Procedural*>& leaves() const { return leaves_; }
  /// Computes the boxes of all chunks with the strategy of the scene (render.bounds). The box of a piece of a
  /// skin encloses the control points of that piece. `counts` receives the counts of the leaves. Errors of
  /// growing leaves reach the caller. Throws Error (kMemory) before growing a leaf that does not fit. When
  /// cancelled, chunks may have no boxes.
  ///
  /// `known`: the boxes of leaves that are known from an earlier frame, by leaf; null where they are not
  /// known. Empty if none are.
  std::vector<ChunkBounds> bounds(const Job& job, BoundingCounts& counts,
                                  const std::vector<const ChunkBounds*>& known = {}) const;
  /// From now on, bounds() computes the boxes with the strategy `conservative` instead of growing the leaves,
  /// if that is faster: if the strategy of the scene measures constant boxes, all chunks fit `render.memory`
  /// together, and no boxes are stored beside caches. Returns whether this is so.
  bool bound_quickly(const Job& job);
  /// From now on, bounds() computes no boxes, because the caller grows all chunks before the first ray and
  /// measures their boxes then. This grows each leaf once instead of twice. Does so if the strategy of the
  /// scene is `exact`, if all chunks take at most half of the free part of `render.memory`, and if no boxes
  /// are stored beside caches. Returns whether this is so.
  bool grow_at_once(const Job& job);
  /// Returns a hash of everything on which the grown leaf and its boxes depend, except for its numbers
  /// (FurChunk::renumber()) and its min width: equal hashes mean equal leaves, in all frames of this process.
  /// Empty when unknown.
  std::optional<ContentHash> content(uint32_t leaf) const;
  /// Counts the next growth of this leaf as a regrowth. Call before its first growth.
  void mark_grown(uint32_t leaf) { was_grown_[leaf].store(true, std::memory_order_relaxed); }
  bool was_grown(uint32_t leaf) const { return was_grown_[leaf].load(std::memory_order_relaxed); }
  /// Returns how often grow() has grown a leaf.
  uint32_t growths(uint32_t leaf) const { return growths_[leaf].load(std::memory_order_relaxed); }
  /// Returns whether strands are stored in fur trees. If so, bounds() computes one box for each leaf;
  /// otherwise, one for each part of a leaf.
  bool in_fur_trees() const;
  /// Returns the memory of this object, in bytes: the descriptions of all chunks, without their contents.
  size_t bytes() const;
  /// Returns whether the material of every coat is opaque everywhere.
  bool opaque() const;
  /// Returns the count of strands that grow() has made so far. A strand that is grown again counts again.
  int64_t strands_grown() const { return strands_grown_.load(std::memory_order_relaxed); }
  /// Returns how many strands of strands_grown() had been grown before.
  int64_t strands_regrown() const { return strands_regrown_.load(std::memory_order_relaxed); }

 private:
  /// How bounds() grows and measures leaves within `render.memory`.
  struct MeasurePlan {
    int concurrency = 1;  // max leaves at once
    size_t block = 0;     // max temporary bytes of growing one leaf, without its strands
  };
  MeasurePlan measure_plan(const Job& job) const;
  /// Returns whether bounds() would grow leaves for constant boxes that are not stored.
  bool measures_boxes_of_fur_trees() const;
  /// Returns the max memory of the first `chunks` chunks together, in bytes.
  int64_t bytes_bound(size_t chunks) const;
  /// Returns the boxes of the given leaves.
  std::vector<ChunkBounds> leaf_bounds(const std::vector<const Procedural*>& leaves, const Job& job,
                                       BoundingCounts& counts) const;

  const std::vector<SkinChunk>& pieces() const { return stored_skins_ ? stored_skins_->pieces() : pieces_; }
  void divide_skins(const Job& job);
  void collect(const Procedural& procedural, uint32_t part, uint32_t coat);

  const RenderScene& scene_;
  BoundingStrategy bounds_;
  std::vector<std::unique_ptr<Procedural>> made_;  // intermediate procedurals of splitting
  std::vector<const Procedural*> leaves_;
  std::vector<uint32_t> parts_;      // index in RenderScene::fur, by leaf
  std::vector<StrandScale> scales_;  // by coat; a coat is a procedural of the scene, before splitting
  std::vector<uint32_t> coats_;      // index in scales_, by leaf
  std::vector<SkinChunk> pieces_;    // of the skins that this object has divided
  std::unique_ptr<const StoredSkins> stored_skins_;  // has all pieces; null: pieces_ has them
  mutable std::atomic<int64_t> strands_grown_{0}, strands_regrown_{0};
  std::unique_ptr<std::atomic<bool>[]> was_grown_;    // by leaf
  std::unique_ptr<std::atomic<uint32_t>[]> growths_;  // by leaf
};

}  // namespace pelage
