// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <iostream>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/program.h"
#include "cli/progress_display.h"
#include "cli/read_scene.h"
#include "cli/report_error.h"
#include "cli/signals.h"
#include "lab/lab_options.h"
#include "lab/measure/experiments.h"
#include "lab/report/machine.h"
#include "lab/report/report_files.h"

namespace pelage {
namespace {

MeasureSetup setup_of(const LabOptions& options, const SceneDescription& scene) {
  MeasureSetup setup;
  const auto program = find_sibling_program("pelage");
  if (!program) {
    throw Error(ErrorKind::kFailed, "the program pelage, which every run starts, is not in " +
                                        current_program().parent_path().string());
  }
  setup.program = *program;
  setup.scene = options.input;
  setup.repeat = options.repeat;
  setup.time_limit_s = options.time_limit_s;
  setup.folder = options.output;
  if (options.output.empty()) {
    setup.folder =
        std::filesystem::path(options.input).stem().string() + "_" + experiment_name(options.experiment);
  }
  // Other experiments use full detail, unless the user requests otherwise.
  if (options.experiment != Experiment::kLod)
    setup.arguments.insert(setup.arguments.end(), {"--set", "render.lod.enabled=false"});
  for (const Override& override : options.overrides)
    setup.arguments.insert(setup.arguments.end(), {"--set", override.key + "=" + override.value});
  if (options.allow_scripts) setup.arguments.emplace_back("--allow-scripts");
  // Pictures, timelines and counts are compared for a single frame.
  setup.arguments.insert(setup.arguments.end(),
                         {"--set", fmt::format("frames={}", scene.frames.frames.front())});
  if (options.threads > 0)
    setup.arguments.insert(setup.arguments.end(), {"--threads", std::to_string(options.threads)});
  return setup;
}

std::string picture_text(const SceneDescription& scene, Experiment experiment) {
  const std::string light =
      experiment == Experiment::kBounces  // which sets both
          ? ""
          : counted(scene.render.samples, "sample") + ", " + counted(scene.render.bounces, "bounce") + ", ";
  return fmt::format("{} x {} pixels, {}frame {}, shutter {:g} to {:g}, seed {}", scene.image.width,
                     scene.image.height, light, scene.frames.frames.front(), scene.camera.shutter.x,
                     scene.camera.shutter.y, scene.render.seed);
}

Measured run_experiment(const LabOptions& options, const SceneDescription& scene, const MeasureSetup& setup,
                        ProgressDisplay& display) {
  switch (options.experiment) {
    case Experiment::kBounds:
      return measure_bounds(scene, setup, display);
    case Experiment::kGrowth:
      return measure_growth(scene, setup, display);
    case Experiment::kResidency:
      return measure_residency(scene, setup, display);
    case Experiment::kSamplers:
      return measure_samplers(scene, setup, display);
    case Experiment::kShading:
      return measure_shading(
          scene, {options.samples, options.reference_samples, options.flicker_samples, options.parts}, setup,
          display);
    case Experiment::kBounces:
      return measure_bounces(scene, options.samples.back(), setup, display);
    case Experiment::kLod:
      return measure_lod(scene, options.parts, setup, display);
  }
  return {};
}

}  // namespace

int run_measure(const LabOptions& options) {
  const SignalGuard signals;
  ProgressDisplay display(options.progress, &SignalGuard::interrupted);
  const SceneDescription scene = read_scene(options, display);
  const MeasureSetup setup = setup_of(options, scene);
  claim_report_folder(setup.folder);

  auto facts = machine_facts();
  const double load_before = load_average();
  Measured measured = run_experiment(options, scene, setup, display);
  const bool interrupted = display.cancelled();
  Report& report = measured.report;
  report.experiment = experiment_name(options.experiment);
  report.title += ": " + std::filesystem::path(options.input).filename().string();
  std::vector<std::string> command{"pelage", "measure", report.experiment, options.input};
  command.insert(command.end(), setup.arguments.begin(), setup.arguments.end());
  command.insert(command.end(), {"--repeat", std::to_string(options.repeat)});
  if (options.experiment == Experiment::kBounces)
    command.insert(command.end(), {"--samples", std::to_string(options.samples.back())});
  if (options.experiment == Experiment::kShading) {
    command.insert(command.end(), {"--samples", fmt::format("{}", fmt::join(options.samples, ",")),
                                   "--reference-samples", std::to_string(options.reference_samples)});
    command.insert(
        command.end(),
        {"--flicker-samples",
         options.flicker_samples.empty() ? "0" : fmt::format("{}", fmt::join(options.flicker_samples, ","))});
    if (!options.parts.empty())
      command.insert(command.end(), {"--parts", fmt::format("{}", fmt::join(options.parts, ","))});
  }
  report.facts = {{"Scene", options.input},
                  {"Scene hash", scene.hash},
                  {"Picture", picture_text(scene, options.experiment)},
                  {"Command", shell_line(command)},
                  {"Repeats", std::to_string(options.repeat)}};
  report.facts.insert(report.facts.end(), facts.begin(), facts.end());
  report.facts.emplace_back("Load average",
                            fmt::format("{:.1f} before, {:.1f} after (report.json has the load of each run)",
                                        load_before, load_average()));
  if (interrupted) report.abstract = "Interrupted: only some variants ran. " + report.abstract;
  report.runs = runs_json(measured.outcomes);

  write_report(setup.folder, report);
  std::cout << (setup.folder / "report.html").string() << "\n";
  if (interrupted) return SignalGuard::exit_code();
  // A refused budget, or one so small that it takes too long, is a result when budgets are measured;
  // everything else that failed is not.
  const bool budgets = options.experiment == Experiment::kResidency;
  const bool answered =
      std::all_of(measured.outcomes.begin(), measured.outcomes.end(), [&](const Outcome& outcome) {
        return outcome.succeeded() || (budgets && (outcome.refused() || outcome.timed_out()));
      });
  return answered ? 0 : exit_code(ErrorKind::kFailed);
}

}  // namespace pelage
