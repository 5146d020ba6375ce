// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "geom/strands.h"

namespace pelage {

/// Root data of a strand in a thinned coat: the line of the skin's normal at shutter open, with an error of
/// up to a degree, and the fraction of strands kept at the root. Packed into three bytes.
///
/// Stored as an attribute of the strands, so that it is copied with them to batches, chunks, files, and the
/// single strand of a hit. Only this class knows the encoding.
class RootDetail {
 public:
  static constexpr size_t kFloats = 3;  ///< per strand, as attributes are counted

  RootDetail(const V3f& normal, float share);

  /// Unit; the sign is arbitrary.
  V3f normal() const;
  /// In (0, 1]; more precise for smaller values, exact for 1.
  float share() const { return root_of_share_ * root_of_share_; }

  /// Adds root data to each strand.
  static Strands added(Strands strands, const std::vector<RootDetail>& details);
  /// The root data of one strand; empty when the strands have none.
  static std::optional<RootDetail> of(const Strands& strands, size_t strand);

 private:
  RootDetail(const V2f& line, float root_of_share) : line_(line), root_of_share_(root_of_share) {}

  V2f line_;
  float root_of_share_;
};

}  // namespace pelage
