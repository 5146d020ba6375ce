// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>

#include "cli/measure/caches.h"
#include "cli/measure/experiments.h"
#include "cli/measure/outcome_table.h"

namespace pelage {
namespace {

// Three ways to grow one groom: its operators, its operators and a new cache, its cache.
struct GroomVariants {
  std::string groom;
  std::filesystem::path cache;
  Variant uncached, cold, warm;
};

GroomVariants variants_of(const Named<GroomParams>::Item& item, const MeasureSetup& setup) {
  const std::string& name = item.name;
  GroomVariants v{name, std::filesystem::absolute(setup.folder) / "caches" / ("growth-" + name), {}, {}, {}};
  const auto variant = [&](const std::string& way, const std::string& cache) {
    Variant made{name + "-" + way, name + ", " + way, "grow", {"--groom", name}};
    made.arguments.insert(made.arguments.end(), {"--set", "grooms." + name + ".cache" + cache});
    return made;
  };
  const std::string directory = yaml_quoted(v.cache.string());
  const std::string cached = ".directory=" + directory;
  v.uncached = variant("uncached", "=null");
  if (!item.value.cache) return v;  // what to freeze only the scene can say
  v.cold = variant("cold", cached);
  v.warm = variant("warm", cached);
  v.cold.prepare = [cache = v.cache] { std::filesystem::remove_all(cache); };
  return v;
}

double rate(const Outcome& o) { return o.number("strands_generated") / o.number("stages_s.grow"); }

}  // namespace

Measured measure_growth(const SceneDescription& scene, const MeasureSetup& setup, ProgressDisplay& display) {
  std::vector<GroomVariants> grooms;
  for (const auto& item : scene.grooms.items) grooms.push_back(variants_of(item, setup));
  VariantRunner runner(setup, display, 3 * grooms.size());
  Measured measured;
  std::vector<Outcome>& outcomes = measured.outcomes;
  Table summary{"Growth of each groom with and without its cache.",
                {{"groom", "groom"},
                 {"strands", "strands", Quantity::kCount},
                 {"uncached_s", "uncached", Quantity::kSeconds},
                 {"warm_s", "from the cache", Quantity::kSeconds},
                 {"gain", "times faster"},
                 {"cold_run_s", "run that fills the cache", Quantity::kSeconds},
                 {"uncached_run_s", "run without", Quantity::kSeconds},
                 {"warm_run_s", "run with it filled", Quantity::kSeconds},
                 {"break_even_runs", "runs to break even"},
                 {"disk_bytes", "on disk", Quantity::kBytes},
                 {"disk_bytes_per_strand", "bytes per strand on disk"}},
                {}};
  BarPlot rates{"Strands grown per second.", {"strands per second", Quantity::kRate}, {}, {}, false, false};
  rates.series = {{"uncached", {}}, {"from the cache", {}}};
  for (const GroomVariants& v : grooms) {
    std::vector<Outcome> three;
    for (const Variant* variant : {&v.uncached, &v.cold, &v.warm}) {
      if (!display.cancelled() && !variant->id.empty()) three.push_back(runner.run(*variant));
    }
    if (three.size() == 3) {
      const Outcome &uncached = three[0], &cold = three[1], &warm = three[2];
      const double disk = folder_bytes(v.cache), strands = warm.number("strands_unique");
      const double saved = uncached.number("wall_s") - warm.number("wall_s");
      const double extra = cold.number("wall_s") - uncached.number("wall_s");
      const double runs = saved > 0 ? std::fmax(1, 1 + std::ceil(extra / saved)) : INFINITY;
      summary.rows.push_back({Text{v.groom}, warm.number("strands_generated"),
                              uncached.number("stages_s.grow"), warm.number("stages_s.grow"),
                              rate(warm) / rate(uncached), cold.number("wall_s"), uncached.number("wall_s"),
                              warm.number("wall_s"), runs, disk, disk / strands});
      rates.groups.push_back(v.groom);
      rates.series[0].values.push_back(rate(uncached));
      rates.series[1].values.push_back(rate(warm));
    }
    outcomes.insert(outcomes.end(), three.begin(), three.end());
  }
  Report& report = measured.report;
  report.title = "Growth and the operator cache";
  report.data = outcome_table(outcomes);
  add_column(report.data, {"strands_per_s", "strands per second", Quantity::kRate}, outcomes,
             [](const Outcome& o) -> Cell { return rate(o); });
  report.sections.push_back(
      {"Method",
       {Paragraph{fmt::format("Each groom is grown on its own, all leaves of all its "
                              "coats once, by pelage grow: without a cache, with a "
                              "cache that is empty (the run fills it), and with the "
                              "cache so filled. Every variant runs {} time{} in "
                              "processes of its own, the run of median wall time is "
                              "reported. Growth is the stage in which strands are "
                              "made (grooms without a cache in the scene have only their uncached one); "
                              "preparing operators (clump centres, guides) and "
                              "filling the cache are in the time of the run. Runs "
                              "to break even: after so many runs, the one that filled "
                              "the cache included, less time was spent than "
                              "without. Files are read from the page cache. Bytes on "
                              "disk are those of all files of the cache, by the "
                              "strands of the groom.",
                              setup.repeat, setup.repeat == 1 ? "" : "s")}}});
  report.sections.push_back({"Cached against uncached", {std::move(summary), std::move(rates)}});
  report.sections.push_back(
      {"Runs",
       {select(report.data,
               {"variant", "status", "wall_s", "wall_least_s", "wall_most_s", "cpu_s", "stage_read_s",
                "stage_grow_s", "strands_generated", "strands_per_s", "peak_rss_bytes"},
               "Every variant."),
        stage_plot(report.data, outcomes, "Wall time by stage of the run.")}});
  return measured;
}

}  // namespace pelage
