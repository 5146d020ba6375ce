// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "base/progress.h"
#include "image/exr.h"
#include "world/scene_schema.h"

namespace CLI {
class App;
}

namespace pelage {

struct Options;

/// Flags of `render` that concern the picture as a whole.
struct PictureOptions {
  std::optional<int> samples;      ///< --samples
  std::optional<double> scale;     ///< --scale: factor of the width and the height
  std::optional<PixelBox> region;  ///< --region: the only pixels to render, in pixels of the scaled picture
  bool preview = false;            ///< --preview
  bool skip_existing = false;      ///< --skip-existing: render no frame whose file is complete
  bool estimate = false;           ///< --estimate: print memory and time instead of rendering
};

/// Values of these flags that are still text.
struct PictureTexts {
  std::string region;
  std::optional<double> time_limit;
};

void add_picture_flags(CLI::App& render, PictureOptions& picture, PictureTexts& texts);

/// Reads the texts, and adds the overrides of the flags that set scene values. Throws Error (kArguments).
void interpret_picture(const PictureTexts& texts, Options& options);

/// Reads the scene at the size and with the samples that the flags state, and shows its warnings. A preview
/// has a quarter of the width and height and at most kPreviewSamples samples per pixel, unless `--scale` or
/// `--samples` state other values. Throws the errors of load_scene(), and Error (kArguments) if the region
/// is not inside the picture.
SceneDescription read_picture_scene(const Options& options, Progress& progress);

inline constexpr int kPreviewSamples = 4;

}  // namespace pelage
