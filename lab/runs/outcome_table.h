// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lab/report/report.h"
#include "lab/runs/variant.h"

namespace pelage {

/// Returns a table with one row per outcome, and the columns that all experiments on `render` have: status,
/// wall and CPU time, memory peaks, bytes by ledger tag ("memory_film_bytes"), seconds by stage
/// ("stage_render_s"), counts of chunks, growth, rays and box tests.
Table outcome_table(const std::vector<Outcome>& outcomes);

/// Adds a column to a table. Calls `value` for the outcome of every row.
void add_column(Table& table, const Column& column, const std::vector<Outcome>& outcomes,
                const std::function<Cell(const Outcome&)>& value);

/// Returns the keys that start with `prefix`, in the order of the table's columns. Omits columns in which all
/// numbers are zero or unknown.
std::vector<std::string> keys_with(const Table& table, const std::string& prefix);

/// Returns the numbers of a column. NaN for texts and for a column that does not exist.
std::vector<double> column_values(const Table& table, const std::string& key);

/// Returns the columns of `table` about law 5: how much of the resident memory the ledger explains.
Table ledger_table(const Table& table);

/// Returns a plot with one bar per outcome: wall times of the stages, stacked, with the min and max total
/// time over all runs.
BarPlot stage_plot(const Table& table, const std::vector<Outcome>& outcomes, const std::string& caption);
/// Returns a plot with one group per outcome and one bar per key in each group.
BarPlot column_plot(const Table& table, const std::vector<Outcome>& outcomes,
                    const std::vector<std::string>& keys, const std::string& axis,
                    const std::string& caption);

/// Returns a sentence about law 5: how much of the resident memory the ledger does not explain.
std::string ledger_text(const std::vector<Outcome>& outcomes);

}  // namespace pelage
