// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pelage {

/// Whether the bytes are a PNG or JPEG file that ends before its end marker. Decoders fill what is missing of
/// a JPEG with grey and say nothing; of a PNG they leak memory. False for everything else.
bool is_cut_short(std::string_view file);

}  // namespace pelage
