// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "procedurals/bounds/procedural.h"
#include "rib/scene/rib_scene.h"

namespace pelage {

class RibPrograms;

/// How a RIB file is read.
struct RibReadOptions {
  /// Number of the frame (FrameBegin) to read; if the file has frames, but not this one, only what is outside
  /// of frames. Empty: the first frame.
  std::optional<int> frame;
  V2f shutter{0, 0};       ///< opening and closing time, in frames relative to the frame
  RibTransform placement;  ///< from the world of the file to the world of the scene
  bool geometry = true;    ///< false: materials, lights and the camera only; coats and skins stay empty
  /// Whether a file with a camera in a left-handed world is mirrored (z becomes -z), so that a right-handed
  /// camera sees the same picture.
  bool mirror_left_handed = false;
  /// Whether to read worlds that are drawn into shadow maps; otherwise, they are skipped, with a warning.
  bool shadow_passes = false;
  size_t max_points = 1'000'000'000;  ///< of all strands and meshes together
  size_t max_inner_archives =
      100'000;  ///< read by archives: 100 small files can double their number 100 times
  size_t max_request_bytes = size_t(4) << 30;  ///< memory of the arguments of one request
  /// Runs programs that the file names; null: such procedurals are skipped, with a warning.
  std::shared_ptr<RibPrograms> programs;
  /// Called at the end of each frame; read_rib() then returns what is outside of frames, and all warnings.
  /// `frame` must be empty and `geometry` false. Frames that only draw shadow maps are left out, unless the
  /// file has no others.
  std::function<void(const RibScene&)> each_frame;
  std::function<void(size_t bytes)> reserve;  ///< called with the bytes of all geometry so far; may throw
  std::function<void()> check_stop;           ///< called often; may throw
};

/// Reads one frame of a RIB file with all files that it reads. Archives of DelayedReadArchive are read too,
/// to measure their strands, but their strands are not kept. Throws Error (kInput) with file, line and
/// column. Requests that are not supported are skipped, with one warning per kind of request. If all worlds
/// of the frame draw shadow maps, they are read, and the result is a shadow pass.
RibScene read_rib(const std::filesystem::path& path, const RibReadOptions& options);

/// Returns the strands of a coat as a procedural, which splits into the batches of the coat.
std::unique_ptr<Procedural> rib_procedural(const RibCoat& coat);

}  // namespace pelage
