// SPDX-License-Identifier: Apache-2.0
#include "world/leaf_sizes.h"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace pelage {
namespace {

constexpr uint64_t kChunksInMemory = 400;
constexpr uint64_t kBytesPerControlPoint = 80;  // of a chunk; half of them are its tree
constexpr int kStep = 4, kFewestStrands = 125;  // boxes and indices of chunks must not outweigh them
constexpr int kStoredStrands = 500;             // some 250 KiB

uint64_t bytes_of(const GroomParams& groom, int64_t strands) {
  return static_cast<uint64_t>(strands) * static_cast<uint64_t>(groom.points) * kBytesPerControlPoint;
}

/// Of all characters in full detail; nothing where a coat does not say how many strands it has.
std::optional<uint64_t> bytes_of_fur(const SceneDescription& scene) {
  uint64_t bytes = 0;
  for (const auto& [name, position, character] : scene.characters.items) {
    uint64_t animals = 1;
    for (const auto& crowd : scene.crowds.items) {
      const auto& of = crowd.value.of;
      const auto is_it = [&](const NameReference& one) { return one.name == name; };
      if (std::any_of(of.begin(), of.end(), is_it)) animals += static_cast<uint64_t>(crowd.value.count);
    }
    for (const PartParams& part : character.parts) {
      for (const auto& coat : part.grooms.items) {
        const GroomParams& groom = scene.grooms.find(coat.name)->value;
        if (!groom.strands) return {};
        bytes += animals * bytes_of(groom, *groom.strands);
      }
    }
  }
  return bytes;
}

int strands_that_fit(const GroomParams& groom, uint64_t limit) {
  int strands = GroomParams::kMostLeafStrands;
  while (strands > kFewestStrands && bytes_of(groom, strands) * kChunksInMemory > limit) strands /= kStep;
  return strands;
}

}  // namespace

void choose_leaf_sizes(SceneDescription& scene) {
  const bool stored = !scene.render.bvh.file.path.empty();
  const uint64_t limit = scene.render.memory.bytes;
  if (!stored && (limit == 0 || bytes_of_fur(scene).value_or(limit + 1) <= limit)) return;
  for (auto& [name, position, groom] : scene.grooms.items) {
    if (groom.leaf_strands || groom.cache || !groom.strands_file.empty()) continue;
    groom.leaf_strands = stored ? kStoredStrands : strands_that_fit(groom, limit);
  }
}

}  // namespace pelage
