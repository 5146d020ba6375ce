// SPDX-License-Identifier: Apache-2.0
#include "groom/cache/growth_cache.h"

#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "tests/groom/shapes.h"
#include "tests/support/quiet_job.h"

namespace pelage::growth_cache_test {
namespace {

class GrowthCacheTest : public testing::Test {
 protected:
  std::filesystem::path folder() const { return folder_.path() / "made" / "later"; }

  /// The follicles of a coat through a cache, or without one.
  FollicleTree place(const GrowthCache* cache, uint64_t seed = 1, int64_t count = 6000) {
    const auto make = [&] {
      ++placed_;
      FollicleOptions options;
      options.count = count;
      options.seed = seed;
      options.leaf_strands = 500;
      return FollicleTree::build(*rest_, options, job_);
    };
    const ContentHash key = ContentHasher().add(seed).add(count).digest();
    return cache ? cache->follicles(key, rest_->topology(), make, [&](const std::string&) { ++warnings_; })
                 : make();
  }

  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder(), error)) files.push_back(entry);
    return files;
  }

  const TemporaryFolder folder_;
  const std::shared_ptr<const LimitSurface> rest_ = shapes::surface_of(shapes::ball_cage());
  QuietJob job_;
  int placed_ = 0, warnings_ = 0;
};

void expect_same(const FollicleTree& a, const FollicleTree& b) {
  ASSERT_EQ(a.size(), b.size());
  ASSERT_EQ(a.leaves().size(), b.leaves().size());
  for (size_t i = 0; i < a.leaves().size(); ++i) {
    EXPECT_EQ(a.leaves()[i].end, b.leaves()[i].end);
    EXPECT_EQ(a.leaves()[i].rest_roots, b.leaves()[i].rest_roots);
  }
  for (size_t f = 0; f < a.size(); ++f) {
    ASSERT_EQ(a.id(f), b.id(f));
    ASSERT_EQ(a.root(f).face, b.root(f).face);
    ASSERT_EQ(a.root(f).u, b.root(f).u);
    ASSERT_EQ(a.root(f).v, b.root(f).v);
  }
}

TEST_F(GrowthCacheTest, HoldsWhatWouldBePlaced) {
  const FollicleTree fresh = place(nullptr);
  const GrowthCache cache(folder());
  expect_same(place(&cache), fresh);
  EXPECT_EQ(placed_, 2);
  expect_same(place(&cache), fresh);
  EXPECT_EQ(placed_, 2);
  place(&cache, 1, 100);  // too few to be worth a file
  EXPECT_EQ(files().size(), 1u);
  EXPECT_EQ(warnings_, 0);
}

TEST_F(GrowthCacheTest, PlacesAgainWhatIsDamaged) {
  const FollicleTree fresh = place(nullptr);
  const GrowthCache cache(folder());
  place(&cache);
  const std::filesystem::path file = files().at(0);
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(file));
  for (const std::streamoff at : {std::streamoff(0), size / 2, size - 1}) {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(at);
    const auto byte = static_cast<char>(stream.get() ^ 0x10);
    stream.seekp(at);
    stream.put(byte);
    stream.close();
    warnings_ = 0;
    expect_same(place(&cache), fresh);
    EXPECT_EQ(warnings_, 1) << at;
    placed_ = 0;
    expect_same(place(&cache), fresh);  // was written anew
    EXPECT_EQ(placed_, 0);
  }
  std::filesystem::resize_file(file, 10);
  expect_same(place(&cache), fresh);
}

TEST_F(GrowthCacheTest, WorksWhereNothingCanBeWritten) {
  std::ofstream(folder_.path() / "file") << "x";
  const GrowthCache cache(folder_.path() / "file" / "cache");
  expect_same(place(&cache), place(nullptr));
  expect_same(place(&cache), place(nullptr));
  EXPECT_EQ(warnings_, 0);
  EXPECT_EQ(cache.clear().files, 0u);
}

TEST_F(GrowthCacheTest, KeepsToItsSize) {
  place(std::make_unique<GrowthCache>(folder()).get());
  const uint64_t one = std::filesystem::file_size(files().at(0));
  const GrowthCache cache(folder(), 2 * one + one / 2);
  const auto age = [&](const std::filesystem::path& file, int hours) {
    std::filesystem::last_write_time(
        file, std::filesystem::file_time_type::clock::now() - std::chrono::hours(hours));
  };
  const std::filesystem::path first = files().at(0);
  age(first, 9);
  place(&cache, 2);
  for (const auto& file : files()) {
    if (file != first) age(file, 5);
  }
  place(&cache, 1);  // reads the first, which is then the last used
  place(&cache, 3);
  EXPECT_EQ(files().size(), 2u);
  placed_ = 0;
  place(&cache, 1);
  place(&cache, 3);
  EXPECT_EQ(placed_, 0);
  age(files().at(0), -1);  // written by a machine whose clock is ahead
  EXPECT_EQ(cache.clear().files, 2u);
  EXPECT_TRUE(files().empty());
}

TEST(GrowthCacheFolder, IsThatOfTheUser) {
  const char* const names[] = {"PELAGE_CACHE", "XDG_CACHE_HOME", "HOME"};
  std::string before[3];
  for (int i = 0; i < 3; ++i) before[i] = std::getenv(names[i]) ? std::getenv(names[i]) : "";
  const auto folder = [&](const char* own, const char* xdg, const char* home) {
    const char* const values[] = {own, xdg, home};
    for (int i = 0; i < 3; ++i) values[i] ? ::setenv(names[i], values[i], 1) : ::unsetenv(names[i]);
    return GrowthCache::folder_of_user();
  };
  EXPECT_EQ(folder("/a/b", "/x", "/h"), "/a/b");
  EXPECT_EQ(folder("off", "/x", "/h"), "");
  EXPECT_EQ(folder("", "/x", "/h"), "");
  EXPECT_EQ(folder(nullptr, "/x", "/h"), "/x/pelage");
  EXPECT_EQ(folder(nullptr, "x", "/h"), "/h/.cache/pelage");
  EXPECT_EQ(folder(nullptr, nullptr, "/h"), "/h/.cache/pelage");
  EXPECT_EQ(folder(nullptr, nullptr, nullptr), "");
  folder(before[0].c_str(), before[1].empty() ? nullptr : before[1].c_str(),
         before[2].empty() ? nullptr : before[2].c_str());
}

}  // namespace
}  // namespace pelage::growth_cache_test
