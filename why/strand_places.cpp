// SPDX-License-Identifier: Apache-2.0
#include "why/strand_places.h"

#include <algorithm>

#include "geom/strand_point.h"

namespace pelage {
namespace {

constexpr uint32_t kPiecesOfSegment = 8;  // straight pieces that measure its length

}  // namespace

StrandPlaces strand_places(const Strands& strand) {
  const uint32_t segments = segment_count(strand.basis(), strand.strand_points(0));
  StrandPlaces places;
  const StrandAttribute* color = strand.find_attribute("color");
  if (color && color->components == 3) places.color.emplace();
  for (size_t i = 0; i < places.position.size(); ++i) {
    const float along = 0.5f * static_cast<float>(i) * static_cast<float>(segments);
    const uint32_t segment = std::min(static_cast<uint32_t>(along), segments - 1);
    const float t = along - static_cast<float>(segment);
    const StrandPoint point = strand_point(strand, 0, segment, t, 0);
    places.position[i] = point.position;
    places.width[i] = 2 * point.radius;
    if (places.color) interpolate_attribute(strand, *color, 0, segment, t, &(*places.color)[i].x);
  }
  V3f last = places.position.front();
  for (uint32_t piece = 1; piece <= segments * kPiecesOfSegment; ++piece) {
    const uint32_t segment = (piece - 1) / kPiecesOfSegment;
    const float t = static_cast<float>(piece - segment * kPiecesOfSegment) / kPiecesOfSegment;
    const V3f at = strand_point(strand, 0, segment, t, 0).position;
    places.length += (at - last).length();
    last = at;
  }
  return places;
}

}  // namespace pelage
