// SPDX-License-Identifier: Apache-2.0
#include "cli/leaf_sizes.h"

#include <cstdint>

namespace pelage {
namespace {

constexpr uint64_t kChunksInMemory = 800;
constexpr uint64_t kBytesPerControlPoint = 80;  // of a chunk; half of them are its tree
constexpr int kStep = 4, kFewestStrands = 125;  // boxes and indices of chunks must not outweigh them

}  // namespace

void choose_leaf_sizes(SceneDescription& scene) {
  const uint64_t limit = scene.render.memory.bytes;
  if (limit == 0) return;
  for (auto& groom : scene.grooms.items) {
    GroomParams& params = groom.value;
    if (params.leaf_strands || params.cache) continue;
    const uint64_t fit =
        limit / (kChunksInMemory * kBytesPerControlPoint * static_cast<uint64_t>(params.points));
    int strands = GroomParams::kMostLeafStrands;
    while (strands > kFewestStrands && static_cast<uint64_t>(strands) > fit) strands /= kStep;
    params.leaf_strands = strands;
  }
}

}  // namespace pelage
