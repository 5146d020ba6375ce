// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "groom/strand_batch.h"

namespace pelage {

/// Coding options for widths and colours of a coat, determined by its operators.
struct CodeOptions {
  /// Whether all strands share one width profile. If so, the profile may use 16 bits per point, otherwise 8.
  bool one_width_profile = false;
};

/// The integers that a cache stores for the strands of a batch; namespace codes below defines their meaning.
///
/// Every number is a function of its strand alone, independent of the batch, the leaf, and the other strands
/// in it. A strand is therefore restored identically however a coat is divided into leaves.
class StrandCodes {
 public:
  enum Column : size_t { kClump, kWidthScale, kWidthProfile, kColorScale, kColorHue, kColorProfile };
  static constexpr size_t kColumns = 6;

  /// From a batch in rest space after the frozen operators.
  StrandCodes(const StrandBatch& batch, const CodeOptions& options);

  size_t count = 0, points = 0;
  size_t color_rows = 0;  ///< 0, 1 or the number of points
  bool has_base = false;  ///< some strand does not start at its root
  bool clumped = false;   ///< some strand belongs to a clump
  /// Some strand cannot be represented by the codes. The batch is then stored as floats. For the other
  /// strands, these are the decoded codes.
  bool plain = false;

  std::vector<uint16_t> steps;  ///< small floats, [strand]
  std::vector<int16_t> shape;   ///< in steps relative to the previous decoded point, [point][axis][strand]
  /// Codes, strand by strand; plain batches store only the codes of clumps.
  std::array<std::vector<std::byte>, kColumns> columns;
  std::vector<float> floats;  ///< plain batches: rows [point][axis], [point] of radii, [row][channel]

 private:
  float* shape_row(size_t r) { return &floats[r * count]; }
  float* radius_row(size_t p) { return shape_row(points * 3 + p); }
  float* color_row(size_t r) { return shape_row(points * 4 + r); }
  void take_floats(const StrandBatch& batch);
  // Each returns whether the strand can be represented.
  bool code_shape(size_t s);
  bool code_widths(size_t s, const CodeOptions& options);
  bool code_colors(size_t s);
  /// Replaces a strand's floats by its decoded codes.
  void decode(size_t s, const CodeOptions& options);
};

/// Definition of the codes.
namespace codes {

inline constexpr float kLargestStep =
    32766.0f;  // one less than 16 bits hold, because the previous point is rounded

inline float clump(uint16_t code) { return (code + 0.5f) * 0x1p-16f; }
inline uint16_t clump_code(float clump) { return static_cast<uint16_t>(clump * 65536.0f); }
inline float width_ratio(uint8_t code) { return code / 255.0f; }
inline float width_ratio(uint16_t code) { return code / 65535.0f; }
/// Max of each channel relative to the strand's max. The code has ten bits per channel, for the square root
/// of this ratio.
inline float hue(uint32_t code, int channel) {
  const float root = static_cast<float>(code >> (10 * channel) & 1023u) / 1023.0f;
  return root * root;
}
inline float color_ratio(int16_t code) { return code / 32767.0f; }

}  // namespace codes
}  // namespace pelage
