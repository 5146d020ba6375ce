// SPDX-License-Identifier: Apache-2.0
#include "world/grow_coat.h"

#include <memory>
#include <vector>

#include "base/memory_budget.h"
#include "base/nearest_name.h"
#include "geom/strand_merge.h"

namespace pelage {
namespace {

using Leaves = std::vector<std::unique_ptr<Procedural>>;

Leaves leaves_of(const World& world, const std::string& coat) {
  Leaves leaves;
  std::vector<std::string> names;
  bool found = false;
  for (const FurPart& part : world.scene.fur) {
    const std::string groom = part.name.substr(part.name.rfind('.') + 1);
    names.push_back(groom);
    names.push_back(part.name);
    if (coat != groom && coat != part.name) continue;
    found = true;
    for (const auto& procedural : part.procedurals) {
      for (auto& leaf : procedural->split()) leaves.push_back(std::move(leaf));
    }
  }
  if (!found) throw Error(ErrorKind::kArguments, "there is no coat " + quote(coat) + suggest(coat, names));
  return leaves;
}

int64_t batch_bytes(const StrandCounts& n) {
  constexpr size_t kPerStrand = sizeof(uint64_t) + sizeof(uint32_t) + sizeof(RootAddress) + sizeof(V2f);
  return static_cast<int64_t>((n.points * n.motion_keys * 4 + n.attribute_floats) * sizeof(float) +
                              n.strands * kPerStrand);
}

void check_alike(const std::vector<Strands>& grown, const std::string& coat) {
  const Strands* first = nullptr;
  for (const Strands& strands : grown) {
    if (strands.strand_count() == 0) continue;
    if (!first) first = &strands;
    if (strands.basis() == first->basis() && strands.motion_keys() == first->motion_keys()) continue;
    throw Error(ErrorKind::kArguments, "the coats " + quote(coat) +
                                           " differ in curve basis or motion keys; name one of a character, "
                                           "such as 'rat.under'");
  }
}

}  // namespace

Strands grow_coat(const World& world, const std::string& coat, const Job& job) {
  const Leaves leaves = leaves_of(world, coat);
  int64_t bytes = 0;
  for (const auto& leaf : leaves) bytes += 2 * batch_bytes(leaf->counts());
  const MemoryCharge charge =
      reserve(job.ledger, MemoryTag::kChunks, bytes, "growing the strands of " + quote(coat));
  const ProgressStage stage(job.progress, "grow " + coat, static_cast<double>(leaves.size()));
  std::vector<Strands> grown(leaves.size());
  job.for_each(leaves.size(), 1, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i) {
      grown[i] = leaves[i]->generate();
      stage.advance(1);
    }
  });
  job.check_stop();
  check_alike(grown, coat);
  return grown.size() == 1 ? std::move(grown.front()) : merge(grown, job.workers);
}

}  // namespace pelage
