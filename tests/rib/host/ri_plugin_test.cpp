// SPDX-License-Identifier: Apache-2.0
#include <thread>

#include <gtest/gtest.h>

#include "base/process_usage.h"
#include "tests/rib/host/ri_test_host.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

class RiPlugin : public testing::Test {
 protected:
  std::string coat(const std::string& more = {}) const {
    return files_.scene() + " character=walker coat=coat frame=2 threads=1" +
           (more.empty() ? "" : " " + more);
  }
  const FurryScene files_;
  const RiTestHost host_;
};

TEST_F(RiPlugin, HandsOverTheStrandsOfThePictureInTheirBoxes) {
  const RiCalls calls = host_.run(coat());
  EXPECT_EQ(calls.errors, std::vector<std::string>{});
  EXPECT_EQ(calls.faults, std::vector<std::string>{});
  EXPECT_EQ(calls.strands, picture_strands(files_.scene(), "walker.coat", 2));
  EXPECT_EQ(calls.strands.size(), 900u);
  EXPECT_EQ(calls.colored, 3 * calls.strands.size());  // in each of three keys
  EXPECT_EQ(calls.motion_blocks, calls.curves);
  EXPECT_EQ(calls.times, (std::vector<float>{-0.25f, 0, 0.25f}));
  EXPECT_GT(calls.procedurals, calls.curves);  // a tree above the leaves
  EXPECT_EQ(calls.freed, calls.procedurals);
  // A box around everything is the exact box, so the plugin accepts it as its bound.
  EXPECT_EQ(host_.run(coat(), 1e38f, &calls.box).faults, std::vector<std::string>{});
}

TEST_F(RiPlugin, NamesMayBeLeftOut) {
  const RiCalls calls = host_.run(files_.scene() + " frame=2 coat=whiskers");
  EXPECT_EQ(calls.strands, picture_strands(files_.scene(), "post.whiskers", 2));
  EXPECT_EQ(calls.motion_blocks, 0);
  EXPECT_EQ(host_.run(files_.scene() + " character=post").strands.size(), 30u);
}

TEST_F(RiPlugin, GrowsOnlyWhatTheRendererAsksFor) {
  const RiCalls calls = host_.run(coat(), 1e38f, nullptr, 0);
  EXPECT_EQ(calls.curves, 0);
  EXPECT_GT(calls.procedurals, 1);
  EXPECT_EQ(calls.freed, calls.procedurals);
  const RiCalls leaf = host_.run(coat("leaf=3"));
  EXPECT_EQ(leaf.procedurals, 0);
  EXPECT_EQ(leaf.curves, 1);
  const StrandsById all = picture_strands(files_.scene(), "walker.coat", 2);
  for (const auto& [id, strand] : leaf.strands) EXPECT_EQ(all.at(id), strand);
}

TEST_F(RiPlugin, MistakesGiveOneLineAndNoHair) {
  files_.write("broken.yaml", "pelage: 1\ncamera: {fof: 3}\ngrooms: 7\n");
  for (const std::string& arguments :
       {std::string(), std::string("frame="), std::string("/nowhere/rat.yaml"), files_.path("broken.yaml"),
        files_.scene() + " character=waker", coat("coat=cot"), coat("leaf=99"), coat("memory=100K"),
        coat("set=render.samples=x"), coat("camera=3"), files_.scene() + " frame=99999999999"}) {
    const RiCalls calls = host_.run(arguments);
    EXPECT_EQ(calls.errors.size(), 1u) << arguments;
    EXPECT_TRUE(calls.strands.empty() && calls.procedurals == 0) << arguments;
    if (!calls.errors.empty()) {
      EXPECT_TRUE(calls.errors[0].starts_with("pelage: error: ")) << calls.errors[0];
      EXPECT_EQ(calls.errors[0].find('\n'), std::string::npos) << calls.errors[0];
    }
  }
  EXPECT_EQ(host_.run(files_.scene() + " character=waker").errors[0],
            "pelage: error: procedural: there is no character 'waker'; did you mean 'walker'?");
  EXPECT_NE(host_.run(files_.path("broken.yaml")).errors[0].find("broken.yaml:2:10"), std::string::npos);
}

// Law 1, for a renderer with many threads.
TEST_F(RiPlugin, EightThreadsAtOnceGetTheSameStrands) {
  const StrandsById reference = picture_strands(files_.scene(), "walker.coat", 2);
  std::vector<RiCalls> calls(8);
  std::vector<std::thread> threads;
  for (size_t i = 0; i < calls.size(); ++i)
    threads.emplace_back([&, i] { calls[i] = host_.run(coat("set=render.seed=7")); });
  for (std::thread& thread : threads) thread.join();
  for (const RiCalls& one : calls) {
    EXPECT_EQ(one.errors, std::vector<std::string>{});
    EXPECT_EQ(one.faults, std::vector<std::string>{});
    EXPECT_EQ(one.strands, reference);
    EXPECT_EQ(one.freed, one.procedurals);
  }
}

// The points of a leaf take more than 70 kB, so 1,000 leaves that are not freed would take more than 70 MB.
// The heap may keep some of what was freed: the limit is an eighth of that.
TEST_F(RiPlugin, ManyProceduralsLeaveNothingBehind) {
  const auto leaf = [&](uint64_t i) {
    return coat("leaf=" + std::to_string(i % 2) + " set=grooms.coat.leaf_strands=400");
  };
  for (uint64_t i = 0; i < 20; ++i) host_.run(leaf(i));
  const int64_t before = current_rss_bytes();
  for (uint64_t i = 0; i < repetitions(1000); ++i) {
    const RiCalls calls = host_.run(leaf(i));
    ASSERT_GT(calls.strands.size() * 5 * 3 * 16, size_t(70000));
    ASSERT_EQ(calls.faults.size() + calls.errors.size(), 0u);
    host_.convert(leaf(i));
  }
  if (!kSanitized) {
    EXPECT_LT(current_rss_bytes() - before, int64_t(8) << 20);
  }
}

}  // namespace
}  // namespace pelage
