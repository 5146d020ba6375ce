// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>

namespace pelage {

/// Whether the stream is a PNG or JPEG file that ends before its end marker. Decoders silently fill the
/// missing part of a JPEG with grey, and leak memory for a PNG. False for everything else.
bool is_cut_short(std::istream& file);

/// Memory for decoding an interlaced PNG or a progressive JPEG, which are decoded as a whole before the first
/// row is available. 0 for everything else.
int64_t interlaced_bytes(std::istream& file);

}  // namespace pelage
