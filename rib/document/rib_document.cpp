// SPDX-License-Identifier: Apache-2.0
#include "rib/document/rib_document.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "rib/document/rib_frames.h"
#include "rib/document/rib_values.h"

namespace pelage {
namespace {

constexpr size_t kMaxLightLayers = 100;  // of more lights, the layers would take more memory than the scene

/// Position, target and up vector of a camera matrix.
struct Pose {
  V3f position, target, up;
};

/// `middle`: of the picture, in camera space.
Pose camera_pose(const M44f& to_camera, const V3d& middle) {
  Imath::M44d inverse;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) inverse[i][j] = to_camera[i][j];
  }
  inverse.invert();
  V3d position, forward, up;
  inverse.multVecMatrix(middle, position);
  inverse.multDirMatrix(V3d(0, 0, 1), forward);
  inverse.multDirMatrix(V3d(0, 1, 0), up);
  // A target as far as the origin, because coordinates of points near the camera would be rounded.
  const double distance = std::max(1.0, position.length());
  return {V3f(position), V3f(position + forward.normalized() * distance), V3f(up.normalized())};
}

/// Makes the blocks of a file's camera and picture.
class PictureBlocks {
 public:
  PictureBlocks(const std::filesystem::path& path, std::vector<Problem>& warnings)
      : at_{path.string(), 1, 1}, warnings_(warnings) {}

  void add_frame(double frame, const RibCamera& camera) {
    const std::pair<int, int> size = camera.format.value_or(std::pair(640, 480));
    width_ = size.first;
    height_ = size.second;
    std::vector<double> times;
    for (const auto& sample : camera.to_camera.samples()) times.push_back(sample.first);
    if (!camera.to_camera.moves()) times = {0};
    for (const double time : times) {
      frames_.push_back(frame + time);
      const Window window = window_of(camera);
      if (poses_.empty()) shift_ = window.shift;
      const V3d middle = camera.perspective ? V3d(0) : V3d(window.x, window.y, 0);
      poses_.push_back(camera_pose(camera.to_camera.at(time), middle));
      const double half = std::tan(double(camera.fov) * std::numbers::pi / 360) * window.half_height;
      const double scale = std::cbrt(std::abs(double(camera.to_camera.at(time).determinant())));
      sizes_.push_back(camera.perspective ? std::atan(half) * 360 / std::numbers::pi
                                          : 2 * window.half_height / scale);
    }
    keys_ = std::max(keys_, times.size());
    if (poses_.size() == times.size()) first_ = camera;
  }

  Value camera() const {
    Value block = Value::map(at_, {});
    add_keyed(block, "position", [&](size_t i) { return rib_vector(at_, poses_[i].position); });
    add_keyed(block, "look_at", [&](size_t i) { return rib_vector(at_, poses_[i].target); });
    add_keyed(block, "up", [&](size_t i) { return rib_vector(at_, poses_[i].up); });
    add_keyed(block, first_.perspective ? "fov" : "orthographic",
              [&](size_t i) { return rib_number(at_, sizes_[i]); });
    if (first_.perspective && shift_ != V2f(0))
      add_entry(block, "shift", Value::list(at_, {rib_number(at_, shift_.x), rib_number(at_, shift_.y)}));
    if (first_.gain != 1) {
      const double stops = std::clamp(std::log2(double(first_.gain)), -64.0, 64.0);
      add_entry(block, "exposure", rib_number(at_, stops));
    }
    const V2f shutter = first_.shutter.value_or(V2f(0));
    add_entry(block, "shutter", Value::list(at_, {rib_number(at_, shutter.x), rib_number(at_, shutter.y)}));
    if (keys_ > 2)
      add_entry(block, "motion_keys", rib_number(at_, static_cast<double>(std::min<size_t>(keys_, 64))));
    if (first_.lens && first_.perspective) {
      Value lens = Value::map(at_, {});
      add_entry(lens, "f_stop", rib_number(at_, first_.lens->x));
      add_entry(lens, "focal_length", rib_number(at_, first_.lens->y));
      add_entry(lens, "focus_distance", rib_number(at_, first_.lens->z));
      add_entry(block, "lens", std::move(lens));
    }
    return block;
  }

  Value image() const {
    Value block = Value::map(at_, {});
    add_entry(block, "width", rib_number(at_, width_));
    add_entry(block, "height", rib_number(at_, height_));
    return block;
  }

  std::optional<Value> samples() const {
    if (!first_.pixel_samples) return {};
    const double count = std::round(double(first_.pixel_samples->x) * first_.pixel_samples->y);
    Value block = Value::map(at_, {});
    add_entry(block, "samples", rib_number(at_, std::clamp(count, 1.0, 1e6)));
    return block;
  }

