// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "base/file.h"
#include "base/temporary_folder.h"
#include "tests/fuzz/corpus.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/right_checksums.h"
#include "world/checkpoint_file.h"

namespace pelage {
namespace {

/// Blocks of the sizes that the corpus has.
struct Blocks {
  std::array<std::byte, 64> film{};
  std::array<std::byte, 12> counts{};
  FrameState state() { return {film, {}, counts}; }
};

void read(std::span<const uint8_t> bytes) {
  const std::filesystem::path path = fuzz_file(bytes, ".checkpoint");
  try {
    const CheckpointFile file(path);
    PELAGE_CHECK(std::isfinite(file.record().seconds) && file.record().seconds >= 0);
    Blocks blocks;
    file.copy_to(blocks.state());
    const FrameInputs inputs{{"frame", "1"}, {"scene render.samples", "4"}};
    PELAGE_CHECK(input_differences(file.record().inputs, inputs).empty() == (file.record().inputs == inputs));
  } catch (const Error& error) {
    PELAGE_CHECK(error.kind() == ErrorKind::kInput);
  }
}

}  // namespace

void fuzz_checkpoint(std::span<const uint8_t> bytes) {
  read(bytes);
  read(with_right_checksums(bytes));
}

std::vector<std::string> checkpoint_corpus() {
  const TemporaryFolder folder;
  std::vector<std::string> files;
  Blocks blocks;
  CheckpointRecord record{{{"frame", "1"}, {"file 1 cube.obj", "00ff"}, {"scene render.samples", "4"}}, 12.5};
  for (const bool finished : {false, true}) {
    if (finished) record.picture = ContentHash{1, 2};
    const auto path = folder.path() / "a.checkpoint";
    CheckpointFile::write(path, record, finished ? FrameState() : blocks.state(), [](const std::string&) {});
    files.push_back(read_file(path));
  }
  return files;
}

}  // namespace pelage
