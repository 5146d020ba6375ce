// SPDX-License-Identifier: Apache-2.0
// Trees of a frame that are kept between runs (render.bvh.file) change no pixel.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/temporary_folder.h"
#include "cli/commands.h"
#include "lab/pictures/picture_difference.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

class BvhFileTest : public testing::Test {
 protected:
  std::string render(const std::string& name, std::vector<Override> overrides) {
    Options options;
    options.command = Command::kRender;
    options.input = (std::filesystem::path(PELAGE_SOURCE_DIR) / "examples" / "colony_small.yaml").string();
    options.progress = ProgressStyle::kQuiet;
    options.overrides = {{"image.width", std::to_string(width_)},
                         {"image.height", std::to_string(width_ * 9 / 16)},
                         {"render.samples", "1"},
                         {"render.accel", "fur"},
                         {"grooms.under.strands", "900"},
                         {"grooms.guard.strands", "400"}};
    options.overrides.insert(options.overrides.end(), overrides.begin(), overrides.end());
    options.output = (folder_.path() / (name + ".exr")).string();
    options.stats = (folder_.path() / "stats.json").string();
    testing::internal::CaptureStderr();
    EXPECT_EQ(run_render(options), 0);
    const std::string said = testing::internal::GetCapturedStderr();
    warnings_ = static_cast<int>(std::count(said.begin(), said.end(), '\n'));
    statistics_ = nlohmann::json::parse(read_file(*options.stats));
    return options.output;
  }
  std::string stored(const std::string& name, std::vector<Override> overrides = {}) {
    overrides.push_back({"render.bvh.file", (folder_.path() / "trees").string()});
    return render(name, std::move(overrides));
  }
  /// The file of a kind: "fur-chunks" or "skins".
  std::filesystem::path file(const std::string& kind = "fur-chunks") const {
    std::filesystem::path found;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "trees")) {
      if (entry.path().filename().string().starts_with(kind)) found = entry.path();
    }
    return found;
  }
  void damage(const std::vector<size_t>& places) const {
    std::string bytes = read_file(file());
    for (const size_t at : places) bytes[at] = static_cast<char>(bytes[at] ^ 1);
    std::ofstream(file(), std::ios::binary) << bytes;
  }
  static void expect_equal(const std::string& a, const std::string& b) {
    const auto difference = compare_picture_files(a, b);
    ASSERT_TRUE(difference);
    EXPECT_EQ(difference->differing, 0) << b;
  }

  TemporaryFolder folder_;
  int width_ = 160;
  nlohmann::json statistics_;
  int warnings_ = 0;  // lines of the last run
};

TEST_F(BvhFileTest, ChangesNoPixel) {
  if (kSanitized) width_ /= 2;
  const std::string lazy = render("lazy", {});
  const int64_t grown = statistics_["strands_generated"];
  EXPECT_EQ(statistics_["chunks_read"], 0);
  expect_equal(lazy, render("eager", {{"render.bounds", "none"}}));
  expect_equal(lazy, stored("first"));
  EXPECT_GT(statistics_["chunks_read"], 0);
  expect_equal(lazy, stored("second"));
  EXPECT_GT(statistics_["chunk_bytes_read"], 0);
  EXPECT_EQ(statistics_["strands_generated"], 0);
  EXPECT_GT(grown, 0);
  const int64_t chunks = statistics_["memory_bytes"]["chunks"], film = statistics_["memory_bytes"]["film"],
                skins = statistics_["memory_bytes"]["skins"], read = statistics_["chunks_read"];
  // Under a budget pages come and go.
  expect_equal(lazy, stored("small", {{"render.memory", std::to_string(film + skins + chunks / 2)}}));
  EXPECT_GT(statistics_["chunks_read"], read);
  EXPECT_LE(statistics_["memory_bytes"]["chunks"], chunks);
  // Another frame, and another coat, are other files.
  stored("other", {{"grooms.under.strands", "901"}});
  EXPECT_GT(statistics_["strands_generated"], 0);
}

TEST_F(BvhFileTest, IsMadeAgainWhenItsTableIsDamaged) {
  const std::string first = stored("first");
  const std::string whole = read_file(file());
  damage({whole.size() - 20});
  expect_equal(first, stored("again"));
  EXPECT_EQ(warnings_, 1);
  EXPECT_GT(statistics_["strands_generated"], 0);
  EXPECT_EQ(read_file(file()), whole);
}

// Chunks are checked when they are read: one that is damaged is grown, all others are read.
TEST_F(BvhFileTest, ChunksThatAreDamagedAreGrown) {
  const std::string first = stored("first");
  const std::string whole = read_file(file());
  const int64_t all = statistics_["strands_generated"], read = statistics_["chunks_read"];
  for (const std::vector<size_t>& places :
       {std::vector{whole.size() / 3}, {whole.size() / 5, whole.size() / 2, whole.size() / 7 * 5}}) {
    damage(places);
    expect_equal(first, stored("damaged"));
    EXPECT_EQ(warnings_, 1);
    EXPECT_GT(statistics_["strands_generated"], 0);
    EXPECT_LT(statistics_["strands_generated"], all);
    EXPECT_GT(statistics_["chunks_read"], read / 2);
    expect_equal(first, stored("made again"));
    EXPECT_EQ(warnings_, 0);
    EXPECT_EQ(read_file(file()), whole);
  }
}

TEST_F(BvhFileTest, SkinsThatAreDamagedAreMadeAgain) {
  const std::string first = stored("first");
  const std::string whole = read_file(file("skins"));
  ASSERT_FALSE(whole.empty());
  for (const size_t place : {whole.size() / 3, whole.size() - 20}) {  // triangles; the table
    std::string bytes = whole;
    bytes[place] = static_cast<char>(bytes[place] ^ 1);
    write_file(file("skins"), bytes);
    expect_equal(first, stored("damaged"));
    EXPECT_EQ(warnings_, 1);
    expect_equal(first, stored("made again"));
    EXPECT_EQ(warnings_, 0);
    EXPECT_EQ(read_file(file("skins")), whole);
  }
}

// A folder that takes nothing costs next to nothing: not a frame grown for a file that will not be.
TEST_F(BvhFileTest, GrowsNothingForAFolderThatTakesNothing) {
  const std::string plain = render("plain", {});
  const int64_t grown = statistics_["strands_generated"];
  expect_equal(plain, render("nowhere", {{"render.bvh.file", "/proc/none"}}));
  EXPECT_EQ(statistics_["strands_generated"], grown);
}

TEST_F(BvhFileTest, IsNotUsedForWhatItCannotKeep) {
  const std::string plain = render("plain", {{"materials.fur.opacity", "0.5"}});
  expect_equal(plain, stored("stored", {{"materials.fur.opacity", "0.5"}}));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "trees"));
}

}  // namespace
}  // namespace pelage
