// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "groom/strand_batch.h"

namespace pelage {

/// How widths and colours of a coat are coded. A function of its operators.
struct CodeOptions {
  /// Strands share the profile of their widths, which then may have 16 bits a point; else 8.
  bool one_width_profile = false;
};

/// What a cache keeps of the strands of a batch, as whole numbers; what each means is in namespace codes
/// below.
///
/// Every number is a function of the strand alone: not of the batch, the leaf, or the other strands in it. So
/// a strand comes out of the cache the same however a coat is cut into leaves.
class StrandCodes {
 public:
  enum Column : size_t { kClump, kWidthScale, kWidthProfile, kColorScale, kColorHue, kColorProfile };
  static constexpr size_t kColumns = 6;

  /// Of a batch in rest space after the frozen operators.
  StrandCodes(const StrandBatch& batch, const CodeOptions& options);

  size_t count = 0, points = 0;
  size_t color_rows = 0;  ///< 0, 1 or as many as points
  bool has_base = false;  ///< some strand does not begin at its root
  bool clumped = false;   ///< some number is not that of a strand in no clump
  /// Some strand does not fit into the codes. Then the batch is kept in floats: those of the strands that do
  /// fit are what their codes would decode to.
  bool plain = false;

  std::vector<uint16_t> steps;  ///< small floats, [strand]
  std::vector<int16_t> shape;   ///< in steps from the decoded point before, [point][axis][strand]
  /// Codes of each strand after the other; but for clumps none of plain batches.
  std::array<std::vector<std::byte>, kColumns> columns;
  std::vector<float> floats;  ///< of plain batches: rows [point][axis], [point] of radii, [row][channel]

 private:
  float* shape_row(size_t r) { return &floats[r * count]; }
  float* radius_row(size_t p) { return shape_row(points * 3 + p); }
  float* color_row(size_t r) { return shape_row(points * 4 + r); }
  void take_floats(const StrandBatch& batch);
  // Each says whether the strand fits.
  bool code_shape(size_t s);
  bool code_widths(size_t s, const CodeOptions& options);
  bool code_colors(size_t s);
  /// Puts what its codes mean in place of a strand's floats.
  void decode(size_t s, const CodeOptions& options);
};

/// What the codes mean.
namespace codes {

inline constexpr float kLargestStep = 32766.0f;  // one less than 16 bits hold: rounding of the point before

inline float clump(uint16_t code) { return (code + 0.5f) * 0x1p-16f; }
inline uint16_t clump_code(float clump) { return static_cast<uint16_t>(clump * 65536.0f); }
inline float width_ratio(uint8_t code) { return code / 255.0f; }
inline float width_ratio(uint16_t code) { return code / 65535.0f; }
/// Of the channel's largest, relative to the strand's: ten bits each, of the root.
inline float hue(uint32_t code, int channel) {
  const float root = static_cast<float>(code >> (10 * channel) & 1023u) / 1023.0f;
  return root * root;
}
inline float color_ratio(int16_t code) { return code / 32767.0f; }

}  // namespace codes
}  // namespace pelage
