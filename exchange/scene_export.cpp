// SPDX-License-Identifier: Apache-2.0
#include "exchange/scene_export.h"

#include <fmt/format.h>

#include "base/file.h"
#include "base/version.h"
#include "exchange/alembic/alembic_coats.h"
#include "exchange/export_folder.h"
#include "exchange/export_notes.h"
#include "exchange/mitsuba/mitsuba_scene.h"
#include "exchange/pbrt/pbrt_scene.h"
#include "exchange/usd/usd_scene.h"

namespace pelage {
namespace {

/// Things that no format has, or that this export does not write.
void note_scene(const SceneDescription& scene, ExportNotes& notes) {
  if (!scene.magnets.items.empty()) notes.add("magnets", "no other program has them");
  if (!scene.archives.items.empty()) notes.add("archives", "RIB archives are not exported");
  if (!scene.image.background.empty()) notes.add("picture", "the background image is lost");
  for (const auto& [name, position, material] : scene.materials.items) {
    const auto* lambert = std::get_if<LambertParams>(&material);
    if (lambert && lambert->shadow_catcher)
      notes.add("material '" + name + "'", "the shadow catcher became a plain surface");
  }
}

std::string readme_text(const ExportSource& source, ExportFormat format,
                        const std::vector<std::filesystem::path>& files, const ExportNotes& notes) {
  std::string text =
      fmt::format("# {} for {}\n\nPelage {} wrote these files from `{}`. Open ", source.path.stem().string(),
                  EnumNames<ExportFormat>::names[static_cast<size_t>(format)], version(),
                  source.path.filename().string());
  for (size_t i = 0; i < files.size(); ++i)
    text += fmt::format("{}`{}`", i > 0 ? ", " : "", files[i].filename().string());
  text += ".\n\n## What these files do not say\n\n";
  text += notes.empty() ? "Nothing is lost.\n" : notes.list();
  return text;
}

/// Names of the files to open, to refuse them before long work.
std::vector<std::string> main_files(ExportFormat format, const ExportSource& source) {
  const std::string stem = source.path.stem().string();
  if (format == ExportFormat::kUsd) return {stem + ".usda"};
  const char* ending = format == ExportFormat::kPbrt      ? ".pbrt"
                       : format == ExportFormat::kAlembic ? ".abc"
                                                          : ".xml";
  const std::vector<int>& frames = source.scene.frames.frames;
  if (frames.size() == 1) return {stem + ending};
  std::vector<std::string> names;
  for (const int frame : frames) names.push_back(fmt::format("{}.{:04}{}", stem, frame, ending));
  return names;
}

}  // namespace

std::vector<std::filesystem::path> export_scene(const std::filesystem::path& folder, ExportFormat format,
                                                const ExportSource& source, const Job& job) {
  ExportFolder out(folder, source.scene.files);
  for (const std::string& file : main_files(format, source)) out.check(file);
  ExportNotes notes;
  note_scene(source.scene, notes);
  std::vector<std::filesystem::path> files;
  switch (format) {
    case ExportFormat::kUsd:
      files = write_usd_scene(out.working(), source, notes, job);
      break;
    case ExportFormat::kPbrt:
      files = write_pbrt_scene(out.working(), source, notes, job);
      break;
    case ExportFormat::kMitsuba:
      files = write_mitsuba_scene(out.working(), source, notes, job);
      break;
    case ExportFormat::kAlembic:
      files = write_alembic_coats(out.working(), source, notes, job);
      break;
  }
  write_file(out.working() / "README.md", readme_text(source, format, files, notes), Links::kReplace);
  out.commit();
  for (std::filesystem::path& file : files) file = folder / file.filename();
  return files;
}

}  // namespace pelage
