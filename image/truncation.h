// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>

namespace pelage {

/// Whether the stream is a PNG or JPEG file that ends before its end marker. Decoders fill what is missing of
/// a JPEG with grey and say nothing; of a PNG they leak memory. False for everything else.
bool is_cut_short(std::istream& file);

/// What decoding an interlaced PNG or a progressive JPEG takes: they are decoded as a whole before the first
/// row is known. 0 for everything else.
int64_t interlaced_bytes(std::istream& file);

}  // namespace pelage
