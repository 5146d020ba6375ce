// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/medulla_tables.h"

#include <atomic>
#include <cstring>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/temporary_folder.h"

namespace pelage {
namespace {

constexpr int kFew = 200;

bool same(const MedullaTables& a, const MedullaTables& b) {
  return a.nodes().size() == b.nodes().size() &&
         std::memcmp(a.nodes().data(), b.nodes().data(), a.nodes().size_bytes()) == 0;
}

TEST(MedullaTables, AreTheSameBitForBitByAnyNumberOfThreads) {
  const auto one = MedullaTables::make(YanOptics{}, Workers(1), kFew);
  EXPECT_TRUE(same(*one, *MedullaTables::make(YanOptics{}, Workers(3), kFew)));
  YanOptics other;
  other.g = 0.1f;
  EXPECT_FALSE(same(*one, *MedullaTables::make(other, Workers(1), kFew)));
}

TEST(MedullaTables, AreDistributions) {
  const auto tables = MedullaTables::make(YanOptics{}, Workers(2), kFew);
  const auto check = [](const auto& cumulative) {
    EXPECT_EQ(cumulative.front(), 0);
    EXPECT_EQ(cumulative.back(), 1);
    for (size_t i = 1; i < cumulative.size(); ++i) EXPECT_GT(cumulative[i], cumulative[i - 1]);
  };
  for (const MedullaTables::Node& node : tables->nodes()) {
    check(node.azimuth);
    check(node.sine[0]);
    check(node.sine[1]);
    EXPECT_GT(node.lengths.mean_core(), 0);
  }
}

/// Keeps warnings, and asks to stop once it has been asked so many times.
class Watcher final : public Progress {
 public:
  explicit Watcher(int patience = std::numeric_limits<int>::max()) : left_(patience) {}
  void begin(std::string_view, double total) override { expected += total; }
  void advance(double amount) override { done.fetch_add(amount); }
  void end() override {}
  void warn(std::string_view line) override { warnings.emplace_back(line); }
  bool cancelled() const override { return left_.fetch_sub(1) <= 0; }

  double expected = 0;
  std::atomic<double> done{0};
  std::vector<std::string> warnings;

 private:
  mutable std::atomic<int> left_;
};

TEST(MedullaTables, ShowHowFarTheyAreAndStopInTheMiddle) {
  const Workers workers(2);
  MemoryLedger ledger;
  Watcher patient;
  MedullaTables::make(YanOptics{}, Job{workers, ledger, patient}, kFew);
  EXPECT_GT(patient.expected, 100);
  EXPECT_EQ(patient.done, patient.expected);

  // Asked within the paths of one node, not only between nodes.
  const TemporaryFolder folder;
  Watcher hasty(10);
  try {
    MedullaTables::find_or_make(YanOptics{}, ContentStore(folder.path()), Job{workers, ledger, hasty});
    FAIL() << "made";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kStopped);
  }
  EXPECT_EQ(hasty.done, 0);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(MedullaTables, AreKeptAndADamagedFileIsMadeAnew) {
  const TemporaryFolder folder;
  const ContentStore store(folder.path());
  const Workers workers(2);
  MemoryLedger ledger;
  Watcher progress;
  const std::vector<std::string>& warnings = progress.warnings;
  const auto get = [&] {
    return MedullaTables::find_or_make(YanOptics{}, store, Job{workers, ledger, progress}, kFew);
  };
  const auto made = get();
  std::filesystem::path file;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (entry.is_regular_file() && is_stored_file(entry.path())) file = entry.path();
  }
  ASSERT_FALSE(file.empty());
  EXPECT_TRUE(same(*made, *get()));
  EXPECT_TRUE(warnings.empty());

  std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(static_cast<std::streamoff>(std::filesystem::file_size(file) / 2));
  bytes.write("damage", 6);
  bytes.close();
  EXPECT_TRUE(same(*made, *get()));
  EXPECT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(same(*made, *get()));
  EXPECT_EQ(warnings.size(), 1u) << "the file should have been replaced";
}

}  // namespace
}  // namespace pelage
