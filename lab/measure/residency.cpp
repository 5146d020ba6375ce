// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/temporary_folder.h"
#include "lab/measure/caches.h"
#include "lab/measure/experiments.h"
#include "lab/measure/memory_plots.h"
#include "lab/pictures/picture_difference.h"
#include "lab/runs/outcome_table.h"
#include "lab/runs/spread.h"

namespace pelage {
namespace {

// Fractions of the peak chunk bytes; those after the third row are tried until one is refused.
constexpr double kShares[] = {1, 0.5, 0.25, 0.1, 0.05, 0.03};
constexpr double kSmallShares[] = {0.02, 0.01, 0.005, 0.0025, 0.001};
constexpr double kStoredShares[] = {0.25, 0.1, 0.05};
constexpr const char* kUnlimited = "1T";

struct Budget {
  double bytes = NAN;   // NaN: no limit
  double share = NAN;   // of the chunks
  bool stored = false;  // fur is read from render.bvh.file
};

Variant limited(const std::string& id, const std::string& title, const std::string& memory) {
  return {id, title, "render", {"--set", "render.memory=" + memory, "--sample-memory", "0.01"}};
}

/// Fixed to the sizes for the scene's own limit, in all rows: otherwise chunks would depend on the row's
/// limit.
std::vector<std::string> same_chunks(const SceneDescription& scene) {
  std::vector<std::string> arguments;
  for (const auto& [name, position, groom] : scene.grooms.items) {
    arguments.push_back("--set");
    arguments.push_back(fmt::format("grooms.{}.leaf_strands={}", name, groom.leaf_size()));
  }
  return arguments;
}

// The budget that a refusal recommends: "...; give at least 120M", "...; give at least --memory 120M".
double min_bytes(const Outcome& refused) {
  const std::string text = refused.error();
  const std::string advice = "give at least ";
  const size_t start = text.find(advice);
  if (start == std::string::npos) return NAN;
  const size_t begin = std::min(text.find_first_of("0123456789", start), text.size());
  const size_t end = std::min(text.find_first_not_of("0123456789", begin), text.size());
  return begin < end ? std::stod(text.substr(begin, end - begin)) * (1 << 20) : NAN;
}

// Max memory of the budget used by anything but chunks.
double fixed_bytes(const Outcome& unlimited) {
  double bytes = 0;
  for (const char* tag : {"film", "skins", "operator_cache", "reflection_cache"}) {
    const double of_tag = unlimited.number(std::string("memory_bytes.") + tag);
    bytes += std::isfinite(of_tag) ? of_tag : 0;
  }
  return bytes;
}

class Sweep {
 public:
  Sweep(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress)
      : progress_(progress),
        runner_(setup, progress, 2 + std::size(kShares) + 2 + 2 + std::size(kStoredShares)),
        cache_arguments_(CacheFolders(scene, setup.folder).arguments("residency")),
        chunk_arguments_(same_chunks(scene)),
        store_(std::filesystem::absolute(setup.folder)) {}

  void run() {
    Variant warm_up = limited("warm-up", "warm-up", kUnlimited);
    warm_up.once = true;
    add(warm_up, {});
    if (done()) return;
    add(limited("unlimited", "unlimited", kUnlimited), {});
    const Outcome& unlimited = outcomes.back();
    const double chunks = unlimited.number("memory_bytes.chunks"), fixed = fixed_bytes(unlimited);
    if (!(chunks > 0)) return;
    run_grown(fixed, chunks);
    run_stored(fixed, chunks);
  }

  bool done() const {
    return progress_.cancelled() ||
           (!outcomes.empty() && outcomes.size() <= 2 && !outcomes.back().succeeded());
  }
  const VariantRunner& runner() const { return runner_; }

  std::vector<Outcome> outcomes;
  std::vector<Budget> budgets;

 private:
  void run_grown(double fixed, double chunks) {
    const auto try_share = [&](double share) {
      const double bytes = fixed + share * chunks;
      add(limited(fmt::format("budget-{:g}", 100 * share), fmt::format("{:g} %", 100 * share),
                  fmt::format("{:.0f}", bytes)),
          {bytes, share});
    };
    for (const double share : kShares) {
      if (!done() && !outcomes.back().timed_out()) try_share(share);  // less memory would take even longer
    }
    for (const double share : kSmallShares) {
      if (!done() && outcomes.back().succeeded()) try_share(share);
    }
    if (done() || !outcomes.back().refused()) return;
    // A refusal names the smallest sufficient budget: the last row verifies it.
    const double min = min_bytes(outcomes.back());
    if (std::isfinite(min)) {
      add(limited("least", "least", fmt::format("{:.0f}", min)), {min, (min - fixed) / chunks});
    }
  }

