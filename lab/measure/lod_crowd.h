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

/// Estimates the cost of full detail for a whole crowd without rendering it. Some characters keep all their
/// hair, while the others surround and occlude them with reduced detail. A line is fitted to the cost by the
/// number of characters with all their hair, and extrapolated to all characters. A crowd of few characters is
/// also rendered in full, which shows the error of the extrapolation.
class LodCrowd {
 public:
  /// `characters`: numbers of characters with all their hair, one run each.
  LodCrowd(const SceneDescription& scene, const MeasureSetup& setup, std::vector<int> characters);

  /// Max number of variants.
  size_t max_variants() const { return characters_.size() + 3; }
  /// Runs the variants. `run` returns null if a variant failed.
  void run(const std::function<const Outcome*(const Variant&)>& run);

  /// False when less than two runs succeeded, or the scene has too few characters.
  bool known() const { return points_.size() > 1; }
  /// One sentence.
  std::string abstract() const;
  Section section() const;
  /// Rows with the extrapolation and its standard error, for the table of all outcomes.
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
  double all_ = 0;  // characters with a coat
  std::vector<Outcome> points_;
  std::vector<double> full_detail_;  // the number for each point
  std::vector<Outcome> whole_;       // the run in which all characters keep their hair: one or none
};

}  // namespace pelage
