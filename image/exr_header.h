// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPixelType.h>

#include "image/exr_file.h"

// Conversion between OpenEXR's headers and ours; only for the sources of image/.

namespace pelage {

Imf::PixelType pixel_type(ChannelType type);
ChannelType channel_type(Imf::PixelType type);

/// Rounded to nearest; finite values beyond the range become the largest half, because some readers fail on
/// infinity. Infinity itself stays.
inline half rounded_half(float v) {
  const bool overflows = std::abs(v) > HALF_MAX && std::abs(v) <= std::numeric_limits<float>::max();
  return half(overflows ? std::copysign(HALF_MAX, v) : v);
}

/// Attributes that ExrAttribute can hold, except those that define the shape of the image.
ExrAttributes read_attributes(const Imf::Header& header);
void insert_attributes(Imf::Header& header, const ExrAttributes& attributes);

}  // namespace pelage
