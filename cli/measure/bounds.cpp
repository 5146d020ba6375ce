// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cli/measure/caches.h"
#include "cli/measure/experiments.h"
#include "cli/measure/memory_plots.h"
#include "cli/measure/outcome_table.h"
#include "cli/measure/picture_difference.h"

namespace pelage {
namespace {

constexpr const char* kUserFactors[] = {"0.9", "0.7", "0.5"};
constexpr const char* kTwoPass[] = {"exact", "exact-shutter", "linear"};

std::vector<std::string> bounds_arguments(const std::string& strategy) {
  return {"--set", "render.bounds=" + strategy, "--sample-memory", "0.01"};
}

// Cold runs stand before the warm ones, whose caches they fill.
std::vector<Variant> variants_of(const SceneDescription& scene, const MeasureSetup& setup) {
  std::vector<Variant> cold, warm;
  const CacheFolders caches(scene, setup.folder);
  const auto cached = [&](Variant variant, const std::string& strategy, bool fresh) {
    const std::vector<std::string> arguments = caches.arguments(strategy);
    variant.arguments.insert(variant.arguments.end(), arguments.begin(), arguments.end());
    if (fresh) variant.prepare = [caches, strategy] { caches.clear(strategy); };
    return variant;
  };
  for (const std::string strategy : kTwoPass) {
    if (!caches.any()) break;
    cold.push_back(cached({strategy + "-cold", strategy + ", cold", "render", bounds_arguments(strategy)},
                          strategy, true));
  }
  // What needs no boxes shares the offsets that the first cold run left.
  warm.push_back(cached({"none", "none", "render", bounds_arguments("none")}, kTwoPass[0], false));
  for (const std::string factor : kUserFactors) {
    Variant variant{"user-" + factor, "user × " + factor, "render", bounds_arguments("user")};
    variant.arguments.insert(variant.arguments.end(), {"--set", "render.bounds_factor=" + factor});
    warm.push_back(cached(std::move(variant), kTwoPass[0], false));
  }
  warm.push_back(cached({"conservative", "conservative", "render", bounds_arguments("conservative")},
                        kTwoPass[0], false));
  for (const std::string strategy : kTwoPass)
    warm.push_back(cached({strategy, strategy, "render", bounds_arguments(strategy)}, strategy, false));
  cold.insert(cold.end(), warm.begin(), warm.end());
  return cold;
}

const Outcome* find(const std::vector<Outcome>& outcomes, const std::string& id) {
  const auto found =
      std::find_if(outcomes.begin(), outcomes.end(), [&](const Outcome& o) { return o.variant.id == id; });
  return found == outcomes.end() ? nullptr : &*found;
}

// What the numbers say of the two strategies that the question is about.
std::string findings(const std::vector<Outcome>& outcomes) {
  const bool counted = std::any_of(outcomes.begin(), outcomes.end(),
                                   [](const Outcome& o) { return o.number("chunk_visits") > 0; });
  if (!counted) {
    return "No run visited a chunk on demand: everything was grown up front whatever the strategy, so these "
           "runs say "
           "nothing of what the strategies differ in.";
  }
  const Outcome *exact = find(outcomes, "exact"), *conservative = find(outcomes, "conservative"),
                *none = find(outcomes, "none");
  std::string text;
  if (exact && conservative && exact->typical() && conservative->typical()) {
    const double before = conservative->number("false_expansions"), after = exact->number("false_expansions");
    text += fmt::format(
        "Exact boxes instead of conservative ones: {:.0f} false expansions instead of {:.0f}{}, "
        "{:.0f} expansions instead of {:.0f}, {:.2f} times the wall time. ",
        after, before, before > 0 ? fmt::format(" ({:+.0f} %)", 100 * (after / before - 1)) : "",
        exact->number("expansions"), conservative->number("expansions"),
        exact->number("wall_s") / conservative->number("wall_s"));
  }
  if (exact && none && exact->typical() && none->typical()) {
    text += fmt::format(
        "Growth on demand with exact boxes instead of growing everything up front: {:.2f} times the "
        "wall time, {:.2f} times the peak resident set.",
        exact->number("wall_s") / none->number("wall_s"),
        exact->number("peak_rss_bytes") / none->number("peak_rss_bytes"));
  }
  return text;
}

struct Differences {
  std::vector<std::optional<PictureDifference>> of;  // per outcome
};

Differences compare_all(const std::vector<Outcome>& outcomes, const VariantRunner& runner) {
  Differences differences;
  const Outcome* none = find(outcomes, "none");
  for (const Outcome& outcome : outcomes) {
    differences.of.push_back(
        none && none->succeeded() && outcome.succeeded()
            ? compare_picture_files(runner.picture(none->variant), runner.picture(outcome.variant))
            : std::nullopt);
  }
  return differences;
}

void add_bounds_columns(Table& table, const std::vector<Outcome>& outcomes, const Differences& differences) {
  const Outcome* exact = find(outcomes, "exact");
  const double reference = exact ? exact->number("bounds_area") : NAN;
  const auto difference = [&](const Outcome& o) -> const std::optional<PictureDifference>& {
    return differences.of[static_cast<size_t>(&o - outcomes.data())];
  };
  add_column(table, {"relative_bounds_area", "box area relative to exact", Quantity::kRatio}, outcomes,
             [&](const Outcome& o) -> Cell {
               const double area = o.number("bounds_area");
               return area > 0 && reference > 0 ? area / reference : NAN;
             });
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

Section picture_section(const std::vector<Outcome>& outcomes, const Differences& differences,
                        const VariantRunner& runner) {
  Section section{"Pictures", {}};
  section.blocks.push_back(
      Paragraph{"A lost pixel is one of which any channel of any layer has other bits than in the picture of "
                "none, where "
                "everything is grown up front and no box can hide anything. Only user, whose boxes are "
                "guesses, may lose any."});
  const Outcome* none = find(outcomes, "none");
  if (none && none->succeeded()) {
    if (auto picture = screen_picture_of(runner.picture(none->variant), 640, "The picture of none.")) {
      picture->half = true;
      section.blocks.push_back(std::move(*picture));
    }
  }
  for (size_t i = 0; i < outcomes.size(); ++i) {
    if (!differences.of[i] || differences.of[i]->differing == 0) continue;
    Picture mask = differences.of[i]->mask;
    mask.caption =
        fmt::format("{}: white where a pixel differs from none ({} of {}).", outcomes[i].variant.title,
                    differences.of[i]->differing, differences.of[i]->pixels);
    mask.half = true;
    section.blocks.push_back(std::move(mask));
  }
  return section;
}

}  // namespace

Measured measure_bounds(const SceneDescription& scene, const MeasureSetup& setup, ProgressDisplay& display) {
  const std::vector<Variant> variants = variants_of(scene, setup);
  VariantRunner runner(setup, display, variants.size());
  Measured measured;
  for (const Variant& variant : variants) {
    if (display.cancelled()) break;
    measured.outcomes.push_back(runner.run(variant));
  }
  const std::vector<Outcome>& outcomes = measured.outcomes;
  const Differences differences = compare_all(outcomes, runner);

  Report& report = measured.report;
  report.title = "Bounding strategies";
  report.abstract = findings(outcomes);
  report.data = outcome_table(outcomes);
  add_bounds_columns(report.data, outcomes, differences);
  const Table& data = report.data;

  std::string caches =
      "The scene has no operator cache, so every run grows its hair by its operators, and boxes are "
      "computed in every run.";
  if (CacheFolders(scene, setup.folder).any()) {
    caches =
        "Caches: variants marked cold begin with an empty cache folder: they compute the offsets of the "
        "operators "
        "and the boxes of their strategy, and serve as the warming run of the variant of the same name "
        "without "
        "the mark. none, user and conservative need no boxes and read the offsets that the cold run of exact "
        "left.";
  }
  report.sections.push_back(
      {"Method",
       {Paragraph{fmt::format(
            "Every variant renders the same frame in a process of its own, {} time{}; times and all "
            "other numbers are those of the run of median wall time, least and most are the spread. "
            "{}",
            setup.repeat, setup.repeat == 1 ? "" : "s", caches)},
        Paragraph{
            "none grows everything up front and tests no boxes above the chunks. user scales the "
            "conservative "
            "box about its centre by a factor. conservative bounds by skin patch, strand lengths and each "
            "operator's reach. exact grows each chunk once in a first pass and keeps its boxes, which hold "
            "the "
            "whole frame interval; exact-shutter holds what the shutter sees; linear has boxes that move "
            "linearly over the shutter. An expansion is the growth of a chunk for use, a false expansion a "
            "chunk "
            "that was grown and never hit by any ray. Box tests and chunk visits are per ray of any kind."},
        Paragraph{"Memory is sampled every 10 ms (peak anonymous) or kept by the kernel (peak RSS, "
                  "file-backed pages "
                  "included). " +
                  ledger_text(outcomes)}}});
  report.sections.push_back(
      {"Time",
       {select(data,
               {"variant", "status", "wall_s", "wall_least_s", "wall_most_s", "cpu_s", "peak_rss_bytes",
                "peak_anonymous_bytes", "lost_pixels", "lost_pixels_share", "largest_difference"},
               "Cost of each strategy, and what it does to the picture."),
        stage_plot(data, outcomes, "Wall time by stage of the run.")}});
  std::vector<std::string> stages = keys_with(data, "stage_");
  stages.insert(stages.begin(), "variant");
  report.sections.back().blocks.push_back(select(data, stages, "Wall time by stage."));

  BarPlot area = column_plot(data, outcomes, {"relative_bounds_area"}, "box area relative to exact",
                             "Sum of the areas of all boxes, relative to exact.");
  BarPlot visits = column_plot(data, outcomes, {"box_tests_per_ray", "chunk_visits_per_ray"}, "per ray",
                               "Box tests and chunk visits per ray.");
  area.half = visits.half = true;
  report.sections.push_back(
      {"Work",
       {select(data,
               {"variant", "chunks", "chunks_touched", "expansions", "reexpansions", "false_expansions",
                "evictions", "relative_bounds_area", "box_tests_per_ray", "chunk_visits_per_ray",
                "strands_generated"},
               "Chunks grown, and boxes tested."),
        column_plot(data, outcomes, {"chunks_touched", "expansions", "reexpansions", "false_expansions"},
                    "chunks", "Chunks touched, grown, grown again, and grown in vain."),
        area, visits}});

  std::vector<std::string> memory = keys_with(data, "memory_");
  memory.insert(memory.begin(), {"variant", "peak_rss_bytes", "peak_anonymous_bytes", "unexplained_bytes"});
  Section in_memory{"Memory",
                    {select(data, memory, "Peak of the process, and of each tag of the ledger."),
                     resident_plot(outcomes, "Resident memory over time (anonymous and file-backed).")}};
  for (LinePlot& plot : tag_plots(outcomes)) in_memory.blocks.push_back(std::move(plot));
  report.sections.push_back(std::move(in_memory));
  report.sections.push_back(picture_section(outcomes, differences, runner));
  return measured;
}

}  // namespace pelage
