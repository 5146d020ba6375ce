// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "procedurals/bounds/procedural.h"
#include "procedurals/detail/coat_detail.h"
#include "procedurals/skin/posed_character_skin.h"

namespace pelage {

/// The coat of one groom on one character. Without level of detail, it splits into one FurLeafProcedural per
/// leaf of the groom's follicle tree.
class FurProcedural final : public Procedural {
 public:
  /// If `lod` is given, reduces the level of detail (see CoatDetail for `direction`). The coat then splits
  /// into ThinnedFurProcedurals, each of which has the kept strands of one or more leaves.
  FurProcedural(std::shared_ptr<const Groom> groom, std::shared_ptr<const PosedCharacterSkin> skin,
                const std::optional<Simplification>& lod = {},
                std::shared_ptr<const CoatDirection> direction = {});

  Box3f bound(BoundSpan span) const override;
  std::vector<std::unique_ptr<Procedural>> split() const override;
  /// Returns all strands of the coat, chunk by chunk, for tools that need a single batch.
  Strands generate() const override;
  StrandCounts counts() const override;
  StrandScale scale() const override;
  ChunkBounds exact_bounds(BoundSpan span, int keys) const override;

  const Groom& groom() const { return *groom_; }
  const PosedCharacterSkin& skin() const { return *skin_; }
  /// Returns the reduction of detail; null if every strand is grown.
  const CoatDetail* detail() const { return detail_.get(); }

 private:
  std::shared_ptr<const Groom> groom_;
  std::shared_ptr<const PosedCharacterSkin> skin_;
  std::shared_ptr<const CoatDetail> detail_;  // null: every strand is grown
};

/// One leaf of a coat with all its strands. It is one chunk.
class FurLeafProcedural final : public Procedural {
 public:
  FurLeafProcedural(std::shared_ptr<const Groom> groom, std::shared_ptr<const PosedCharacterSkin> skin,
                    size_t leaf);

  Box3f bound(BoundSpan span) const override;
  Strands generate() const override;
  StrandCounts counts() const override;
  StrandScale scale() const override;
  ChunkBounds exact_bounds(BoundSpan span, int keys) const override;
  std::optional<ContentHash> content() const override;
  /// The boxes are stored beside the cache of the groom, in one file for all leaves of the coat.
  std::optional<BoundsRecord> bounds_record() const override;
  size_t bytes() const override { return sizeof(*this); }

 private:
  std::shared_ptr<const Groom> groom_;
  std::shared_ptr<const PosedCharacterSkin> skin_;
  size_t leaf_;
};

}  // namespace pelage
