// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "lab/compare/compared_frame.h"
#include "lab/compare/single_fibre.h"

namespace pelage {

/// Result of comparing fibre models on a scene. Incomplete when the user stopped the comparison.
struct Comparison {
  std::vector<ComparedFrame> frames;
  std::vector<SingleFibre> fibres;
  std::map<std::string, double> furnace;  ///< by name of the model: result of FrameComparer::furnace()
};

/// Returns the report, without the facts about the machine: tables of cost, noise and energy, the contact
/// sheet, and pictures of the single fibres. `comparison` must have at least one frame.
Report comparison_report(const Comparison& comparison, const SceneDescription& scene);

/// Returns data for plots, as JSON. For every fibre, this is the distribution of scattered energy around the
/// fibre and along it, both from the model and from tracing.
std::string fibres_json(const std::vector<SingleFibre>& fibres);

}  // namespace pelage
