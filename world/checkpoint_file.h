// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "base/content_store.h"
#include "base/hash.h"
#include "render/frame/frame_saver.h"

namespace pelage {

/// Everything that determines the pixels of a frame: names and values. A name is a category, a space and a
/// name within the category, such as "scene render.samples", or only a category, such as "frame".
using FrameInputs = std::map<std::string, std::string>;

/// What a checkpoint file says about its frame.
struct CheckpointRecord {
  FrameInputs inputs;
  double seconds = 0;                       ///< duration of the render so far, over all its runs
  std::optional<ContentHash> picture = {};  ///< file_hash() of the finished picture; empty: not finished
};

/// A checkpoint file: a record and, unless the frame is finished, its state. It is a file of a content store
/// (base/content_store.h) under a name of its own, so every byte is verified by checksums.
class CheckpointFile {
 public:
  /// Maps and verifies a file. Throws Error (kInput) with the reason when it cannot be read or is damaged.
  explicit CheckpointFile(const std::filesystem::path& path);

  const CheckpointRecord& record() const { return record_; }
  /// Copies the state to the blocks. Returns false, and copies nothing, if the file has other blocks.
  bool copy_to(const FrameState& state) const;

  /// Writes a file; it replaces the old one when it is complete. Returns false after a failure, which it
  /// reports to `warn`; the old file then stays.
  static bool write(const std::filesystem::path& path, const CheckpointRecord& record,
                    const FrameState& state, const WarningSink& warn);

 private:
  StoredFile stored_;
  CheckpointRecord record_;
};

/// Returns a text without control characters. Different texts have different results.
std::string one_line(const std::string& text);

/// Returns one line that names the inputs that differ: "`render.samples`, rat.obj". Empty if none does.
std::string input_differences(const FrameInputs& before, const FrameInputs& now);

}  // namespace pelage
