// SPDX-License-Identifier: Apache-2.0
#include "world/motion_files_check.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "geom/io/strand_file.h"
#include "world/frames.h"

namespace pelage {
namespace {

/// Keys of `dynamics` that have an effect beside `files`.
constexpr std::array<std::string_view, 4> kUsedKeys = {"files", "guides", "neighbours", "after"};

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

}  // namespace

void check_motion_files(const SceneDescription& scene, const Value& document, Problems& problems) {
  for (const auto& [name, position, groom] : scene.grooms.items) {
    if (!groom.dynamics || groom.dynamics->files.empty()) continue;
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

}  // namespace pelage
