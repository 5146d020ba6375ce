// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/options.h"

namespace CLI {
class App;
}

namespace pelage {

/// Flags of motionblur and stereo that stay text until they are validated, so that all error messages come
/// from Pelage.
struct PostTexts {
  std::string units, up, filter, eye, convergence;
  std::string motion_layer, depth_layer;
  std::vector<std::string> data, colors;
  float vector_scale = 1;
  int scale = 0;  // 0: the tool's default
};

void add_motion_blur_flags(CLI::App& command, Options& options, PostTexts& texts);
void add_stereo_flags(CLI::App& command, Options& options, PostTexts& texts);

/// Throws Error (kArguments).
void interpret_post(const PostTexts& texts, Options& options);

}  // namespace pelage
