// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/schema.h"
#include "base/value_readers.h"
#include "base/vector.h"
#include "procedurals/crowd/crowd_placement.h"
#include "procedurals/crowd/ground_area.h"

namespace pelage {

// The values of one item of the key `crowds` of a scene, and the animals of a crowd.

struct CrowdHeadingParams {
  float value = 0;        ///< mean heading, degrees about y
  float variation = 180;  ///< max random deviation to either side, degrees
  static const Schema<CrowdHeadingParams>& schema();
};
struct CrowdPhaseParams {
  float value = 0;      ///< mean offset, frames
  float variation = 0;  ///< max random deviation to either side, frames
  static const Schema<CrowdPhaseParams>& schema();
};
struct CrowdScaleParams {
  float value = 1;
  float variation = 0;  ///< max random change of the size of the whole animal, as a fraction
  V3f axes{0};          ///< max random change of the size along each axis, as a fraction
  static const Schema<CrowdScaleParams>& schema();
};
struct CrowdLengthParams {
  float value = 1;      ///< factor on the length of hair
  float variation = 0;  ///< max random change of the factor, as a fraction
  static const Schema<CrowdLengthParams>& schema();
};
struct CrowdColorParams {
  Rgb value{1};
  float variation = 0;  ///< max random change of brightness, as a fraction
  float hue = 0;        ///< max random change of each channel separately, as a fraction
  static const Schema<CrowdColorParams>& schema();
};

struct CrowdParams {
  std::vector<NameReference> of;  ///< the characters of which animals are copies: the prototypes
  int64_t count = 0;              ///< number of animals
  int64_t seed = 0;
  AreaParams area;
  float spacing = 0;     ///< min distance between footprints, scene units
  NameReference ground;  ///< character whose skins the animals stand on; empty: the level ground of `area`
  float tilt = 0;        ///< 0: animals stand upright on the ground, 1: along its normal
  CrowdHeadingParams heading;
  CrowdPhaseParams phase;
  CrowdScaleParams scale;
  CrowdLengthParams length;
  CrowdColorParams color;
  static const Schema<CrowdParams>& schema();
};

/// Properties of a single animal of a crowd.
struct CrowdMember {
  size_t prototype = 0;  ///< index into CrowdParams::of
  V3f position{0};
  V3f up{0, 1, 0};         ///< unit, y of the prototype after the rotation to its heading
  float heading = 0;       ///< radians about y; 0 faces +z
  V3f scale{1};            ///< factors on the size along the axes of the prototype
  float frame_offset = 0;  ///< frames, added to the frame offset of the prototype
  float length = 1;        ///< factor on the length of its hair
  Rgb tint{1};             ///< factor on the colours of its hair and skins
};

/// Makes the animals of a crowd. The result depends only on `name`, `params`, `footprints` and `obstacles`.
/// `footprints`: one for each prototype (CrowdParams::of). `obstacles`: animals of other crowds, which do not
/// move. `named_at`: position of the crowd in the scene, for messages. Throws Error: kInput when the animals
/// do not fit into the area, kMemory (before any animal is placed) when memory does not suffice, kStopped
/// when the job is stopped.
std::vector<CrowdMember> make_crowd(const std::string& name, const SourcePosition& named_at,
                                    const CrowdParams& params, const std::vector<Footprint>& footprints,
                                    const Job& job, const std::vector<PlacedFootprint>& obstacles = {});

/// Returns an upper bound of the memory in bytes while a crowd is placed, including the result. `obstacles`:
/// their number.
int64_t crowd_temporary_bytes(const CrowdParams& params, const std::vector<Footprint>& footprints,
                              size_t obstacles);

/// Returns the ground that an animal covers. `footprint`: footprint of its prototype.
PlacedFootprint placed_footprint(const CrowdMember& member, const Footprint& footprint);

/// Returns the matrix that scales the prototype to the size of the animal (row vectors: p * M). Apply
/// scale_of(), then the prototype's own transform, then placement_of().
M44f scale_of(const CrowdMember& member);
/// Returns the matrix that rotates the animal about y to its heading, then y to CrowdMember::up by the
/// smallest rotation, then translates it to its position.
M44f placement_of(const CrowdMember& member);

}  // namespace pelage
