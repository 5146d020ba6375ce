// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPixelType.h>

#include "image/exr_file.h"

// Conversion between the headers of OpenEXR and ExrPart. Include this header only in image/.

namespace pelage {

Imf::PixelType pixel_type(ChannelType type);
ChannelType channel_type(Imf::PixelType type);

/// Rounds a float to the nearest half. Finite values beyond the range of a half become the largest finite
/// half of the same sign, because some readers fail on infinity. Infinity stays infinite.
inline half rounded_half(float v) {
  const bool overflows = std::abs(v) > HALF_MAX && std::abs(v) <= std::numeric_limits<float>::max();
  return half(overflows ? std::copysign(HALF_MAX, v) : v);
}

/// Returns the attributes that ExrAttribute can hold, except for those about the format: windows, channels,
/// compression, tiles, chromaticities and similar ones.
ExrAttributes read_attributes(const Imf::Header& header);
/// Adds attributes to a header; replaces those of the same name.
void insert_attributes(Imf::Header& header, const ExrAttributes& attributes);

}  // namespace pelage
