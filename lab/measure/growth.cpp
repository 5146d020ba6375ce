// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/file_name.h"
#include "lab/measure/caches.h"
#include "lab/measure/experiments.h"
#include "lab/measure/growth_edits.h"
#include "lab/runs/outcome_table.h"

namespace pelage {
namespace {

constexpr const char* kMethod =
    "`pelage grow` grows each groom on its own: uncached, with all operators; cold, with an empty cache that "
    "the run fills; and warm, from the filled cache. The caches of all other grooms are off; a groom without "
    "a cache in the scene has only an uncached run. Every variant runs {}, each run in its own process; the "
    "report shows the run of median wall time. Uncached runs grow the coat once. Warm runs grow it on every "
    "character that wears it and write a strand file. Growth times are for one coat, without writing. The "
    "time to fill the cache is the extra time that opening it takes cold rather than warm, follicles "
    "included; break-even is the number of growths after which the cache has saved this time. Files are read "
    "from the page cache. Growth reads offsets and follicles. The cache also keeps one layer per operator, "
    "so that editing one operator recomputes only this operator and those after it.";

constexpr const char* kEdits =
    "Each run finds the cache as an edit of the operator leaves it: offsets and layers from this operator on "
    "are missing, earlier layers are present. The run starts from the last layer, runs this operator and all "
    "that follow, and stores their results; the time covers all of this. Read from the last row up, the "
    "times are the cumulative cost of the stack; the difference of two rows is the cost of one operator, "
    "storing its layer included. Follicles are kept. The last operator leaves the offsets instead of a "
    "layer.";

// Three ways to grow one groom: from its operators, from its operators with a new cache, from its cache.
struct GroomVariants {
  std::string groom;
  std::filesystem::path cache;
  std::filesystem::path strands;  // written by the warm variant
  std::vector<Variant> variants;  // uncached, or uncached, cold and warm
  const GroomParams* params = nullptr;
  std::vector<GrowthEdit> edits;  // of a groom with a cache
};

GroomVariants variants_of(const SceneDescription& scene, const Named<GroomParams>::Item& item,
                          const MeasureSetup& setup) {
  const std::string& name = item.name;
  const std::string file = file_name_of({name});
  GroomVariants v{name,
                  std::filesystem::absolute(setup.folder) / "caches" / ("growth-" + file),
                  setup.folder / (file + "-warm.hair"),
                  {},
                  &item.value,
                  {}};
  // The other grooms are loaded too: their caches must be neither read nor written.
  std::vector<std::string> common{"--groom", name};
  for (const auto& other : scene.grooms.items) {
    if (other.name != name && other.value.cache)
      common.insert(common.end(), {"--set", "grooms." + other.name + ".cache=null"});
  }
  const auto add = [&](const std::string& way, const std::string& cache) -> Variant& {
    Variant made{file + "-" + way, name + ", " + way, "grow", common};
    if (!cache.empty())
      made.arguments.insert(made.arguments.end(), {"--set", "grooms." + name + ".cache" + cache});
    return v.variants.emplace_back(std::move(made));
  };
  add("uncached", item.value.cache ? "=null" : "");
  if (!item.value.cache) return v;  // only the scene can define what to freeze
  const std::string cached = ".directory=" + yaml_quoted(v.cache.string());
  Variant& cold = add("cold", cached);
  v.edits = growth_edits(name, item.value, v.cache, cold);
  cold.prepare = [cache = v.cache] { std::filesystem::remove_all(cache); };
  // A cached groom is grown only for a file.
  Variant& warm = add("warm", cached);
  warm.arguments.insert(warm.arguments.end(), {"-o", v.strands.string()});
  return v;
}

double rate(const Outcome& o) { return o.number("strands_generated") / o.number("stages_s.grow"); }

Table summary_table() {
  return {"Growth of one coat of each groom, with and without its cache.",
          {{"groom", "groom"},
           {"strands", "strands", Quantity::kCount},
           {"uncached_s", "by its operators", Quantity::kSeconds},
           {"warm_s", "from the cache", Quantity::kSeconds},
           {"gain", "times faster"},
           {"fill_s", "filling the cache", Quantity::kSeconds},
           {"break_even_growths", "growths to break even", Quantity::kCount},
           {"disk_bytes", "on disk", Quantity::kBytes},
           {"offset_bytes_per_strand", "bytes per strand: offsets"},
           {"follicle_bytes_per_strand", "follicles"},
           {"layer_bytes_per_strand", "layers"}},
          {}};
}

std::vector<Cell> summary_row(const std::string& groom, const std::filesystem::path& cache,
                              const std::vector<Outcome>& three) {
  const Outcome &uncached = three[0], &cold = three[1], &warm = three[2];
  const double strands = uncached.number("strands_generated");
  const double without = strands / rate(uncached), with = strands / rate(warm);
  const double fill = cold.number("stages_s.cache") - warm.number("stages_s.cache");
  double growths = NAN;
  if (std::isfinite(fill) && std::isfinite(without) && std::isfinite(with))
    growths = without > with ? std::fmax(0, std::ceil(fill / (without - with))) : INFINITY;
  return {Text{groom},
          strands,
          without,
          with,
          without / with,
          fill,
          growths,
          folder_bytes(cache),
          folder_bytes(cache, "offsets-") / strands,
          folder_bytes(cache, "follicles-") / strands,
          folder_bytes(cache, "layer-") / strands};
}

}  // namespace

Measured measure_growth(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress) {
  std::vector<GroomVariants> grooms;
  size_t count = 0;
  for (const auto& item : scene.grooms.items) {
    grooms.push_back(variants_of(scene, item, setup));
    count += grooms.back().variants.size() + grooms.back().edits.size();
  }
  VariantRunner runner(setup, progress, count);
  Measured measured;
  std::vector<Outcome>& outcomes = measured.outcomes;
  Table summary = summary_table();
  BarPlot rates{"Strands grown per second.", {"strands per second", Quantity::kRate}, {}, {}, false, false};
  rates.series = {{"by operators", {}}, {"from the cache", {}}};
  std::vector<Table> edits;
  for (const GroomVariants& v : grooms) {
    std::vector<Outcome> own;
    for (const Variant& variant : v.variants) {
      if (!progress.cancelled()) own.push_back(runner.run(variant));
    }
    std::error_code ignored;
    std::filesystem::remove(v.strands, ignored);
    if (own.size() == 3) summary.rows.push_back(summary_row(v.groom, v.cache, own));
    rates.groups.push_back(v.groom);
    rates.series[0].values.push_back(own.empty() ? NAN : rate(own.front()));
    rates.series[1].values.push_back(own.size() == 3 ? rate(own.back()) : NAN);
    outcomes.insert(outcomes.end(), own.begin(), own.end());
    if (own.size() < 3) continue;
    std::vector<Outcome> edited;
    for (const GrowthEdit& edit : v.edits) {
      if (!progress.cancelled()) edited.push_back(runner.run(edit.variant));
    }
    edits.push_back(edit_table(v.groom, *v.params, v.cache, v.edits, edited, own[1]));
    outcomes.insert(outcomes.end(), edited.begin(), edited.end());
  }

  Report& report = measured.report;
  report.title = "Growth and the operator cache";
  report.data = outcome_table(outcomes);
  add_column(report.data, {"strands_per_s", "strands per second", Quantity::kRate}, outcomes,
             [](const Outcome& o) -> Cell { return rate(o); });
  report.sections.push_back({"Method", {Paragraph{fmt::format(kMethod, counted(setup.repeat, "time"))}}});
  report.sections.push_back({"Cached against uncached", {}});
  if (!summary.rows.empty()) report.sections.back().blocks.push_back(std::move(summary));
  report.sections.back().blocks.push_back(std::move(rates));
  if (!edits.empty()) report.sections.push_back({"Editing one operator", {Paragraph{kEdits}}});
  for (Table& table : edits) {
    BarPlot plot{table.caption, {"seconds", Quantity::kSeconds}, {}, {}, false, true};
    plot.series = {{"wall time of the edit", column_values(table, "edit_s")}};
    for (const auto& row : table.rows) plot.groups.push_back(std::get<Text>(row.front()).text);
    report.sections.back().blocks.push_back(std::move(table));
    report.sections.back().blocks.push_back(std::move(plot));
  }
  report.sections.push_back({"Runs",
                             {select(report.data,
                                     {"variant", "status", "wall_s", "wall_least_s", "wall_most_s", "cpu_s",
                                      "cpu_least_s", "cpu_most_s", "stage_read_s", "stage_cache_s",
                                      "stage_grow_s", "strands_generated", "strands_per_s", "peak_rss_bytes"},
                                     "Every variant."),
                              stage_plot(report.data, outcomes, "Wall time by stage of the run.")}});
  return measured;
}

}  // namespace pelage
