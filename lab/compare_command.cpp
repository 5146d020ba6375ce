// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>

#include <fmt/format.h>

#include "base/file.h"
#include "base/program.h"
#include "cli/output_files.h"
#include "cli/read_scene.h"
#include "cli/report_error.h"
#include "cli/run.h"
#include "lab/compare/compare_models.h"
#include "lab/compare/contact_sheet.h"
#include "lab/lab_options.h"
#include "lab/report/machine.h"
#include "lab/report/png.h"
#include "lab/report/report_files.h"

namespace pelage {
namespace {

void check_fur(const SceneDescription& scene, const std::string& input) {
  for (const auto& character : scene.characters.items) {
    for (const PartParams& part : character.value.parts) {
      if (!part.grooms.items.empty()) return;
    }
  }
  throw Error(ErrorKind::kInput, input + ": the scene has no character with fur");
}

}  // namespace

int run_compare(const LabOptions& options) {
  Run run(options);
  const SceneDescription scene = read_scene(options, run.display());
  check_fur(scene, options.input);
  check_stats(options, scene.files);
  const std::filesystem::path folder = options.output.empty()
                                           ? std::filesystem::path(options.input).stem().string() + "_compare"
                                           : options.output;
  claim_report_folder(folder);
  const auto assets = run.stage("read", [&] { return load_assets(scene, run.job()); });

  const double load_before = load_average();
  const Comparison comparison = compare_models(
      scene, *assets, options.models.empty() ? fibre_model_names() : options.models, folder, run.job());
  const bool interrupted = run.display().cancelled();
  if (!comparison.frames.empty()) {
    Report report = comparison_report(comparison, scene);
    report.title += ": " + std::filesystem::path(options.input).filename().string();
    std::vector<std::string> command{"pelage", "compare", options.input};
    for (const Override& override : options.overrides)
      command.insert(command.end(), {"--set", override.key + "=" + override.value});
    report.facts = {{"Scene", options.input}, {"Scene hash", scene.hash}, {"Arguments", shell_line(command)}};
    for (auto& fact : machine_facts()) report.facts.push_back(std::move(fact));
    report.facts.emplace_back("Load average",
                              fmt::format("{:.1f} before, {:.1f} after", load_before, load_average()));
    if (interrupted) report.abstract = "Interrupted: the comparison is incomplete. " + report.abstract;
    report.runs = fibres_json(comparison.fibres);
    write_file(folder / "contact_sheet.png", png_bytes(contact_sheet(comparison.frames)), Links::kReplace);
    if (!comparison.fibres.empty())
      write_file(folder / "single_fibres.png", png_bytes(single_fibre_sheet(comparison.fibres)),
                 Links::kReplace);
    write_report(folder, report);
    std::cout << (folder / "report.html").string() << "\n";
  }
  run.finish(options);
  return interrupted ? SignalGuard::exit_code() : 0;
}

}  // namespace pelage
