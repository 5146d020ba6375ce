// SPDX-License-Identifier: Apache-2.0
#include "world/motion_files.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "base/file.h"
#include "world/checkpoint_file.h"
#include "world/frames.h"

namespace pelage {
namespace {

bool has_files(const GroomParams& groom) { return groom.dynamics && !groom.dynamics->files.empty(); }

std::set<std::filesystem::path> guide_files_of(const GroomParams& groom, const CameraParams& camera,
                                               std::span<const int> frames) {
  std::set<std::filesystem::path> files;
  for (const int of : frames) {
    const auto [first, last] = whole_frames_around(camera, of);
    for (int frame = first; frame <= last; ++frame)
      files.insert(frame_file_name(groom.dynamics->files.path.string(), frame));
  }
  return files;
}

}  // namespace

std::pair<int, int> whole_frames_around(const CameraParams& camera, double frame) {
  return {static_cast<int>(std::floor(frame + std::min(-0.5, double(camera.shutter.x)))),
          static_cast<int>(std::ceil(frame + std::max(0.5, double(camera.shutter.y))))};
}

std::vector<std::filesystem::path> motion_files(const SceneDescription& scene, std::span<const int> frames) {
  std::vector<std::filesystem::path> files;
  for (const auto& groom : scene.grooms.items) {
    if (!has_files(groom.value)) continue;
    const auto own = guide_files_of(groom.value, scene.camera, frames);
    files.insert(files.end(), own.begin(), own.end());
  }
  return files;
}

std::map<std::string, std::string> motion_file_inputs(const SceneDescription& scene,
                                                      std::span<const int> frames) {
  std::map<std::string, std::string> inputs;
  for (const auto& groom : scene.grooms.items) {
    if (!has_files(groom.value)) continue;
    ContentHasher hasher;
    for (const std::filesystem::path& file : guide_files_of(groom.value, scene.camera, frames)) {
      std::error_code failed;
      const bool exists = std::filesystem::exists(file, failed);
      hasher.add(file.filename().string()).add(exists);
      if (exists) hasher.add(file_hash(file));
    }
    // Its last word is shown if it differs (input_differences()).
    const std::string pattern = groom.value.dynamics->files.path.filename().string();
    inputs[fmt::format("file guides-{} {}", inputs.size() + 1, one_line(pattern))] =
        to_string(hasher.digest());
  }
  return inputs;
}

}  // namespace pelage
