// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "post/flow_field.h"
#include "post/layers.h"
#include "post/warp.h"

namespace pelage {

/// Opening of the shutter, and number of samples in time. Times are in frames (or the unit of the vectors),
/// relative to the rendered instant.
struct ShutterParams {
  float length = 0.5f;  ///< 0.5 is a shutter of 180 degrees
  float centre = 0;     ///< 0: symmetric about the rendered instant
  int steps = 0;        ///< number of times; 0: about one per pixel of the longest motion, 8 to 64
};

/// The sample times: centres of equal parts of the shutter. `longest`: max length of all vectors, in pixels.
/// Without motion, there is a single time.
std::vector<float> shutter_times(const ShutterParams& shutter, float longest);

/// Default max size of gaps to close, in pixels.
inline constexpr int kDefaultSeam = 4;

/// Tiling of the work; does not affect pixels.
struct PostTiling {
  int columns = 128, rows = 16;  ///< pixels of a tile that a worker draws and resolves at a time
};

/// Rows of the result (the picture shifted by target.origin) to make, and their input.
struct BlurJob {
  const FlowField* field = nullptr;
  WarpTarget target;
  std::vector<float> times;
  int width = 0;                    ///< columns of the result
  int first_row = 0, last_row = 0;  ///< half-open
};

/// Pixmotor [Neulander07; Neulander13]: warps the picture to each of the job's times, resolves visibility,
/// and averages. The sources of the layers must contain all rows of the field that can reach the job's rows
/// (`rows_reaching`). The targets of the layers must contain the job's rows. Throws no Error. Reports a step
/// per row to `progress` and returns early when `progress` is cancelled. Otherwise the result depends only on
/// the job and the layers, not on the tiling and the workers.
void blur_rows(const BlurJob& job, const PostLayers& layers, PostTiling tiling, const Workers& workers,
               Progress& progress);

/// Half-open; empty is {0, 0}.
struct RowRange {
  int first = 0, last = 0;
};

/// Rows of the field from which a pixel may reach rows first_row .. last_row (half-open) of the result at one
/// of the times.
RowRange rows_reaching(const FlowField& field, const WarpTarget& target, int width, int first_row,
                       int last_row, const std::vector<float>& times);

/// Integer number of pixels per side.
struct Overhang {
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// How far pixels move outside the field at any of the times.
Overhang overhang(const FlowField& field, const std::vector<float>& times);

}  // namespace pelage
