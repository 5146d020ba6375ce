// SPDX-License-Identifier: Apache-2.0
#include "world/archive_coats.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "procedurals/fur.h"
#include "procedurals/thinned_fur.h"
#include "rib/scene/placed_procedural.h"

namespace pelage {
namespace {

/// An own procedural with its parsed arguments.
struct Request {
  HairArguments arguments;
  std::shared_ptr<const ArchiveScene> scene;
  int frame = 0;
};

[[noreturn]] void fail(const RibOwnProcedural& request, const std::string& why) {
  throw Error(ErrorKind::kInput, request.position, "Procedural: " + why);
}

/// The scene file, searched beside the file with the request, beside the first file, and in the working
/// folder, where the plugin searches it in other renderers.
std::filesystem::path scene_path(const std::string& name, const RibOwnProcedural& request) {
  const std::filesystem::path path(name);
  std::error_code ignored;
  if (path.is_absolute()) return path;
  for (const std::filesystem::path& folder :
       {std::filesystem::path(request.position.file).parent_path(), request.folder}) {
    if (std::filesystem::exists(folder / path, ignored)) return (folder / path).lexically_normal();
  }
  return path;
}

std::shared_ptr<const ArchiveScene> open_scene(const std::filesystem::path& path,
                                               const HairArguments& arguments,
                                               const SceneDescription& picture, const Job& job) {
  auto opened = std::make_shared<ArchiveScene>();
  SceneDescription& scene = opened->scene;
  RibUse use;
  use.overrides = true;
  scene = load_scene(path, arguments.overrides, use);
  for (const Problem& warning : scene.warnings)
    job.progress.warn(to_string(warning.position) + ": " + warning.message);
  // The picture has lights of its own. Archives of the other scene are not part of coats.
  scene.lights.items.clear();
  scene.archives.items.clear();
  scene.camera.shutter = picture.camera.shutter;
  scene.render.memory = picture.render.memory;
  scene.growth_cache = picture.growth_cache;
  scene.scripts = picture.scripts;
  opened->assets = load_assets(scene, job);
  return opened;
}

Request parse(const RibOwnProcedural& own, const SceneDescription& picture, const Job& job,
              const ArchiveScenes& before, ArchiveScenes& scenes) {
  Request request;
  try {
    request.arguments = parse_hair_arguments(own.arguments);
  } catch (const Error& error) {
    fail(own, error.what());
  }
  const std::filesystem::path path = scene_path(request.arguments.scene, own);
  HairArguments key;  // only the arguments that select the scene
  key.scene = path.string();
  key.overrides = request.arguments.overrides;
  std::erase_if(key.overrides, [](const Override& one) { return one.key == "render.memory"; });
  const std::string name = print_hair_arguments(key);
  std::shared_ptr<const ArchiveScene>& scene = scenes[name];
  const auto known = before.find(name);
  if (!scene && known != before.end() && known->second->scene.camera.shutter == picture.camera.shutter)
    scene = known->second;
  if (!scene) {
    try {
      scene = open_scene(path, key, picture, job);
    } catch (const Error& error) {
      // A mistake within the other scene has a line there; others are mistakes of the request.
      if (error.kind() != ErrorKind::kInput || error.problems().front().position.line > 0) throw;
      fail(own, error.what());
    }
  }
  request.scene = scene;
  request.frame = request.arguments.frame.value_or(scene->scene.frames.frames.front());
  return request;
}

/// The level of detail of the request, instead of that of the other scene's camera.
void set_detail(const HairArguments& arguments, const SceneDescription& scene, const Job& job,
                FrameCoat& coat) {
  if (arguments.scene_camera && !arguments.full_detail) return;
  coat.lod.reset();
  coat.direction.reset();
  if (scene.render.lod.enabled && !arguments.full_detail && arguments.pixels_per_unit)
    coat.lod.emplace(scale_detail(coat, scene.render.lod, *arguments.pixels_per_unit, job.workers));
}

std::string skin_of(const FrameCoat& coat, const FrameParts& parts) {
  for (const FrameSkin& skin : parts.skins) {
    if (skin.posed == coat.skin) return skin.name;
  }
  return {};
}

void add_coats(const Request& request, size_t index, const RibOwnProcedural& own, const FrameParts& parts,
               const Job& job, std::vector<ArchiveCoat>& coats) {
  const HairArguments& arguments = request.arguments;
  std::vector<std::string> grooms;
  const size_t before = coats.size();
  bool has_character = arguments.character.empty();
  for (const FrameSkin& skin : parts.skins) has_character |= skin.name.starts_with(arguments.character + ".");
  if (!has_character)
    fail(own, "there is no character " + quote(arguments.character) +
                  suggest(arguments.character, request.scene->scene.characters.names()));
  for (const FrameCoat& coat : parts.coats) {
    if (!arguments.character.empty() && coat.character != arguments.character) continue;
    if (std::find(grooms.begin(), grooms.end(), coat.groom) == grooms.end()) grooms.push_back(coat.groom);
    if (!arguments.coat.empty() && coat.groom != arguments.coat) continue;
    ArchiveCoat found{index, coat, arguments.leaves, skin_of(coat, parts), request.scene};
    const size_t leaves = coat.coat->follicles().leaves().size();
    if (found.leaves && found.leaves->end > leaves)
      fail(own, fmt::format("there is no leaf {}; the coat '{}' has the leaves 0 to {}",
                            found.leaves->end - 1, coat.groom, leaves - 1));
    set_detail(arguments, request.scene->scene, job, found.coat);
    coats.push_back(std::move(found));
  }
  if (coats.size() == before && !arguments.coat.empty())
    fail(own, "there is no coat " + quote(arguments.coat) + suggest(arguments.coat, grooms));
}

std::vector<std::unique_ptr<Procedural>> procedurals_of(const ArchiveCoat& own) {
  const FrameCoat& coat = own.coat;
  std::vector<std::unique_ptr<Procedural>> procedurals;
  if (!own.leaves) {
    procedurals.push_back(std::make_unique<FurProcedural>(coat.coat, coat.skin, coat.lod, coat.direction));
    return procedurals;
  }
  const size_t count = coat.coat->follicles().leaves().size();
  const auto detail =
      coat.lod ? std::make_shared<const CoatDetail>(coat.coat, *coat.skin, *coat.lod, coat.direction)
               : nullptr;
  for (size_t leaf = own.leaves->first; leaf < own.leaves->end; ++leaf) {
    if (detail) {
      procedurals.push_back(
          std::make_unique<ThinnedFurProcedural>(detail, coat.skin, leaf, leaf + 1, leaf, count));
    } else {
      procedurals.push_back(std::make_unique<FurLeafProcedural>(coat.coat, coat.skin, leaf));
    }
  }
  return procedurals;
}

}  // namespace

ArchiveProcedurals pose_procedurals(const RibScene& rib, const SceneDescription& picture, const Job& job,
                                    const ArchiveScenes& before) {
  ArchiveProcedurals all;
  std::vector<Request> requests;
  // All characters of a scene are posed together, because they share measurements of their coats.
  std::map<std::pair<const ArchiveScene*, int>, std::set<std::string>> characters;
  for (const RibOwnProcedural& own : rib.own_procedurals) {
    job.check_stop();
    requests.push_back(parse(own, picture, job, before, all.scenes));
    characters[{requests.back().scene.get(), requests.back().frame}].insert(
        requests.back().arguments.character);
  }
  std::map<std::pair<const ArchiveScene*, int>, FrameParts> posed;
  for (auto& [frame, names] : characters) {
    if (names.contains("")) names.clear();
    posed[frame] = pose_frame(frame.first->scene, *frame.first->assets, frame.second, job, names);
  }
  for (size_t i = 0; i < requests.size(); ++i) {
    add_coats(requests[i], i, rib.own_procedurals[i], posed.at({requests[i].scene.get(), requests[i].frame}),
              job, all.coats);
  }
  return all;
}

FurPart archive_fur(const std::string& name, const ArchiveCoat& coat, const RibOwnProcedural& request,
                    size_t material, const RibShutter& shutter) {
  FurPart fur{name,          procedurals_of(coat),   material, coat.coat.rest, request.tint,
              coat.coat.lod, coat.coat.skin->scale()};
  if (request.to_world == RibTransform()) {
    fur.follows = coat.coat.skin;
    return fur;
  }
  // Shading asks for the detail at positions in the picture's world, which are not those of the coat's.
  fur.lod.reset();
  fur.scale *= mean_scale(request.to_world.at(shutter.times.x));
  for (auto& procedural : fur.procedurals)
    procedural = std::make_unique<PlacedProcedural>(std::move(procedural), request.to_world, shutter);
  return fur;
}

}  // namespace pelage
