// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "groom/strands/strand_batch.h"

namespace pelage {

/// Options for coding the widths and colours of a coat. Its operators determine them.
struct CodeOptions {
  /// Whether all strands share one width profile. If so, the profile has 16 bits per point, otherwise 8.
  bool one_width_profile = false;
};

/// The integers that a cache stores for the strands of a batch. Namespace codes, below, defines their
/// meaning.
///
/// Every integer depends on its strand alone, not on the batch, the leaf, or other strands in it. A strand is
/// therefore decoded to the same values however a coat is divided into leaves.
class StrandCodes {
 public:
  enum Column : size_t { kClump, kWidthScale, kWidthProfile, kColorScale, kColorHue, kColorProfile };
  static constexpr size_t kColumns = 6;

  /// Codes the strands of a batch, which must be in rest space after the frozen operators.
  StrandCodes(const StrandBatch& batch, const CodeOptions& options);

  size_t count = 0, points = 0;
  size_t color_rows = 0;  ///< number of colours per strand: 0, 1, or the number of points
  bool has_base = false;  ///< whether some strand does not start at its root
  bool clumped = false;   ///< whether some strand belongs to a clump
  /// Whether some strand cannot be represented by the codes. The whole batch is then stored as floats. For
  /// strands that can be represented, these floats are the decoded codes.
  bool plain = false;

  std::vector<uint16_t>
      steps;  ///< size of the step of each strand, as small floats (groom/cache/small_float.h)
  std::vector<int16_t> shape;  ///< [point][axis][strand]: offset from the previous decoded point, in steps
  /// Codes of each column, strand by strand. Plain batches have only the column kClump.
  std::array<std::vector<std::byte>, kColumns> columns;
  /// Plain batches: rows over strands, first [point][axis] of shapes, then [point] of radii, then
  /// [row][channel] of colours.
  std::vector<float> floats;

 private:
  float* shape_row(size_t r) { return &floats[r * count]; }
  float* radius_row(size_t p) { return shape_row(points * 3 + p); }
  float* color_row(size_t r) { return shape_row(points * 4 + r); }
  void take_floats(const StrandBatch& batch);
  // The following functions code strand `s`. They return whether the codes can represent it.
  bool code_shape(size_t s);
  bool code_widths(size_t s, const CodeOptions& options);
  bool code_colors(size_t s);
  /// Replaces the floats of a strand by its decoded codes.
  void decode(size_t s, const CodeOptions& options);
};

/// Functions that decode the codes. They define the meaning of the codes.
namespace codes {

/// Max component of the offset between two successive points, in steps.
inline constexpr float kLargestStep =
    32766.0f;  // one less than the max of int16_t, because the previous point is rounded

/// Random number of the strand's clump.
inline float clump(uint16_t code) { return (code + 0.5f) * 0x1p-16f; }
inline uint16_t clump_code(float clump) { return static_cast<uint16_t>(clump * 65536.0f); }
/// Width at a point relative to the max width of the strand.
inline float width_ratio(uint8_t code) { return code / 255.0f; }
inline float width_ratio(uint16_t code) { return code / 65535.0f; }
/// Max of a channel over a strand, relative to the max over all channels. The code holds the square root of
/// this ratio, in ten bits per channel.
inline float hue(uint32_t code, int channel) {
  const float root = static_cast<float>(code >> (10 * channel) & 1023u) / 1023.0f;
  return root * root;
}
/// Channel of a colour relative to the max of this channel over the strand.
inline float color_ratio(int16_t code) { return code / 32767.0f; }

}  // namespace codes
}  // namespace pelage
