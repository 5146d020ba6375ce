// SPDX-License-Identifier: Apache-2.0
#include "world/camera_check.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "world/camera_frame.h"

namespace pelage {
namespace {

/// Max shift of the lens, in pictures: far beyond any use.
constexpr float kMaxShift = 100;

void check_subject(const SceneDescription& scene, const NameReference& subject, const char* purpose, bool all,
                   Problems& problems) {
  if (subject.name.empty()) return;
  std::vector<std::string> names = scene.characters.names();
  for (std::string& skin : scene.skins.names()) names.push_back(std::move(skin));
  if (all) names.emplace_back(kFrameAll);
  if (std::find(names.begin(), names.end(), subject.name) != names.end()) return;
  problems.add(subject.position, fmt::format("there is no skin or character {} to {}{}", quote(subject.name),
                                             purpose, suggest(subject.name, names)));
}

void check_keys(const CameraParams& camera, const Value* block, Problems& problems) {
  if (!block || !block->is_map()) return;
  const auto given = [&](const char* key) {
    const Value* value = block->find(key);
    return value && !value->is_null() ? value : nullptr;
  };
  const auto refuse_both = [&](const char* key, const char* other) {
    if (given(key) && given(other))
      problems.add(given(key)->position(),
                   fmt::format("`{}` contradicts `{}`; remove one of them", key, other));
  };
  refuse_both("focal_length", "fov");
  refuse_both("f_stop", "lens");
  refuse_both("focus_on", "focus_distance");
  if (camera.projection == CameraProjection::kPerspective) refuse_both("projection", "orthographic");
  if (given("focus_distance") && !given("f_stop"))
    problems.add(given("focus_distance")->position(), "`focus_distance` needs `f_stop`");
  if (given("focus_on") && !given("f_stop") && !given("lens"))
    problems.add(given("focus_on")->position(), "`focus_on` needs `f_stop` or `lens`");
  if (given("f_stop") && camera.is_orthographic())
    problems.add(given("f_stop")->position(), "an orthographic camera has no `f_stop`; remove it");
  if (given("sensor") && !given("focal_length") && !given("f_stop"))
    problems.add(given("sensor")->position(), "`sensor` needs `focal_length` or `f_stop`");
  if (given("shift") && std::max(std::abs(camera.shift.x), std::abs(camera.shift.y)) > kMaxShift)
    problems.add(given("shift")->position(),
                 fmt::format("expected a shift of at most {} pictures", kMaxShift));
  if (given("shutter") && camera.shutter.x > camera.shutter.y)
    problems.add(given("shutter")->position(), "the shutter closes before it opens");
}

}  // namespace

void check_camera_names(const SceneDescription& scene, Problems& problems) {
  check_subject(scene, scene.camera.frame, "frame", true, problems);
  check_subject(scene, scene.camera.focus_on, "focus on", false, problems);
  const std::optional<CameraParams>& detail = scene.render.lod.camera.own;
  if (!detail) return;
  if (!detail->frame.name.empty())
    problems.add(detail->frame.position, "the camera of `lod` cannot `frame`; give its `position`");
  if (!detail->focus_on.name.empty())
    problems.add(detail->focus_on.position, "the camera of `lod` cannot `focus_on`; give its distance");
}

void check_camera_keys(const SceneDescription& scene, const Value& document, Problems& problems) {
  check_keys(scene.camera, document.find("camera"), problems);
  if (!scene.render.lod.camera.own) return;
  const Value* render = document.find("render");
  const Value* lod = render ? render->find("lod") : nullptr;
  check_keys(*scene.render.lod.camera.own, lod ? lod->find("camera") : nullptr, problems);
}

}  // namespace pelage
