// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/memory_plots.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

using Rows = std::vector<std::vector<double>>;
constexpr size_t kSeconds = 0, kAnonymous = 1, kFile = 2, kFirstTag = 3;
constexpr size_t kMaxPoints = 250;  // more cannot be seen

// At most kMaxPoints rows: of each group of neighbours, the one with the most memory, so that no peak is
// lost.
Rows thinned(const Rows& rows) {
  if (rows.size() <= kMaxPoints) return rows;
  Rows result;
  for (size_t i = 0; i < kMaxPoints; ++i) {
    const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(i * rows.size() / kMaxPoints);
    const auto end = rows.begin() + static_cast<std::ptrdiff_t>((i + 1) * rows.size() / kMaxPoints);
    result.push_back(*std::max_element(
        begin, end, [](const auto& a, const auto& b) { return a[kAnonymous] < b[kAnonymous]; }));
  }
  return result;
}

bool has_timeline(const VariantRun* run) {
  return run && !run->statistics->timeline().empty() &&
         run->statistics->timeline_columns().size() > kFirstTag;
}

bool is_used(const Rows& rows, size_t column) {
  return std::any_of(rows.begin(), rows.end(), [&](const auto& row) { return row[column] > 0; });
}

}  // namespace

LinePlot resident_plot(const std::vector<Outcome>& outcomes, const std::string& caption) {
  LinePlot plot;
  plot.caption = caption;
  plot.x = {"time", Quantity::kSeconds};
  plot.y = {"resident memory", Quantity::kBytes};
  for (const Outcome& outcome : outcomes) {
    const VariantRun* run = outcome.typical();
    if (!has_timeline(run)) continue;
    Series series{outcome.variant.title, {}};
    for (const auto& row : thinned(run->statistics->timeline()))
      series.points.emplace_back(row[kSeconds], row[kAnonymous] + row[kFile]);
    plot.lines.push_back(std::move(series));
  }
  return plot;
}

std::vector<LinePlot> tag_plots(const std::vector<Outcome>& outcomes) {
  double last = 0, max = 0;
  std::vector<bool> used;
  for (const Outcome& outcome : outcomes) {
    const VariantRun* run = outcome.typical();
    if (!has_timeline(run)) continue;
    const Rows& rows = run->statistics->timeline();
    last = std::max(last, rows.back()[kSeconds]);
    for (const auto& row : rows) max = std::max(max, row[kAnonymous]);
    used.resize(std::max(used.size(), rows.front().size()));
    for (size_t tag = kFirstTag; tag < rows.front().size(); ++tag)
      used[tag] = used[tag] || is_used(rows, tag);
  }
  std::vector<LinePlot> plots;
  for (const Outcome& outcome : outcomes) {
    const VariantRun* run = outcome.typical();
    if (!has_timeline(run)) continue;
    const Rows rows = thinned(run->statistics->timeline());
    LinePlot plot;
    plot.half = true;
    plot.caption = outcome.variant.title + ": memory by tag of the ledger.";
    plot.x = {"time", Quantity::kSeconds, false, last};
    plot.y = {"memory", Quantity::kBytes, false, max};
    for (size_t tag = kFirstTag; tag < rows.front().size(); ++tag) {
      if (!used[tag]) continue;
      std::string name = run->statistics->timeline_columns()[tag];
      std::replace(name.begin(), name.end(), '_', ' ');
      Series series{std::move(name), {}};
      for (const auto& row : rows) series.points.emplace_back(row[kSeconds], row[tag]);
      plot.areas.push_back(std::move(series));
    }
    const double baseline = run->statistics->number("baseline_anonymous_bytes");
    Series resident{"resident (anonymous)", {}};
    for (const auto& row : rows)
      resident.points.emplace_back(row[kSeconds], row[kAnonymous] - (std::isfinite(baseline) ? baseline : 0));
    plot.lines.push_back(std::move(resident));
    plots.push_back(std::move(plot));
  }
  return plots;
}

}  // namespace pelage
