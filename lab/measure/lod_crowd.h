// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lab/report/report.h"
#include "lab/runs/variant.h"
#include "world/scene_schema.h"

namespace pelage {

/// Compares the cost of a whole crowd in reduced and in full detail, under the memory limit of the scene. The
/// working set counts every chunk that a ray needs once, so it is that of full detail although this may not
/// fit the limit.
class LodCrowd {
 public:
  LodCrowd(const SceneDescription& scene, const MeasureSetup& setup);

  /// Number of variants that run() runs.
  static constexpr size_t kVariants = 3;
  /// Runs the variants by calling `run` for each. `run` returns null if a variant failed.
  void run(const std::function<const Outcome*(const Variant&)>& run);

  /// Whether all variants succeeded.
  bool known() const { return outcomes_.size() == 2; }
  /// Returns one sentence about the savings, for the summary of the report.
  std::string abstract() const;
  Section section() const;

 private:
  Variant variant(const std::string& id, const std::string& title, bool reduced) const;

  std::filesystem::path caches_;
  std::vector<std::string> arguments_;
  std::vector<Outcome> outcomes_;  // reduced detail, full detail
};

}  // namespace pelage
