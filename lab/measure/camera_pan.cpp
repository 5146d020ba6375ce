// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/camera_pan.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/error.h"

namespace pelage {

FrameList pan_frames(const SceneDescription& scene, int count) {
  FrameList list;
  const int first = scene.frames.frames.front();
  list.frames.clear();
  for (int frame = first; frame < first + count; ++frame) list.frames.push_back(frame);
  return list;
}

void require_placed(const CameraParams& camera) {
  if (camera.frame.name.empty()) return;
  throw Error(ErrorKind::kInput, camera.frame.position,
              "this experiment moves the camera: give its `position` and `look_at` instead of `frame`");
}

std::vector<std::pair<std::string, std::string>> camera_pan(const SceneDescription& scene, int count) {
  const FrameList list = pan_frames(scene, count);
  const int first = list.frames.front(), last = list.frames.back();
  const CameraParams& camera = scene.camera;
  require_placed(camera);
  const V3d from(camera.position.at(first)), to(camera.look_at.at(first));
  const float aspect = static_cast<float>(scene.image.width) / static_cast<float>(scene.image.height);
  const double height =
      camera.is_orthographic()
          ? double{camera.height_at(first, aspect)}
          : 2 * (to - from).length() * std::tan(camera.fov_at(first, aspect) * std::numbers::pi / 360);
  const V3d step = (to - from).cross(V3d(camera.up.at(first))).normalized() * (height / scene.image.height);
  const auto keys = [&](const V3d& start) {
    const V3d end = start + step * (last - first);
    return fmt::format("{{keys: {{{}: [{:.12g}, {:.12g}, {:.12g}], {}: [{:.12g}, {:.12g}, {:.12g}]}}}}",
                       first, start.x, start.y, start.z, last, end.x, end.y, end.z);
  };
  return {{"frames", "'" + print_frames(list) + "'"},
          {"camera.position", keys(from)},
          {"camera.look_at", keys(to)},
          {"camera.up", fmt::format("[{:.9g}, {:.9g}, {:.9g}]", camera.up.at(first).x, camera.up.at(first).y,
                                    camera.up.at(first).z)}};
}

}  // namespace pelage
