// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/fuzz/corpus.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/support/allocation_meter.h"

namespace pelage {
namespace {

// A generated corpus goes through the functions that are fuzzed. A crash or another exception fails the test;
// hangs are caught by the time limit of ctest.

struct Replay {
  const char* name;
  void (*feed)(std::span<const uint8_t>);
  std::vector<std::string> (*corpus)();
  int count;  ///< damaged copies of each kind
  /// Bytes that one input may make the reader take. OpenImageIO asks for 64 MiB to read the smallest of
  /// images.
  size_t max_heap;
};

class Fuzz : public testing::TestWithParam<Replay> {};

INSTANTIATE_TEST_SUITE_P(Readers, Fuzz,
                         testing::Values(Replay{"hair", fuzz_hair, hair_corpus, 400, 4 << 20},
                                         Replay{"tfx", fuzz_tfx, tfx_corpus, 400, 4 << 20},
                                         Replay{"obj", fuzz_obj, obj_corpus, 400, 64 << 20},
                                         Replay{"hdr", fuzz_hdr, hdr_corpus, 200, 256 << 20},
                                         Replay{"exr", fuzz_exr, exr_corpus, 200, 256 << 20},
                                         Replay{"ies", fuzz_ies, ies_corpus, 400, 4 << 20},
                                         Replay{"post", fuzz_post, post_corpus, 60, 192 << 20},
                                         Replay{"request", fuzz_request, request_corpus, 400, 1 << 20},
                                         Replay{"scene", fuzz_scene, scene_corpus, 400, 16 << 20},
                                         Replay{"cache", fuzz_cache, cache_corpus, 400, 4 << 20},
                                         Replay{"checkpoint", fuzz_checkpoint, checkpoint_corpus, 400,
                                                4 << 20},
                                         Replay{"leaf", fuzz_leaf, leaf_corpus, 400, 16 << 20},
                                         Replay{"fur", fuzz_fur, fur_corpus, 4000, 1 << 20},
                                         Replay{"chunks", fuzz_chunks, chunks_corpus, 400, 16 << 20},
                                         Replay{"rib", fuzz_rib, rib_corpus, 400, 64 << 20},
                                         Replay{"usd", fuzz_usd, usd_corpus, 400, 64 << 20},
                                         Replay{"alembic", fuzz_alembic, alembic_corpus, 400, 64 << 20}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(Fuzz, SurvivesItsCorpus) {
  const Replay& replay = GetParam();
  size_t worst = 0;
  int inputs = 0;
  const auto feed = [&](const std::string& bytes) {
    const size_t before = live_bytes();
    reset_peak();
    replay.feed({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
    const size_t cost = peak_bytes() - std::min(before, peak_bytes());
    worst = std::max(worst, cost);
    EXPECT_LE(cost, replay.max_heap) << "input " << inputs << " of " << bytes.size() << " bytes";
    ++inputs;
  };
  const std::vector<std::string> corpus = replay.corpus();
  feed(corpus.front());  // loads what loads once
  worst = 0;
  for (const std::string& input : corpus) feed(input);
  for_each_damaged(corpus.front(), replay.count, feed);
  if (corpus.size() > 1) for_each_damaged(corpus[1], replay.count / 4, feed);
  RecordProperty("inputs", inputs);
  RecordProperty("worst_heap_bytes", std::to_string(worst));
}

}  // namespace
}  // namespace pelage
