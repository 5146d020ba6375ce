// SPDX-License-Identifier: Apache-2.0
#include "lab/lab_options.h"

#include <algorithm>
#include <iterator>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "base/nearest_name.h"
#include "cli/command_line.h"
#include "cli/common_flags.h"
#include "cli/lab_program.h"
#include "cli/number_checks.h"
#include "lab/compare/fibre_oracle.h"
#include "lab/measure/experiments.h"
#include "lab/measure/shading_curves.h"

namespace pelage {
namespace {

constexpr const char* kExperimentNames[] = {"bounces",   "bounds",   "growth", "lod",
                                            "residency", "samplers", "shading"};

Experiment parse_experiment(const std::string& text) {
  const std::vector<std::string> names(std::begin(kExperimentNames), std::end(kExperimentNames));
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) fail_arguments("unknown experiment " + quote(text) + suggest(text, names));
  return static_cast<Experiment>(found - names.begin());
}

void check_parts(Experiment experiment, const std::vector<std::string>& parts) {
  if (!parts.empty() && experiment != Experiment::kLod && experiment != Experiment::kShading)
    fail_arguments("--parts: only lod and shading have parts");
  std::vector<std::string> known(std::begin(kLodParts), std::end(kLodParts));
  if (experiment == Experiment::kShading) known.assign(std::begin(kShadingParts), std::end(kShadingParts));
  for (const std::string& part : parts) {
    if (std::find(known.begin(), known.end(), part) == known.end())
      fail_arguments("--parts: unknown part " + quote(part) + suggest(part, known));
  }
}

void check_models(const std::vector<std::string>& models) {
  const std::vector<std::string>& known = fibre_model_names();
  for (const std::string& model : models) {
    if (std::find(known.begin(), known.end(), model) == known.end())
      fail_arguments("--models: unknown fibre model " + quote(model) + suggest(model, known));
  }
}

void add_experiment_flags(CLI::App& measure, LabOptions& options) {
  measure
      .add_option(
          "--parts", options.parts,
          "lod: run only these parts (of crowd, detail, wedge, dolly). shading: run only these variants "
          "beside path (of splatted, adaptive, gather, visibility, reuse, spacing, skin_spacing, cells, "
          "light_rays, paths, cache, no_cache, drawn, screen_door, gather_screen_door, dual, skin_ball, "
          "together and others: see docs/MEASURE.md)")
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
  measure
      .add_option("--flicker-samples", options.flicker_samples,
                  "shading: those of --samples whose flicker is measured over 8 frames (default: the "
                  "smallest); 0: none")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(0, 1 << 20))
      ->type_name("N,N");
}

void sort_unique(std::vector<int>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

void interpret_samples(LabOptions& options) {
  sort_unique(options.samples);
  std::vector<int>& flicker = options.flicker_samples;
  sort_unique(flicker);
  if (flicker.empty()) {
    flicker = {options.samples.front()};
  } else if (flicker == std::vector<int>{0}) {
    flicker.clear();
  }
  for (const int samples : flicker) {
    if (!std::binary_search(options.samples.begin(), options.samples.end(), samples))
      fail_arguments(fmt::format("--flicker-samples: {} is not one of --samples {}", samples,
                                 fmt::join(options.samples, ",")));
  }
}

/// Values of flags that are still text.
struct LabTexts : RunTexts {
  std::string experiment;
};

void add_measure(CLI::App& measure, LabOptions& options, LabTexts& texts) {
  measure
      .add_option("EXPERIMENT", texts.experiment,
                  "bounces, bounds, growth, lod, residency, samplers or shading")
      ->required();
  add_scene_flags(measure, options, texts);
  add_script_flag(measure, options);
  measure
      .add_option("-o,--output", options.output,
                  "Report folder (default: the scene's and the experiment's name)")
      ->type_name("DIR");
  measure.add_option("--frames", texts.frames, "Frame to measure (default: the scene's first)")
      ->type_name("FRAME");
  measure.add_option("--repeat", options.repeat, "Runs per variant; the median one counts (default: 3)")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  measure.add_option("--time-limit", options.time_limit_s, "Time limit of a run in seconds (default: 600)")
      ->check(positive_number())
      ->type_name("SECONDS");
  add_experiment_flags(measure, options);
  add_parallel_flags(measure, options, texts, kMemoryHelp);
}

void add_compare(CLI::App& compare, LabOptions& options, LabTexts& texts) {
  add_scene_flags(compare, options, texts);
  add_script_flag(compare, options);
  compare
      .add_option("-o,--output", options.output,
                  "Folder for the report and its pictures (default: the scene's name and _compare)")
      ->type_name("DIR");
  compare.add_option("--models", options.models, "Compare only these models, such as chiang,yan")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("MODELS");
  compare.add_option("--frames", texts.frames, "Frame to compare (default: the scene's first)")
      ->type_name("FRAME");
  add_run_flags(compare, options, texts);
}

void interpret(const LabTexts& texts, LabOptions& options) {
  check_models(options.models);
  interpret_run(texts, options);
  if (!texts.experiment.empty()) options.experiment = parse_experiment(texts.experiment);
  check_parts(options.experiment, options.parts);
  interpret_samples(options);
}

}  // namespace

const char* experiment_name(Experiment experiment) {
  return kExperimentNames[static_cast<size_t>(experiment)];
}

std::optional<LabOptions> parse_lab_options(const std::vector<std::string>& arguments, std::ostream& out) {
  LabOptions options;
  LabTexts texts;
  const auto app = make_parser("The laboratory of Pelage measures and compares.", "pelage-lab",
                               "'pelage-lab COMMAND --help' explains a command; 'pelage COMMAND' does the "
                               "same as 'pelage-lab COMMAND'.");
  for (const LabCommand& command : lab_commands()) {
    CLI::App* added = app->add_subcommand(command.name, command.help);
    if (added->get_name() == "measure") {
      add_measure(*added, options, texts);
    } else {
      add_compare(*added, options, texts);
    }
  }
  if (!parse_command_line(*app, arguments, out)) return {};
  options.task = arguments[0] == "measure" ? LabTask::kMeasure : LabTask::kCompare;
  interpret(texts, options);
  return options;
}

}  // namespace pelage
