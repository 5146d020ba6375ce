// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include "cli/commands.h"
#include "cli/output_files.h"
#include "cli/read_scene.h"
#include "cli/run.h"
#include "render/accel/kept_fur.h"
#include "render/frame/frame_geometry.h"
#include "why/why_json.h"
#include "why/why_picture.h"
#include "why/why_text.h"

namespace pelage {
namespace {

void check_output(const std::string& path, const SceneDescription& scene) {
  if (path.empty()) return;
  if (!is_display_image(path))
    throw Error(ErrorKind::kArguments, "-o " + path + ": the picture is written as .png or .jpg");
  check_replaces_none("-o", path, scene.files);
  prepare_output(path);
}

}  // namespace

int run_why(const Options& options) {
  Run run(options);
  const SceneDescription scene = read_scene(options, run.display());
  check_pixel(scene.image, options.pixel_x, options.pixel_y);
  check_output(options.output, scene);
  const auto assets = run.stage("read", [&] { return load_assets(scene, run.job()); });
  const World world =
      run.stage("pose", [&] { return compose(scene, *assets, scene.frames.frames.front(), run.job()); });
  KeptFur fur;  // so that no leaf is grown only to measure its boxes
  std::unique_ptr<FrameGeometry> geometry;
  const ExplainedFrame frame{scene, *assets, world, geometry, &fur};
  const PixelWhy why = explain_pixel(frame, options.pixel_x, options.pixel_y, run.job());
  if (!options.output.empty()) write_display_image(options.output, why_picture(frame, why, run.job()));
  std::cout << (options.json ? why_json(why) + "\n" : why_text(why));
  run.finish(options);
  return 0;
}

}  // namespace pelage
