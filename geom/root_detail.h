// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "geom/strands.h"

namespace pelage {

/// Data at the root of a strand of a thinned coat, packed into three bytes. It consists of the line along the
/// skin's normal when the shutter opens, with an error of up to a degree, and of the share: the fraction of
/// the strands at this root that level of detail keeps.
///
/// Stored as an attribute of the strands, so that it is copied with the strands to batches, chunks, files,
/// and the single strand of a hit. Only this class knows how the attribute is encoded.
class RootDetail {
 public:
  static constexpr size_t kFloats = 3;  ///< number of floats per strand of the attribute

  RootDetail(const V3f& normal, float share);

  /// The normal, unit length. Its sign is arbitrary.
  V3f normal() const;
  /// The fraction of strands kept, in (0, 1]. Exact for 1; otherwise, the error is smaller for smaller
  /// values.
  float share() const { return root_of_share_ * root_of_share_; }

  /// Returns `strands` with root data added; `details` holds the data of each strand.
  static Strands added(Strands strands, const std::vector<RootDetail>& details);
  /// Returns the root data of one strand; empty when the strands have none.
  static std::optional<RootDetail> of(const Strands& strands, size_t strand);

 private:
  RootDetail(const V2f& line, float root_of_share) : line_(line), root_of_share_(root_of_share) {}

  V2f line_;
  float root_of_share_;
};

}  // namespace pelage