  /// The same budgets with fur and skins on disk: a first run writes them, the others read them.
  void run_stored(double fixed, double chunks) {
    Variant first = limited("stored-first", "stored, first run", kUnlimited);
    first.once = true;
    add(first, {NAN, NAN, true});
    if (done() || !outcomes.back().succeeded()) return;
    add(limited("stored", "stored", kUnlimited), {NAN, NAN, true});
    for (const double share : kStoredShares) {
      if (done()) return;
      const double bytes = fixed + share * chunks;
      add(limited(fmt::format("stored-{:g}", 100 * share), fmt::format("stored, {:g} %", 100 * share),
                  fmt::format("{:.0f}", bytes)),
          {bytes, share, true});
    }
  }

  void add(Variant variant, const Budget& budget) {
    for (const auto& more : {cache_arguments_, chunk_arguments_})
      variant.arguments.insert(variant.arguments.end(), more.begin(), more.end());
    if (budget.stored) {
      variant.arguments.insert(variant.arguments.end(),
                               {"--set", "render.bvh.file=" + yaml_quoted(store_.path().string())});
    }
    outcomes.push_back(runner_.run(variant));
    budgets.push_back(budget);
  }

  Progress& progress_;
  VariantRunner runner_;
  std::vector<std::string> cache_arguments_, chunk_arguments_;
  const TemporaryFolder store_;
};

Cell same_pixels(const VariantRunner& runner, const Outcome& unlimited, const Outcome& outcome) {
  if (!unlimited.succeeded() || !outcome.succeeded()) return Text{"–"};
  const auto difference =
      compare_picture_files(runner.picture(unlimited.variant), runner.picture(outcome.variant));
  if (!difference) return Text{"not comparable"};
  return Text{difference->differing == 0 ? "identical" : fmt::format("{} differ", difference->differing)};
}

LinePlot budget_plot(const Table& table, const std::vector<std::string>& keys, const std::string& axis,
                     const std::string& caption) {
  LinePlot plot;
  plot.caption = caption;
  plot.half = plot.markers = true;
  plot.x = {"budget for chunks, of their unlimited peak", Quantity::kPercent, true};
  const std::vector<double> shares = column_values(table, "budget_share");
  for (const std::string& key : keys) {
    const Table column = select(table, {key}, "");
    plot.y = {axis, column.columns.at(0).quantity};
    Series series{column.columns.at(0).title, {}};
    const std::vector<double> values = column_values(table, key);
    for (size_t i = shares.size(); i-- > 0;) {
      if (std::isfinite(shares[i]) && std::isfinite(values[i]))
        series.points.emplace_back(shares[i], values[i]);
    }
    std::sort(series.points.begin(), series.points.end());
    plot.lines.push_back(std::move(series));
  }
  return plot;
}

/// The rows with or without stored fur. `table`: one row per budget after the first.
Table rows_of(Table table, const std::vector<Budget>& budgets, bool stored) {
  size_t row = 0;
  std::erase_if(table.rows, [&](const auto&) { return budgets[++row].stored != stored; });
  return table;
}

LinePlot wall_plot(const Table& grown, const Table& stored) {
  LinePlot plot = budget_plot(grown, {"wall_s"}, "wall time", "Wall time against the budget.");
  plot.lines.front().name = "grown";
  plot.lines.push_back(budget_plot(stored, {"wall_s"}, "", "").lines.front());
  plot.lines.back().name = "stored";
  return plot;
}

Section method(const MeasureSetup& setup) {
  return {
      "Method",
      {Paragraph{fmt::format(
           "The frame is rendered once to warm caches, then without a limit. A budget of p % means "
           "render.memory = F + p % of C. C is the peak of the ledger's tag `chunks` in the unlimited "
           "run; F is the sum of the peaks of film, skins and caches in that run, an upper bound of what "
           "they need at one time. Every budget runs {}; numbers are from the run of median wall time. "
           "Budgets decrease until one is refused (exit code 4), which is a result; the row `least`, if "
           "present, is the budget that the refusal recommends. A run that takes longer than {:g} s is "
           "stopped: a time-out.",
           counted(setup.repeat, "time"), setup.time_limit_s)},
       Paragraph{
           "`Stored` runs have the same budgets and `render.bvh.file`: the first writes fur, its trees and "
           "skins to disk, the others read each chunk when a ray needs it."},
       Paragraph{"Re-expansions are growths after an eviction. Waiting is the sum over threads of the "
                 "time spent waiting for memory or for a chunk that another thread grows. Pixels are "
                 "identical when every bit of every channel equals the unlimited run."}}};
}

}  // namespace

Measured measure_residency(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress) {
  Sweep sweep(scene, setup, progress);
  sweep.run();
  Measured measured;
  measured.outcomes = std::move(sweep.outcomes);
  const std::vector<Outcome>& outcomes = measured.outcomes;
  const auto index = [&](const Outcome& o) { return static_cast<size_t>(&o - outcomes.data()); };

  Report& report = measured.report;
  report.title = "Geometry under a memory budget";
  report.data = outcome_table(outcomes);
  Table& data = report.data;
  add_column(data, {"budget_bytes", "render.memory", Quantity::kBytes}, outcomes,
             [&](const Outcome& o) -> Cell { return sweep.budgets[index(o)].bytes; });
  add_column(data, {"budget_share", "of chunks", Quantity::kPercent}, outcomes,
             [&](const Outcome& o) -> Cell { return sweep.budgets[index(o)].share; });
  const Outcome* unlimited = outcomes.size() > 1 ? &outcomes[1] : nullptr;
  add_column(data, {"pixels", "pixels", Quantity::kRatio}, outcomes, [&](const Outcome& o) -> Cell {
    return unlimited ? same_pixels(sweep.runner(), *unlimited, o) : Text{"–"};
  });
  for (const auto& [key, title, quantity] : {Column{"chunks_read", "chunks read", Quantity::kCount},
                                             Column{"chunk_bytes_read", "bytes read", Quantity::kBytes}}) {
    add_column(data, {key, title, quantity}, outcomes,
               [key = key](const Outcome& o) -> Cell { return o.number(key); });
  }
  add_column(data, {"message", "message", Quantity::kRatio}, outcomes,
             [](const Outcome& o) -> Cell { return Text{o.error()}; });

  double smallest = NAN;
  const Outcome* tightest = nullptr;
  for (size_t i = 2; i < outcomes.size() && !sweep.budgets[i].stored; ++i) {
    if (!outcomes[i].succeeded() || !(std::isnan(smallest) || sweep.budgets[i].bytes < smallest)) continue;
    smallest = sweep.budgets[i].bytes;
    tightest = &outcomes[i];
  }
  if (tightest) {
    report.abstract = fmt::format(
        "The smallest budget that rendered is {:.1f} MiB; it took {} times the CPU time and {} times the "
        "wall time of the unlimited run.",
        smallest / (1 << 20), spread_text(ratio_of(*tightest, outcomes[1], "cpu_s")),
        spread_text(ratio_of(*tightest, outcomes[1], "wall_s")));
  }
  report.sections.push_back(method(setup));
  // Runs that warm the caches are in the data but not compared.
  const std::vector<Outcome> compared(outcomes.begin() + std::min<std::ptrdiff_t>(1, std::ssize(outcomes)),
                                      outcomes.end());
  Table shown = data;
  shown.rows.erase(shown.rows.begin(),
                   shown.rows.begin() + std::min<std::ptrdiff_t>(1, std::ssize(shown.rows)));
  const Table grown = rows_of(shown, sweep.budgets, false);
  Section time{
      "Time and growth",
      {select(shown,
              {"variant", "budget_bytes", "status", "wall_s", "wall_least_s", "wall_most_s", "cpu_s",
               "cpu_least_s", "cpu_most_s", "residency_wait_s", "expansions", "reexpansions", "evictions",
               "chunks_read", "chunk_bytes_read", "peak_rss_bytes", "pixels"},
              "Cost of each budget."),
       stage_plot(
           shown, compared,
           "Wall time by stage of the run of median wall time. Whiskers: minimum and maximum of all runs."),
       wall_plot(grown, rows_of(shown, sweep.budgets, true)),
       budget_plot(grown, {"expansions", "reexpansions"}, "chunks", "Chunks grown against the budget."),
       budget_plot(grown, {"peak_rss_bytes", "memory_chunks_bytes", "budget_bytes"}, "memory",
                   "Peaks of the resident set and of the chunks against the budget."),
       budget_plot(grown, {"residency_wait_s"}, "thread time", "Time spent waiting, all threads together.")}};
  Table refusals =
      select(shown, {"variant", "budget_bytes", "status", "message"}, "Messages for the other budgets.");
  std::erase_if(refusals.rows, [](const auto& row) { return std::get<Text>(row.back()).text.empty(); });
  if (!refusals.rows.empty()) time.blocks.push_back(std::move(refusals));
  report.sections.push_back(std::move(time));
  Section memory{"Memory",
                 {resident_plot(compared, "Resident memory over time (anonymous and file-backed).")}};
  for (LinePlot& plot : tag_plots(compared)) memory.blocks.push_back(std::move(plot));
  memory.blocks.push_back(Paragraph{ledger_text(compared)});
  memory.blocks.push_back(ledger_table(shown));
  report.sections.push_back(std::move(memory));
  return measured;
}

}  // namespace pelage
