// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lab/measure/line_fit.h"
#include "lab/report/report.h"
#include "lab/runs/variant.h"
#include "world/scene_schema.h"

namespace pelage {

/// Estimates the cost of full detail for a whole crowd without rendering the crowd in full detail. In each
/// run, some characters keep all their strands. The other characters have reduced detail; they surround and
/// occlude the characters in full detail. A line is fitted to the cost as a function of the number of
/// characters in full detail, and extrapolated to all characters. A crowd of at most 128 characters is also
/// rendered in full detail, to show the error of the extrapolation.
class LodCrowd {
 public:
  /// `characters`: numbers of characters in full detail, one run for each number.
  LodCrowd(const SceneDescription& scene, const MeasureSetup& setup, std::vector<int> characters);

  /// Max number of variants that run() runs.
  size_t max_variants() const { return characters_.size() + 3; }
  /// Runs the variants by calling `run` for each. `run` returns null if a variant failed.
  void run(const std::function<const Outcome*(const Variant&)>& run);

  /// Whether there is a result. False when fewer than two runs succeeded, or when the scene has too few
  /// characters.
  bool known() const { return points_.size() > 1; }
  /// Returns one sentence about the savings, for the summary of the report.
  std::string abstract() const;
  Section section() const;
  /// Adds two rows to the table of all outcomes: the extrapolation, and its standard error.
  void add_rows(Table& data) const;

 private:
  struct Line {
    Column column;
    LineFit fit;
  };
  Variant variant(int full_detail) const;
  std::vector<Line> lines() const;

  const MeasureSetup& setup_;
  std::vector<int> characters_;
  std::filesystem::path caches_;
  std::vector<std::string> arguments_;
  double all_ = 0;  // number of characters with a coat
  std::vector<Outcome> points_;
  std::vector<double> full_detail_;  // for each of points_: number of characters in full detail
  std::vector<Outcome> whole_;       // the run with all characters in full detail: one element or none
};

}  // namespace pelage
