// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "geom/root_detail.h"
#include "geom/strand_scale.h"
#include "groom/groom.h"
#include "lod/simplification.h"
#include "procedurals/coat_direction.h"
#include "procedurals/posed_character_skin.h"

namespace pelage {

/// Selects the strands of one coat on one character that are worth growing. The decision for each strand
/// depends only on its own root at shutter open and close, never on leaves, boxes, rays or threads.
///
/// Immutable. Thread safety: const members may be called from any thread.
class CoatDetail {
 public:
  /// `direction` distinguishes blur along strands from blur across them; null: directions are unknown.
  CoatDetail(std::shared_ptr<const Groom> groom, const PosedCharacterSkin& skin,
             const Simplification& simplification, std::shared_ptr<const CoatDirection> direction);

  const Groom& groom() const { return *groom_; }
  const Simplification& simplification() const { return simplification_; }

  /// Number of strands of a leaf, counted from the first, that may be kept. The others are never kept.
  size_t candidates(size_t leaf) const;

  /// The strands kept of a leaf.
  struct Choice {
    std::vector<uint32_t> strands;  ///< indices in the leaf
    std::vector<float> width;
    std::vector<float> contrast;
    std::vector<RootDetail> detail;
    std::vector<float> tolerance;  ///< tolerance of with_fewer_points()
    KeptStrands kept() const { return {strands, width, contrast}; }
  };
  /// `pose` must contain the faces of the candidates.
  Choice choose(size_t leaf, const SkinPose& pose) const;

  /// Upper bound of the width factor of all strands; lower bound for strands that do not fade.
  float max_width_factor() const { return max_width_factor_; }
  float min_width_factor() const { return min_width_factor_; }

 private:
  std::shared_ptr<const Groom> groom_;
  Simplification simplification_;
  std::shared_ptr<const CoatDirection> direction_;
  float first_out_ = 1;  // no strand with this priority or a larger one is kept
  float max_width_factor_ = 1, min_width_factor_ = 1;
};

/// Scale of a whole coat. `detail`: null if every strand is grown.
StrandScale coat_scale(const Groom& groom, const PosedCharacterSkin& skin, const CoatDetail* detail);

}  // namespace pelage
