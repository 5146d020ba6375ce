// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "post/flow_field.h"
#include "post/layers.h"
#include "post/warp.h"

namespace pelage {

/// When the shutter is open, and how finely it is looked at. Times are in frames (or whatever the vectors
/// are per), 0 being when the picture was rendered.
struct ShutterParams {
  float length = 0.5f;  ///< 0.5 is a shutter of 180 degrees
  float centre = 0;     ///< 0: as much before the rendered instant as after it
  int steps = 0;        ///< instants; 0: about one per pixel of the longest motion, 8 to 64
};

/// The instants: middles of equal parts of the shutter. `longest` is that of all vectors, in pixels. Without
/// motion there is one.
std::vector<float> shutter_times(const ShutterParams& shutter, float longest);

/// Pixels up to which gaps are closed unless somebody says otherwise.
inline constexpr int kDefaultSeam = 4;

/// How the work is cut; changes no pixel.
struct PostTiling {
  int columns = 128, rows = 16;  ///< pixels of a piece that a worker draws and resolves at a time
};

/// Which rows of the result (the picture shifted by target.origin) are made, and of what.
struct BlurJob {
  const FlowField* field = nullptr;
  WarpTarget target;
  std::vector<float> times;
  int width = 0;                    ///< columns of the result
  int first_row = 0, last_row = 0;  ///< half-open
};

/// Pixmotor [Neulander07; Neulander13]: warps the picture to each of the job's times, resolves what is seen,
/// and averages. The layers' sources must hold every row of the field from which something reaches the job's
/// rows
/// (`rows_reaching`), their targets those rows. Throws nothing of its own. Returns early when `progress` is
/// cancelled, to which it reports a step per row; otherwise a function of its arguments but the tiling and
/// the workers.
void blur_rows(const BlurJob& job, const PostLayers& layers, PostTiling tiling, const Workers& workers,
               Progress& progress);

/// Half-open; empty as {0, 0}.
struct RowRange {
  int first = 0, last = 0;
};

/// Rows of the field from which a pixel may reach rows first_row .. last_row (half-open) of the result at one
/// of the times.
RowRange rows_reaching(const FlowField& field, const WarpTarget& target, int width, int first_row,
                       int last_row, const std::vector<float>& times);

/// Whole pixels per side.
struct Overhang {
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// How far pixels come to lie outside the field at any of the times.
Overhang overhang(const FlowField& field, const std::vector<float>& times);

}  // namespace pelage
