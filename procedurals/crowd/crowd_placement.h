// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "procedurals/crowd/ground_area.h"

namespace pelage {

struct Job;

/// The ground that an animal covers, as discs (x, z, radius) relative to its origin, for heading 0.
using Footprint = std::vector<V3f>;

/// Position of one animal of a crowd.
struct CrowdPlace {
  V2f position{0};    ///< (x, z)
  float heading = 0;  ///< radians about y; 0 faces +z, pi / 2 faces +x
};

/// An animal that is already placed.
struct PlacedFootprint {
  Footprint footprint;
  CrowdPlace place;
};

/// Constraints of a placement.
struct CrowdRules {
  std::vector<Footprint> footprints;  ///< one per animal; an empty one means a single point
  float spacing = 0;                  ///< min distance between two footprints, scene units
  float heading = 0;                  ///< middle of the allowed headings, radians
  float heading_variation = 0;        ///< max deviation from `heading`, radians
  uint64_t seed = 0;
  std::vector<PlacedFootprint> obstacles;  ///< other animals, which do not move; `spacing` holds for them too
};

/// Spreads animals evenly over an area. Then moves and rotates animals that are too close to others, until
/// all distances are at least `spacing`. The positions of animals stay inside the area; their footprints may
/// extend beyond its border. The result depends only on `area` and `rules`. Runs on the calling thread.
/// Throws Error: kInput when the animals do not fit, kStopped when the job is stopped.
std::vector<CrowdPlace> place_crowd(const GroundArea& area, const CrowdRules& rules, const Job& job);

/// Returns the max memory in bytes that place_crowd() and its rules take per animal. `discs`: number of discs
/// of a footprint.
size_t crowd_placement_bytes(size_t discs);

/// Returns the distance between footprint `a` at place `at` and footprint `b` at place `bt`; negative when
/// they overlap.
float footprint_distance(const Footprint& a, const CrowdPlace& at, const Footprint& b, const CrowdPlace& bt);

}  // namespace pelage
