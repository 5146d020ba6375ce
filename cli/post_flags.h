// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/options.h"

namespace CLI {
class App;
}

namespace pelage {

/// Values of flags of motionblur and stereo, as text. interpret_post() validates them instead of the
/// command-line library, so that all error messages have the style of Pelage.
struct PostTexts {
  std::string units, up, filter, eye, convergence;
  std::string motion_layer, depth_layer;
  std::vector<std::string> data, colors;
  float vector_scale = 1;
  int scale = 0;  // 0: the default of the tool
};

void add_motion_blur_flags(CLI::App& command, Options& options, PostTexts& texts);
void add_stereo_flags(CLI::App& command, Options& options, PostTexts& texts);

/// Validates the texts and sets the members of `options`. Throws Error (kArguments).
void interpret_post(const PostTexts& texts, Options& options);

}  // namespace pelage
