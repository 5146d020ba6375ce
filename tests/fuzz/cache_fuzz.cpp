// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <memory>

#include "base/check.h"
#include "base/content_store.h"
#include "base/error.h"
#include "cli/info.h"
#include "groom/cache/frozen_leaf.h"
#include "groom/cache/strand_layer.h"
#include "tests/fuzz/fuzz_targets.h"

namespace pelage {

void fuzz_cache(std::span<const uint8_t> bytes) {
  const std::filesystem::path path = fuzz_file(bytes, ".cache");
  try {
    const StoredFile file(path);
    for (size_t i = 0; i < file.section_count(); ++i) PELAGE_CHECK(file.section(i).size() <= bytes.size());
    describe_cache(file);
  } catch (const Error& error) {
    PELAGE_CHECK(error.kind() == ErrorKind::kInput);
  }
}

void fuzz_leaf(std::span<const uint8_t> bytes) {
  // Aligned as in a mapped file.
  const auto copy = std::make_unique<std::byte[]>(bytes.size() + 1);
  if (!bytes.empty()) std::memcpy(copy.get(), bytes.data(), bytes.size());
  const std::span<const std::byte> aligned(copy.get(), bytes.size());
  const auto batch = std::make_unique<StrandBatch>();
  for (size_t s = 0; s < kBlockStrands; ++s) {
    batch->ids[s] = s;
    batch->current.set(s, V3f(0), Frame{V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1)});
  }
  if (const std::optional<FrozenLeaf> leaf = FrozenLeaf::read(aligned)) {
    size_t strands = 0;
    for (const FrozenLeaf::Block& block : leaf->blocks()) {
      strands += block.count;
      batch->count = block.count;
      batch->points.resize(static_cast<size_t>(block.points));
      batch->colors.resize(static_cast<size_t>(block.points));
      leaf->attributes(block, *batch);
      leaf->shape(block, batch->current, 1, *batch);
    }
    PELAGE_CHECK(strands == leaf->strand_count());
  }
  // The same bytes as a layer.
  batch->count = 3;
  batch->points.resize(4);
  batch->colors.resize(1);
  for (size_t at = 0; read_layer(aligned, at, *batch);) PELAGE_CHECK(at <= aligned.size());
}

}  // namespace pelage
