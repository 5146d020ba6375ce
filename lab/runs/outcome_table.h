// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lab/report/report.h"
#include "lab/runs/variant.h"

namespace pelage {

/// The columns common to all experiments on `render`, one row per outcome: status, wall and CPU time, memory
/// peaks, bytes by ledger tag ("memory_film_bytes"), seconds by stage ("stage_render_s"), chunks and growth,
/// rays and boxes.
Table outcome_table(const std::vector<Outcome>& outcomes);

/// Adds a column; calls `value` for every row's outcome.
void add_column(Table& table, const Column& column, const std::vector<Outcome>& outcomes,
                const std::function<Cell(const Outcome&)>& value);

/// Keys of the columns that start with `prefix` and are not entirely zero or unknown, in the table's order.
std::vector<std::string> keys_with(const Table& table, const std::string& prefix);

/// The numbers of a column; NaN for texts.
std::vector<double> column_values(const Table& table, const std::string& key);

/// The columns of law 5: how much of the resident memory the ledger explains.
Table ledger_table(const Table& table);

/// Stages by wall time, stacked, with the spread of all runs: one bar per outcome.
BarPlot stage_plot(const Table& table, const std::vector<Outcome>& outcomes, const std::string& caption);
/// Columns side by side, or stacked: one bar per outcome and key.
BarPlot column_plot(const Table& table, const std::vector<Outcome>& outcomes,
                    const std::vector<std::string>& keys, const std::string& axis,
                    const std::string& caption);

/// The sentence on law 5: how much of the resident memory the ledger does not explain.
std::string ledger_text(const std::vector<Outcome>& outcomes);

}  // namespace pelage
