// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "lab/measure/bounds_report.h"
#include "lab/measure/bounds_variants.h"
#include "lab/measure/caches.h"
#include "lab/measure/experiments.h"

namespace pelage {
namespace {

constexpr int kPictureWidth = 640;

void take(const std::string& id, std::vector<Outcome>& from, std::vector<Outcome>& to) {
  const auto found =
      std::find_if(from.begin(), from.end(), [&](const Outcome& o) { return o.variant.id == id; });
  if (found == from.end()) return;  // interrupted before
  to.push_back(std::move(*found));
  from.erase(found);
}

}  // namespace

Measured measure_bounds(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress) {
  const BoundsVariants variants = bounds_variants(scene, setup);
  VariantRunner runner(setup, progress, variants.run.size());
  std::vector<Outcome> run = runner.run_in_rounds(variants.run);

  BoundsResults results;
  for (const std::string& id : variants.shown) take(id, run, results.outcomes);
  results.strategies = results.outcomes.size();
  for (const Switch& s : variants.switches) take(s.off.id, run, results.outcomes);
  results.cached = CacheFolders(scene, setup.folder).any();
  results.repeat = setup.repeat;

  const auto none = std::find_if(results.outcomes.begin(), results.outcomes.end(),
                                 [](const Outcome& o) { return o.variant.id == kNoneId && o.succeeded(); });
  for (const Outcome& outcome : results.outcomes) {
    const bool both = none != results.outcomes.end() && outcome.succeeded();
    results.differences.push_back(
        both ? compare_picture_files(runner.picture(none->variant), runner.picture(outcome.variant))
             : std::nullopt);
  }
  if (none != results.outcomes.end()) {
    results.picture = screen_picture_of(runner.picture(none->variant), kPictureWidth,
                                        "The frame, as every strategy renders it.");
  }
  Report report = bounds_report(results);
  return {std::move(report), std::move(results.outcomes)};
}

}  // namespace pelage
