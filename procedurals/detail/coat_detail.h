// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "geom/root_detail.h"
#include "geom/strand_scale.h"
#include "groom/groom.h"
#include "lod/simplification.h"
#include "procedurals/detail/coat_direction.h"
#include "procedurals/skin/posed_character_skin.h"

namespace pelage {

/// Selects the strands of one coat on one character that level of detail keeps. The decision for a strand
/// depends only on its priority and on its root at shutter open and close. It never depends on leaves, boxes,
/// rays or threads.
///
/// Immutable. Thread safety: const members may be called from any thread.
class CoatDetail {
 public:
  /// `direction`: mean directions of the strands, to separate blur along strands from blur across them; null:
  /// unknown.
  CoatDetail(std::shared_ptr<const Groom> groom, const PosedCharacterSkin& skin,
             const Simplification& simplification, std::shared_ptr<const CoatDirection> direction);

  const Groom& groom() const { return *groom_; }
  const Simplification& simplification() const { return simplification_; }

  /// Returns a number n such that only the first n strands of a leaf can be kept. choose() decides which of
  /// them are kept.
  size_t candidates(size_t leaf) const;

  /// The kept strands of a leaf. All lists have one item per kept strand.
  struct Choice {
    std::vector<uint32_t> strands;   ///< indices of the strands in the leaf, ascending
    std::vector<float> width;        ///< factor on the width (Simplification::width_factor())
    std::vector<float> contrast;     ///< factor on the deviation of the colour (Simplification::contrast())
    std::vector<RootDetail> detail;  ///< normal and share at the root
    std::vector<float> tolerance;    ///< tolerance for FewerPoints::refit(), in scene units
    KeptStrands kept() const { return {strands, width, contrast}; }
  };
  /// Returns the kept strands of a leaf. `pose` must contain the faces below the candidates of the leaf.
  Choice choose(size_t leaf, const SkinPose& pose) const;

  /// Returns the data of a root from which its level of detail follows. `pose`: as in choose().
  RootPlace place(size_t follicle, const SkinPose& pose) const;

  /// Returns an upper bound of the width factors of all strands.
  float max_width_factor() const { return max_width_factor_; }
  /// Returns a lower bound of the width factors of all strands that do not fade.
  float min_width_factor() const { return min_width_factor_; }

 private:
  std::shared_ptr<const Groom> groom_;
  Simplification simplification_;
  std::shared_ptr<const CoatDirection> direction_;
  float first_out_ = 1;  // strands with this priority or a larger one are omitted
  float max_width_factor_ = 1, min_width_factor_ = 1;
};

/// Returns the scale of a whole coat. `detail`: null if every strand is grown.
StrandScale coat_scale(const Groom& groom, const PosedCharacterSkin& skin, const CoatDetail* detail);

}  // namespace pelage
