// SPDX-License-Identifier: Apache-2.0
#include "lab/runs/outcome_table.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

namespace pelage {
namespace {

// Union over all outcomes, so that every row has the same columns.
std::vector<std::string> all_keys(const std::vector<Outcome>& outcomes, const std::string& object) {
  std::set<std::string> keys;
  for (const Outcome& outcome : outcomes) {
    if (const VariantRun* run = outcome.typical()) {
      for (const std::string& key : run->statistics->keys(object)) keys.insert(key);
    }
  }
  return {keys.begin(), keys.end()};
}

// In the order of a run's stages; others afterwards.
std::vector<std::string> stages(const std::vector<Outcome>& outcomes) {
  const std::vector<std::string> keys = all_keys(outcomes, "stages_s");
  std::vector<std::string> sorted;
  for (const char* known : {"read", "pose", "prepare", "bound", "grow", "render", "write"}) {
    if (std::find(keys.begin(), keys.end(), known) != keys.end()) sorted.emplace_back(known);
  }
  for (const std::string& key : keys) {
    if (std::find(sorted.begin(), sorted.end(), key) == sorted.end()) sorted.push_back(key);
  }
  return sorted;
}

double anonymous_growth(const Outcome& o) {
  return o.number("peak_anonymous_bytes") - o.number("baseline_anonymous_bytes");
}

double rays(const Outcome& outcome) {
  const VariantRun* run = outcome.typical();
  return run ? run->statistics->sum("rays") : NAN;
}

std::string words(std::string key) {
  std::replace(key.begin(), key.end(), '_', ' ');
  return key;
}

const Column& column_of(const Table& table, const std::string& key) {
  return *std::find_if(table.columns.begin(), table.columns.end(),
                       [&](const Column& column) { return column.key == key; });
}

}  // namespace

void add_column(Table& table, const Column& column, const std::vector<Outcome>& outcomes,
                const std::function<Cell(const Outcome&)>& value) {
  table.columns.push_back(column);
  table.rows.resize(outcomes.size());
  for (size_t i = 0; i < outcomes.size(); ++i) table.rows[i].push_back(value(outcomes[i]));
}

Table outcome_table(const std::vector<Outcome>& outcomes) {
  Table table;
  const auto add = [&](const std::string& key, const std::string& title, Quantity quantity,
                       const auto& value) {
    add_column(table, {key, title, quantity}, outcomes, value);
  };
  const auto number = [&](const std::string& key, const std::string& title, Quantity quantity,
                          const std::string& path) {
    add(key, title, quantity, [path](const Outcome& o) -> Cell { return o.number(path); });
  };
  const auto per_ray = [&](const std::string& key, const std::string& title, const std::string& path) {
    add(key, title, Quantity::kRatio, [path](const Outcome& o) -> Cell { return o.number(path) / rays(o); });
  };
  add("variant", "variant", Quantity::kRatio, [](const Outcome& o) -> Cell { return Text{o.variant.title}; });
  add("status", "status", Quantity::kRatio, [](const Outcome& o) -> Cell { return Text{o.status()}; });
  add("runs", "runs", Quantity::kCount, [](const Outcome& o) -> Cell { return double(o.runs.size()); });
  number("wall_s", "time", Quantity::kSeconds, "wall_s");
  add("wall_least_s", "least", Quantity::kSeconds, [](const Outcome& o) -> Cell { return o.min("wall_s"); });
  add("wall_most_s", "most", Quantity::kSeconds, [](const Outcome& o) -> Cell { return o.max("wall_s"); });
  number("cpu_s", "CPU time", Quantity::kSeconds, "cpu_s");
  add("cpu_least_s", "min CPU", Quantity::kSeconds, [](const Outcome& o) -> Cell { return o.min("cpu_s"); });
  add("cpu_most_s", "max CPU", Quantity::kSeconds, [](const Outcome& o) -> Cell { return o.max("cpu_s"); });
  for (const std::string& part : all_keys(outcomes, "cpu_s_by"))
    number("cpu_" + part + "_s", "CPU: " + words(part), Quantity::kSeconds, "cpu_s_by." + part);
  number("first_pixel_s", "first pixel", Quantity::kSeconds, "first_pixel_s");
  number("peak_rss_bytes", "peak RSS", Quantity::kBytes, "peak_rss_bytes");
  number("peak_anonymous_bytes", "peak anonymous", Quantity::kBytes, "peak_anonymous_bytes");
  number("baseline_anonymous_bytes", "baseline anonymous", Quantity::kBytes, "baseline_anonymous_bytes");
  add("explained_bytes", "baseline and tags", Quantity::kBytes, [](const Outcome& o) -> Cell {
    return o.number("peak_anonymous_bytes") - o.number("unexplained_bytes");
  });
  number("unexplained_bytes", "unexplained", Quantity::kBytes, "unexplained_bytes");
  add("unexplained_share", "of peak less baseline", Quantity::kPercent,
      [](const Outcome& o) -> Cell { return o.number("unexplained_bytes") / anonymous_growth(o); });
  for (const std::string& tag : all_keys(outcomes, "memory_bytes"))
    number("memory_" + tag + "_bytes", words(tag), Quantity::kBytes, "memory_bytes." + tag);
  for (const std::string& stage : stages(outcomes))
    number("stage_" + stage + "_s", words(stage), Quantity::kSeconds, "stages_s." + stage);
  number("chunks", "chunks", Quantity::kCount, "chunks");
  number("chunks_touched", "touched", Quantity::kCount, "chunks_touched");
  number("expansions", "expansions", Quantity::kCount, "expansions");
  number("reexpansions", "re-expansions", Quantity::kCount, "reexpansions");
  number("false_expansions", "false expansions", Quantity::kCount, "false_expansions");
  add("false_expansions_share", "of expansions", Quantity::kPercent,
      [](const Outcome& o) -> Cell { return o.number("false_expansions") / o.number("expansions"); });
  number("evictions", "evictions", Quantity::kCount, "evictions");
  number("residency_wait_s", "waiting", Quantity::kSeconds, "residency_wait_s");
  number("working_set_bytes", "working set", Quantity::kBytes, "working_set_bytes");
  add("bytes_per_strand", "bytes per strand grown", Quantity::kRatio, [](const Outcome& o) -> Cell {
    return o.number("working_set_bytes") * o.number("expansions") / o.number("chunks_touched") /
           o.number("strands_generated");
  });
  number("strands_described", "strands in the scene", Quantity::kCount, "strands_described");
  number("strands_generated", "strands grown", Quantity::kCount, "strands_generated");
  number("bounds_area", "sum of box areas", Quantity::kRatio, "bounds_area");
  number("part_bounds_area", "of parts", Quantity::kRatio, "part_bounds_area");
  add("rays", "rays", Quantity::kCount, [](const Outcome& o) -> Cell { return rays(o); });
  per_ray("box_tests_per_ray", "box tests per ray", "box_tests");
  per_ray("chunk_visits_per_ray", "chunk visits per ray", "chunk_visits");
  return table;
}

std::vector<double> column_values(const Table& table, const std::string& key) {
  std::vector<double> values;
  for (const std::vector<Cell>& row : select(table, {key}, "").rows) {
    const double* number = row.empty() ? nullptr : std::get_if<double>(&row.front());
    values.push_back(number ? *number : NAN);
  }
  return values;
}

std::vector<std::string> keys_with(const Table& table, const std::string& prefix) {
  std::vector<std::string> keys;
  for (const Column& column : table.columns) {
    if (!column.key.starts_with(prefix)) continue;
    const std::vector<double> values = column_values(table, column.key);
    if (std::any_of(values.begin(), values.end(), [](double v) { return std::isfinite(v) && v != 0; }))
      keys.push_back(column.key);
  }
  return keys;
}

BarPlot column_plot(const Table& table, const std::vector<Outcome>& outcomes,
                    const std::vector<std::string>& keys, const std::string& axis,
                    const std::string& caption) {
  BarPlot plot;
  plot.caption = caption;
  plot.value.label = axis;
  for (const Outcome& outcome : outcomes) plot.groups.push_back(outcome.variant.title);
  for (const std::string& key : keys) {
    const Column& column = column_of(table, key);
    plot.value.quantity = column.quantity;
    plot.series.push_back({column.title, column_values(table, key)});
  }
  return plot;
}

BarPlot stage_plot(const Table& table, const std::vector<Outcome>& outcomes, const std::string& caption) {
  BarPlot plot = column_plot(table, outcomes, keys_with(table, "stage_"), "wall time", caption);
  plot.stacked = true;
  for (const Outcome& outcome : outcomes) {
    plot.spread.emplace_back(outcome.min("wall_s"), outcome.max("wall_s"));
    plot.notes.push_back(outcome.succeeded() ? "" : outcome.status());
  }
  return plot;
}

Table ledger_table(const Table& table) {
  return select(table,
                {"variant", "peak_rss_bytes", "peak_anonymous_bytes", "baseline_anonymous_bytes",
                 "explained_bytes", "unexplained_bytes", "unexplained_share"},
                "Ledger against kernel, at the peak of anonymous resident pages.");
}

std::string ledger_text(const std::vector<Outcome>& outcomes) {
  double worst = -1, bytes = 0;
  const Outcome* at = nullptr;
  for (const Outcome& outcome : outcomes) {
    const double share = std::abs(outcome.number("unexplained_bytes")) / anonymous_growth(outcome);
    if (!(share > worst)) continue;
    worst = share;
    bytes = outcome.number("unexplained_bytes");
    at = &outcome;
  }
  if (!at) return "No run reported how much of its memory the ledger explains.";
  return fmt::format(
      "Ledger against kernel: at the peak of anonymous resident pages, the ledger's tags and the baseline "
      "(the memory of the process once its command line is read) explained the growth of these pages to "
      "within {:.1f} % in the worst case ({}, {:+.1f} MiB); Pelage promises 10 %.",
      100 * worst, at->variant.title, bytes / (1 << 20));
}

}  // namespace pelage
