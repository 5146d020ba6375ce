// SPDX-License-Identifier: Apache-2.0
// Stored chunks, skins and tables are those recorded with their versions.
#include <gtest/gtest.h>

#include "render/accel/fur_chunk_file.h"
#include "render/fibre/medulla_tables.h"
#include "render/frame/stored_skins.h"
#include "tests/geom/random_strands.h"
#include "tests/procedurals/random_coats.h"
#include "tests/support/recorded_results.h"

namespace pelage {
namespace {

TEST(StoredVersions, ChunksOfFur) {
  StageResult result;
  for (const int keys : {1, 2}) {
    ChunkContents contents;
    contents.geometry =
        FurContents{random_strands(7, {.strands = 200, .motion_keys = keys, .wander = 0.3f}), {}};
    FurChunkOptions options;
    options.tree.build.rotation = keys == 1 ? FurRotation::kAlways : FurRotation::kWhenUseful;
    const FurChunk chunk(std::move(contents), 0, FurGrid({0.02f, V3f(0.1f, -0.2f, 0.05f), 0.03f}), options);
    const FurTree& tree = chunk.tree();
    const auto add = [&](const char* name, std::span<const std::byte> bytes) {
      result.add(name + (" at " + std::to_string(keys)),
                 std::span(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()));
    };
    add("packed strands", chunk.strands().stored_block());
    add("nodes", {tree.view().nodes, tree.node_bytes()});
    add("leaves", {tree.view().leaves, tree.leaf_bytes()});
  }
  RecordedResults().check("chunks of fur", {{"chunks of fur", FurChunkFile::kVersion}},
                          "FurChunkFile::kVersion in render/accel/fur_chunk_file.h", result);
}

TEST(StoredVersions, Skins) {
  const RandomCoat coat(1, {.cage_levels = 3});
  QuietJob job(2);
  const View view{coat.skin->bound(BoundSpan::kShutter).center() + V3f(0, 0, 12), 900};
  std::vector<float> points;
  std::vector<uint32_t> triangles;
  for (const SkinPiece& piece : coat.skin->divide(view, 2000, job)) {
    const SkinMesh mesh = coat.skin->tessellate(piece, view);
    points.insert(points.end(), mesh.positions.begin(), mesh.positions.end());
    points.insert(points.end(), mesh.normals.begin(), mesh.normals.end());
    for (const V2f& uv : mesh.vertex_uv) points.insert(points.end(), {uv.x, uv.y});
    triangles.insert(triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
    triangles.insert(triangles.end(), mesh.faces.begin(), mesh.faces.end());
  }
  StageResult result;
  result.add("points", points);
  result.add("triangles", triangles);
  RecordedResults().check("skins", {{"skins", StoredSkins::kVersion}},
                          "StoredSkins::kVersion in render/frame/stored_skins.h", result);
}

TEST(StoredVersions, MedullaTables) {
  const auto tables = MedullaTables::make(YanOptics{}, Workers(2), 60);
  std::vector<float> values;
  for (const MedullaTables::Node& node : tables->nodes()) {
    values.insert(values.end(), node.azimuth.begin(), node.azimuth.end());
    for (const auto& half : node.sine) values.insert(values.end(), half.begin(), half.end());
    values.insert(values.end(), {node.lengths.mean_core(), node.lengths.mean_cortex()});
  }
  StageResult result;
  result.add("values", values);
  RecordedResults().check("medulla tables", {{"medulla tables", MedullaTables::kVersion}},
                          "MedullaTables::kVersion in render/fibre/medulla_tables.h", result);
}

}  // namespace
}  // namespace pelage
