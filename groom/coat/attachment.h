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

/// Whether the strands of a file follow the skin of their groom. kAuto: they follow it unless they start too
/// far from it (SkinGaps::far).
enum class Attachment { kAuto, kSkin, kNone };
template <>
struct EnumNames<Attachment> {
  static constexpr const char* names[] = {"auto", "skin", "none"};
};

/// Distances from the roots of a file's strands to a skin, in scene units.
struct SkinGaps {
  float min = 0, median = 0, max = 0;
  float skin_size = 0;  ///< length of the diagonal of the skin's box

  /// Returns the statistics of `gaps`, which holds the distance of each strand. Reorders `gaps`. `skin` is
  /// the box of the skin.
  static SkinGaps of(std::vector<float>& gaps, const Box3f& skin);

  /// Distance from the skin that counts as far, as a fraction of skin_size. Strands made for a skin start on
  /// it or slightly above or below it. Strands in another unit or for another character start farther away.
  static constexpr float kNear = 0.1f;
  /// Whether at least half of the strands start farther away than kNear * skin_size.
  bool far() const { return median > kNear * skin_size; }
  /// Returns a text such as "begin 97 to 103 units from skin 'rat', which is 5.2 units across".
  std::string describe(const std::string& skin) const;
};

struct GroomParams;

/// Binds every strand of `params.strands_file` to the skin. `positions` holds the position of each root. Sets
/// `roots` to the nearest points of the skin, and `positions` to the positions of these points. Returns
/// false, with unchanged positions, when the strands shall not follow the skin: with kNone, or with kAuto
/// when they are too far from it or all faces are holes. With kAuto, also warns the user through `job`.
/// Throws Error (kInput) with kSkin when all faces of the skin are holes.
bool follow_skin(const GroomParams& params, const LimitSurface& rest, const Job& job,
                 std::vector<V3f>& positions, std::vector<RootAddress>& roots);

}  // namespace pelage
