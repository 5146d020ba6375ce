// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "image/exr.h"

namespace pelage {

/// Returns the layer to which a channel belongs, among all channels: "RGBA" for R, G, B and A, "key.diffuse"
/// for key.diffuse.R, and the channel's own name where it has no dot, or where its part before the dot is a
/// channel.
std::string layer_of(const std::string& channel, const std::vector<std::string>& all);

/// Makes one array (height, width, channels) for each layer, of float32, or uint32 for counts and ids.
pybind11::dict layer_arrays(std::vector<ExrChannel> channels, int width, int height);

}  // namespace pelage
