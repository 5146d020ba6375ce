// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "render/accel/fur/snapped_strands.h"

namespace pelage {

/// The header of a block. A block stores four segments, one per lane. The leaves of a tree consist of blocks,
/// which have the only copy of the points.
///
/// After the header, a block has for each motion key the coordinates, indexed [axis][Bezier point][lane], and
/// the radii, indexed [Bezier point][lane]. A narrow block stores coordinates as 16-bit differences from the
/// block's origin, and a radius k^2 / 256 as the 8-bit number k. A wide block stores coordinates and radii as
/// floats. A wide block is used only if a segment is too large for a narrow block. Narrow and wide blocks of
/// the same segments decode to the same bits.
struct FurBlockHeader {
  static constexpr uint32_t kNone = ~0u;  ///< segment number of an empty lane, whose points are all equal
  static constexpr size_t kLanes = 4;

  int32_t origin[3];
  uint32_t unused;
  uint32_t number[kLanes];  ///< segment numbers as in SnappedStrands
};
static_assert(sizeof(FurBlockHeader) == 32);

/// Sizes in bytes: of the coordinates along one axis and of the radii, at one motion key.
struct FurBlockSizes {
  size_t axis, radii;
  constexpr size_t key() const { return 3 * axis + radii; }
  constexpr size_t block(int motion_keys) const {
    return sizeof(FurBlockHeader) + static_cast<size_t>(motion_keys) * key();
  }
};
inline constexpr FurBlockSizes kNarrowBlock{32, 16}, kWideBlock{64, 64};

/// Input of write_block(): one to four segments at all motion keys.
struct FurBlockContents {
  std::array<uint32_t, FurBlockHeader::kLanes> numbers{FurBlockHeader::kNone, FurBlockHeader::kNone,
                                                       FurBlockHeader::kNone, FurBlockHeader::kNone};
  std::span<const SnappedSegment> segments;  ///< lane by lane; for each lane all keys
};

/// Whether a narrow block can represent these segments.
bool fits_narrow_block(const FurBlockContents& contents);
/// Writes a block. `out` must have FurBlockSizes::block(motion_keys) bytes. If `wide` is false, the contents
/// must fit a narrow block.
void write_block(const FurBlockContents& contents, int motion_keys, bool wide, std::byte* out);
/// Reads the segment in one lane at one motion key.
SnappedSegment read_block(const std::byte* block, bool wide, size_t lane, int key);

}  // namespace pelage
