// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "groom/groom_params.h"
#include "lab/report/report.h"
#include "lab/runs/variant.h"

namespace pelage {

/// Cost of editing one frozen operator: the groom is grown again from the state before it.
struct GrowthEdit {
  std::string op;  ///< name of the operator
  size_t place = 0;
  Variant variant;
};

/// One edit for each frozen operator of a groom with a cache, in order. The folder must be filled and used by
/// this groom only. Before each run, it is reset to the state after an edit of the operator.
std::vector<GrowthEdit> growth_edits(const std::string& groom, const GroomParams& params,
                                     const std::filesystem::path& cache, const Variant& common);

/// One row per operator, using the first of `outcomes` for each; `cold`: the run with an empty cache.
Table edit_table(const std::string& groom, const GroomParams& params, const std::filesystem::path& cache,
                 const std::vector<GrowthEdit>& edits, const std::vector<Outcome>& outcomes,
                 const Outcome& cold);

}  // namespace pelage
