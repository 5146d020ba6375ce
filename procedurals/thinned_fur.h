// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "procedurals/bounds/procedural.h"
#include "procedurals/detail/coat_detail.h"

namespace pelage {

/// A chunk of a coat with reduced level of detail. It has the kept strands of one leaf or of several
/// consecutive leaves; for a distant character, of all leaves. Strands that are not kept are never grown.
class ThinnedFurProcedural final : public Procedural {
 public:
  /// Returns all leaves of the coat as chunks of consecutive leaves. A chunk has at most as many candidates
  /// (CoatDetail::candidates()) as the largest leaf has strands.
  static std::vector<std::unique_ptr<Procedural>> divide(std::shared_ptr<const CoatDetail> detail,
                                                         std::shared_ptr<const PosedCharacterSkin> skin);

  /// Makes chunk `index` of the `count` chunks of a coat, with the leaves first <= leaf < end.
  ThinnedFurProcedural(std::shared_ptr<const CoatDetail> detail,
                       std::shared_ptr<const PosedCharacterSkin> skin, size_t first, size_t end, size_t index,
                       size_t count);

  Box3f bound(BoundSpan span) const override;
  Strands generate() const override;
  StrandCounts counts() const override;
  StrandScale scale() const override;
  size_t temporary_bytes() const override;
  ChunkBounds exact_bounds(BoundSpan span, int keys) const override;
  std::optional<ContentHash> content() const override;
  std::optional<BoundsRecord> bounds_record() const override;
  size_t bytes() const override { return sizeof(*this); }

 private:
  template <class Use>
  auto in_pose(BoundSpan span, const Use& use) const;
  Strands grow(const SkinPose& pose) const;
  ContentHash coat() const;

  std::shared_ptr<const CoatDetail> detail_;
  std::shared_ptr<const PosedCharacterSkin> skin_;
  size_t first_, end_;
  size_t index_, count_;
};

}  // namespace pelage
