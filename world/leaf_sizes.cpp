// SPDX-License-Identifier: Apache-2.0
#include "world/leaf_sizes.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "base/error.h"
#include "geom/io/strand_reader.h"

namespace pelage {
namespace {

constexpr uint64_t kChunksInMemory = 400, kChunksOfFileInMemory = 32;
constexpr uint64_t kMinChunksInMemory = 8;      // if everything fits; growing a chunk needs twice its bytes
constexpr uint64_t kBytesPerControlPoint = 80;  // of a chunk; half of it for its tree
constexpr int kStep = 4;
// Boxes and indices of chunks must not outweigh them.
constexpr uint64_t kFewestStrands = 125, kFewestPoints = 8000, kFewestLongStrands = 8;
constexpr int kStoredStrands = 500;  // some 250 KiB

/// Size of a coat before it is made.
struct Extent {
  std::optional<uint64_t> strands;  // empty when it depends on the area of the skin
  uint64_t points = 0;              // per strand
};

Extent extent_of(const GroomParams& groom) {
  Extent extent;
  extent.points = static_cast<uint64_t>(groom.points);
  if (groom.strands) extent.strands = static_cast<uint64_t>(*groom.strands);
  if (groom.strands_file.empty()) return extent;
  try {
    const StrandReader file(groom.strands_file, {groom.basis, groom.default_width});
    extent.strands = file.strands_in_file();
    extent.points = file.points_in_file() / std::max<uint64_t>(1, *extent.strands) + 1;
  } catch (const Error&) {
    // Groom::create() reports problems with the file.
  }
  return extent;
}

uint64_t strand_bytes(uint64_t strands, uint64_t points) { return strands * points * kBytesPerControlPoint; }

using Extents = std::map<std::string, Extent>;  // by coat

/// Bytes of all characters in full detail; empty when a coat does not state its number of strands.
std::optional<uint64_t> bytes_of_fur(const SceneDescription& scene, const Extents& extents) {
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
        const Extent& extent = extents.at(coat.name);
        if (!extent.strands) return {};
        bytes += animals * strand_bytes(*extent.strands, extent.points);
      }
    }
  }
  return bytes;
}

int strands_that_fit(uint64_t points, uint64_t chunks, uint64_t limit) {
  const uint64_t fewest = std::clamp(kFewestPoints / points, kFewestLongStrands, kFewestStrands);
  uint64_t strands = GroomParams::kMaxLeafStrands;
  while (strands > fewest && strand_bytes(strands, points) * chunks > limit) strands /= kStep;
  return static_cast<int>(strands);
}

}  // namespace

void choose_leaf_sizes(SceneDescription& scene) {
  const bool stored = !scene.render.bvh.file.path.empty();
  const uint64_t limit = scene.render.memory.bytes;
  if (!stored && limit == 0) return;
  Extents extents;
  for (const auto& [name, position, groom] : scene.grooms.items) extents[name] = extent_of(groom);
  const bool fits = bytes_of_fur(scene, extents).value_or(limit + 1) <= limit;
  for (auto& [name, position, groom] : scene.grooms.items) {
    const bool from_file = !groom.strands_file.empty();
    if (groom.leaf_strands || groom.cache || (stored && from_file)) continue;
    const uint64_t chunks = fits ? kMinChunksInMemory : from_file ? kChunksOfFileInMemory : kChunksInMemory;
    groom.leaf_strands = stored ? kStoredStrands : strands_that_fit(extents.at(name).points, chunks, limit);
  }
}

}  // namespace pelage
