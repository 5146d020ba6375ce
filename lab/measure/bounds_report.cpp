// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/bounds_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/parallel.h"
#include "lab/measure/memory_plots.h"
#include "lab/runs/outcome_table.h"
#include "lab/runs/spread.h"

namespace pelage {
namespace {

constexpr const char* kStrategies =
    "`none` grows everything before rendering; rays are tested against boxes measured on the grown strands. "
    "`conservative` bounds strands by skin patch, strand length and the reach of each operator. `exact` "
    "grows each chunk once in a first pass and "
    "keeps the boxes of its parts for the whole frame interval; `exact-shutter` keeps boxes only for the "
    "open shutter; `linear` keeps boxes that move linearly over the shutter.";
constexpr const char* kTerms =
    "An expansion is the growth of a chunk for use; the first pass does not count, its time is the stage "
    "`bound`. A re-expansion is a growth after an eviction. A false expansion is the growth of a chunk that "
    "holds the hit of no ray: whatever a ray met in it was hidden by something nearer. Box areas are sums of "
    "surface areas over all leaves of all coats: of the box around each leaf, and of the boxes of its parts, "
    "which rays are tested against; a moving box counts with the mean of shutter open and close. Box tests "
    "and chunk visits are per ray of any kind. They include tests of the boxes that a chunk gets when it "
    "grows; their number depends slightly on which thread comes first. `none` has no box areas to sum.";
constexpr const char* kCold =
    "Caches: each run of a variant marked cold starts with an empty cache folder, computes the operator "
    "offsets and the boxes of its strategy, and stores both; the variant of the same name without the mark "
    "reads them. `none` and `conservative` need no stored boxes and read the offsets that `exact, "
    "cold` stored.";
constexpr const char* kUncached =
    "The scene has no operator cache: every run grows its strands with all operators and computes its boxes.";

const Outcome* find(const std::vector<Outcome>& outcomes, const std::string& id) {
  const auto found =
      std::find_if(outcomes.begin(), outcomes.end(), [&](const Outcome& o) { return o.variant.id == id; });
  return found == outcomes.end() || !found->typical() ? nullptr : &*found;
}

std::string change(double after, double before) {
  constexpr double kTooFew = 50;  // min count for a meaningful percentage
  return before >= kTooFew ? fmt::format(" ({:+.0f} %)", 100 * (after / before - 1)) : "";
}

// "1.03 times the CPU time", or why the number is not meaningful: other work on the machine makes times vary
// between runs.
std::string time_text(const Outcome& a, const Outcome& b, const std::string& path, const char* name) {
  const bool known = a.runs.size() > 1 && b.runs.size() > 1;
  const bool apart = !known || a.min(path) > b.max(path) || a.max(path) < b.min(path);
  return fmt::format("{} times the {}{}", spread_text(ratio_of(a, b, path)), name,
                     apart ? "" : " (less than the difference between runs of one strategy)");
}

// Reports scenes in which bounds cannot save anything.
std::string touched_text(const Outcome& exact, const Outcome& conservative) {
  const auto all = [](const Outcome& o) { return o.number("chunks_touched") >= 0.95 * o.number("chunks"); };
  if (!all(exact) || !all(conservative)) return "";
  return "Rays need nearly every chunk, whatever its box. This is usual if light comes from all around and "
         "everything is in the frame. Tighter bounds then save no growth, only box tests and visits. ";
}

// Other work on the machine slows down runs, and not equally.
std::string load_text(const std::vector<Outcome>& outcomes) {
  double max = 0;
  for (const Outcome& outcome : outcomes) {
    for (const VariantRun& run : outcome.runs) max = std::max(max, run.load);
  }
  // The load average of a run includes threads of the run before it.
  if (max <= 1.5 * available_processors()) return "";
  return fmt::format(
      " The machine was busy with other work (a load of {:.0f} on {} processors): counts and memory are "
      "reliable, times are not.",
      max, available_processors());
}

// Findings about the strategies in question.
std::string bounds_findings(const std::vector<Outcome>& outcomes) {
  const bool counted = std::any_of(outcomes.begin(), outcomes.end(),
                                   [](const Outcome& o) { return o.number("chunk_visits") > 0; });
  if (!counted) return "No ray visited a chunk in any run, so the runs do not compare the strategies.";
  const Outcome *exact = find(outcomes, kExactId), *conservative = find(outcomes, kConservativeId),
                *none = find(outcomes, kNoneId), *shutter = find(outcomes, kExactShutterId);
  std::string text;
  const auto against = [&](const char* name, const Outcome& a, const char* than, const Outcome& b) {
    const double after = a.number("false_expansions"), before = b.number("false_expansions");
    text += fmt::format(
        "{} boxes instead of {} ones: {:.0f} false expansions instead of {:.0f}{}, {:.0f} expansions instead "
        "of {:.0f}, {:.2f} times the box area, {}, {}. ",
        name, than, after, before, change(after, before), a.number("expansions"), b.number("expansions"),
        a.number("bounds_area") / b.number("bounds_area"), time_text(a, b, "wall_s", "wall time"),
        time_text(a, b, "cpu_s", "CPU time"));
  };
  if (exact && conservative) {
    against("Exact", *exact, "conservative", *conservative);
    text += touched_text(*exact, *conservative);
  }
  if (exact && shutter) against("Shutter-aware", *shutter, "exact", *exact);
  if (exact && none) {
    text += fmt::format(
        "Growth on demand with exact boxes instead of growing everything up front: {}, {:.2f} times the peak "
        "resident set.",
        time_text(*exact, *none, "wall_s", "wall time"),
        exact->number("peak_rss_bytes") / none->number("peak_rss_bytes"));
  }
  const bool once =
      std::all_of(outcomes.begin(), outcomes.end(), [](const Outcome& o) { return o.runs.size() < 2; });
  if (once) text += " Each variant ran once, so the variation of times is unknown.";
  return text + load_text(outcomes);
}

using Differences = std::vector<std::optional<PictureDifference>>;

void add_bounds_columns(Table& table, const std::vector<Outcome>& outcomes, const Differences& differences) {
  const Outcome* exact = find(outcomes, kExactId);
  const auto difference = [&](const Outcome& o) -> const std::optional<PictureDifference>& {
    return differences[static_cast<size_t>(&o - outcomes.data())];
  };
  const auto relative = [&](const std::string& path) {
    return [&, path](const Outcome& o) -> Cell {
      const double area = o.number(path), reference = exact ? exact->number(path) : NAN;
      return area > 0 && reference > 0 ? area / reference : NAN;
    };
  };
  add_column(table, {"relative_bounds_area", "box area relative to exact", Quantity::kRatio}, outcomes,
             relative("bounds_area"));
  add_column(table, {"relative_part_bounds_area", "area of parts relative to exact", Quantity::kRatio},
             outcomes, relative("part_bounds_area"));
  add_column(
      table, {"lost_pixels", "lost pixels", Quantity::kCount}, outcomes,
      [&](const Outcome& o) -> Cell { return difference(o) ? double(difference(o)->differing) : NAN; });
  add_column(table, {"lost_pixels_share", "of all", Quantity::kPercent}, outcomes,
             [&](const Outcome& o) -> Cell {
               return difference(o) ? double(difference(o)->differing) / double(difference(o)->pixels) : NAN;
             });
  add_column(table, {"largest_difference", "largest difference of R, G, B", Quantity::kRatio}, outcomes,
             [&](const Outcome& o) -> Cell { return difference(o) ? difference(o)->largest : NAN; });
}

Section time_section(const Table& data, const std::vector<Outcome>& outcomes) {
  std::vector<std::string> stages = keys_with(data, "stage_");
  stages.insert(stages.begin(), "variant");
  return {
      "Time",
      {select(data,
              {"variant", "status", "wall_s", "wall_least_s", "wall_most_s", "cpu_s", "cpu_least_s",
               "cpu_most_s", "first_pixel_s", "peak_rss_bytes", "lost_pixels", "lost_pixels_share",
               "largest_difference"},
              "Cost of each strategy, and its effect on the picture."),
       stage_plot(
           data, outcomes,
           "Wall time by stage of the run of median wall time. Whiskers: minimum and maximum of all runs."),
       select(data, stages, "Wall time by stage.")}};
}

Section work_section(const Table& data, const std::vector<Outcome>& outcomes) {
  BarPlot area = column_plot(data, outcomes, {"relative_bounds_area"}, "box area relative to exact",
                             "Sum of the areas of the boxes of all leaves, relative to `exact`.");
  BarPlot tests = column_plot(data, outcomes, {"box_tests_per_ray"}, "box tests per ray",
                              "Tests of rays against boxes of chunks and above.");
  BarPlot in_vain = column_plot(data, outcomes, {"false_expansions"}, "chunks", "Chunks grown for nothing.");
  BarPlot visits = column_plot(data, outcomes, {"chunk_visits_per_ray"}, "chunk visits per ray",
                               "Chunks that a ray traverses.");
  area.half = tests.half = visits.half = in_vain.half = true;
  return {"Work",
          {select(data,
                  {"variant", "chunks", "expansions", "reexpansions", "false_expansions",
                   "false_expansions_share", "relative_bounds_area", "relative_part_bounds_area",
                   "box_tests_per_ray", "chunk_visits_per_ray", "strands_generated"},
                  "Chunks grown, and boxes tested."),
           in_vain, area, tests, visits}};
}

// Strategies with the same geometry in memory look the same over time.
std::vector<Outcome> plotted(const std::vector<Outcome>& outcomes) {
  std::vector<Outcome> result;
  for (const Outcome& outcome : outcomes) {
    const std::string& id = outcome.variant.id;
    if (!id.ends_with("-cold") || id == std::string(kExactId) + "-cold") result.push_back(outcome);
  }
  return result;
}

// `all` and `results` include the rows with switched-off optimisations, which the ledger must explain too.
Section memory_section(const Table& data, const std::vector<Outcome>& outcomes, const Table& all,
                       const BoundsResults& results) {
  std::vector<std::string> memory = keys_with(data, "memory_");
  memory.insert(memory.begin(), {"variant", "peak_rss_bytes", "working_set_bytes", "bytes_per_strand"});
  const std::vector<Outcome> few = plotted(outcomes);
  Section section{"Memory",
                  {select(data, memory,
                          "Peak of the process, bytes of all distinct chunks touched (skins included, also "
                          "in bytes per strand), and the peak of each tag of the ledger."),
                   resident_plot(few, "Resident memory over time (anonymous and file-backed).")}};
  for (LinePlot& plot : tag_plots(few)) section.blocks.push_back(std::move(plot));
  section.blocks.push_back(Paragraph{ledger_text(results.outcomes)});
  section.blocks.push_back(ledger_table(all));
  return section;
}

Section switch_section(const Table& data, const BoundsResults& results) {
  Table table = select(
      data,
      {"variant", "wall_s", "wall_least_s", "wall_most_s", "cpu_s", "cpu_least_s", "cpu_most_s",
       "working_set_bytes", "bytes_per_strand", "memory_chunks_bytes", "memory_skins_bytes", "peak_rss_bytes",
       "relative_bounds_area", "box_tests_per_ray", "lost_pixels", "largest_difference"},
      "What each saving is worth: all savings on (exact), then one of them switched off or on. All rows read "
      "warm caches.");
  for (Column& column : table.columns) {
    if (column.key == "lost_pixels") column.title = "pixels that differ";
  }
  std::vector<std::vector<Cell>> rows;
  for (size_t i = 0; i < results.outcomes.size(); ++i) {
    const std::string& id = results.outcomes[i].variant.id;
    if (id == kExactId || id == kExactShutterId || i >= results.strategies) rows.push_back(table.rows[i]);
  }
  table.rows = std::move(rows);
  return {"Optional savings",
          {Paragraph{"render.compact_attributes stores every attribute of a chunk in the most compact class "
                     "(constant, uniform, varying, vertex) with three digits. In a picture of few samples a "
                     "pixel may differ where the last digit decides a random choice, such as the end of a "
                     "path; its mean does not. render.bounds: exact-shutter bounds strands "
                     "over the open shutter instead of the whole frame interval."},
           std::move(table)}};
}

Section picture_section(const BoundsResults& results) {
  Section section{"Pictures", {}};
  section.blocks.push_back(
      Paragraph{"A pixel is lost if any channel of any layer differs in any bit from the picture of `none`, "
                "which grows everything before rendering, so that no box can hide anything."});
  if (results.picture) {
    section.blocks.push_back(*results.picture);
    std::get<Picture>(section.blocks.back()).half = true;
  }
  for (size_t i = 0; i < results.outcomes.size(); ++i) {
    if (!results.differences[i] || results.differences[i]->differing == 0) continue;
    Picture mask = results.differences[i]->mask;
    mask.caption = fmt::format("{}: white where a pixel differs from `none` ({} of {}).",
                               results.outcomes[i].variant.title, results.differences[i]->differing,
                               results.differences[i]->pixels);
    mask.half = true;
    section.blocks.push_back(std::move(mask));
  }
  return section;
}

}  // namespace

Report bounds_report(const BoundsResults& results) {
  Report report;
  report.title = "Bounding strategies";
  report.data = outcome_table(results.outcomes);
  add_bounds_columns(report.data, results.outcomes, results.differences);

  const auto count = static_cast<std::ptrdiff_t>(results.strategies);
  const std::vector<Outcome> strategies(results.outcomes.begin(), results.outcomes.begin() + count);
  Table data = report.data;
  data.rows.resize(results.strategies);
  report.abstract = bounds_findings(strategies);
  report.sections.push_back(
      {"Method",
       {Paragraph{fmt::format("Every variant renders the same frame with all its strands, in its own "
                              "process, {}, in rounds over all variants. Numbers are from the run of median "
                              "wall time; minimum and maximum show the spread. {}",
                              counted(results.repeat, "time"), results.cached ? kCold : kUncached)},
        Paragraph{kStrategies}, Paragraph{kTerms},
        Paragraph{"Memory over time is sampled every 10 ms; the kernel reports the peak of the resident set "
                  "(peak RSS), including file-backed pages."}}});
  report.sections.push_back(time_section(data, strategies));
  report.sections.push_back(work_section(data, strategies));
  report.sections.push_back(memory_section(data, strategies, report.data, results));
  report.sections.push_back(switch_section(report.data, results));
  report.sections.push_back(picture_section(results));
  return report;
}

}  // namespace pelage
