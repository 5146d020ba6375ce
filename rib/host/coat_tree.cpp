// SPDX-License-Identifier: Apache-2.0
#include "rib/host/coat_tree.h"

#include <algorithm>

#include "geom/rest_position.h"
#include "procedurals/bounds/bounding.h"
#include "procedurals/fur.h"
#include "procedurals/thinned_fur.h"

namespace pelage {
namespace {

constexpr size_t kChildren = 8;

}  // namespace

CoatTree::CoatTree(const FrameCoat& coat, const std::optional<Simplification>& lod)
    : rest_(coat.at_rest ? nullptr : coat.rest) {
  const size_t count = coat.coat->follicles().leaves().size();
  if (!lod) {
    for (size_t leaf = 0; leaf < count; ++leaf)
      leaves_.push_back(std::make_unique<FurLeafProcedural>(coat.coat, coat.skin, leaf));
    return;
  }
  const auto detail = std::make_shared<const CoatDetail>(coat.coat, *coat.skin, *lod, coat.direction);
  for (size_t leaf = 0; leaf < count; ++leaf) {
    leaves_.push_back(std::make_unique<ThinnedFurProcedural>(detail, coat.skin, leaf, leaf + 1, leaf, count));
  }
}

std::vector<LeafRange> CoatTree::split(LeafRange range) const {
  const size_t children = std::min(range.count(), kChildren);
  std::vector<LeafRange> parts;
  for (size_t i = 0; i < children; ++i) {
    parts.push_back(
        {range.first + range.count() * i / children, range.first + range.count() * (i + 1) / children});
  }
  return parts;
}

Box3f CoatTree::box(LeafRange range, const Job& job) const {
  const std::lock_guard lock(mutex_);
  if (boxes_.empty()) {
    std::vector<const Procedural*> leaves;
    for (const auto& leaf : leaves_) leaves.push_back(leaf.get());
    BoundingOptions options;
    options.strategy = BoundingStrategy::kExactShutter;
    options.in_one_part = true;
    std::vector<Box3f> boxes;
    for (const ChunkBounds& bounds : bound_chunks(options, leaves, job)) boxes.push_back(bounds.whole());
    job.check_stop();  // boxes of a stopped job are missing
    boxes_ = std::move(boxes);
  }
  Box3f box;
  for (size_t leaf = range.first; leaf < range.end; ++leaf) box.extendBy(boxes_[leaf]);
  return box;
}

Strands CoatTree::grow(size_t index) const {
  Strands strands = leaves_[index]->generate();
  if (!rest_ || !strands.has_roots()) return strands;
  StrandAttribute rest{std::string(kRestPositions), AttributeClass::kPerStrand, 3, {}};
  rest.values.reserve(3 * strands.strand_count());
  for (const RootAddress& root : strands.arrays().roots) {
    const V3f p = rest_->evaluate(root.face, root.u, root.v).position;
    rest.values.insert(rest.values.end(), {p.x, p.y, p.z});
  }
  StrandArrays arrays = std::move(strands).release();
  arrays.attributes.push_back(std::move(rest));
  return Strands(std::move(arrays));
}

int64_t CoatTree::growth_bytes(size_t index) const {
  const Procedural& leaf = *leaves_[index];
  StrandCounts counts = leaf.counts();
  if (rest_) counts.attribute_floats += 3 * counts.strands;
  return static_cast<int64_t>(2 * measuring_bytes(counts) + leaf.temporary_bytes());
}

}  // namespace pelage
