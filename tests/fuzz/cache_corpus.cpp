// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "base/content_store.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/temporary_folder.h"
#include "groom/cache/frozen_leaf_writer.h"
#include "groom/cache/strand_layer.h"
#include "tests/fuzz/corpus.h"

namespace pelage {
namespace {

std::string text(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::unique_ptr<StrandBatch> random_batch(size_t count, size_t points, size_t color_rows, uint64_t seed) {
  auto batch = std::make_unique<StrandBatch>();
  batch->count = count;
  batch->points.resize(points);
  batch->colors.resize(color_rows);
  uint64_t next = 0;
  const auto number = [&] { return unit_float(hash64(seed, next++)); };
  for (size_t s = 0; s < count; ++s) {
    batch->ids[s] = s;
    batch->clump[s] = number();
    batch->rest.set(s, V3f(0), Frame{V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1)});
    for (size_t p = 0; p < points; ++p) {
      batch->set_offset(static_cast<int>(p), s, V3f(number(), number(), number()) * static_cast<float>(p));
      batch->points[p].radius[s] = 0.1f * number();
    }
    for (VectorRow& color : batch->colors) set_vector(color, s, V3f(number(), number(), number()));
  }
  return batch;
}

std::string leaf_bytes(size_t points, size_t color_rows, uint64_t seed) {
  FrozenLeafWriter writer;
  writer.add(*random_batch(7, points, color_rows, seed));
  writer.add(*random_batch(3, points, color_rows, seed + 1));
  return text(writer.finish());
}

// Strands of few kinds, which share entries of tables.
std::string alike_leaf_bytes(size_t kinds) {
  FrozenLeafWriter writer({true});
  const auto batch = random_batch(250, 5, 5, 9);
  for (size_t s = kinds; s < batch->count; ++s) {
    batch->clump[s] = batch->clump[s % kinds];
    for (auto& point : batch->points) point.radius[s] = point.radius[s % kinds];
    for (VectorRow& color : batch->colors) set_vector(color, s, vector_at(color, s % kinds));
  }
  for (int i = 0; i < 2; ++i) writer.add(*batch);
  return text(writer.finish());
}

}  // namespace

std::vector<std::string> leaf_corpus() {
  std::vector<std::byte> layer;
  append_layer(*random_batch(3, 4, 1, 5), layer);
  return {leaf_bytes(4, 4, 1),
          leaf_bytes(3, 1, 2),
          leaf_bytes(2, 0, 3),
          alike_leaf_bytes(1),
          alike_leaf_bytes(40),
          text(layer),
          text(FrozenLeafWriter().finish()),
          std::string(64, '\xff')};
}

std::vector<std::string> cache_corpus() {
  const TemporaryFolder folder;
  const ContentStore store(folder.path());
  std::vector<std::string> files;
  for (const char* kind : {"offsets", "manifest", "follicles"}) {
    ContentStore::Writer writer = store.writer(kind, {1, 2});
    const std::string head(16, '\1'), leaf = leaf_bytes(4, 4, 1);
    writer.add(std::as_bytes(std::span(head.data(), head.size())));
    if (kind != std::string("manifest")) writer.add(std::as_bytes(std::span(leaf.data(), leaf.size())));
    writer.commit([](const std::string&) {});
    files.push_back(read_file(store.file(kind, {1, 2})));
  }
  return files;
}

}  // namespace pelage
