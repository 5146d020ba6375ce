// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/value_readers.h"
#include "base/vector.h"

namespace pelage {

class LimitSurface;
struct Job;
struct RootAddress;

/// Whether the strands of a file follow the skin of their groom.
enum class Attachment { kAuto, kSkin, kNone };
template <>
struct EnumNames<Attachment> {
  static constexpr const char* names[] = {"auto", "skin", "none"};
};

/// Distances from the roots of a file's strands to a skin.
struct SkinGaps {
  float min = 0, median = 0, max = 0;
  float skin_size = 0;  ///< diagonal of the skin's box

  /// `gaps`: one per strand, reordered.
  static SkinGaps of(std::vector<float>& gaps, const Box3f& skin);

  /// Fraction of the skin's size. Hair made for a skin starts on it or slightly above or below; a file in
  /// another unit, or for another character, starts farther away than this.
  static constexpr float kNear = 0.1f;
  /// Whether at least half of the strands start farther away than kNear.
  bool far() const { return median > kNear * skin_size; }
  /// "begin 97 to 103 units from skin 'rat', which is 5.2 units across"
  std::string describe(const std::string& skin) const;
};

struct GroomParams;

/// For every strand of `params.strands_file`, finds the point of the skin nearest to its root and moves the
/// root in `positions` to this point. Returns false, with nothing changed, when the strands are not to follow
/// the skin; warns `job` of strands that are too far from it. Throws Error (kInput) when they must follow a
/// skin without faces.
bool follow_skin(const GroomParams& params, const LimitSurface& rest, const Job& job,
                 std::vector<V3f>& positions, std::vector<RootAddress>& roots);

}  // namespace pelage
