// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "image/exr.h"

namespace pelage {

/// What a farm shall render.
struct FarmRequest {
  std::string program = "pelage";      ///< how the machines start Pelage
  std::string scene;                   ///< scene file
  std::vector<std::string> arguments;  ///< for `grow` and `render`: --set KEY=VALUE ...
  std::vector<std::string> flags;      ///< for all commands: --threads, --progress, --quiet
  std::vector<int> frames;
  std::string output;         ///< file of a picture, with a placeholder for the frame number (world/frames.h)
  std::string folder;         ///< for checkpoints, pieces and statistics; all machines must reach it
  int width = 0, height = 0;  ///< of the picture, in pixels
  int columns = 1, rows = 1;  ///< regions that a picture is divided into
  uint64_t memory = 0;        ///< budget of each task that reads the scene (render.memory), in bytes
  bool grows = false;         ///< whether tasks fill the caches of the scene first
  std::string simulates;      ///< frames whose motion a task simulates first, as for --frames; empty: none
  bool saves = true;          ///< whether frames can have checkpoints, see check_saving()
  double every_s = 60;        ///< seconds between two checkpoints
};

/// A command that one machine runs. It can be run again after any failure: a render continues from its
/// checkpoint, and a finished one ends at once.
struct FarmTask {
  std::string name;  ///< "simulate", "grow", "grow-0002", "render-0001", "render-0001-r0c1" or "merge-0001"
  std::optional<int> frame = {};
  std::optional<PixelBox> region = {};
  std::vector<std::string> command;  ///< program and arguments
  std::vector<std::string> after;    ///< names of the tasks that must be finished before
  std::string output;                ///< picture that the task writes; empty for "simulate" and "grow"
  uint64_t memory = 0;               ///< its memory budget in bytes; 0 for "merge"

  /// "simulate", "grow", "render" or "merge".
  std::string_view kind() const { return std::string_view(name).substr(0, name.find('-')); }
};

/// Divides a picture into boxes, row by row. Their borders are at multiples of 16 pixels, where `gather` and
/// splatted samples divide best. A picture with fewer blocks of 16 pixels than columns or rows has fewer
/// boxes.
std::vector<PixelBox> divide_picture(int width, int height, int columns, int rows);

/// Returns the tasks of a request, each after the tasks that it depends on. The task "simulate" makes the
/// motion of coats with `dynamics`. The task "grow" fills the caches of the scene and measures the boxes of
/// the first frame. Where frames are divided, a task "grow-NNNN" measures the boxes of each other frame,
/// which its regions share; else each render measures its own.
std::vector<FarmTask> make_farm_plan(const FarmRequest& request);

}  // namespace pelage
