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

/// One edit for each frozen operator of a groom with a cache, in order. Before each run the folder, which
/// must be this groom's alone and filled, is made to hold what it would after an edit of the operator.
std::vector<GrowthEdit> growth_edits(const std::string& groom, const GroomParams& params,
                                     const std::filesystem::path& cache, const Variant& common);

/// A row per operator, for the first of `outcomes` each; `cold` is the run that finds an empty cache.
Table edit_table(const std::string& groom, const GroomParams& params, const std::filesystem::path& cache,
                 const std::vector<GrowthEdit>& edits, const std::vector<Outcome>& outcomes,
                 const Outcome& cold);

}  // namespace pelage
