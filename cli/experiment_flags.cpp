// SPDX-License-Identifier: Apache-2.0
#include "cli/experiment_flags.h"

#include <algorithm>
#include <map>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "base/error.h"
#include "base/nearest_name.h"
#include "lab/measure/shading_curves.h"

namespace pelage {
namespace {

[[noreturn]] void fail(const std::string& message) { throw Error(ErrorKind::kArguments, message); }

Experiment parse_experiment(const std::string& text) {
  static const std::map<std::string, Experiment> built{{"bounds", Experiment::kBounds},
                                                       {"growth", Experiment::kGrowth},
                                                       {"residency", Experiment::kResidency},
                                                       {"samplers", Experiment::kSamplers},
                                                       {"lod", Experiment::kLod},
                                                       {"shading", Experiment::kShading},
                                                       {"bounces", Experiment::kBounces}};
  static const std::vector<std::string> promised{"scaling"};
  if (const auto found = built.find(text); found != built.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [name, experiment] : built) names.push_back(name);
  if (std::find(promised.begin(), promised.end(), text) != promised.end())
    fail("experiment " + quote(text) +
         " does not exist yet; choose one of bounces, bounds, growth, lod, residency, samplers and "
         "shading");
  fail("unknown experiment " + quote(text) + suggest(text, names));
}

void check_parts(Experiment experiment, const std::vector<std::string>& parts) {
  if (!parts.empty() && experiment != Experiment::kLod && experiment != Experiment::kShading)
    fail("--parts: only lod and shading have parts");
  std::vector<std::string> known(std::begin(kLodParts), std::end(kLodParts));
  if (experiment == Experiment::kShading) known.assign(std::begin(kShadingParts), std::end(kShadingParts));
  for (const std::string& part : parts) {
    if (std::find(known.begin(), known.end(), part) == known.end())
      fail("--parts: unknown part " + quote(part) + suggest(part, known));
  }
}

}  // namespace

void add_experiment_flags(CLI::App& measure, Options& options) {
  measure
      .add_option(
          "--parts", options.parts,
          "lod: run only these parts (of crowd, detail, wedge, dolly). shading: run only these variants "
          "beside path (of splatted, adaptive, gather, visibility, reuse, spacing, skin_spacing, cells, "
          "light_rays, paths, cache, no_cache, drawn, screen_door, gather_screen_door, skin_ball, "
          "gather_skin_ball, together, gather_together)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("PARTS");
  measure
      .add_option("--samples", options.samples,
                  "shading: sample counts to render each variant with (default: 4,16,64). bounces: the "
                  "largest of these counts is used")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1, 1 << 20))
      ->type_name("N,N");
  measure
      .add_option("--reference-samples", options.reference_samples,
                  "shading: samples of the two reference pictures (default: 256)")
      ->check(CLI::Range(1, 1 << 20))
      ->type_name("N");
}

void interpret_experiment(const std::string& name, Options& options) {
  if (!name.empty()) options.experiment = parse_experiment(name);
  check_parts(options.experiment, options.parts);
  std::sort(options.samples.begin(), options.samples.end());
  options.samples.erase(std::unique(options.samples.begin(), options.samples.end()), options.samples.end());
}

}  // namespace pelage
