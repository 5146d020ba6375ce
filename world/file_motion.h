// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "world/coat_motion.h"
#include "world/guide_poses.h"

namespace pelage {

/// Motion of the guides of a coat that is read from strand files (`dynamics.files`). Each segment of a guide
/// is turned the shortest way from where the skin carries it to the direction of the same segment in the file
/// of the frame. So lengths and roots of the strands in a file have no effect. Between two frames, turns are
/// interpolated linearly. Arguments of the constructor must outlive the object.
class FileMotion {
 public:
  /// `frame`: the one to render. If the file of another frame is missing, that of the nearest frame towards
  /// `frame` takes its place. Throws Error (kMemory) if the guides do not fit.
  FileMotion(const SceneDescription& scene, const Assets& assets, const MovingCoat& coat, double frame,
             const Job& job);
  /// Returns the turns at half a frame number. Throws Error (kInput) at the place in the scene that names the
  /// file: if the file of the rendered frame is missing, is damaged, or does not hold the guides of the coat.
  GuideTurns at(int half);

 private:
  std::filesystem::path file_of(int frame) const;
  /// The frame whose file is read for a frame.
  int held(int frame) const;
  const GuideTurns& at_frame(int frame);
  Strands read(int frame) const;
  void check_strands(const std::filesystem::path& file, const StrandFile& read) const;
  void check_roots(const std::filesystem::path& file, const Strands& strands,
                   const std::vector<RodRoot>& roots) const;
  [[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) const;

  const Assets& assets_;
  const MovingCoat& coat_;
  const Job& job_;
  int own_first_, own_last_;  // the whole frames around the rendered one
  MemoryCharge charge_;
  std::vector<GuideShape> shapes_;  // in scene units
  std::map<int, GuideTurns> known_;
};

}  // namespace pelage
