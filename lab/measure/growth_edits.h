// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "groom/coat/groom_params.h"
#include "lab/report/report.h"
#include "lab/runs/variant.h"

namespace pelage {

/// A run that measures the cost of editing one frozen operator: the groom is grown again from the state
/// before this operator.
struct GrowthEdit {
  std::string op;    ///< name of the operator
  size_t place = 0;  ///< index of the operator in the groom
  Variant variant;
};

/// Returns one edit for each frozen operator of a groom with a cache, in order of the operators. `cache` is
/// the folder of the cache. It must be filled, and no other groom may use it. Before each run, removes the
/// results that an edit of the operator would make stale.
std::vector<GrowthEdit> growth_edits(const std::string& groom, const GroomParams& params,
                                     const std::filesystem::path& cache, const Variant& common);

/// Returns a table with one row per operator; outcome i belongs to edit i. `cold` is the outcome with an
/// empty cache.
Table edit_table(const std::string& groom, const GroomParams& params, const std::filesystem::path& cache,
                 const std::vector<GrowthEdit>& edits, const std::vector<Outcome>& outcomes,
                 const Outcome& cold);

}  // namespace pelage
