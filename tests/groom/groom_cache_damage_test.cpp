// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <fstream>
#include <thread>

#include <sys/resource.h>

#include "base/file.h"
#include "tests/groom/cached_coats.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

class GroomCacheDamageTest : public CachedCoatTest {
 protected:
  static constexpr const char* kOperators =
      "- length: {value: 0.5, variation: 0.4}\n- clump: {spacing: 0.3, amount: 0.6}\n"
      "- frizz: {amplitude: 0.02}\n- width: {root: 0.008, variation: 0.3}\n";
  Coat coat_{kOperators, "frizz", 200, 100};
  std::vector<float> truth() { return bits(*make(coat_), at_rest()); }
};

TEST_F(GroomCacheDamageTest, AChangedByteIsNeverWrongHairAndAtMostOneWarning) {
  const std::vector<float> right = truth();
  size_t refused = 0;
  for (const char* kind : {"offsets", "follicles", "layer", "manifest"}) {
    for (const auto& path : files(kind)) {
      const std::string whole = read_file(path);
      const size_t stride = std::max<size_t>(1, whole.size() / 25);
      for (size_t i = 0; i < whole.size(); i += stride) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
        std::ofstream(path, std::ios::binary) << damaged;
        if (std::string(kind) == "layer") std::filesystem::remove(files("offsets").front());
        warnings_.clear();
        const auto groom = make(coat_, 1);
        ASSERT_EQ(bits(*groom, at_rest()), right) << kind << " " << i;
        ASSERT_LE(warnings_.size(), 1u) << warnings_.back();
        refused += warnings_.size();
        ASSERT_TRUE(make(coat_, 1)->cache_report()->fresh) << "mended";
      }
      std::ofstream(path, std::ios::binary) << whole;
    }
  }
  EXPECT_GE(refused, 75u);
}

TEST_F(GroomCacheDamageTest, CutFilesAreGrownAgain) {
  const std::vector<float> right = truth();
  for (const char* kind : {"offsets", "follicles"}) {
    const auto path = files(kind).front();
    const std::string whole = read_file(path);
    for (const size_t length : {size_t(0), size_t(1), size_t(100), whole.size() / 2, whole.size() - 1}) {
      std::ofstream(path, std::ios::binary) << whole.substr(0, length);
      warnings_.clear();
      EXPECT_EQ(bits(*make(coat_), at_rest()), right);
      EXPECT_EQ(warnings_.size(), 1u);
    }
  }
}

// Files of the right name and form that hold other hair: made by hand, since content never gives them.
TEST_F(GroomCacheDamageTest, WholeFilesOfOtherStrandsAreRefused) {
  const std::vector<float> right = truth();
  const auto offsets = files("offsets").front(), follicles = files("follicles").front();
  const StoredFile shape(offsets), places(follicles);
  const ContentStore store(cache());
  const auto rewrite = [&](const StoredFile& from, const std::vector<std::vector<std::byte>>& sections) {
    ContentStore::Writer writer = store.writer(from.kind(), from.key());
    for (const auto& section : sections) writer.add(std::span<const std::byte>(section));
    ASSERT_TRUE(writer.commit([](const std::string&) {}));
  };
  const auto sections = [](const StoredFile& file) {
    std::vector<std::vector<std::byte>> copy;
    for (size_t i = 0; i < file.section_count(); ++i)
      copy.emplace_back(file.section(i).begin(), file.section(i).end());
    return copy;
  };
  auto fewer = sections(shape);
  fewer.pop_back();
  auto cut = sections(shape);
  cut.back().resize(cut.back().size() - 16);
  for (const auto& wrong : {fewer, cut, {}}) {
    rewrite(shape, wrong);
    warnings_.clear();
    EXPECT_EQ(bits(*make(coat_), at_rest()), right);
    EXPECT_EQ(warnings_.size(), 1u);
  }
  auto elsewhere = sections(places);
  std::fill_n(elsewhere[2].begin(), 2, std::byte(0xff));  // a face that is not there
  rewrite(places, elsewhere);
  warnings_.clear();
  EXPECT_EQ(bits(*make(coat_), at_rest()), right);
  EXPECT_EQ(warnings_.size(), 1u);
}

TEST_F(GroomCacheDamageTest, AFolderThatTakesNothingChangesNoHair) {
  const std::vector<float> right = truth();
  std::filesystem::remove_all(cache());
  std::ofstream(cache()) << "a file, not a folder";
  warnings_.clear();
  const auto groom = make(coat_);
  EXPECT_EQ(bits(*groom, at_rest()), right);
  EXPECT_FALSE(groom->cache_report()->stored);
  EXPECT_EQ(warnings_.size(), 1u) << warnings_.back();
  EXPECT_GT(ledger_.current(MemoryTag::kOperatorCache), 0);
}

TEST_F(GroomCacheDamageTest, AFullDiskChangesNoHair) {
  const std::vector<float> right = truth();
  std::filesystem::remove_all(cache());
  warnings_.clear();
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit limit{4096, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  const auto groom = make(coat_);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(bits(*groom, at_rest()), right);
  EXPECT_FALSE(groom->cache_report()->stored);
  EXPECT_EQ(warnings_.size(), 1u) << warnings_.back();
  for (const auto& path : files("offsets")) ADD_FAILURE() << path;
  EXPECT_EQ(bits(*make(coat_), at_rest()), right);
}

TEST_F(GroomCacheDamageTest, ManyAtOnceGrowItOnce) {
  const std::vector<float> right = truth();
  std::filesystem::remove_all(cache());
  std::vector<std::thread> threads;
  std::atomic<int> grown{0};
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      MemoryLedger ledger;
      TextureLibrary textures(ledger);
      const auto groom =
          Groom::create("coat", params_of(coat_), rest_, textures, QuietJob(Workers::alone(), ledger));
      if (!groom->cache_report()->fresh) ++grown;
      EXPECT_EQ(bits(*groom, at_rest()), right);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(files("offsets").size(), 1u);
  for (const auto& entry : std::filesystem::directory_iterator(cache()))
    EXPECT_FALSE(entry.path().filename().string().starts_with('.')) << entry.path();
}

}  // namespace
}  // namespace pelage
