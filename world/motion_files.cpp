// SPDX-License-Identifier: Apache-2.0
#include "world/motion_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "base/file.h"
#include "base/nearest_name.h"
#include "geom/io/strand_file.h"
#include "world/checkpoint_file.h"
#include "world/frames.h"

namespace pelage {
namespace {

/// Keys of `dynamics` that have an effect beside `files`.
constexpr std::array<std::string_view, 4> kUsedKeys = {"files", "guides", "neighbours", "after"};

bool has_files(const GroomParams& groom) { return groom.dynamics && !groom.dynamics->files.empty(); }

/// Adds a problem for each key that only computed motion uses.
void check_unused_keys(const Value* dynamics, Problems& problems) {
  if (!dynamics || !dynamics->is_map()) return;
  for (const Value::Entry& entry : dynamics->entries()) {
    if (entry.value.is_null() || std::find(kUsedKeys.begin(), kUsedKeys.end(), entry.key) != kUsedKeys.end())
      continue;
    problems.add(entry.value.position(), "`" + entry.key +
                                             "` has no effect beside `files`, because the guides follow the "
                                             "files and are not computed; remove one of the two keys");
  }
}

/// The drawn coats of a groom.
std::vector<std::string> coats_of(const SceneDescription& scene, const std::string& groom) {
  std::vector<std::string> coats;
  for (const auto& character : scene.characters.items) {
    if (!character.value.drawn.value_or(true)) continue;
    for (const PartParams& part : character.value.parts) {
      if (part.grooms.find(groom)) coats.push_back(character.name + "." + groom);
    }
  }
  return coats;
}

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

void check_motion_files(const SceneDescription& scene, const Value& document, Problems& problems) {
  for (const auto& [name, position, groom] : scene.grooms.items) {
    if (!has_files(groom)) continue;
    const AssetPath& files = groom.dynamics->files;
    const auto refuse = [&](const std::string& why) {
      problems.add(files.position, quote(files.path.string()) + ": " + why);
    };
    if (files.data) {
      refuse("the guides of many frames must be in files");
    } else if (!is_strand_file(files.path)) {
      refuse(std::string("expected strand files ending in ") + kStrandEndings);
    } else if (!has_frame_pattern(files.path.string())) {
      refuse("expected the frame number in the name, as in guides.%04d.hair");
    }
    const std::vector<std::string> coats = coats_of(scene, name);
    if (coats.size() > 1) {
      problems.add(files.position,
                   fmt::format("`files` hold the guides of one coat, but {} have the groom {}; give each "
                               "character a groom of its own",
                               fmt::join(coats, " and "), quote(name)));
    }
    const Value* grooms = document.find("grooms");
    const Value* own = grooms ? grooms->find(name) : nullptr;
    check_unused_keys(own ? own->find("dynamics") : nullptr, problems);
  }
}

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