 private:
  template <class Make>
  void add_keyed(Value& block, const char* key, const Make& make) const {
    const auto differs = [&](size_t i) {
      return poses_[i].position != poses_[0].position || poses_[i].target != poses_[0].target ||
             poses_[i].up != poses_[0].up || sizes_[i] != sizes_[0];
    };
    bool moves = false;
    for (size_t i = 1; i < poses_.size(); ++i) moves |= differs(i);
    if (!moves) {
      add_entry(block, key, make(0));
      return;
    }
    Value frames = Value::map(at_, {}), keyed = Value::map(at_, {});
    for (size_t i = 0; i < poses_.size(); ++i) {
      if (i == 0 || frames_[i] > frames_[i - 1])
        add_entry(frames, fmt::format("{:.9g}", frames_[i]), make(i));
    }
    add_entry(keyed, "keys", std::move(frames));
    add_entry(block, key, std::move(keyed));
  }

  /// The middle of the screen window and half its height.
  struct Window {
    double x = 0, y = 0, half_height = 1;
    V2f shift{0, 0};  // x and y in widths and heights of the window
  };

  Window window_of(const RibCamera& camera) {
    const double aspect = camera.frame_aspect.value_or(
        static_cast<float>(width_) / static_cast<float>(height_) * camera.pixel_aspect.value_or(1.0f));
    Window window{0, 0, aspect >= 1 ? 1 : 1 / aspect, V2f(0)};
    if (camera.screen_window) {
      const auto& [left, right, bottom, top] = *camera.screen_window;
      window = {0.5 * (double(left) + right), 0.5 * (double(bottom) + top), 0.5 * (double(top) - bottom),
                V2f(0)};
      const double size = double(right) - left + top - bottom;
      if (2 * (std::abs(window.x) + std::abs(window.y)) > 1e-4 * size) {
        window.shift = V2f(static_cast<float>(window.x / (double(right) - left)),
                           static_cast<float>(window.y / (double(top) - bottom)));
      }
    }
    if (std::abs(aspect * height_ / width_ - 1) > 1e-4) warn("pixels that are not square are not supported");
    return window;
  }

  void warn(const char* message) {
    if (!warned_) warnings_.push_back({at_, message});
    warned_ = true;
  }

  const SourcePosition at_;
  std::vector<Problem>& warnings_;
  bool warned_ = false;
  int width_ = 640, height_ = 480;
  size_t keys_ = 0;
  std::vector<double> frames_;
  std::vector<Pose> poses_;
  V2f shift_{0, 0};            // of the first frame
  std::vector<double> sizes_;  // of the picture: the field of view, or the height of an orthographic one
  RibCamera first_;
};

/// Adds the entries of `from` that `to` does not have.
void add_missing(Value& to, Value from) {
  for (Value::Entry& entry : from.entries()) {
    if (!to.find(entry.key)) to.entries().push_back(std::move(entry));
  }
}

Value option_block(const RibScene& rib, const char* name, const SourcePosition& at) {
  const auto option = rib.options.find(name);
  return option == rib.options.end() ? Value::map(at, {}) : rib_block(option->second.front());
}

RibMaterials materials_of(const RibUse& use) {
  return RibMaterials(use.materials.empty() ? RibMaterialTable() : RibMaterialTable(use.materials));
}

void add_materials_and_lights(const RibFrames& frames, RibMaterials own, Value& document, Value& table,
                              std::vector<Problem>& warnings) {
  const SourcePosition at = document.position();
  Value materials = Value::map(at, {}), lights = Value::map(at, {});
  for (const auto& [key, material] : frames.materials) {
    add_entry(materials, key, own.material(material, warnings));
    add_entry(table, key, rib_text(at, key));
  }
  own.finish(warnings);
  RibLights blocks;
  for (const RibLight& light : frames.first.lights) {
    if (std::optional<Value> block = blocks.light(light, warnings))
      add_entry(lights, light.name, std::move(*block));
  }
  if (!materials.entries().empty()) add_entry(document, "materials", std::move(materials));
  if (!lights.entries().empty()) add_entry(document, "lights", std::move(lights));
}

}  // namespace

bool is_rib(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return name.ends_with(".rib") || name.ends_with(".rib.gz");
}

