// SPDX-License-Identifier: Apache-2.0
#include "rib/document/rib_frames.h"

#include <algorithm>

#include <fmt/format.h>

#include "rib/scene/rib_reading.h"

namespace pelage {
namespace {

constexpr size_t kMaxRibFrames = 10'000;

bool is_same(const RibSetting& a, const RibSetting& b) {
  return a.name == b.name && a.type == b.type && a.is_array == b.is_array && a.numbers == b.numbers &&
         a.strings == b.strings;
}

/// Whether Pelage wrote the shader, whose text then says everything.
bool is_own(const std::shared_ptr<const RibShader>& shader) { return shader && shader->find("pelage"); }

bool is_same(const std::shared_ptr<const RibShader>& a, const std::shared_ptr<const RibShader>& b) {
  if (is_own(a) && is_own(b)) return a->find("pelage")->strings == b->find("pelage")->strings;
  if (!a || !b) return !a && !b;
  return a->name == b->name &&
         std::equal(a->settings.begin(), a->settings.end(), b->settings.begin(), b->settings.end(),
                    [](const RibSetting& x, const RibSetting& y) { return is_same(x, y); });
}

bool is_same(const RibMaterial& a, const RibMaterial& b) {
  if (!is_same(a.shader, b.shader) || a.fibre != b.fibre) return false;
  return is_own(a.shader) || (a.color == b.color && a.strand_color == b.strand_color &&
                              a.opacity == b.opacity && a.strand_opacity == b.strand_opacity);
}

bool is_same(const RibLight& a, const RibLight& b) {
  if (a.name != b.name || !is_same(a.shader, b.shader)) return false;
  return is_own(a.shader) || (a.to_world == b.to_world && a.shape == b.shape && a.radius == b.radius &&
                              a.corners == b.corners && a.visible == b.visible && a.map == b.map);
}

/// Collects the frames of a file in their order, and then what is outside of them.
class FrameCollector {
 public:
  FrameCollector(std::filesystem::path path, RibFrames& frames) : path_(std::move(path)), frames_(frames) {}

  void add(const RibScene& scene) {
    const bool stated = scene.camera.stated;
    if (stated && scene.frame && !frames_.cameras.try_emplace(*scene.frame, scene.camera).second) return;
    if (frames_.cameras.size() > kMaxRibFrames)
      throw Error(ErrorKind::kInput, {path_.string(), 0, 0},
                  fmt::format("more than {} frames", kMaxRibFrames));
    if (frames_.first.camera.stated && stated && scene.frame) compare_lights(scene);
    if (is_empty_ || (stated && !frames_.first.camera.stated)) frames_.first = scene;
    is_empty_ = false;
    for (const RibMaterial& material : scene.materials) add_material(material, scene.frame);
  }

 private:
  void add_material(const RibMaterial& material, const std::optional<int>& frame) {
    const auto [known, is_new] = by_name_.try_emplace(material.name, frames_.materials.size());
    if (is_new) {
      frames_.materials.push_back({material.name, material});
    } else if (frame && !is_same(frames_.materials[known->second].material, material)) {
      frames_.materials.push_back({frame_material(material.name, *frame), material});
    }
  }

  void compare_lights(const RibScene& scene) {
    const std::vector<RibLight>&a = frames_.first.lights, &b = scene.lights;
    const auto same = [](const RibLight& x, const RibLight& y) { return is_same(x, y); };
    if (frames_.other_lights || std::equal(a.begin(), a.end(), b.begin(), b.end(), same)) return;
    frames_.other_lights =
        Problem{{path_.string(), 1, 1},
                fmt::format("frame {} has other lights than frame {}, whose lights shine in all frames",
                            *scene.frame, frames_.first.frame.value_or(0))};
  }

  const std::filesystem::path path_;
  RibFrames& frames_;
  std::map<std::string, size_t> by_name_;  // materials, by the name in their frame
  bool is_empty_ = true;
};

}  // namespace

RibFrames read_rib_frames(const std::filesystem::path& path, bool mirror, const RibUse& use,
                          size_t max_request_bytes, std::vector<Problem>& warnings) {
  RibFrames frames;
  FrameCollector collector(path, frames);
  RibReadOptions options;
  options.geometry = false;
  options.mirror_left_handed = mirror;
  options.programs = use.programs;
  options.max_request_bytes = max_request_bytes;
  options.each_frame = [&](const RibScene& scene) { collector.add(scene); };
  const RibScene rest = read_rib(path, options);
  collector.add(rest);
  warnings.insert(warnings.end(), rest.warnings.begin(), rest.warnings.end());
  return frames;
}

}  // namespace pelage
