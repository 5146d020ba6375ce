// SPDX-License-Identifier: Apache-2.0
// Skins that are read from a file against skins that are tessellated.
#include "render/frame/stored_skins.h"

#include <cstring>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary_folder.h"
#include "render/frame/frame_chunks.h"
#include "tests/procedurals/random_coats.h"
#include "tests/support/allocation_meter.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

class StoredSkinsTest : public testing::Test {
 protected:
  struct Warnings final : Progress {
    void begin(std::string_view, double) override {}
    void advance(double) override {}
    void end() override {}
    bool cancelled() const override { return false; }
    void warn(std::string_view line) override { lines.emplace_back(line); }
    std::vector<std::string> lines;
  };

  /// Two skins, near the camera, with a budget for which they are divided.
  RenderScene scene(bool stores, float from = 2) const {
    CameraParams camera;
    const Box3f box = large_.skin->bound(BoundSpan::kShutter);
    camera.look_at = box.center();
    camera.position = box.center() + V3f(0, 0, from * box.size().length());
    ImageParams image;
    image.width = image.height = 2000;
    RenderParams render;
    render.memory.bytes = uint64_t(64) << 20;
    if (stores) render.bvh.file.path = folder_.path().string();
    std::vector<SkinPart> skins(2);
    skins[0].skin = large_.skin, skins[0].rest = large_.rest;
    skins[1].skin = small_.skin, skins[1].rest = small_.rest;
    return {{},
            std::move(skins),
            {LambertParams{}},
            LightSet({}),
            Camera(camera, 1, image.width, image.height),
            image,
            render};
  }
  Job job() { return {workers_, ledger_, warnings_}; }
  std::filesystem::path entry() const {
    std::filesystem::path found;
    for (const auto& file : std::filesystem::directory_iterator(folder_.path())) {
      if (file.path().filename().string().starts_with("skins-")) found = file.path();
    }
    return found;
  }
  static void expect_equal(const FrameChunks& a, const FrameChunks& b) {
    ASSERT_EQ(a.size(), b.size());
    for (uint32_t chunk = 0; chunk < a.size(); ++chunk) {
      EXPECT_EQ(a.part(chunk), b.part(chunk));
      EXPECT_EQ(a.counts(chunk).triangles, b.counts(chunk).triangles);
      EXPECT_EQ(a.counts(chunk).growth_bytes, b.counts(chunk).growth_bytes);
      const ChunkContents of_a = a.grow(chunk), of_b = b.grow(chunk);
      const auto &mesh_a = std::get<SkinMesh>(of_a.geometry), &mesh_b = std::get<SkinMesh>(of_b.geometry);
      EXPECT_EQ(mesh_a.motion_keys, mesh_b.motion_keys);
      EXPECT_TRUE(mesh_a.positions == mesh_b.positions && mesh_a.normals == mesh_b.normals);
      EXPECT_TRUE(mesh_a.triangles == mesh_b.triangles && mesh_a.faces == mesh_b.faces);
      EXPECT_TRUE(mesh_a.vertex_uv == mesh_b.vertex_uv);
    }
  }

  const RandomCoat large_{1, {.cage_levels = 4}}, small_{2, {.cage_levels = 3}};
  TemporaryFolder folder_;
  Workers workers_{2};
  MemoryLedger ledger_;
  Warnings warnings_;
};

TEST_F(StoredSkinsTest, PiecesAndTrianglesAreThoseOfTheSkins) {
  const RenderScene plain = scene(false), stored = scene(true);
  const FrameChunks expected(plain, job());
  ASSERT_GT(expected.size(), 4u);
  FrameChunks first(stored, job());
  first.store_skins(job());
  ASSERT_NE(entry(), "");
  const FrameChunks second(stored, job());
  expect_equal(expected, first);
  expect_equal(expected, second);
  for (uint32_t chunk = 0; chunk < second.size(); ++chunk) {  // what reading takes is reserved before
    const size_t before = live_bytes();
    reset_peak();
    const ChunkContents contents = second.grow(chunk);
    EXPECT_LE(peak_bytes() - before, live_bytes() - before + second.counts(chunk).growth_bytes);
  }
  EXPECT_TRUE(warnings_.lines.empty());
}

