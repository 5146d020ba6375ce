// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "image/exr_file.h"
#include "scene/document_hash.h"
#include "scene/renamed_keys.h"
#include "world/asset_files.h"
#include "world/camera_check.h"
#include "world/camera_frame.h"
#include "world/complete_scene.h"
#include "world/dark_lights.h"
#include "world/frame_characters.h"
#include "world/leaf_sizes.h"
#include "world/light_links.h"
#include "world/motion_files_check.h"
#include "world/presets.h"
#include "world/regions.h"
#include "world/scene_schema.h"
#include "world/scene_source.h"

namespace pelage {
namespace {

template <class T>
void check_name(const NameReference& reference, const char* what, const Named<T>& known, Problems& problems) {
  if (known.find(reference.name)) return;
  std::string message = "there is no " + std::string(what) + " " + quote(reference.name);
  message += known.items.empty() ? "; the scene has none" : suggest(reference.name, known.names());
  problems.add(reference.position, std::move(message));
}

bool is_fibre(const MaterialParams& material) { return fibre_params(material) != nullptr; }

void check_material(const SceneDescription& scene, const NameReference& reference, bool for_fibres,
                    Problems& problems) {
  const auto* material = scene.materials.find(reference.name);
  if (!material) {
    check_name(reference, "material", scene.materials, problems);
  } else if (is_fibre(material->value) != for_fibres) {
    problems.add(reference.position, quote(reference.name) + " is a material for " +
                                         (for_fibres ? "skins, not for strands" : "strands, not for skins"));
  }
}

void check_part(const SceneDescription& scene, const PartParams& part, Problems& problems) {
  if (part.skin.name != kNoSkin) {
    check_name(part.skin, "skin", scene.skins, problems);
    check_material(scene, part.material, false, problems);
  }
  for (const auto& [name, position, material] : part.grooms.items) {
    const auto* groom = scene.grooms.find(name);
    if (!groom) {
      check_name({name, position}, "groom", scene.grooms, problems);
    } else if (!groom->value.skin.name.empty() && groom->value.skin.name != part.skin.name) {
      problems.add(position, "groom " + quote(name) + " grows on the skin " + quote(groom->value.skin.name) +
                                 ", not on " + quote(part.skin.name));
    }
    check_material(scene, material, true, problems);
  }
}

// By file in the order of first mention, then by line, as a reader expects.
std::vector<Problem> in_file_order(std::vector<Problem> problems) {
  std::map<std::string, size_t> files;
  for (const Problem& problem : problems) files.try_emplace(problem.position.file, files.size());
  std::stable_sort(problems.begin(), problems.end(), [&](const Problem& a, const Problem& b) {
    const auto key = [&](const Problem& p) {
      return std::tuple(files.at(p.position.file), p.position.line, p.position.column);
    };
    return key(a) < key(b);
  });
  // A mistake in a region is found at each of its uses.
  const auto same = [](const Problem& a, const Problem& b) {
    return to_string(a.position) == to_string(b.position) && a.message == b.message;
  };
  problems.erase(std::unique(problems.begin(), problems.end(), same), problems.end());
  return problems;
}

// Checks that a groom states its number of strands exactly once.
void check_strands(const Named<GroomParams>::Item& groom, Problems& problems) {
  const bool counted = groom.value.strands || groom.value.density,
             from_file = !groom.value.strands_file.empty();
  if (!counted && !from_file && !groom.value.skin.name.empty()) {
    problems.add(groom.position, "groom " + quote(groom.name) +
                                     " needs `strands` (how many) or `density` (how many per square unit)");
  } else if (counted && from_file) {
    problems.add(groom.position,
                 "groom " + quote(groom.name) +
                     " takes its strands from a file; `strands` and `density` must not be given");
  }
  if (groom.value.transform && !from_file)
    problems.add(groom.position, "groom " + quote(groom.name) +
                                     ": `transform` needs a strands_file; the skin has a `transform`, too");
}

// Checks names that are used in layers of a picture, which would truncate them at a zero byte or at its max
// length and then confuse them.
void check_layer_name(const std::string& what, const std::string& name, const SourcePosition& position,
                      Problems& problems) {
  constexpr size_t kLongestName = kLongestExrName - 24;  // enough for ".secondary.indirect.R"
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  if (name.size() > kLongestName) {
    problems.add(position, fmt::format("the name of {} {} has {} bytes; the limit is {}", what, quote(name),
                                       name.size(), kLongestName));
  } else if (std::any_of(name.begin(), name.end(), is_control)) {
    problems.add(position, "the name of " + what + " " + quote(name) + " contains a control character");
  }
}

bool moves_ever(const SceneDescription& scene, const CharacterParams& character) {
  bool posed = moves(character.transform);
  for (const PartParams& part : character.parts) {
    const auto* skin = scene.skins.find(part.skin.name);
    posed |= part.poses || (skin && skin->value.poses);
  }
  return posed;
}

void check_crowd(const SceneDescription& scene, const Named<CrowdParams>::Item& item, Problems& problems) {
  const CrowdParams& crowd = item.value;
  const auto refuse = [&](const std::string& why) {
    problems.add(item.position, "crowd " + quote(item.name) + why);
  };
  if (crowd.of.empty()) refuse(" names no character");
  if (!crowd.ground.name.empty()) {
    check_name(crowd.ground, "character", scene.characters, problems);
    const auto* ground = scene.characters.find(crowd.ground.name);
    if (ground && moves_ever(scene, ground->value))
      problems.add(crowd.ground.position, quote(crowd.ground.name) + " moves; the ground must be still");
    for (const auto& other : scene.crowds.items) {
      for (const NameReference& name : other.value.of) {
        if (name.name == crowd.ground.name)
          problems.add(crowd.ground.position, quote(crowd.ground.name) + " is an animal of crowd " +
                                                  quote(other.name) +
                                                  "; the ground must be a character of its own");
      }
    }
  } else if (crowd.tilt > 0) {
    refuse(": `tilt` needs `ground`");
  }
  for (const NameReference& name : crowd.of) check_name(name, "character", scene.characters, problems);
  const auto* polygon = std::get_if<PolygonAreaParams>(&crowd.area);
  if (polygon && polygon->points.size() < 3) refuse(": its area needs at least three points");
}

}  // namespace

bool is_simulated(const SceneDescription& scene, const std::string& groom) {
  const auto* coat = scene.grooms.find(groom);
  return coat && coat->value.dynamics && coat->value.dynamics->mode == DynamicsMode::kSimulated;
}

/// Adds a problem for each groom that cannot have its `dynamics`, and for each crowd whose animals would have
/// to be simulated.
void check_dynamics(const SceneDescription& scene, Problems& problems) {
  for (const auto& [name, position, groom] : scene.grooms.items) {
    const std::optional<Problem> problem = check_dynamics(groom);
    if (!problem) continue;
    problems.add(problem->position.file.empty() ? position : problem->position,
                 "groom " + quote(name) + ": " + problem->message);
  }
  for (const auto& groom : scene.grooms.items) {
    if (!groom.value.dynamics) continue;
    for (const NameReference& other : groom.value.dynamics->collide_with)
      check_name(other, "character", scene.characters, problems);
  }
  for (const auto& [name, position, crowd] : scene.crowds.items) {
    for (const NameReference& of : crowd.of) {
      const auto* animal = scene.characters.find(of.name);
      if (!animal) continue;
      for (const PartParams& part : animal->value.parts) {
        for (const auto& groom : part.grooms.items) {
          if (!is_simulated(scene, groom.name)) continue;
          problems.add(position, "crowd " + quote(name) + ": groom " + quote(groom.name) +
                                     " has `dynamics`; animals of a crowd need `mode: kinematic`");
        }
      }
    }
  }
}

void check_references(const SceneDescription& scene, Problems& problems) {
  for (const auto& [name, position, groom] : scene.grooms.items) {
    if (!groom.skin.name.empty()) {
      check_name(groom.skin, "skin", scene.skins, problems);
    } else if (groom.strands_file.empty()) {
      problems.add(position, "groom " + quote(name) + " needs a skin to grow on, or a strands_file");
    }
    check_strands({name, position, groom}, problems);
    if (const std::optional<Problem> problem = check_freeze(groom))
      problems.add(problem->position, problem->message);
  }
  for (const auto& [name, position, character] : scene.characters.items) {
    if (character.parts.empty()) problems.add(position, "character " + quote(name) + " has no parts");
    for (const PartParams& part : character.parts) check_part(scene, part, problems);
    for (const V3f& disc : character.footprint) {
      if (!(disc.z >= 0))
        problems.add(position, "character " + quote(name) +
                                   ": a disc [x, z, radius] of the footprint has a negative radius");
    }
  }
  for (const auto& crowd : scene.crowds.items) check_crowd(scene, crowd, problems);
  check_camera_names(scene, problems);
  check_dynamics(scene, problems);
  for (const auto& archive : scene.archives.items) {
    for (const auto& material : archive.value.materials.items)
      check_name(material.value, "material", scene.materials, problems);
  }
  for (const auto& light : scene.lights.items) {
    check_layer_name("light", light.name, light.position, problems);
    if (light.name == kBackground && !scene.image.background.empty())
      problems.add(light.position,
                   "the layer of `image.background` has this name; give the light another one");
  }
  check_light_links(scene, problems);
  for (const auto& groom : scene.grooms.items)
    check_layer_name("groom", groom.name, groom.position, problems);
}

namespace {

void check_event_layers(const SceneDescription& scene, const Value& document, Problems& problems) {
  if (!scene.image.event_layers || scene.image.light_layers) return;
  problems.add(document.find("image")->find("event_layers")->position(),
               "`event_layers` needs `light_layers: true`");
}

void check_gather(const SceneDescription& scene, const Value& document, Problems& problems) {
  if (scene.render.integrator != Integrator::kGather) return;
  if (scene.render.indirect == IndirectLight::kDual) {
    problems.add(document.find("render")->find("indirect")->position(),
                 "`indirect: dual` needs `integrator: path`");
  }
  const bool asks = scene.render.gather.visibility == GatherVisibility::kRaster;
  if (asks && !scene.render.draws_visible()) {
    problems.add(document.find("render")->find("gather")->position(),
                 "`visibility: raster` needs `accel: fur` and `curves: flat`");
  }
  if (scene.render.gather.min_width > 0 && !scene.render.draws_visible()) {
    problems.add(document.find("render")->find("gather")->position(),
                 "`min_width` needs `visibility: raster`");
  }
  if (scene.render.gather.cache == true && !scene.render.gather.reuse) {
    problems.add(document.find("render")->find("gather")->find("cache")->position(),
                 "`cache: true` needs `reuse: true`");
  }
}

void warn_of_visibility(const SceneDescription& scene, const Value& document,
                        std::vector<Problem>& warnings) {
  const bool asks = scene.render.gather.visibility == GatherVisibility::kRaster;
  if (!asks || scene.render.integrator == Integrator::kGather) return;
  warnings.push_back({document.find("render")->find("gather")->position(),
                      "`visibility: raster` has no effect without `integrator: gather`"});
}

void collect_files(const Value& value, std::set<std::string>& files) {
  if (value.position().line > 0) files.insert(value.position().file);  // flags have no lines
  if (value.is_map()) {
    for (const Value::Entry& entry : value.entries()) collect_files(entry.value, files);
  }
  if (value.is_list()) {
    for (const Value& item : value.items()) collect_files(item, files);
  }
}

/// The scene file, and those that provided a value.
std::vector<std::filesystem::path> files_of(const Value& document, const SceneSource& source) {
  std::set<std::string> included;
  collect_files(document, included);
  std::vector<std::filesystem::path> files;
  if (!source.made) files.push_back(source.path);
  for (const std::string& file : included) {
    if (source.made || file != source.path.string()) files.emplace_back(file);
  }
  return files;
}

/// Completes a camera with `frame`: its default direction, and the frame of the pose. Overrides of `frames`
/// do not count, because every machine of a farm renders other frames with the same camera.
void complete_frame(const SceneSource& source, std::vector<Override> overrides, const Value& document,
                    SceneDescription& scene) {
  CameraParams& camera = scene.camera;
  if (camera.frame.name.empty()) return;
  const Value& block = *document.find("camera");
  if (!block.find("position") && !block.find("look_at")) camera.position = default_view(camera.up.at(1));
  scene.framed_at = scene.frames.frames.front();
  const auto removed = std::erase_if(overrides, [](const Override& o) { return o.key == "frames"; });
  if (removed == 0 || scene.from_rib) return;
  Problems ignored;  // they are known
  const std::optional<Value> file = source.document(overrides, ignored, nullptr);
  const Value* frames = file ? file->find("frames") : nullptr;
  FrameList list;
  if (!frames || ValueReader<FrameList>::read(*frames, {}, list, ignored))
    scene.framed_at = list.frames.front();
}

SceneDescription read_scene(const SceneSource& source, const std::vector<Override>& overrides,
                            const RibUse& use) {
  Problems problems;
  SceneDescription scene;
  RenamedKeys renamed{SceneDescription::schema()};
  if (std::optional<Value> document = source.any_document(overrides, use, problems, renamed)) {
    expand_presets(*document, problems);
    expand_regions(*document, problems);
    const ContentHash hash = document_hash(*document);
    scene.parts = scene_parts(*document);
    scene.files = files_of(*document, source);
    scene.from_rib = source.is_rib();
    scene.programs = use.programs;
    scene.hash = fmt::format("{:016x}{:016x}", hash.high, hash.low);
    // If a block could not be read, references to its names would be reported as unknown too.
    if (SceneDescription::schema().read(*document, scene, problems)) {
      complete_parts(scene, problems);
      check_references(scene, problems);
      check_camera_keys(scene, *document, problems);
      check_event_layers(scene, *document, problems);
      check_gather(scene, *document, problems);
      check_motion_files(scene, *document, problems);
      warn_of_visibility(scene, *document, scene.warnings);
      warn_of_dark_lights(scene, *document, scene.warnings);
      complete_frame(source, overrides, *document, scene);
      set_scale(scene);
    }
  }
  if (!problems.empty()) throw Error(ErrorKind::kInput, in_file_order(problems.list()));
  const std::vector<std::filesystem::path> assets = asset_files(scene);
  scene.files.insert(scene.files.end(), assets.begin(), assets.end());
  scene.warnings.insert(scene.warnings.begin(), renamed.warnings.begin(), renamed.warnings.end());
  choose_leaf_sizes(scene);
  return scene;
}

}  // namespace

SceneDescription load_scene(const std::filesystem::path& path, const std::vector<Override>& overrides,
                            const RibUse& use) {
  SceneDescription scene = read_scene({path}, overrides, use);
  for (const Override& setting : overrides) {
    if (!setting.given) scene.settings.push_back(setting.key + "=" + setting.value);
  }
  return scene;
}

SceneDescription make_scene(const Value& document, const std::vector<Override>& overrides) {
  return read_scene({{}, &document}, overrides, {});
}

}  // namespace pelage
