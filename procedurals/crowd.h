// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/schema.h"
#include "base/value_readers.h"
#include "base/vector.h"
#include "procedurals/crowd_placement.h"
#include "procedurals/ground_area.h"

namespace pelage {

// `crowds:` of a scene, and the animals that one means.

struct CrowdHeadingParams {
  float value = 0;        ///< degrees about y
  float variation = 180;  ///< degrees to either side
  static const Schema<CrowdHeadingParams>& schema();
};
struct CrowdPhaseParams {
  float value = 0;      ///< frames
  float variation = 0;  ///< frames to either side
  static const Schema<CrowdPhaseParams>& schema();
};
struct CrowdScaleParams {
  float value = 1;
  float variation = 0;  ///< of the whole animal, as a share
  V3f axes{0};          ///< of each axis by itself, as a share
  static const Schema<CrowdScaleParams>& schema();
};
struct CrowdLengthParams {
  float value = 1;
  float variation = 0;
  static const Schema<CrowdLengthParams>& schema();
};
struct CrowdColorParams {
  Rgb value{1};
  float variation = 0;  ///< of all channels together
  float hue = 0;        ///< of each channel by itself
  static const Schema<CrowdColorParams>& schema();
};

struct CrowdParams {
  std::vector<NameReference> of;
  int64_t count = 0;
  int64_t seed = 0;
  AreaParams area;
  float spacing = 0;
  CrowdHeadingParams heading;
  CrowdPhaseParams phase;
  CrowdScaleParams scale;
  CrowdLengthParams length;
  CrowdColorParams color;
  static const Schema<CrowdParams>& schema();
};

/// What one animal of a crowd has of its own.
struct CrowdMember {
  size_t prototype = 0;  ///< of CrowdParams::of
  V3f position{0};
  float heading = 0;  ///< radians about y, 0 looks along +z
  V3f scale{1};       ///< along the axes of the prototype
  float frame_offset = 0;
  float length = 1;  ///< of its hair
  Rgb tint{1};       ///< multiplies the colours of its hair and skins
};

/// The animals of a crowd, a function of the arguments. `footprints`: of each of its prototypes; `obstacles`:
/// of other crowds. Throws Error (kInput) when they do not fit into their area, Error (kMemory) before any is
/// placed, Error (kStopped); `named_at` is where the crowd stands in the scene.
std::vector<CrowdMember> make_crowd(const std::string& name, const SourcePosition& named_at,
                                    const CrowdParams& params, const std::vector<Footprint>& footprints,
                                    const Job& job, const std::vector<PlacedFootprint>& obstacles = {});

/// Upper bound of the bytes that placing a crowd holds at any moment, what it makes included.
int64_t crowd_temporary_bytes(const CrowdParams& params, const std::vector<Footprint>& footprints,
                              size_t obstacles);

/// The ground that an animal covers, for the `footprint` of its prototype.
PlacedFootprint placed_footprint(const CrowdMember& member, const Footprint& footprint);

/// Scales, turns about y and moves, in this order (row vectors: p * M); what a prototype's own transform does
/// stands between the scale and the turn.
M44f scale_of(const CrowdMember& member);
M44f placement_of(const CrowdMember& member);

}  // namespace pelage