TEST_F(StoredSkinsTest, PiecesAreInMemoryOnce) {
  const RenderScene plain = scene(false), stored = scene(true);
  const FrameChunks made(plain, job());
  FrameChunks(stored, job()).store_skins(job());
  const StoredSkins skins(StoredSections(entry()), stored, [](const std::string&) {});
  size_t faces = 0;
  for (const SkinChunk& chunk : skins.pieces()) faces += chunk.piece.faces.size() * sizeof(uint32_t);
  EXPECT_GT(faces, 0u);
  EXPECT_LE(FrameChunks(stored, job()).bytes() + faces, made.bytes() + skins.bytes());
}

TEST_F(StoredSkinsTest, AnotherViewHasAnotherEntry) {
  const RenderScene near = scene(true), far = scene(true, 3), plain = scene(false, 3);
  FrameChunks(near, job()).store_skins(job());
  const std::filesystem::path stored = entry();
  const FrameChunks chunks(far, job()), expected(plain, job());
  expect_equal(expected, chunks);
  EXPECT_NE(StoredSkins::key(near, 1000), StoredSkins::key(far, 1000));
  EXPECT_NE(StoredSkins::key(near, 1000), StoredSkins::key(near, 1001));
}

TEST_F(StoredSkinsTest, DamageIsReportedOnceAndMadeGood) {
  const RenderScene stored = scene(true), plain = scene(false);
  const FrameChunks expected(plain, job());
  FrameChunks(stored, job()).store_skins(job());
  const std::filesystem::path path = entry();
  const std::string good = read_file(path);
  for (const double place : {0.01, 0.3, 0.6, 0.9, 0.999}) {
    warnings_.lines.clear();
    std::string bad = good;
    for (size_t i = 0; i < 64; ++i) bad[static_cast<size_t>(place * double(good.size())) - i] ^= 85;
    write_file(path, bad);
    const FrameChunks chunks(stored, job());
    expect_equal(expected, chunks);
    EXPECT_EQ(warnings_.lines.size(), 1u) << place;
    write_file(path, good.substr(0, static_cast<size_t>(place * double(good.size()))));
    expect_equal(expected, FrameChunks(stored, job()));
  }
}

// Checksums are right, numbers are wrong: as in a file that somebody else has written.
TEST_F(StoredSkinsTest, ImpossibleFilesAreRefused) {
  const RenderScene stored = scene(true);
  FrameChunks(stored, job()).store_skins(job());
  const StoredSections good(entry());
  const auto is_refused = [&](size_t section, size_t place, uint32_t value) {
    const std::filesystem::path path = folder_.path() / "bad.cache";
    ContentStore::Writer writer(path, "skins", {1, 2});
    for (size_t i = 0; i < good.section_count(); ++i) {
      std::vector<std::byte> bytes(good.section_bytes(i));
      good.read(i, bytes);
      if (i == section) std::memcpy(&bytes[place], &value, sizeof value);
      writer.add(std::span<const std::byte>(bytes));
    }
    EXPECT_TRUE(writer.commit([](const std::string& line) { ADD_FAILURE() << line; }));
    try {
      const StoredSkins skins(StoredSections(path), stored, [](const std::string&) {});
      return !skins.mesh(0);
    } catch (const Error& error) {
      return error.kind() == ErrorKind::kInput;
    }
  };
  EXPECT_FALSE(is_refused(0, 24, 0));       // nothing that is checked: the temporary bytes of the first piece
  EXPECT_TRUE(is_refused(0, 0, 1));         // the first skin has no piece
  EXPECT_TRUE(is_refused(0, 0, 9));         // no such skin
  EXPECT_TRUE(is_refused(0, 4, 1u << 30));  // more faces than are listed
  EXPECT_TRUE(is_refused(0, 8, 7));         // vertices
  EXPECT_TRUE(is_refused(0, 16, 7));        // triangles
  EXPECT_TRUE(is_refused(1, 4, 1u << 30));  // no such face
  EXPECT_TRUE(is_refused(4, 0, 1u << 30));  // no such vertex
  EXPECT_TRUE(is_refused(5, 0, 1u << 30));  // a triangle of no face
}

}  // namespace
}  // namespace pelage
