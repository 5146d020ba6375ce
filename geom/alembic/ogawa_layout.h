// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace pelage {

// An Ogawa file begins with "Ogawa", 0xff once the file is complete, the version in two bytes (0 and 1), and
// the position of the first group.
inline constexpr char kOgawaBeginning[16] = {'O', 'g', 'a', 'w', 'a', 0, 0, 1};
inline constexpr size_t kOgawaMark = 5;                                       ///< length of "Ogawa"
inline constexpr size_t kOgawaClosed = 5, kOgawaVersion = 6, kOgawaRoot = 8;  ///< positions
inline constexpr char kOgawaClosedByte = '\xff';

/// The bit of a word that names a block of data, not a group.
inline constexpr uint64_t kOgawaData = uint64_t(1) << 63;

}  // namespace pelage
