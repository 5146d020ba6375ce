// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "post/flow_field.h"
#include "post/layers.h"
#include "post/warp.h"

namespace pelage {

/// Interval in which the shutter is open, and number of samples in time. The unit of time is the frame, or
/// the time in which a pixel moves by its vector. Time 0 is the rendered instant.
struct ShutterParams {
  float length = 0.5f;  ///< duration; 0.5 is a shutter of 180 degrees
  float centre = 0;     ///< middle of the interval
  int steps = 0;        ///< number of samples; 0: one per pixel of the longest motion, at least 8, at most 64
};

/// Returns the sample times: the centres of equal parts of the shutter interval. `longest`: max length of all
/// vectors, in pixels. If steps == 0 and there is no motion, returns a single time.
std::vector<float> shutter_times(const ShutterParams& shutter, float longest);

/// Default of WarpTarget::longest_seam for motion blur, in pixels.
inline constexpr int kDefaultSeam = 4;

/// Size of the tiles in which workers process the picture. Does not affect pixels.
struct PostTiling {
  int columns = 128, rows = 16;  ///< size of a tile in pixels
};

/// Rows of the result to make, and their input. Pixel (x, y) of the result is pixel (x + target.origin_x, y +
/// target.origin_y) of the field.
struct BlurJob {
  const FlowField* field = nullptr;
  WarpTarget target;
  std::vector<float> times;
  int width = 0;                    ///< number of columns of the result
  int first_row = 0, last_row = 0;  ///< rows first_row <= y < last_row
};

/// Blurs some rows of a picture with the algorithm Pixmotor [Neulander07; Neulander13]: warps the picture to
/// each of the times, determines which pixel is visible at each sample, and averages over all times. The
/// sources of the layers must contain all rows that rows_reaching() returns for the rows of the job. The
/// targets must contain the rows of the job. Throws no Error. Advances `progress` by 1 per row, and returns
/// early when `progress` is cancelled. If not cancelled, the result depends only on the job and the layers,
/// not on the tiling or the workers.
void blur_rows(const BlurJob& job, const PostLayers& layers, PostTiling tiling, const Workers& workers,
               Progress& progress);

/// Rows first <= y < last; {0, 0} if empty.
struct RowRange {
  int first = 0, last = 0;
};

/// Returns a range of rows of the field that contains all pixels that may appear in rows first_row <= y <
/// last_row of the result at one of the times. `width`: number of columns of the result.
RowRange rows_reaching(const FlowField& field, const WarpTarget& target, int width, int first_row,
                       int last_row, const std::vector<float>& times);

/// Number of pixels by which a picture grows at each side.
struct Overhang {
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// Returns upper bounds of the distance by which pixels move beyond each side of the field at any of the
/// times.
Overhang overhang(const FlowField& field, const std::vector<float>& times);

}  // namespace pelage
