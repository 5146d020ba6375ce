// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/lod_cases.h"

#include <fmt/format.h>

#include "lab/measure/camera_pan.h"

namespace pelage {
namespace {

constexpr float kDistances[] = {2, 4};
constexpr int64_t kOtherSeed = 7001;

double frame_of(const SceneDescription& scene) { return scene.frames.frames.front(); }

std::string text(const V3f& v) { return fmt::format("[{:.9g}, {:.9g}, {:.9g}]", v.x, v.y, v.z); }

V3f away(const SceneDescription& scene, float factor) {
  require_placed(scene.camera);
  const V3f to = scene.camera.look_at.at(frame_of(scene));
  return to + (scene.camera.position.at(frame_of(scene)) - to) * factor;
}

Settings from(const SceneDescription& scene, float factor) {
  Settings view{{"camera.position", text(away(scene, factor))}};
  if (scene.camera.lens)
    view.emplace_back("camera.lens.focus_distance",
                      fmt::format("{:.9g}", scene.camera.lens->focus_distance * factor));
  return view;
}

/// Enables the given criteria.
Settings ideas(bool motion, bool focus, bool back_facing, bool contrast, bool points) {
  const auto word = [](bool on) { return std::string(on ? "true" : "false"); };
  return {{"render.lod.motion_blur", word(motion)},
          {"render.lod.depth_of_field", word(focus)},
          {"render.lod.backfacing", word(back_facing)},
          {"render.lod.contrast", word(contrast)},
          {"render.lod.fewer_points", word(points)}};
}

}  // namespace

std::vector<LodPlace> lod_places(const SceneDescription& scene) {
  std::vector<LodPlace> places{{"here", "the scene", {}}};
  for (const float distance : kDistances)
    places.push_back({fmt::format("distance-{:g}", distance), fmt::format("{:g} x as far", distance),
                      from(scene, distance)});
  const V2f shutter = scene.camera.shutter;
  if (shutter.y > shutter.x) {
    places.push_back({"shutter-0", "no blur", {{"camera.shutter", "[0, 0]"}}});
    places.push_back({"shutter-2",
                      "shutter open twice as long",
                      {{"camera.shutter", fmt::format("[{:g}, {:g}]", 2 * shutter.x, 2 * shutter.y)}}});
  }
  if (scene.camera.lens) {
    const float stop = scene.camera.lens->f_stop;
    places.push_back(
        {"lens-small", "lens a quarter as wide", {{"camera.lens.f_stop", fmt::format("{:g}", 4 * stop)}}});
    places.push_back(
        {"lens-large", "lens twice as wide", {{"camera.lens.f_stop", fmt::format("{:g}", stop / 2)}}});
  }
  return places;
}

std::vector<LodSetting> lod_ideas() {
  Settings naive = ideas(true, true, true, true, true);
  naive.emplace_back("render.lod.width_gain", "false");
  return {{"all", "everything", {}},
          {"size", "size", ideas(false, false, false, false, false)},
          {"motion", "+ motion", ideas(true, false, false, false, false)},
          {"focus", "+ focus", ideas(true, true, false, false, false)},
          {"turned", "+ backfacing", ideas(true, true, true, false, false)},
          {"contrast", "+ contrast", ideas(true, true, true, true, false)},
          {"naive", "naive: no width gain", naive}};
}

LodSetting other_hairs(const SceneDescription& scene) {
  LodSetting setting{"other", "full detail, other hairs", {}, false};
  for (const auto& groom : scene.grooms.items)
    setting.lod.emplace_back("grooms." + groom.name + ".seed", std::to_string(groom.value.seed + kOtherSeed));
  return setting;
}

std::vector<LodSetting> lod_qualities() {
  std::vector<LodSetting> settings;
  for (const float quality : {0.5f, 1.0f, 2.0f, 4.0f})
    settings.push_back({fmt::format("quality-{:g}", quality),
                        fmt::format("quality {:g}", quality),
                        {{"render.lod.quality", fmt::format("{:g}", quality)}}});
  return settings;
}

Settings detail_camera(const SceneDescription& scene, float factor) {
  const double frame = frame_of(scene);
  const CameraParams& camera = scene.camera;
  std::string lens;
  if (camera.lens)
    lens = fmt::format(", lens: {{f_stop: {:.9g}, focal_length: {:.9g}, focus_distance: {:.9g}}}",
                       camera.lens->f_stop, camera.lens->focal_length, camera.lens->focus_distance * factor);
  return {{"render.lod.camera",
           fmt::format("{{position: {}, look_at: {}, up: {}, fov: {:.9g}, shutter: [{:.9g}, {:.9g}]{}}}",
                       text(away(scene, factor)), text(camera.look_at.at(frame)), text(camera.up.at(frame)),
                       camera.fov.at(frame), camera.shutter.x, camera.shutter.y, lens)}};
}

}  // namespace pelage
