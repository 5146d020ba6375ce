// SPDX-License-Identifier: Apache-2.0
#include "world/scene_crowds.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/nearest_name.h"
#include "world/frame_characters.h"
#include "world/terrain.h"

namespace pelage {
namespace {

size_t character_index(const SceneDescription& scene, const std::string& name) {
  const auto& items = scene.characters.items;
  return static_cast<size_t>(
      std::find_if(items.begin(), items.end(), [&](const auto& item) { return item.name == name; }) -
      items.begin());  // load_scene checked that it exists
}

/// Memory of a crowd's animals in a frame, assuming prototypes in equal numbers.
int64_t bytes_in_frame(const SceneDescription& scene, const CrowdParams& crowd,
                       const std::vector<int64_t>& drawn_bytes) {
  double sum = 0;
  for (const NameReference& of : crowd.of)
    sum += static_cast<double>(drawn_bytes[character_index(scene, of.name)]);
  return static_cast<int64_t>(sum / static_cast<double>(crowd.of.size()) * static_cast<double>(crowd.count));
}

std::vector<Footprint> footprints_of(const SceneDescription& scene, const CrowdParams& crowd) {
  std::vector<Footprint> footprints;
  for (const NameReference& of : crowd.of)
    footprints.push_back(scene.characters.find(of.name)->value.footprint);
  return footprints;
}

/// Moves the animals of a crowd along y to its ground, and leans them.
void stand_on_ground(const SceneDescription& scene, const Assets& assets, const std::string& name,
                     const CrowdParams& params, const Job& job, std::vector<CrowdMember>& members) {
  const CharacterParams& ground = scene.characters.find(params.ground.name)->value;
  std::vector<Terrain::Surface> surfaces;
  for (const PartParams& part : ground.parts)
    surfaces.push_back({assets.skins.at(part.skin.name).rest, character_matrix(ground.transform, 1)});
  const Terrain terrain(std::move(surfaces), job);
  for (CrowdMember& member : members) {
    const auto below = terrain.at(member.position.x, member.position.z);
    if (!below) {
      throw Error(ErrorKind::kInput, params.ground.position,
                  fmt::format("crowd '{}': {} has no ground at x = {:g}, z = {:g}; choose a smaller `area`",
                              name, quote(params.ground.name), member.position.x, member.position.z));
    }
    member.position.y = below->height;
    const V3f up(0, 1, 0);
    if (params.tilt > 0) member.up = (up + params.tilt * (below->normal - up)).normalized();
  }
}

/// Memory of each character in a frame, by its index in the scene.
std::vector<int64_t> drawn_bytes(const SceneDescription& scene, const Assets& assets) {
  std::vector<int64_t> bytes;
  for (const auto& [name, position, params] : scene.characters.items)
    bytes.push_back(frame_character_bytes(scene, assets, name, params));
  return bytes;
}

}  // namespace

std::vector<std::vector<CrowdMember>> place_crowds(const SceneDescription& scene, const Assets& assets,
                                                   const Job& job) {
  const std::vector<int64_t> animal_bytes = drawn_bytes(scene, assets);
  int64_t in_frame = 0;
  size_t placed = 0;
  for (const auto& [name, position, params] : scene.crowds.items) {
    in_frame += bytes_in_frame(scene, params, animal_bytes);
    const int64_t making = crowd_temporary_bytes(params, footprints_of(scene, params), placed);
    require_memory(job.ledger, std::max(making, in_frame),
                   fmt::format("crowd '{}' with {} animals", name, params.count));
    placed += static_cast<size_t>(params.count);
  }
  std::vector<std::vector<CrowdMember>> crowds;
  std::vector<PlacedFootprint> taken;
  const bool others_follow = scene.crowds.items.size() > 1;
  for (const auto& [name, position, params] : scene.crowds.items) {
    const std::vector<Footprint> footprints = footprints_of(scene, params);
    crowds.push_back(make_crowd(name, position, params, footprints, job, taken));
    if (!params.ground.name.empty()) stand_on_ground(scene, assets, name, params, job, crowds.back());
    if (!others_follow) break;
    for (const CrowdMember& member : crowds.back())
      taken.push_back(placed_footprint(member, footprints[member.prototype]));
  }
  return crowds;
}

}  // namespace pelage
