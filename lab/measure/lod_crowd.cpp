// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/lod_crowd.h"

#include <cmath>
#include <system_error>

#include <fmt/format.h>

#include "lab/measure/caches.h"
#include "lab/runs/outcome_table.h"

namespace pelage {
namespace {

constexpr const char* kFolder = "lod";
constexpr const char* kBoxes = "boxes-";  // prefix of the files of boxes in a cache

/// Boxes are measured in every run, as for every new frame; results of operators are kept.
void remove_boxes(const std::filesystem::path& folder) {
  std::error_code failure;
  std::vector<std::filesystem::path> old;
  for (std::filesystem::recursive_directory_iterator it(folder, failure), end; !failure && it != end;
       it.increment(failure)) {
    if (it->path().filename().string().starts_with(kBoxes)) old.push_back(it->path());
  }
  for (const auto& path : old) std::filesystem::remove(path, failure);
}

void set(Variant& variant, const std::string& key, const std::string& value) {
  variant.arguments.insert(variant.arguments.end(), {"--set", key + "=" + value});
}

}  // namespace

LodCrowd::LodCrowd(const SceneDescription& scene, const MeasureSetup& setup) {
  const CacheFolders caches(scene, setup.folder);
  caches_ = caches.folder(kFolder);
  arguments_ = caches.arguments(kFolder);
}

Variant LodCrowd::variant(const std::string& id, const std::string& title, bool reduced) const {
  Variant variant{"crowd-" + id, title, "render", arguments_};
  set(variant, "render.lod.enabled", reduced ? "true" : "false");
  variant.prepare = [caches = caches_] { remove_boxes(caches); };
  return variant;
}

void LodCrowd::run(const std::function<const Outcome*(const Variant&)>& run) {
  Variant warm_up = variant("warm-up", "warm-up", true);
  warm_up.once = true;
  for (const auto& [key, value] : {std::pair{"render.bounds", "conservative"},
                                   {"image.width", "16"},
                                   {"image.height", "9"},
                                   {"render.samples", "1"}})
    set(warm_up, key, value);
  if (!run(warm_up)) return;
  for (const bool reduced : {true, false}) {
    const Outcome* outcome = run(
        variant(reduced ? "reduced" : "full", reduced ? "reduced detail" : "all at full detail", reduced));
    if (!outcome) return;
    outcomes_.push_back(*outcome);
  }
}

std::string LodCrowd::abstract() const {
  const auto saved = [&](const std::string& key) {
    return 100 * (1 - outcomes_.front().number(key) / outcomes_.back().number(key));
  };
  return fmt::format(
      "For {:.0f} characters, reduced detail grows {:.1f} % fewer strands, with {:.1f} % less working set "
      "and "
      "{:.1f} % less CPU time than full detail.",
      outcomes_.back().number("characters"), saved("strands_generated"), saved("working_set_bytes"),
      saved("cpu_s"));
}

Section LodCrowd::section() const {
  const Table numbers = outcome_table(outcomes_);
  std::vector<std::string> keys{"variant", "strands_generated", "reexpansions", "working_set_bytes", "cpu_s",
                                "wall_s"};
  for (const std::string& stage : keys_with(numbers, "stage_")) keys.push_back(stage);
  Table table = select(numbers, keys, "Reduced and full detail, and what reduced detail saves.");
  std::vector<Cell> saved{Text{"saved"}};
  for (size_t column = 1; column < table.columns.size(); ++column) {
    const std::vector<double> values = column_values(table, table.columns[column].key);
    const double part = 1 - values.front() / values.back();
    saved.emplace_back(Text{std::isfinite(part) ? fmt::format("{:+.1f} %", 100 * part) : "–"});
  }
  table.rows.push_back(std::move(saved));
  return {
      "Crowd",
      {Paragraph{"The whole crowd, in reduced and in full detail. Operator caches are warm, and boxes are "
                 "measured anew in every run. The working set is the memory of all chunks that rays need, "
                 "each counted once, also where it exceeds the memory limit. Full detail then grows "
                 "chunks again; its strands and times include this. With --memory, both have more memory. "
                 "Stages are wall time."},
       std::move(table)}};
}

}  // namespace pelage
