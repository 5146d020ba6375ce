// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "base/job.h"
#include "procedurals/bounding.h"
#include "render/accel/chunk_grower.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// The chunks of a frame: first the leaves of all coats, then the pieces of all skins. Makes each chunk from
/// the scene, which must outlive this object.
class FrameChunks final : public ChunkGrower {
 public:
  /// Splits every coat down to its leaves and divides skins. To divide skins, it poses whole skins, a few at
  /// a time, and charges their memory to the ledger meanwhile. Throws Error (kInput) for a coat whose
  /// material is not for fibres, Error (kMemory) when a single skin does not fit `render.memory`.
  FrameChunks(const RenderScene& scene, const Job& job);

  ChunkContents grow(uint32_t chunk) const override;
  bool is_skin(uint32_t chunk) const override { return chunk >= leaves_.size(); }
  uint32_t part(uint32_t chunk) const override {
    return is_skin(chunk) ? pieces_[chunk - leaves_.size()].skin : parts_[chunk];
  }
  ChunkCounts counts(uint32_t chunk) const override;
  StrandScale scale(uint32_t chunk) const override;
  /// Name of the chunk's coat or skin, such as "walker.under".
  std::string name(uint32_t chunk) const override;

  size_t size() const { return leaves_.size() + pieces_.size(); }
  /// The leaves: chunks 0, 1, 2 ...
  const std::vector<const Procedural*>& leaves() const { return leaves_; }
  /// Computes the boxes of all chunks with the strategy of the scene. The box of a skin is the hull of its
  /// control points. `counts` receives the counts of the leaves. Passes on errors of growth; throws Error
  /// (kMemory) before growing anything that does not fit. When cancelled, chunks have no boxes.
  std::vector<ChunkBounds> bounds(const Job& job, BoundingCounts& counts) const;
  /// Whether strands are stored in fur trees. Chunks with fur trees need no boxes of parts.
  bool in_fur_trees() const;
  /// Memory of the descriptions of the chunks, grown or not.
  size_t bytes() const;
  /// Whether the material of every coat is opaque everywhere.
  bool opaque() const;
  /// Number of strands that grow() has made so far.
  int64_t strands_grown() const { return strands_grown_.load(std::memory_order_relaxed); }

 private:
  struct SkinChunk {
    uint32_t skin = 0;  // of RenderScene::skins
    SkinPiece piece;
    size_t temporary_bytes = 0;
  };

  /// Concurrency and memory of measuring leaves within `render.memory`.
  struct MeasurePlan {
    int concurrency = 1;
    size_t block = 0;  // memory of a block of strands during the operators
  };
  MeasurePlan measure_plan(const Job& job) const;

  void divide_skins(const Job& job);
  void collect(const Procedural& procedural, uint32_t part, uint32_t coat);

  const RenderScene& scene_;
  std::vector<std::unique_ptr<Procedural>> made_;  // intermediate procedurals of splitting
  std::vector<const Procedural*> leaves_;
  std::vector<uint32_t> parts_;      // of RenderScene::fur, per leaf
  std::vector<StrandScale> scales_;  // of coats: of the scene's procedurals, before splitting
  std::vector<uint32_t> coats_;      // per leaf
  std::vector<SkinChunk> pieces_;
  mutable std::atomic<int64_t> strands_grown_{0};
};

}  // namespace pelage
