// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>

namespace pelage {

/// Returns whether the stream is a PNG or JPEG file that ends before its end marker. Returns false for all
/// other formats. Decoders silently fill the missing rest of a JPEG with grey, and leak memory for a
/// truncated PNG.
bool is_cut_short(std::istream& file);

/// Returns the memory in bytes for decoding an interlaced PNG or a progressive JPEG. Decoders decode such a
/// file completely before they return its first row. Returns 0 for all other files.
int64_t interlaced_bytes(std::istream& file);

}  // namespace pelage
