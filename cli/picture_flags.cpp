// SPDX-License-Identifier: Apache-2.0
#include "cli/picture_flags.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include "base/nearest_name.h"
#include "cli/number_checks.h"
#include "cli/options.h"
#include "cli/read_scene.h"
#include "render/render_frame.h"
#include "world/dark_lights.h"

namespace pelage {
namespace {

constexpr double kPreviewScale = 0.25;

PixelBox parse_region(const std::string& text) {
  int corners[4] = {};
  const char *at = text.data(), *end = at + text.size();
  for (int i = 0; i < 4; ++i) {
    const auto [stop, error] = std::from_chars(at, end, corners[i]);
    const bool last = i == 3;
    if (error != std::errc() || (last ? stop != end : stop == end || *stop != ','))
      throw Error(ErrorKind::kArguments,
                  "--region: expected four pixels X0,Y0,X1,Y1 such as 0,0,160,90, got " + quote(text));
    at = last ? stop : stop + 1;
  }
  return {corners[0], corners[1], corners[2], corners[3]};
}

int scaled(int pixels, double scale) {
  return std::max(1, static_cast<int>(std::min(std::round(pixels * scale), 1e9)));
}

}  // namespace

void add_picture_flags(CLI::App& render, PictureOptions& picture, PictureTexts& texts) {
  render.add_option("--samples", picture.samples, "Samples per pixel (sets render.samples)")
      ->check(CLI::Range(1, 1 << 20))
      ->type_name("N");
  render.add_option("--scale", picture.scale, "Factor on the picture's width and height, such as 0.25")
      ->check(positive_number())
      ->type_name("FACTOR");
  render
      .add_option("--region", texts.region,
                  "Render only these pixels: X0 to X1 - 1, Y0 to Y1 - 1, from the upper left corner")
      ->type_name("X0,Y0,X1,Y1");
  render.add_flag(
      "--preview", picture.preview,
      fmt::format("A quarter of the width and height, and at most {} samples per pixel", kPreviewSamples));
  render
      .add_option("--time-limit", texts.time_limit,
                  "Time limit of a frame in seconds (sets render.time_limit)")
      ->check(positive_number())
      ->type_name("SECONDS");
  render.add_flag("--skip-existing", picture.skip_existing, "Skip the frames whose file is already complete");
}

void interpret_picture(const PictureTexts& texts, Options& options) {
  if (options.picture.samples)
    options.overrides.push_back({"render.samples", fmt::format("{}", *options.picture.samples)});
  if (texts.time_limit)
    options.overrides.push_back({"render.time_limit", fmt::format("{}", *texts.time_limit)});
  if (!texts.region.empty()) options.picture.region = parse_region(texts.region);
}

SceneDescription read_picture_scene(const Options& options, Progress& progress) {
  const PictureOptions& picture = options.picture;
  Options resized = options;
  const RibUse use = rib_use(options.rib_in);
  if (picture.scale || picture.preview) {
    const SceneDescription whole = load_scene(options.input, options.overrides, use);
    const double scale = picture.scale.value_or(kPreviewScale);
    const auto set = [&](const char* key, int value) {
      resized.overrides.push_back({key, fmt::format("{}", value)});
    };
    set("image.width", scaled(whole.image.width, scale));
    set("image.height", scaled(whole.image.height, scale));
    if (picture.preview && !picture.samples)
      set("render.samples", std::min(whole.render.samples, kPreviewSamples));
  }
  SceneDescription scene = read_scene(resized, progress, use);
  if (const auto dark = why_dark(scene)) progress.warn(options.input + ": " + *dark);
  if (picture.region) check_region(scene.image, scene.render, *picture.region);
  return scene;
}

}  // namespace pelage
