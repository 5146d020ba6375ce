// SPDX-License-Identifier: Apache-2.0
// Tested in tests/view/live_renderer_test.cpp.
#include "view/scene_follower.h"

#include <exception>
#include <utility>

namespace pelage {
namespace {

using std::chrono::milliseconds;

/// An editor may write a file in several steps, and a tool several files.
constexpr milliseconds kQuiet{30}, kLongestUnrest{300};
/// Finds changes that inotify does not report: of network drives, and of folders that were replaced.
constexpr milliseconds kPoll{1000};

}  // namespace

SceneFollower::SceneFollower(std::filesystem::path scene, std::vector<Override> overrides,
                             LiveRenderer& renderer, ViewDesk& desk)
    : path_(std::move(scene)), overrides_(std::move(overrides)), renderer_(renderer), desk_(desk) {
  last_ = read();
  files_ = followed_files(last_->scene);
  stamps_ = last_->files;
  watch_.watch(files_);
  renderer_.submit(last_);
  thread_ = std::thread([this] { run(); });
}

SceneFollower::~SceneFollower() {
  stopped_ = true;
  watch_.wake();
  thread_.join();
}

std::shared_ptr<const SceneEdit> SceneFollower::read() const {
  const auto noticed = std::chrono::steady_clock::now();
  SceneDescription scene = load_scene(path_, overrides_);
  FileStamps stamps = stamps_of(followed_files(scene));
  return std::make_shared<const SceneEdit>(SceneEdit{std::move(scene), std::move(stamps), noticed});
}

void SceneFollower::run() {
  while (!stopped_) {
    const bool changed = watch_.wait(kPoll);
    if (stopped_) return;
    if (changed) wait_for_quiet();
    // A file that an include names and that does not exist yet is not among files_.
    const bool broken = !desk_.status().scene_error.empty();
    if (changed || broken || stamps_of(files_) != stamps_) read_again();
  }
}

void SceneFollower::wait_for_quiet() {
  const auto end = std::chrono::steady_clock::now() + kLongestUnrest;
  while (!stopped_ && watch_.wait(kQuiet) && std::chrono::steady_clock::now() < end) {
  }
}

void SceneFollower::read_again() {
  try {
    std::shared_ptr<const SceneEdit> edit = read();
    files_ = followed_files(edit->scene);
    stamps_ = edit->files;
    watch_.watch(files_);
    const bool failed = !desk_.status().render_error.empty();
    const bool same = edit->redo_after(*last_) == Redo::kNothing && !failed;
    desk_.update([](ViewStatus& status) { status.scene_error.clear(); });
    if (same) return;
    last_ = edit;
    renderer_.submit(std::move(edit));
  } catch (const std::exception& error) {  // an Error, or a failure of the system
    stamps_ = stamps_of(files_);
    desk_.update([&](ViewStatus& status) { status.scene_error = error.what(); });
  }
}

}  // namespace pelage
