// SPDX-License-Identifier: Apache-2.0
#include "render/path/frame_geometry.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "render/accel/embree_accel.h"
#include "render/memory_budget.h"
#include "render/path/strand_fields.h"

namespace pelage {
namespace {

struct Leaf {
  const Procedural* procedural = nullptr;
  uint32_t part = 0;
};

/// Leaves in a fixed order. Procedurals made on the way down live in `made`.
void collect_leaves(const Procedural& procedural, uint32_t part,
                    std::vector<std::unique_ptr<Procedural>>& made, std::vector<Leaf>& leaves) {
  std::vector<std::unique_ptr<Procedural>> children = procedural.split();
  if (children.empty()) leaves.push_back({&procedural, part});
  for (std::unique_ptr<Procedural>& child : children) {
    made.push_back(std::move(child));
    collect_leaves(*made.back(), part, made, leaves);
  }
}

FurBatch grow(const Leaf& leaf, const RenderScene& scene) {
  const FurPart& part = scene.fur[leaf.part];
  FurBatch batch;
  batch.part = leaf.part;
  batch.strands = leaf.procedural->generate();
  if (batch.strands.strand_count() == 0) return batch;
  const FibreParams* fibre = fibre_params(scene.materials[part.material]);
  if (!fibre) throw Error(ErrorKind::kInput, part.name + ": its material is not one for fibres");
  find_attributes(fibre->color, batch.strands, part.name);  // throws for one that is missing
  batch.opacity = point_opacities(fibre->opacity, batch.strands, part);
  return batch;
}

}  // namespace

std::vector<const SkinMesh*> FrameGeometry::tessellate_skins(const RenderScene& scene, const Workers& workers,
                                                             MemoryLedger& ledger) {
  skins_.resize(scene.skins.size());
  workers.for_each(skins_.size(), 1, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i)
      skins_[i] = scene.skins[i].skin->tessellate(scene.camera.view());
  });
  std::vector<const SkinMesh*> skins;
  for (const SkinMesh& mesh : skins_) {
    charges_.emplace_back(ledger, MemoryTag::kSkins, static_cast<int64_t>(mesh.bytes()));
    skins.push_back(&mesh);
  }
  return skins;
}

std::unique_ptr<const FrameGeometry> FrameGeometry::make(const RenderScene& scene, const Workers& workers,
                                                         Progress& progress, MemoryLedger& ledger,
                                                         Statistics& statistics) {
  std::vector<std::unique_ptr<Procedural>> made;
  std::vector<Leaf> leaves;
  for (uint32_t part = 0; part < scene.fur.size(); ++part) {
    for (const auto& procedural : scene.fur[part].procedurals)
      collect_leaves(*procedural, part, made, leaves);
  }

  auto geometry = std::make_unique<FrameGeometry>();
  geometry->batches_.resize(leaves.size());
  geometry->charges_.resize(leaves.size());
  progress.begin("grow", static_cast<double>(leaves.size()));
  workers.for_each(leaves.size(), 1, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end && !progress.cancelled(); ++i) {
      FurBatch& batch = geometry->batches_[i];
      batch = grow(leaves[i], scene);
      const size_t bytes = batch.strands.bytes() + batch.opacity.capacity() * sizeof(float);
      geometry->charges_[i] = MemoryCharge(ledger, MemoryTag::kChunks, static_cast<int64_t>(bytes));
      require_room(ledger, scene.render.memory.bytes, 0, "the fur of " + scene.fur[batch.part].name);
      progress.advance(1);
    }
  });
  progress.end();
  if (progress.cancelled()) return nullptr;

  std::vector<AccelStrands> strands;
  int64_t working_set = 0;
  for (const FurBatch& batch : geometry->batches_) {
    strands.push_back({&batch.strands, batch.part, batch.opacity});
    statistics.strands_generated += static_cast<int64_t>(batch.strands.strand_count());
    working_set += static_cast<int64_t>(batch.strands.bytes());
  }
  statistics.chunks += static_cast<int64_t>(leaves.size());
  statistics.expansions += static_cast<int64_t>(leaves.size());
  statistics.working_set_bytes = std::max(statistics.working_set_bytes, working_set);

  progress.begin("build", 1);
  std::vector<const SkinMesh*> skins = geometry->tessellate_skins(scene, workers, ledger);
  EmbreeOptions options;
  options.shape = scene.render.curves;
  options.memory_limit = scene.render.memory.bytes;
  geometry->accel_ =
      std::make_unique<EmbreeAccel>(std::move(strands), std::move(skins), options, ledger, workers);
  progress.advance(1);
  progress.end();
  return geometry;
}

}  // namespace pelage