Value rib_document(const std::filesystem::path& path, const RibUse& use, size_t max_request_bytes,
                   std::vector<Problem>& warnings) {
  const SourcePosition at{path.string(), 1, 1};
  const RibFrames frames = read_rib_frames(path, true, use, max_request_bytes, warnings);
  if (frames.other_lights) warnings.push_back(*frames.other_lights);
  const RibScene& rib = frames.first;
  if (!rib.camera.stated)
    throw Error(ErrorKind::kInput, {path.string(), 0, 0},
                "the file has no WorldBegin, and so no camera; use it in a scene: "
                "archives: {name: {rib: " +
                    path.filename().string() + "}}");
  PictureBlocks picture(path, warnings);
  if (frames.cameras.empty()) picture.add_frame(1, rib.camera);
  std::string list;
  for (const auto& [frame, camera] : frames.cameras) {
    picture.add_frame(frame, camera);
    list += (list.empty() ? "" : ",") + std::to_string(frame);
  }
  Value document = Value::map(at, {});
  add_entry(document, "pelage", rib_number(at, 1));
  if (!list.empty()) add_entry(document, "frames", rib_text(at, list));
  add_entry(document, "camera", picture.camera());
  const Value image_option = option_block(rib, "image", at);
  const bool many_lights = rib.lights.size() > kMaxLightLayers && !image_option.find("light_layers");
  if (many_lights)
    warnings.push_back({at, fmt::format("{} lights; their layers are left out of the picture "
                                        "(--set image.light_layers=true)",
                                        rib.lights.size())});
  for (const char* name : {"units", "image", "render"}) {
    Value block = name == std::string_view("image") ? picture.image() : Value::map(at, {});
    if (std::optional<Value> samples = picture.samples(); samples && name == std::string_view("render"))
      block = std::move(*samples);
    if (many_lights && name == std::string_view("image"))
      add_entry(block, "light_layers", Value::scalar(at, "false"));
    add_missing(block, option_block(rib, name, at));
    if (!block.entries().empty()) add_entry(document, name, std::move(block));
  }
  Value table = Value::map(at, {}), archive = Value::map(at, {}), archives = Value::map(at, {});
  add_materials_and_lights(frames, materials_of(use), document, table, warnings);
  add_entry(archive, "rib", rib_text(at, path.filename().string()));
  if (!table.entries().empty()) add_entry(archive, "materials", std::move(table));
  const std::string name = path.filename().string();
  add_entry(archives, name.substr(0, name.find(".rib")), std::move(archive));
  add_entry(document, "archives", std::move(archives));
  return document;
}

namespace {

/// Of the `materials` that a scene gives an archive.
void warn_of_unknown_surfaces(const Value& table, const RibFrames& frames, std::vector<Problem>& warnings) {
  std::vector<std::string> names;
  for (const RibFrameMaterial& material : frames.materials) names.push_back(material.key);
  for (const Value::Entry& entry : table.entries()) {
    if (std::find(names.begin(), names.end(), entry.key) == names.end())
      warnings.push_back(
          {entry.key_position, "the archive has no surface " + quote(entry.key) + suggest(entry.key, names)});
  }
}

}  // namespace

void add_archive_materials(Value& document, const RibUse& use, size_t max_request_bytes,
                           std::vector<Problem>& warnings) {
  RibMaterials own_materials = materials_of(use);
  Value* archives = document.find("archives");
  if (!archives || !archives->is_map()) {
    own_materials.finish(warnings);
    return;
  }
  Value added = Value::map(archives->position(), {});
  for (Value::Entry& entry : archives->entries()) {
    const Value* file = entry.value.find("rib");
    if (!file || !file->is_scalar() || file->text().empty()) continue;  // the schema reports it
    const SourcePosition named_at = file->position();  // a copy: `file` is an entry of a map that grows below
    const std::filesystem::path folder = std::filesystem::path(named_at.file).parent_path();
    const bool by_flag = named_at.line == 0;
    std::filesystem::path path = by_flag ? std::filesystem::path(file->text()) : folder / file->text();
    RibFrames frames;
    try {
      frames = read_rib_frames(path, false, use, max_request_bytes, warnings);
    } catch (const Error& error) {
      if (error.problems().size() != 1 || error.problems()[0].position.line > 0) throw;
      throw Error(ErrorKind::kInput, named_at, error.what());
    }
    if (!entry.value.find("materials")) add_entry(entry.value, "materials", Value::map(named_at, {}));
    Value* table = entry.value.find("materials");
    if (!table->is_map()) continue;
    warn_of_unknown_surfaces(*table, frames, warnings);
    const Value stated = *table;  // what the scene says of a surface holds in all frames
    for (const auto& [key, material] : frames.materials) {
      own_materials.note(material);
      if (stated.find(material.name) || stated.find(key)) continue;
      const std::string name = entry.key + "." + key;
      add_entry(*table, key, rib_text(named_at, name));
      const Value* own = document.find("materials");
      if (!own || !own->find(name)) add_entry(added, name, own_materials.material(material, warnings));
    }
  }
  own_materials.finish(warnings);
  if (added.entries().empty()) return;
  if (!document.find("materials")) add_entry(document, "materials", Value::map(added.position(), {}));
  Value* materials = document.find("materials");
  if (!materials->is_map()) return;
  for (Value::Entry& entry : added.entries()) materials->entries().push_back(std::move(entry));
}

}  // namespace pelage
