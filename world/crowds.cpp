// SPDX-License-Identifier: Apache-2.0
#include "world/crowds.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/memory_budget.h"

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

}  // namespace

std::vector<std::vector<CrowdMember>> make_crowds(const SceneDescription& scene,
                                                  const std::vector<int64_t>& drawn_bytes, const Job& job) {
  int64_t in_frame = 0;
  size_t placed = 0;
  for (const auto& [name, position, params] : scene.crowds.items) {
    in_frame += bytes_in_frame(scene, params, drawn_bytes);
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
    if (!others_follow) break;
    for (const CrowdMember& member : crowds.back())
      taken.push_back(placed_footprint(member, footprints[member.prototype]));
  }
  return crowds;
}

}  // namespace pelage
