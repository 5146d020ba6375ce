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

/// What full detail of a whole crowd takes, without rendering it: some of its characters keep every hair
/// while the others stand around them with reduced detail, and hide of them what they would hide. What each
/// more takes is a line, which is followed to all. A crowd of few characters is rendered in full too: then it
/// is seen how far that is wrong.
class LodCrowd {
 public:
  /// `characters`: how many keep every hair, a run each.
  LodCrowd(const SceneDescription& scene, const MeasureSetup& setup, std::vector<int> characters);

  /// Variants that are run at most.
  size_t max_variants() const { return characters_.size() + 3; }
  /// Runs them; `run` returns null where one did not succeed.
  void run(const std::function<const Outcome*(const Variant&)>& run);

  /// Nothing to say where less than two runs succeeded, or no scene has so many characters.
  bool known() const { return points_.size() > 1; }
  /// One sentence.
  std::string abstract() const;
  Section section() const;
  /// Rows of the extrapolation, and of its standard error, for the table of all outcomes.
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
  std::vector<double> full_detail_;  // of each of these
  std::vector<Outcome> whole_;       // all in full: one, or none
};

}  // namespace pelage
