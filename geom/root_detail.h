// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "geom/strands.h"

namespace pelage {

/// What a strand of a thinned coat knows of its root: the line of the skin's normal there when the shutter
/// opens, off by up to a degree, and the share of the strands that are kept there. Three bytes, packed.
///
/// Strands carry it as one of their attributes, so that it goes wherever they go: into batches, chunks and
/// files, and to the one strand that was hit. Only here is it known how.
class RootDetail {
 public:
  static constexpr size_t kFloats = 3;  ///< of a strand, as attributes are counted

  RootDetail(const V3f& normal, float share);

  /// Unit; of the two directions either.
  V3f normal() const;
  /// In (0, 1]; finer the less it is, and 1 stays 1.
  float share() const { return root_of_share_ * root_of_share_; }

  /// One for each strand.
  static Strands added(Strands strands, const std::vector<RootDetail>& details);
  /// Of one strand; nothing where the strands have none.
  static std::optional<RootDetail> of(const Strands& strands, size_t strand);

 private:
  RootDetail(const V2f& line, float root_of_share) : line_(line), root_of_share_(root_of_share) {}

  V2f line_;
  float root_of_share_;
};

}  // namespace pelage
