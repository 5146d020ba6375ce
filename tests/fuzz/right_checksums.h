// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace pelage {

/// The same bytes as a file of a content store that is in order: header and trailer are made good, sections
/// are moved to where there is something, and every checksum is right. What a reader is protected from by
/// checksums alone reaches it. What is too short for a file comes back as it is.
std::vector<uint8_t> with_right_checksums(std::span<const uint8_t> bytes);

}  // namespace pelage
