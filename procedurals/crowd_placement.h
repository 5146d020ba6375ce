// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "procedurals/ground_area.h"

namespace pelage {

struct Job;

/// The ground that an animal covers, as discs (x, z, radius) about its origin, for heading 0.
using Footprint = std::vector<V3f>;

/// Where one animal of a crowd stands.
struct CrowdPlace {
  V2f position{0};    ///< (x, z)
  float heading = 0;  ///< radians about y; 0 looks along +z, a quarter turn along +x
};

/// An animal that stands already.
struct PlacedFootprint {
  Footprint footprint;
  CrowdPlace place;
};

/// What a placement has to keep to.
struct CrowdRules {
  std::vector<Footprint> footprints;  ///< one per animal; an empty one is the point it stands on
  float spacing = 0;                  ///< least distance between two footprints
  float heading = 0;                  ///< middle of the allowed headings, radians
  float heading_variation = 0;        ///< farthest from it, radians
  uint64_t seed = 0;
  std::vector<PlacedFootprint> obstacles;  ///< keep clear of these by `spacing` too; they do not move
};

/// Spreads animals evenly over an area, then pushes and turns those that are too close until none is.
/// Positions (not footprints) stay inside the area. A function of its arguments alone; on one thread. Throws
/// Error (kInput) when they do not fit, Error (kStopped).
std::vector<CrowdPlace> place_crowd(const GroundArea& area, const CrowdRules& rules, const Job& job);

/// What place_crowd() holds at any moment, its rules included, for each body of so many discs.
size_t crowd_placement_bytes(size_t discs);

/// Distance between two footprints, negative when they overlap.
float footprint_distance(const Footprint& a, const CrowdPlace& at, const Footprint& b, const CrowdPlace& bt);

}  // namespace pelage
