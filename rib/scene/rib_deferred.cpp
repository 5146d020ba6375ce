// SPDX-License-Identifier: Apache-2.0
// The strands of RIB files as procedurals.
#include <limits>

#include "geom/strand_merge.h"
#include "procedurals/bounds/segment_parts.h"
#include "procedurals/fixed_strands.h"
#include "rib/scene/rib_interpreter.h"

namespace pelage {
namespace {

/// A batch of an archive, which is read again for each use.
class RibArchiveBatch final : public Procedural {
 public:
  RibArchiveBatch(RibDeferredBatch batch, const StrandScale& scale)
      : batch_(std::move(batch)), scale_(scale) {}
  Box3f bound(BoundSpan) const override { return batch_.box; }
  Strands generate() const override { return batch_.archive->read(batch_.batch, batch_.counts); }
  StrandCounts counts() const override { return batch_.counts; }
  StrandScale scale() const override { return scale_; }
  ChunkBounds exact_bounds(BoundSpan, int keys) const override {
    const Strands strands = generate();
    return SegmentParts(strands).exact_bounds(keys);
  }
  /// The open batch and the finished one, and the arrays of one request.
  size_t temporary_bytes() const override {
    const size_t floats =
        4 * batch_.counts.points * batch_.counts.motion_keys + batch_.counts.attribute_floats;
    return 4 * sizeof(float) * floats + batch_.archive->request_bytes;
  }
  size_t bytes() const override { return sizeof(*this); }

 private:
  RibDeferredBatch batch_;
  StrandScale scale_;
};

/// All batches of a coat. Splits into one procedural per batch.
class RibCoatProcedural final : public Procedural {
 public:
  explicit RibCoatProcedural(RibCoat coat) : coat_(std::move(coat)) {}
  Box3f bound(BoundSpan span) const override {
    Box3f box;
    for (const auto& leaf : split()) box.extendBy(leaf->bound(span));
    return box;
  }
  std::vector<std::unique_ptr<Procedural>> split() const override {
    std::vector<std::unique_ptr<Procedural>> leaves;
    for (const auto& batch : coat_.batches)
      leaves.push_back(std::make_unique<FixedStrands>(batch, coat_.scale));
    for (const auto& batch : coat_.deferred)
      leaves.push_back(std::make_unique<RibArchiveBatch>(batch, coat_.scale));
    return leaves;
  }
  Strands generate() const override {
    std::vector<Strands> batches;
    for (const auto& leaf : split()) batches.push_back(leaf->generate());
    return merge(batches);
  }
  StrandCounts counts() const override {
    StrandCounts sum;
    for (const auto& leaf : split()) sum += leaf->counts();
    return sum;
  }
  StrandScale scale() const override { return coat_.scale; }
  ChunkBounds exact_bounds(BoundSpan span, int keys) const override {
    ChunkBounds all;
    all.keys = keys;
    for (const auto& leaf : split()) {
      const ChunkBounds bounds = leaf->exact_bounds(span, keys);
      all.boxes.insert(all.boxes.end(), bounds.boxes.begin(), bounds.boxes.end());
    }
    return all;
  }

 private:
  RibCoat coat_;
};

}  // namespace

Strands RibDeferredArchive::read(size_t batch, const StrandCounts& expected) const {
  RibReadOptions options;
  options.max_request_bytes =
      std::numeric_limits<size_t>::max();  // was checked when the archive was measured
  RibInterpreter interpreter(options, context);
  std::optional<Strands> found;
  size_t number = 0;
  interpreter.set_take([&](size_t, Strands strands) {
    if (number++ != batch) return;
    found = std::move(strands);
    interpreter.stop();
  });
  interpreter.read_file(path, nullptr);
  if (!found) interpreter.finish();
  const StrandCounts counts = found ? counts_of(*found) : StrandCounts();
  if (!found || counts.points != expected.points || counts.strands != expected.strands ||
      counts.segments != expected.segments || counts.motion_keys != expected.motion_keys ||
      counts.attribute_floats != expected.attribute_floats)
    throw Error(ErrorKind::kInput, {path.string(), 0, 0}, "the file changed while it was in use");
  return std::move(*found);
}

std::unique_ptr<Procedural> rib_procedural(const RibCoat& coat) {
  return std::make_unique<RibCoatProcedural>(coat);
}

}  // namespace pelage
