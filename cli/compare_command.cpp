// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>

#include <fmt/format.h>

#include "base/file.h"
#include "cli/commands.h"
#include "cli/compare/comparison.h"
#include "cli/compare/contact_sheet.h"
#include "cli/compare/light_side.h"
#include "cli/measure/machine.h"
#include "cli/measure/process.h"
#include "cli/report/png.h"
#include "cli/report/report_csv.h"
#include "cli/report/report_html.h"
#include "cli/report/report_json.h"
#include "cli/report_error.h"
#include "render/fibre/fibre_material.h"

namespace pelage {
namespace {

void write_whole(const std::filesystem::path& path, const std::string& bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

/// The materials of a scene under each model in turn.
class ModelMaterials {
 public:
  ModelMaterials(std::vector<MaterialParams> materials, std::filesystem::path tables, const Workers& workers)
      : materials_(std::move(materials)), tables_(std::move(tables)), workers_(workers) {}

  void choose(const std::string& model) {
    LambertCylinderParams white;
    white.color = Field(Rgb(1));
    white_ = with_fibre_model(white, model);
    if (auto* yan = std::get_if<YanParams>(&white_)) yan->tables.path = tables_;
    white_ = with_tables(white_, workers_, [](const std::string&) {});
  }
  std::vector<MaterialParams> in_color() const {
    std::vector<MaterialParams> all;
    for (const MaterialParams& material : materials_) {
      const FibreParams* looks = fibre_params(material);
      if (!looks || material.index() == white_.index()) {
        all.push_back(looks ? with_tables(material, workers_, [](const std::string&) {}) : material);
      } else {
        all.push_back(white_);
        std::visit(
            [&]<class P>(P& p) {
              if constexpr (std::is_base_of_v<FibreParams, P>) {
                p.color = looks->color;
                p.opacity = looks->opacity;
              }
            },
            all.back());
      }
    }
    return all;
  }
  std::vector<MaterialParams> in_white() const {
    LambertParams skin;
    skin.color = Field(Rgb(1));
    std::vector<MaterialParams> all;
    for (const MaterialParams& material : materials_)
      all.push_back(fibre_params(material) ? white_ : MaterialParams(skin));
    return all;
  }
  const MaterialParams& white() const { return white_; }

 private:
  std::vector<MaterialParams> materials_;
  std::filesystem::path tables_;
  const Workers& workers_;
  MaterialParams white_;
};

void check_fur(const SceneDescription& scene, const std::string& input) {
  for (const auto& character : scene.characters.items) {
    for (const PartParams& part : character.value.parts) {
      if (!part.grooms.items.empty()) return;
    }
  }
  throw Error(ErrorKind::kInput, input + ": no character of this scene has fur to compare models on");
}

/// One model after the other until all are done or the user wants to stop.
Comparison compare(const Options& options, const SceneDescription& scene, Assets& assets, Run& run,
                   const std::filesystem::path& folder) {
  const std::vector<std::string>& models = options.models.empty() ? fibre_model_names() : options.models;
  ModelMaterials materials(assets.materials, folder / "tables", run.workers());
  FrameComparer comparer(scene, assets, run);
  Comparison comparison;
  ProgressDisplay& display = run.display();
  // The furnace and the single fibre count as a picture each.
  display.begin("compare", static_cast<double>(models.size() * (kLightSides.size() + 2)));
  for (const std::string& model : models) {
    materials.choose(model);
    for (const LightSide& side : kLightSides) {
      if (display.cancelled()) break;
      const auto lights = lights_from(side, scene.camera, scene.frames.frames.front());
      ComparedFrame frame = comparer.render(materials.in_color(), lights, model, side.name);
      if (display.cancelled()) break;
      display.advance(1);
      display.note(fmt::format("{}, light from the {}: {:.1f} CPU s, relMSE {:.3f}, mean luminance {:.3f}",
                               model, side.name, frame.cpu_s, frame.noise, frame.luminance));
      comparison.frames.push_back(std::move(frame));
    }
    if (display.cancelled()) break;
    const double furnace = comparer.furnace(materials.in_white());
    if (display.cancelled()) break;
    comparison.furnace[model] = furnace;
    display.advance(1);
    comparison.fibres.push_back(compare_single_fibre(model, materials.white(), run.workers()));
    display.advance(1);
  }
  display.end();
  return comparison;
}

}  // namespace

int run_compare(const Options& options) {
  Run run(options);
  const SceneDescription scene = load_scene(options.input, options.overrides);
  check_fur(scene, options.input);
  const std::filesystem::path folder = options.output.empty()
                                           ? std::filesystem::path(options.input).stem().string() + "_compare"
                                           : options.output;
  // A folder that takes nothing is found before anything is rendered.
  write_whole(folder / "report.json", "{}\n");
  const auto assets = run.stage("read", [&] { return load_assets(scene, run.job()); });

  const double load_before = load_average();
  const Comparison comparison = compare(options, scene, *assets, run, folder);
  const bool interrupted = run.display().cancelled();
  if (!comparison.frames.empty()) {
    Report report = comparison_report(comparison, scene);
    report.title += ": " + std::filesystem::path(options.input).filename().string();
    std::vector<std::string> command{"pelage", "compare", options.input};
    for (const Override& override : options.overrides)
      command.insert(command.end(), {"--set", override.key + "=" + override.value});
    report.facts = {{"Scene", options.input}, {"Scene hash", scene.hash}, {"Arguments", shell_text(command)}};
    for (auto& fact : machine_facts()) report.facts.push_back(std::move(fact));
    report.facts.emplace_back("Load average",
                              fmt::format("{:.1f} before, {:.1f} after", load_before, load_average()));
    if (interrupted) report.abstract = "Interrupted: only a part was done. " + report.abstract;
    report.runs = fibres_json(comparison.fibres);
    write_whole(folder / "contact_sheet.png", png_bytes(contact_sheet(comparison.frames)));
    if (!comparison.fibres.empty())
      write_whole(folder / "single_fibres.png", png_bytes(single_fibre_sheet(comparison.fibres)));
    write_whole(folder / "report.json", report_json(report));
    write_whole(folder / "report.csv", csv_text(report.data));
    write_whole(folder / "report.html", report_html(report));
    std::cout << (folder / "report.html").string() << "\n";
  }
  run.finish(options);
  return interrupted ? kInterruptedExitCode : 0;
}

}  // namespace pelage
