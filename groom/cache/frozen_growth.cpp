// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <numbers>
#include <span>
#include <vector>

#include "base/error.h"
#include "base/memory_budget.h"
#include "groom/cache/frozen_coat.h"
#include "groom/cache/frozen_leaf_writer.h"
#include "groom/cache/strand_layer.h"

namespace pelage {
namespace {

constexpr const char* kLayerKind = "layer";
constexpr uint32_t kLayerFormat = 1;

ContentHash layer_key(const ContentHash& stage, int leaf_strands) {
  return ContentHasher().add(in_leaves(stage, leaf_strands)).add(kLayerFormat).digest();
}

/// Properties of strands after quantisation, whose error applies to every point (groom/cache/frozen_leaf.h).
StrandReach quantised(StrandReach reach) {
  constexpr float kError = 0.8661f / codes::kLargestStep;  // of the longest segment
  reach.distance += 1.1f * kError * reach.length;
  reach.length *= 1.0f + 2.2f * kError * static_cast<float>(reach.segments);
  reach.radius *= 1.0f + 0x1p-10f;
  // Operators that keep a lean below a half turn also keep the segments of a strand similar in length.
  if (reach.lean > 0) reach.lean = std::min(reach.lean + 1e-3f, std::numbers::pi_v<float>);
  return reach;
}

/// Grows one leaf.
class LeafGrowth {
 public:
  LeafGrowth(const FrozenGrowth& growth, size_t leaf)
      : growth_(growth), range_(growth.source.follicles().leaves()[leaf]) {
    const std::optional<AttributeClass> colors = growth.stack.traits(0, growth.frozen).colors;
    color_rows_ = !colors ? 0 : *colors == AttributeClass::kPerPoint ? SIZE_MAX : 1;
  }

  /// Whether a layer holds the strands of this leaf.
  bool fits(std::span<const std::byte> layer) const {
    const auto batch = std::make_unique<StrandBatch>();
    size_t at = 0;
    for (size_t begin = range_.begin; begin < range_.end; begin += batch->count) {
      size_batch(*batch, begin);
      batch->points.resize(static_cast<size_t>(growth_.source.strand_points(begin)));
      if (!read_layer(layer, at, *batch)) return false;
    }
    return at == layer.size();
  }

  /// Runs operators [from, frozen) on the state in `layer` (from > 0) and stores the state after all but the
  /// last.
  std::vector<std::byte> run(size_t from, std::span<const std::byte> layer,
                             std::vector<std::vector<std::byte>>& layers) const {
    FrozenLeafWriter writer(
        {!growth_.source.imported && growth_.stack.traits(0, growth_.frozen).has_one_width_profile});
    const auto batch = std::make_unique<StrandBatch>();
    size_t at = 0;
    layers.assign(growth_.frozen - std::min(growth_.frozen, from + 1), {});
    for (size_t begin = range_.begin; begin < range_.end; begin += batch->count) {
      size_batch(*batch, begin);
      growth_.source.start(*batch, begin);
      if (from > 0) read_layer(layer, at, *batch);
      for (size_t i = from; i < growth_.frozen; ++i) {
        growth_.stack.apply(i, i + 1, *batch);
        if (i + 1 < growth_.frozen) append_layer(*batch, layers[i - from]);
      }
      writer.add(*batch);
    }
    return writer.finish();
  }

 private:
  void size_batch(StrandBatch& batch, size_t begin) const {
    batch.count = growth_.source.run_length(begin, range_.end);
    batch.colors.resize(std::min(color_rows_, static_cast<size_t>(growth_.source.strand_points(begin))));
  }

