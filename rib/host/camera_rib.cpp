// SPDX-License-Identifier: Apache-2.0
#include "rib/host/camera_rib.h"

#include <algorithm>
#include <cmath>

#include "world/frame_coats.h"

namespace pelage {
namespace {

/// Two factors of the samples of a pixel, as equal as possible.
V2f sample_grid(int samples) {
  int x = 1;
  for (int i = 1; i * i <= samples; ++i) {
    if (samples % i == 0) x = i;
  }
  return V2f(static_cast<float>(samples / x), static_cast<float>(x));
}

bool moves(const CameraParams& camera) {
  const bool still = camera.position.is_constant() && camera.look_at.is_constant() && camera.up.is_constant();
  return !still && camera.shutter.y > camera.shutter.x;
}

void write_clipping(RibWriter& rib, const V3f& eye, const Box3f& content) {
  constexpr float kNear = 1e-5f;  // of the far distance
  float far_distance = 1e5f;
  if (!content.isEmpty()) {
    V3f farthest;
    for (int axis = 0; axis < 3; ++axis)
      farthest[axis] = std::max(eye[axis] - content.min[axis], content.max[axis] - eye[axis]);
    far_distance = 1.1f * farthest.length();
  }
  rib.request("Clipping").number(kNear * far_distance).number(far_distance);
}

void write_transform(RibWriter& rib, const SceneDescription& scene, const CameraParams& camera,
                     double frame) {
  std::vector<float> times{0};
  if (moves(camera)) {
    times = motion_times(camera, camera.motion_keys);
    rib.request("MotionBegin").numbers(times);
  }
  for (const float time : times) {
    const Camera at(camera, frame + static_cast<double>(time), scene.image.width, scene.image.height);
    const M44f matrix = at.world_to_camera();
    rib.request("ConcatTransform").numbers(std::span(&matrix[0][0], 16));
  }
  if (moves(camera)) rib.request("MotionEnd");
}

}  // namespace

void write_camera(RibWriter& rib, const SceneDescription& scene, const CameraParams& camera, double frame,
                  const Box3f& content, const std::string& picture) {
  const float aspect = static_cast<float>(scene.image.width) / static_cast<float>(scene.image.height);
  rib.request("Format").integer(scene.image.width).integer(scene.image.height).number(1);
  const V2f grid = sample_grid(scene.render.samples);
  rib.request("PixelSamples").number(grid.x).number(grid.y);
  rib.request("Shutter").number(camera.shutter.x).number(camera.shutter.y);
  write_clipping(rib, camera.position.at(frame), content);
  if (const float stops = camera.exposure.at(frame); stops != 0)
    rib.request("Exposure").number(std::exp2(stops)).number(1);
  if (const std::optional<LensParams> lens = camera.lens_at(frame, aspect)) {
    rib.request("DepthOfField").number(lens->f_stop).number(lens->focal_length);
    rib.number(lens->focus_distance);
  }
  const float half = camera.is_orthographic() ? 0.5f * camera.height_at(frame, aspect) : 1;
  const float right = 2 * half * aspect * camera.shift.x, up = 2 * half * camera.shift.y;
  rib.request("ScreenWindow").number(right - half * aspect).number(right + half * aspect);
  rib.number(up - half).number(up + half);
  if (camera.is_orthographic()) {
    rib.request("Projection").text("orthographic");
  } else {
    rib.request("Projection").text("perspective").parameter("float fov");
    rib.numbers({camera.fov_at(frame, aspect)});
  }
  rib.request("Display").text(picture).text("exr").text("rgba");
  // Floats. Binary readers take 0 for an integer only if it is written as one.
  rib.request("Quantize").text("rgba").integer(0).integer(0).integer(0).number(0);
  write_transform(rib, scene, camera, frame);
}

}  // namespace pelage
