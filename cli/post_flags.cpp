// SPDX-License-Identifier: Apache-2.0
#include "cli/post_flags.h"

#include <cmath>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "base/nearest_name.h"
#include "base/value_readers.h"
#include "cli/command_line.h"
#include "cli/number_checks.h"
#include "world/frames.h"

namespace pelage {
namespace {

void add_file_flags(CLI::App& command, Options& options, PostTexts& texts, int usual_scale) {
  command.add_option("IN", options.input, "EXR file to read; %04d is the frame number")
      ->required()
      ->type_name("IN.exr");
  command.add_option("-o,--output", options.output, "EXR file to write; %04d is the frame number")
      ->required()
      ->type_name("OUT.exr");
  command.add_option("--frames", options.frames, "Frames: 1-48, 1-48x2 or 1,5,9-12")->type_name("FRAMES");
  command
      .add_option("--scale", texts.scale,
                  "Samples per pixel along each axis of the work buffer (default: " +
                      std::to_string(usual_scale) + ")")
      ->check(CLI::Range(1, 8))
      ->type_name("1-8");
  command
      .add_option("--depth-layer", texts.depth_layer, "Layer, part or channel that holds depth (default: Z)")
      ->type_name("NAME");
  command
      .add_option("--data-layer", texts.data, "Layer to resample without averaging, such as IDs; repeatable")
      ->allow_extra_args(false)
      ->type_name("NAME");
  command.add_option("--color-layer", texts.colors, "Layer to average regardless of its name; repeatable")
      ->allow_extra_args(false)
      ->type_name("NAME");
}

void add_vector_flags(CLI::App& command, PostTexts& texts, const char* layer, const char* help) {
  const std::string what(layer);
  command.add_option("--" + what + "-layer", texts.motion_layer, help)->type_name("NAME");
  command
      .add_option("--" + what + "-units", texts.units,
                  "Unit of the vectors: pixels (default) or ndc, fractions of the display window")
      ->type_name("UNITS");
  command
      .add_option("--" + what + "-y", texts.up, "Direction of positive v: down (default) or up, as in Nuke")
      ->type_name("down|up");
  command.add_option("--" + what + "-scale", texts.vector_scale, "Factor on the vectors (default: 1)")
      ->type_name("FACTOR");
}

void add_fill_flag(CLI::App& command, PostFileParams& file, const char* help) {
  command.add_option("--fill", file.longest_fill, help)->check(CLI::Range(0, 65535))->type_name("PIXELS");
}

[[noreturn]] void fail(const std::string& message) { throw Error(ErrorKind::kArguments, message); }

/// Whether `text` is the second of two words; false for the first; otherwise an error.
bool is_second(const std::string& flag, const std::string& text, const std::vector<std::string>& words) {
  if (text.empty() || text == words[0]) return false;
  if (text == words[1]) return true;
  fail(flag + " " + quote(text) + " is not known" + suggest(text, words));
}

void check_finite(const std::string& flag, float value) {
  if (!std::isfinite(value)) fail(flag + ": expected a finite number");
}

/// `vectors`: prefix of the vector flags.
void interpret_file(const PostTexts& texts, const std::string& vectors, PostFileParams& file) {
  file.layers.depth = texts.depth_layer;
  file.layers.data = texts.data;
  file.layers.colors = texts.colors;
  file.vectors.is_ndc = is_second(vectors + "-units", texts.units, {"pixels", "ndc"});
  file.vectors.is_y_up = is_second(vectors + "-y", texts.up, {"down", "up"});
  check_finite(vectors + "-scale", texts.vector_scale);
  file.vectors.scale = texts.vector_scale;
  if (texts.scale > 0) file.scale = texts.scale;
}

}  // namespace

void add_motion_blur_flags(CLI::App& command, Options& options, PostTexts& texts) {
  add_file_flags(command, options, texts, options.motion_blur.file.scale);
  ShutterParams& shutter = options.motion_blur.shutter;
  command.add_option("--shutter", shutter.length, "Shutter interval in frames (default: 0.5)")
      ->check(number_between(0, 1000))
      ->type_name("FRAMES");
  command
      .add_option("--shutter-centre", shutter.centre,
                  "Middle of the shutter interval, in frames from the rendered instant (default: 0)")
      ->check(number_between(-1000, 1000))
      ->type_name("FRAMES");
  command.add_option("--steps", shutter.steps, "Time steps (default: one per pixel of motion, 8 to 64)")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  add_fill_flag(command, options.motion_blur.file,
                "Close gaps between two surfaces up to this many pixels (default: 4)");
  add_vector_flags(
      command, texts, "motion",
      "Layer or part that holds the vectors, or two channels as in mv.R,mv.G (default: forward, motion ...)");
}

void add_stereo_flags(CLI::App& command, Options& options, PostTexts& texts) {
  add_file_flags(command, options, texts, options.stereo.file.scale);
  StereoFileParams& stereo = options.stereo;
  command
      .add_option("--eye-separation", stereo.eye_separation,
                  "Distance between the eyes in scene units (default: 6.5 cm, if the file gives its units)")
      ->type_name("D");
  command.add_option("--convergence", texts.convergence, "Distance of zero parallax (default: infinite)")
      ->type_name("Z");
  command
      .add_option("--focal-pixels", stereo.focal_pixels,
                  "Focal length in pixels; overrides the file's camera")
      ->check(positive_number())
      ->type_name("PIXELS");
  command.add_option("--fov", stereo.fov_deg, "Vertical field of view; overrides the file's camera")
      ->check(number_between(0.01, 170))
      ->type_name("DEGREES");
  command.add_option("--eye", texts.eye, "Eye to make: right (default) or left")->type_name("right|left");
  command.add_option("--view", stereo.view, "View of the file to start from (default: left)")
      ->type_name("NAME");
  command.add_option("--filter", texts.filter, "Filter: lanczos (default), which keeps sharpness, or box")
      ->type_name("FILTER");
  add_fill_flag(command, stereo.file,
                "Maximum width of a gap to fill, in pixels; 0 fills none (default: all)");
  add_vector_flags(command, texts, "parallax",
                   "Layer that holds the parallax in pixels; no camera is needed then");
}

void interpret_post(const PostTexts& texts, Options& options) {
  if (options.command == Command::kMotionBlur) {
    interpret_file(texts, "--motion", options.motion_blur.file);
    options.motion_blur.file.layers.motion = texts.motion_layer;
  }
  if (options.command != Command::kStereo) return;
  interpret_file(texts, "--parallax", options.stereo.file);
  options.stereo.parallax = texts.motion_layer;
  check_finite("--eye-separation", options.stereo.eye_separation.value_or(0));
  options.stereo.to_left = is_second("--eye", texts.eye, {"right", "left"});
  if (is_second("--filter", texts.filter, {"lanczos", "box"})) options.stereo.filter = StereoFilter::kBox;
  if (texts.convergence.empty() || texts.convergence == "infinite") return;
  const auto distance = parse_number(texts.convergence);
  if (!distance || !(*distance > 0)) {
    fail("--convergence: expected a distance above 0 or 'infinite', got " + quote(texts.convergence));
  }
  options.stereo.convergence = static_cast<float>(*distance);
}

}  // namespace pelage
