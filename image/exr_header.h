// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPixelType.h>

#include "image/exr_file.h"

// Between OpenEXR's headers and ours; for the sources of image/ alone.

namespace pelage {

Imf::PixelType pixel_type(ChannelType type);
ChannelType channel_type(Imf::PixelType type);

/// Rounded to nearest; what a half cannot hold becomes its largest number, because readers choke on
/// infinity. Infinity itself stays.
inline half rounded_half(float v) {
  const bool overflows = std::abs(v) > HALF_MAX && std::abs(v) <= std::numeric_limits<float>::max();
  return half(overflows ? std::copysign(HALF_MAX, v) : v);
}

/// Attributes that ExrAttribute can hold, without those that are the image's own shape.
ExrAttributes read_attributes(const Imf::Header& header);
void insert_attributes(Imf::Header& header, const ExrAttributes& attributes);

}  // namespace pelage
