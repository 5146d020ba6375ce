// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "lab/compare/compared_frame.h"
#include "lab/compare/single_fibre.h"

namespace pelage {

/// Result of comparing the fibre models on a scene; incomplete when the user stopped it.
struct Comparison {
  std::vector<ComparedFrame> frames;
  std::vector<SingleFibre> fibres;
  std::map<std::string, double> furnace;  ///< by model: see FrameComparer::furnace
};

/// The report without the facts about the machine: tables of cost, noise and energy, the contact sheet and
/// the single fibres. `comparison` must have frames.
Report comparison_report(const Comparison& comparison, const SceneDescription& scene);

/// Data for plots, as JSON: for every fibre, the distributions of energy around and along the fibre, from the
/// model and from tracing.
std::string fibres_json(const std::vector<SingleFibre>& fibres);

}  // namespace pelage
