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

// `crowds:` of a scene, and the animals of one of them.

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
  float variation = 0;  ///< variation of the whole animal's size, as a fraction
  V3f axes{0};          ///< variation of the size along each axis, as a fraction
  static const Schema<CrowdScaleParams>& schema();
};
struct CrowdLengthParams {
  float value = 1;
  float variation = 0;
  static const Schema<CrowdLengthParams>& schema();
};
struct CrowdColorParams {
  Rgb value{1};
  float variation = 0;  ///< variation that all channels share
  float hue = 0;        ///< variation of each channel separately
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

/// Properties of a single animal of a crowd.
struct CrowdMember {
  size_t prototype = 0;  ///< index into CrowdParams::of
  V3f position{0};
  float heading = 0;  ///< radians about y, 0 looks along +z
  V3f scale{1};       ///< along the axes of the prototype
  float frame_offset = 0;
  float length = 1;  ///< factor on the length of its hair
  Rgb tint{1};       ///< multiplies the colours of its hair and skins
};

/// Makes the animals of a crowd; the result depends only on the arguments. `footprints`: of the crowd's
/// prototypes; `obstacles`: animals of other crowds; `named_at`: position of the crowd in the scene. Throws
/// Error: kInput when the animals do not fit their area, kMemory (before any animal is placed) when memory
/// does not suffice, kStopped when the job is stopped.
std::vector<CrowdMember> make_crowd(const std::string& name, const SourcePosition& named_at,
                                    const CrowdParams& params, const std::vector<Footprint>& footprints,
                                    const Job& job, const std::vector<PlacedFootprint>& obstacles = {});

/// Upper bound of the memory in use while a crowd is placed, including the result.
int64_t crowd_temporary_bytes(const CrowdParams& params, const std::vector<Footprint>& footprints,
                              size_t obstacles);

/// The ground covered by an animal, given the `footprint` of its prototype.
PlacedFootprint placed_footprint(const CrowdMember& member, const Footprint& footprint);

/// Scale, rotation about y, and translation, applied in this order (row vectors: p * M). The prototype's own
/// transform is applied between scale and rotation.
M44f scale_of(const CrowdMember& member);
M44f placement_of(const CrowdMember& member);

}  // namespace pelage
