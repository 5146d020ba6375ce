// SPDX-License-Identifier: Apache-2.0
#include "base/check.h"
#include "base/error.h"
#include "base/temporary_folder.h"
#include "post/blur_file.h"
#include "post/stereo_file.h"
#include "tests/fuzz/fuzz_targets.h"

namespace pelage {
namespace {

constexpr int64_t kBudget = 16 << 20;

template <class Tool, class Params>
void feed(Tool&& tool, const std::filesystem::path& input, Params params) {
  static const TemporaryFolder folder;
  static const Workers workers(1);
  params.file.scale = 2;
  params.file.memory = kBudget;
  NoProgress progress;
  MemoryLedger ledger;
  try {
    tool(input, folder.path() / "out.exr", params, Job{workers, ledger, progress});
    PELAGE_CHECK(ledger.peak(MemoryTag::kFilm) <= kBudget);
  } catch (const Error& error) {
    PELAGE_CHECK(error.kind() == ErrorKind::kInput || error.kind() == ErrorKind::kMemory);
  }
  PELAGE_CHECK(ledger.current(MemoryTag::kFilm) == 0);
}

}  // namespace

void fuzz_post(std::span<const uint8_t> bytes) {
  const std::filesystem::path input = fuzz_file(bytes, ".exr");
  BlurFileParams blur;
  blur.shutter.steps = 2;
  feed(blur_file, input, blur);
  StereoFileParams stereo;
  stereo.focal_pixels = 10;
  stereo.eye_separation = 1;
  feed(stereo_file, input, stereo);
}

}  // namespace pelage
