// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/lod_crowd.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

#include "lab/measure/caches.h"
#include "lab/runs/outcome_table.h"

namespace pelage {
namespace {

constexpr double kMaxWhole = 128;  // characters; for more, full detail of all may take hours
constexpr const char* kFolder = "lod";
constexpr const char* kBoxes = "boxes-";  // prefix of the files of boxes in a cache
constexpr const char* kMemory = "render.memory=";

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

Cell percent(double share) {
  return Text{std::isfinite(share) ? fmt::format("{:+.1f} %", 100 * share) : "–"};
}

}  // namespace

LodCrowd::LodCrowd(const SceneDescription& scene, const MeasureSetup& setup, std::vector<int> characters)
    : setup_(setup), characters_(std::move(characters)) {
  const CacheFolders caches(scene, setup.folder);
  caches_ = caches.folder(kFolder);
  arguments_ = caches.arguments(kFolder);
  std::sort(characters_.begin(), characters_.end());
  characters_.erase(std::unique(characters_.begin(), characters_.end()), characters_.end());
}

Variant LodCrowd::variant(int full_detail) const {
  Variant variant{fmt::format("crowd-{}", full_detail),
                  full_detail > 0 ? fmt::format("{} at full detail", full_detail) : "reduced detail",
                  "render", arguments_};
  set(variant, "render.lod.enabled", "true");
  set(variant, "render.lod.full_detail_characters", std::to_string(full_detail));
  // Without a limit nothing is grown twice.
  const bool limited = std::any_of(setup_.arguments.begin(), setup_.arguments.end(),
                                   [](const std::string& a) { return a.starts_with(kMemory); });
  if (!limited) set(variant, "render.memory", "1T");
  variant.prepare = [caches = caches_] { remove_boxes(caches); };
  return variant;
}

void LodCrowd::run(const std::function<const Outcome*(const Variant&)>& run) {
  Variant warm_up = variant(0);
  warm_up.id = "crowd-warm-up";
  warm_up.title = "warm-up";
  warm_up.once = true;
  for (const auto& [key, value] : {std::pair{"render.bounds", "conservative"},
                                   {"image.width", "16"},
                                   {"image.height", "9"},
                                   {"render.samples", "1"}})
    set(warm_up, key, value);
  const Outcome* first = run(warm_up);
  if (!first) return;
  all_ = first->number("characters");
  const auto add = [&](int full_detail) {
    const Outcome* outcome = run(variant(full_detail));
    if (!outcome) return false;
    points_.push_back(*outcome);
    full_detail_.push_back(full_detail);
    return true;
  };
  if (!(all_ > 1) || !add(0)) return;
  for (const int full_detail : characters_) {
    if (full_detail > 0 && full_detail < all_ && !add(full_detail)) return;
  }
  if (all_ > kMaxWhole || !known()) return;
  Variant whole = variant(0);
  whole.id = "crowd-all";
  whole.title = "all at full detail";
  set(whole, "render.lod.enabled", "false");
  if (const Outcome* outcome = run(whole)) whole_.push_back(*outcome);
}

std::vector<LodCrowd::Line> LodCrowd::lines() const {
  const Table numbers = outcome_table(points_);
  std::vector<std::string> keys{"strands_generated", "working_set_bytes", "cpu_s", "wall_s"};
  for (const std::string& stage : keys_with(numbers, "stage_")) keys.push_back(stage);
  std::vector<Line> lines;
  for (const std::string& key : keys) {
    const std::vector<double> values = column_values(numbers, key);
    std::vector<std::pair<double, double>> points;
    for (size_t i = 0; i < values.size(); ++i) points.emplace_back(full_detail_[i], values[i]);
    lines.push_back({select(numbers, {key}, "").columns.front(), fit_line(points)});
  }
  return lines;
}

std::string LodCrowd::abstract() const {
  const std::vector<Line> all = lines();
  const auto saved = [&](const std::string& key) {
    const auto line =
        std::find_if(all.begin(), all.end(), [&](const Line& l) { return l.column.key == key; });
    const double full = whole_.empty() ? line->fit.at(all_) : whole_.front().number(key);
    const double part = 100 * (1 - points_.front().number(key) / full);
    return whole_.empty()
               ? fmt::format("{:.1f} +- {:.1f} %", part, (100 - part) * line->fit.error_at(all_) / full)
               : fmt::format("{:.1f} %", part);
  };
  return fmt::format(
      "For {:.0f} characters, reduced detail grows {} fewer strands, with {} less working set and {} less "
      "CPU time than full detail, which {}.",
      all_, saved("strands_generated"), saved("working_set_bytes"), saved("cpu_s"),
      whole_.empty()
          ? fmt::format("is extrapolated from at most {:.0f} of them at full detail", full_detail_.back())
          : "was measured");
}

Section LodCrowd::section() const {
  const std::vector<Line> all = lines();
  Table table;
  table.caption = fmt::format(
      "Full detail of {:.0f} characters, extrapolated from some of them. Saved: by reduced detail, relative "
      "to the extrapolation{}.",
      all_, whole_.empty() ? "" : "; relative to the measurement");
  table.columns = {{"variant", "characters", Quantity::kRatio}};
  for (const Line& line : all) table.columns.push_back(line.column);
  std::vector<std::vector<double>> measured;
  for (const std::vector<Outcome>* outcomes : {&points_, &whole_}) {
    const Table numbers = outcome_table(*outcomes);
    for (size_t i = 0; i < outcomes->size(); ++i) measured.emplace_back();
    for (const Line& line : all) {
      const std::vector<double> values = column_values(numbers, line.column.key);
      for (size_t i = 0; i < values.size(); ++i)
        measured[measured.size() - values.size() + i].push_back(values[i]);
    }
  }
  const auto add = [&](const std::string& title, const auto& cell) {
    std::vector<Cell> row{Text{title}};
    for (size_t i = 0; i < all.size(); ++i) row.push_back(cell(i));
    table.rows.push_back(std::move(row));
  };
  const auto extrapolated = [&](size_t i) { return all[i].fit.at(all_); };
  for (size_t p = 0; p < points_.size(); ++p)
    add(points_[p].variant.title, [&](size_t i) -> Cell { return measured[p][i]; });
  add("residual of the line", [&](size_t i) -> Cell { return all[i].fit.residual; });
  add("all at full detail, extrapolated", [&](size_t i) -> Cell { return extrapolated(i); });
  add("its standard error", [&](size_t i) -> Cell { return all[i].fit.error_at(all_); });
  add("saved", [&](size_t i) { return percent(1 - measured.front()[i] / extrapolated(i)); });
  if (!whole_.empty()) {
    add("all at full detail, measured", [&](size_t i) -> Cell { return measured.back()[i]; });
    add("error of the extrapolation",
        [&](size_t i) { return percent(extrapolated(i) / measured.back()[i] - 1); });
    add("saved", [&](size_t i) { return percent(1 - measured.front()[i] / measured.back()[i]); });
  }
  return {
      "Crowd",
      {Paragraph{"Some characters keep every strand, chosen evenly by their distance from the camera. The "
                 "others are around them at reduced detail, so that they hide as much of them as at full "
                 "detail. A straight line is fitted to these runs and the run without full-detail "
                 "characters, and extrapolated to all characters. Operator caches are warm, boxes are "
                 "measured anew in every run, and memory is unlimited: under a limit, full detail would also "
                 "grow many strands repeatedly. The residual is the standard deviation of the runs from the "
                 "line; the standard error follows from the residual alone. Stages are wall time."},
       std::move(table)}};
}

void LodCrowd::add_rows(Table& data) const {
  const std::vector<Line> all = lines();
  const auto add = [&](const std::string& title, const auto& value) {
    std::vector<Cell> row;
    for (const Column& column : data.columns) {
      const auto line =
          std::find_if(all.begin(), all.end(), [&](const Line& l) { return l.column.key == column.key; });
      row.push_back(column.key == "variant"  ? Cell{Text{title}}
                    : column.key == "status" ? Cell{Text{"extrapolated"}}
                    : line == all.end()      ? Cell{NAN}
                                             : Cell{value(line->fit)});
    }
    data.rows.push_back(std::move(row));
  };
  add("all at full detail, extrapolated", [&](const LineFit& fit) { return fit.at(all_); });
  add("standard error of the extrapolation", [&](const LineFit& fit) { return fit.error_at(all_); });
}

}  // namespace pelage
