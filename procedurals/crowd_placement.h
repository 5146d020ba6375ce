// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "procedurals/ground_area.h"

namespace pelage {

struct Job;

/// The ground covered by an animal, as discs (x, z, radius) around its origin, for heading 0.
using Footprint = std::vector<V3f>;

/// Position of one animal of a crowd.
struct CrowdPlace {
  V2f position{0};    ///< (x, z)
  float heading = 0;  ///< radians about y; 0 looks along +z, a quarter turn along +x
};

/// An animal that is already placed.
struct PlacedFootprint {
  Footprint footprint;
  CrowdPlace place;
};

/// Constraints of a placement.
struct CrowdRules {
  std::vector<Footprint> footprints;  ///< one per animal; an empty one is a single point
  float spacing = 0;                  ///< min distance between two footprints
  float heading = 0;                  ///< middle of the allowed headings, radians
  float heading_variation = 0;        ///< max deviation from `heading`, radians
  uint64_t seed = 0;
  std::vector<PlacedFootprint> obstacles;  ///< fixed; `spacing` applies to them too
};

/// Spreads animals evenly over an area, then pushes and rotates animals that are too close until none are too
/// close. Positions (not footprints) stay inside the area. The result depends only on the arguments.
/// Single-threaded. Throws Error: kInput when the animals do not fit, kStopped when the job is stopped.
std::vector<CrowdPlace> place_crowd(const GroundArea& area, const CrowdRules& rules, const Job& job);

/// Max memory per animal that place_crowd() holds, including its rules, for animals with this number of
/// discs.
size_t crowd_placement_bytes(size_t discs);

/// Distance between two footprints, negative when they overlap.
float footprint_distance(const Footprint& a, const CrowdPlace& at, const Footprint& b, const CrowdPlace& bt);

}  // namespace pelage
