// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <limits>

#include "base/file.h"
#include "base/temporary_folder.h"
#include "render/accel/fur_chunk_file.h"
#include "tests/fuzz/corpus.h"
#include "tests/render/accel/fur/fur_grooms.h"

namespace pelage {
namespace {

constexpr uint32_t kKinds = 6;

/// Of every kind that a file may hold, with everything that a strand may have.
std::unique_ptr<FurChunk> small_chunk(uint32_t kind) {
  GroomShape shape;
  shape.basis = kind == 1 ? CurveBasis::kLinear : kind == 2 ? CurveBasis::kBSpline : shape.basis;
  shape.motion_keys = kind == 3 ? 2 : 1;
  StrandArrays arrays = random_groom(shape, 5, kind).release();
  const size_t strands = arrays.ids.size(), points = arrays.first_point.back();
  FurContents fur;
  if (kind != 4) {
    arrays.attributes.push_back(
        {"color", AttributeClass::kPerPoint, 3, std::vector<float>(3 * points, 0.25f)});
    arrays.attributes.back().values[1] = 0.5f;
    arrays.attributes.push_back({"tint", AttributeClass::kConstant, 1, {0.75f}});
    for (size_t s = 0; s < strands; ++s) {
      const auto k = static_cast<float>(s);
      arrays.roots.push_back({static_cast<uint32_t>(s), 0.1f * k, 0.5f});
      arrays.root_uv.emplace_back(0.1f * k, 0.25f);
    }
  }
  if (kind == 2 || kind == 3) {
    for (size_t i = 0; i < points; ++i) fur.opacity.push_back(i % 2 == 0 ? 0.25f : 0.75f);
  }
  if (kind == 5) arrays.ids.back() = uint64_t(1) << 40;
  fur.strands = Strands(std::move(arrays));
  FurChunkOptions options;
  options.compact_attributes = kind != 5;
  options.tree.build.rotation = kind == 0 ? FurRotation::kAlways : FurRotation::kNever;
  return std::make_unique<FurChunk>(ChunkContents{std::move(fur), kind}, kind, FurGrid(shape.width), options);
}

std::string chunk_file(std::initializer_list<uint32_t> kinds) {
  const TemporaryFolder folder;
  const ContentStore store(folder.path());
  FurChunkFile::Writer writer(store, {1, 2});
  for (const uint32_t kind : kinds) writer.add(kind < kKinds ? small_chunk(kind).get() : nullptr);
  writer.commit([](const std::string&) {});
  return read_file(std::filesystem::directory_iterator(folder.path())->path());
}

/// Whose box would hold nothing.
std::string unbounded_chunk_file() {
  constexpr size_t kBox = 64 + 32;  // in what is known of the first chunk
  std::string file = chunk_file({0});
  const float nothing = std::numeric_limits<float>::quiet_NaN();
  for (size_t i = 0; i < 6; ++i) std::memcpy(&file[kBox + 4 * i], &nothing, sizeof(nothing));
  return file;
}

}  // namespace

std::vector<std::string> chunks_corpus() {
  return {chunk_file({0, 3}), chunk_file({1, kKinds, 2}), chunk_file({4}), chunk_file({5}),
          chunk_file({}),     unbounded_chunk_file()};
}

}  // namespace pelage
