// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "render/camera/camera.h"
#include "render/film/frame_header.h"
#include "render/frame/frame_result.h"

namespace pelage {

/// A layer of a picture: the channels "R", "G", "B" and "A" are the layer "beauty"; "key.diffuse.R" belongs
/// to the layer "key.diffuse"; a channel without a dot, such as "Z", is a layer by itself.
std::string layer_of(const std::string& channel);

/// Some layers of a picture at one moment of its render. Immutable.
struct Picture {
  uint64_t version = 0;  ///< greater for each later picture
  int edit = 0;          ///< ViewStatus::edits of the edit that it shows
  int frame = 1;         ///< of the scene
  int width = 0, height = 0;
  int grid = 1;          ///< see PassState; pixels between those of the grid are still empty
  PixelBox full;         ///< see PassState
  uint32_t samples = 0;  ///< min sample count of a pixel of the grid
  std::map<std::string, std::vector<ExrChannel>> layers;  ///< by name
};

/// A finished frame, from which any layer can be taken.
struct FinishedFrame {
  FrameResult result;
  FrameHeader header;
  Camera camera;
};

/// Returns the layers of a film that `wanted` accepts, by name, and all names of layers in `names`.
std::map<std::string, std::vector<ExrChannel>> film_layers(
    const Film& film, const std::function<bool(const std::string& layer)>& wanted,
    std::vector<std::string>* names = nullptr);

}  // namespace pelage
