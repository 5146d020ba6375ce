// SPDX-License-Identifier: Apache-2.0
#include "render/path/frame_chunks.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "procedurals/bounding.h"
#include "render/path/strand_fields.h"

namespace pelage {
namespace {

/// What growing holds for a moment: a block of strands on its way through the operators, whose points and
/// colours are rows of floats, twice where they are posed at several times; the lattice of a skin.
constexpr size_t kGrowthBytes = size_t(128) << 10, kGrowthBytesPerPoint = size_t(7) << 10;
constexpr size_t kLatticeBytesPerVertex = 32;

size_t growth_bytes(const StrandCounts& n) {
  if (n.strands == 0) return kGrowthBytes;
  // Strands of one file may be longer than others of it.
  const size_t points = 2 * (n.points / n.strands + 1);
  return kGrowthBytes + kGrowthBytesPerPoint * points * (n.motion_keys > 1 ? 2 : 1);
}

const FibreParams& fibre_material(const RenderScene& scene, const FurPart& part) {
  const FibreParams* fibre = fibre_params(scene.materials[part.material]);
  if (!fibre) throw Error(ErrorKind::kInput, part.name + ": its material is not one for fibres");
  return *fibre;
}

}  // namespace

FrameChunks::FrameChunks(const RenderScene& scene, const Workers& workers)
    : scene_(scene), skin_sizes_(scene.skins.size()) {
  for (uint32_t part = 0; part < scene.fur.size(); ++part) {
    fibre_material(scene, scene.fur[part]);
    for (const auto& procedural : scene.fur[part].procedurals) {
      collect(*procedural, part, static_cast<uint32_t>(scales_.size()));
      scales_.push_back(procedural->scale());
    }
  }
  workers.for_each(skin_sizes_.size(), 1, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i)
      skin_sizes_[i] = scene.skins[i].skin->size(scene.camera.view());
  });
}

void FrameChunks::collect(const Procedural& procedural, uint32_t part, uint32_t coat) {
  std::vector<std::unique_ptr<Procedural>> children = procedural.split();
  if (children.empty()) {
    leaves_.push_back(&procedural);
    parts_.push_back(part);
    coats_.push_back(coat);
  }
  for (std::unique_ptr<Procedural>& child : children) {
    made_.push_back(std::move(child));
    collect(*made_.back(), part, coat);
  }
}

ChunkContents FrameChunks::grow(uint32_t chunk) const {
  if (chunk >= leaves_.size()) {
    const auto skin = static_cast<uint32_t>(chunk - leaves_.size());
    return {scene_.skins[skin].skin->tessellate(scene_.camera.view()), skin};
  }
  const FurPart& part = scene_.fur[parts_[chunk]];
  const FibreParams& fibre = fibre_material(scene_, part);
  FurContents fur;
  fur.strands = leaves_[chunk]->generate();
  strands_grown_.fetch_add(static_cast<int64_t>(fur.strands.strand_count()), std::memory_order_relaxed);
  if (fur.strands.strand_count() > 0) {
    find_attributes(fibre.color, fur.strands, part.name);  // throws for one that is missing
    fur.opacity = point_opacities(fibre.opacity, fur.strands, part);
  }
  return {std::move(fur), parts_[chunk]};
}

ChunkCounts FrameChunks::counts(uint32_t chunk) const {
  ChunkCounts counts;
  if (chunk >= leaves_.size()) {
    const size_t skin = chunk - leaves_.size();
    counts.vertices = skin_sizes_[skin].vertices;
    counts.triangles = skin_sizes_[skin].triangles;
    counts.motion_keys = scene_.skins[skin].skin->motion_keys();
    counts.growth_bytes = scene_.skins[skin].skin->making_bytes() + kLatticeBytesPerVertex * counts.vertices;
    return counts;
  }
  const StrandCounts strands = leaves_[chunk]->counts();
  counts.strands = strands.strands;
  counts.points = strands.points;
  counts.segments = strands.segments;
  counts.attribute_floats = strands.attribute_floats;
  counts.motion_keys = static_cast<int>(strands.motion_keys);
  counts.growth_bytes = growth_bytes(strands) + leaves_[chunk]->making_bytes();
  return counts;
}

StrandScale FrameChunks::scale(uint32_t chunk) const {
  return chunk < leaves_.size() ? scales_[coats_[chunk]] : StrandScale{};
}

bool FrameChunks::opaque() const {
  return std::all_of(scene_.fur.begin(), scene_.fur.end(),
                     [&](const FurPart& part) { return is_opaque(fibre_material(scene_, part).opacity); });
}

std::vector<ChunkBounds> FrameChunks::bounds(const Workers& workers, Progress& progress,
                                             MemoryLedger& ledger) const {
  BoundingOptions options;
  options.strategy = scene_.render.bounds;
  options.factor = scene_.render.bounds_factor;
  std::vector<ChunkBounds> bounds =
      bound_chunks(options, leaves_, workers, progress, ledger,
                   [&progress](const std::string& line) { progress.warn(line); });
  for (const SkinPart& part : scene_.skins) {
    ChunkBounds box;
    box.keys = bound_keys(options.strategy);
    box.boxes.assign(static_cast<size_t>(box.keys), part.skin->bound(bound_span(options.strategy)));
    bounds.push_back(std::move(box));
  }
  return bounds;
}

}  // namespace pelage