  const FrozenGrowth& growth_;
  const FollicleTree::Leaf& range_;
  size_t color_rows_ = 0;
};

}  // namespace

ContentHash in_leaves(const ContentHash& hash, int leaf_strands) {
  return ContentHasher().add(hash).add("leaves").add(leaf_strands).digest();
}

std::filesystem::path layer_file(const ContentStore& store, const ContentHash& stage, int leaf_strands) {
  return store.file(kLayerKind, layer_key(stage, leaf_strands));
}

bool FrozenGrowth::resumes(const StoredFile& layer, std::vector<StrandReach>& reaches) const {
  if (layer.section_count() != reaches.size() + 1 ||
      layer.section(0).size() != reaches.size() * sizeof(StrandReach)) {
    return false;
  }
  for (size_t leaf = 0; leaf < reaches.size(); ++leaf) {
    if (!LeafGrowth(*this, leaf).fits(layer.section(leaf + 1))) return false;
  }
  if (!reaches.empty()) std::memcpy(reaches.data(), layer.section(0).data(), layer.section(0).size());
  return true;
}

/// Charges the first `done` leaves, and estimates the size of all from them.
void FrozenGrowth::charge_grown(size_t done, Result& result) const {
  int64_t bytes = 0;
  for (size_t leaf = 0; leaf < done; ++leaf) bytes += static_cast<int64_t>(result.leaves[leaf].capacity());
  result.charge = {};
  const double share = static_cast<double>(done) / static_cast<double>(result.leaves.size());
  require_memory(job.ledger, static_cast<int64_t>(static_cast<double>(bytes) / share),
                 "growing strands for the cache of " + owner);
  result.charge = MemoryCharge(job.ledger, MemoryTag::kOperatorCache, bytes);
}

FrozenGrowth::Result FrozenGrowth::run(const PrepareContext& context, int leaf_strands) const {
  const size_t leaf_count = source.follicles().leaves().size();
  const auto key = [&](size_t i) { return layer_key(identity.of_operator(i).hash, leaf_strands); };

  Result result;
  for (size_t leaf = 0; leaf < leaf_count; ++leaf) result.reaches.push_back(source.reach(leaf));
  std::optional<StoredFile> layer;
  for (size_t i = frozen - 1; i > 0 && !layer; --i) {
    layer = store.open(kLayerKind, key(i - 1), warn);
    if (layer && !resumes(*layer, result.reaches)) layer.reset();
    if (layer) result.resumed = i;
  }
  stack.prepare(result.resumed, frozen, context);

  std::vector<std::unique_ptr<ContentStore::Writer>> writers;
  for (size_t i = result.resumed; i < frozen; ++i) {
    for (StrandReach& reach : result.reaches) reach = stack.reach(reach, i, i + 1);
    if (i + 1 == frozen) break;
    writers.emplace_back(new ContentStore::Writer(store.writer(kLayerKind, key(i))));
    writers.back()->add(std::span<const StrandReach>(result.reaches));
  }
  for (StrandReach& reach : result.reaches) reach = quantised(reach);
  result.leaves.resize(leaf_count);
  job.progress.begin("grow", static_cast<double>(leaf_count));
  const size_t group = static_cast<size_t>(job.workers.thread_count()) * 4;
  for (size_t first = 0; first < leaf_count; first += group) {
    const size_t count = std::min(group, leaf_count - first);
    std::vector<std::vector<std::vector<std::byte>>> layers(count);
    job.for_each(count, 1, [&](WorkRange range) {
      for (size_t i = range.begin; i < range.end; ++i) {
        const size_t leaf = first + i;
        job.check_stop();
        result.leaves[leaf] =
            LeafGrowth(*this, leaf)
                .run(result.resumed, layer ? layer->section(leaf + 1) : std::span<const std::byte>(),
                     layers[i]);
        job.progress.advance(1);
      }
    });
    charge_grown(first + count, result);
    for (const auto& of_leaf : layers) {
      for (size_t i = 0; i < writers.size(); ++i) writers[i]->add(std::span<const std::byte>(of_leaf[i]));
    }
  }
  job.progress.end();
  for (const auto& writer : writers) writer->commit(cannot_store);
  return result;
}

}  // namespace pelage
