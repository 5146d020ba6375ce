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
#include "groom/strands/strand_batch.h"

namespace pelage {
namespace {

// Layers: lossless storage of the state of strands between two frozen operators, in rest space. A coat can be
// grown again from this state, without the operators before it. Widths take no space before an operator sets
// them, and colours none while all are white.

struct Header {
  uint32_t count = 0, points = 0;
  uint32_t has_radii = 0;
  uint32_t color_rows = 0;
};

template <class Rows>
bool all_are(const Rows& rows, size_t count, float value) {
  return std::all_of(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(count),
                     [value](float v) { return v == value; });
}

void append_row(const StrandRow& row, size_t count, std::vector<std::byte>& bytes) {
  const auto from = std::as_bytes(std::span(row).first(count));
  bytes.insert(bytes.end(), from.begin(), from.end());
}

/// Appends the state of a batch to `bytes`.
void append_layer(const StrandBatch& batch, std::vector<std::byte>& bytes) {
  const size_t n = batch.count;
  Header header{static_cast<uint32_t>(n), static_cast<uint32_t>(batch.points.size()), 0, 0};
  for (const StrandBatch::PointRows& point : batch.points)
    header.has_radii |= !all_are(point.radius, n, 0.0f);
  for (const VectorRow& color : batch.colors) {
    for (const StrandRow& channel : color) {
      if (!all_are(channel, n, 1.0f)) header.color_rows = static_cast<uint32_t>(batch.colors.size());
    }
  }
  const auto from = std::as_bytes(std::span(&header, 1));
  bytes.insert(bytes.end(), from.begin(), from.end());
  append_row(batch.clump, n, bytes);
  // Operators do not move point 0.
  for (size_t p = 1; p < batch.points.size(); ++p) {
    for (const StrandRow& axis : batch.points[p].offset) append_row(axis, n, bytes);
  }
  if (header.has_radii) {
    for (const StrandBatch::PointRows& point : batch.points) append_row(point.radius, n, bytes);
  }
  if (header.color_rows) {
    for (const VectorRow& color : batch.colors) {
      for (const StrandRow& channel : color) append_row(channel, n, bytes);
    }
  }
}

/// Reads the state of a batch from `bytes` at `at`, and advances `at` past it. `batch` must have been started
/// with the same strands. Returns false when the bytes at `at` do not hold this batch; `batch` is then in an
/// unspecified state.
bool read_layer(std::span<const std::byte> bytes, size_t& at, StrandBatch& batch) {
  Header header;
  if (at > bytes.size() || bytes.size() - at < sizeof(header)) return false;
  std::memcpy(&header, bytes.data() + at, sizeof(header));
  const size_t n = batch.count, points = batch.points.size();
  if (header.count != n || header.points != points) return false;
  if (header.color_rows != 0 && header.color_rows != batch.colors.size()) return false;
  const size_t rows = 1 + 3 * (points - 1) + (header.has_radii ? points : 0) + 3 * size_t(header.color_rows);
  if ((bytes.size() - at - sizeof(header)) / (4 * n) < rows) return false;
  at += sizeof(header);
  const auto take = [&](StrandRow& row) {
    std::memcpy(row.data(), bytes.data() + at, 4 * n);
    at += 4 * n;
  };
  take(batch.clump);
  for (size_t p = 1; p < points; ++p) {
    for (StrandRow& axis : batch.points[p].offset) take(axis);
  }
  for (StrandBatch::PointRows& point : batch.points) {
    if (header.has_radii) {
      take(point.radius);
    } else {
      point.radius.fill(0.0f);
    }
  }
  if (header.color_rows) {
    for (VectorRow& color : batch.colors) {
      for (StrandRow& channel : color) take(channel);
    }
  }
  return true;
}

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
