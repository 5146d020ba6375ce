// SPDX-License-Identifier: Apache-2.0
#include "procedurals/crowd/crowd.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/job.h"
#include "base/memory_budget.h"

namespace pelage {

namespace {

/// Random numbers of one animal, in [-1, 1).
class MemberRandom {
 public:
  MemberRandom(uint64_t seed, size_t animal) : seed_(seed), animal_(animal) {}
  uint64_t bits(uint64_t use) const { return hash64(seed_, animal_, use); }
  float varied(float value, float variation, uint64_t use) const {
    return value * (1 + variation * signed_float(bits(use)));
  }

 private:
  uint64_t seed_;
  size_t animal_;
};

CrowdMember vary(const CrowdParams& params, const MemberRandom& random) {
  CrowdMember member;
  member.prototype = random.bits(random_use("crowd prototype")) % params.of.size();
  const float scale = random.varied(params.scale.value, params.scale.variation, random_use("crowd scale"));
  member.scale = {random.varied(scale, params.scale.axes.x, random_use("crowd scale x")),
                  random.varied(scale, params.scale.axes.y, random_use("crowd scale y")),
                  random.varied(scale, params.scale.axes.z, random_use("crowd scale z"))};
  member.frame_offset =
      params.phase.value + params.phase.variation * signed_float(random.bits(random_use("crowd phase")));
  member.length = random.varied(params.length.value, params.length.variation, random_use("crowd length"));
  const float brightness = random.varied(1, params.color.variation, random_use("crowd color"));
  member.tint =
      params.color.value * Rgb(random.varied(brightness, params.color.hue, random_use("crowd red")),
                               random.varied(brightness, params.color.hue, random_use("crowd green")),
                               random.varied(brightness, params.color.hue, random_use("crowd blue")));
  return member;
}

Footprint scaled_footprint(const Footprint& footprint, const V3f& scale) {
  Footprint result;
  for (const V3f& disc : footprint)
    result.emplace_back(disc.x * scale.x, disc.y * scale.z, disc.z * std::max(scale.x, scale.z));
  return result;
}

}  // namespace

int64_t crowd_temporary_bytes(const CrowdParams& params, const std::vector<Footprint>& footprints,
                              size_t obstacles) {
  size_t discs = 1;
  for (const Footprint& footprint : footprints) discs = std::max(discs, footprint.size());
  const size_t bodies = static_cast<size_t>(params.count) + obstacles;
  return static_cast<int64_t>(static_cast<size_t>(params.count) * sizeof(CrowdMember) +
                              bodies * crowd_placement_bytes(discs));
}

std::vector<CrowdMember> make_crowd(const std::string& name, const SourcePosition& named_at,
                                    const CrowdParams& params, const std::vector<Footprint>& footprints,
                                    const Job& job, const std::vector<PlacedFootprint>& obstacles) {
  const MemoryCharge making =
      reserve(job.ledger, MemoryTag::kSkins, crowd_temporary_bytes(params, footprints, obstacles.size()),
              fmt::format("placing {} animals of crowd '{}'", params.count, name));
  constexpr float to_radians = std::numbers::pi_v<float> / 180;
  const uint64_t seed = hash64(static_cast<uint64_t>(params.seed),
                               content_hash(std::as_bytes(std::span(name.data(), name.size()))).low);
  std::vector<CrowdMember> members;
  CrowdRules rules;
  members.reserve(static_cast<size_t>(params.count));
  rules.footprints.reserve(static_cast<size_t>(params.count));
  for (size_t i = 0; i < static_cast<size_t>(params.count); ++i) {
    if (i % 4096 == 0) job.check_stop();
    members.push_back(vary(params, MemberRandom(seed, i)));
    rules.footprints.push_back(scaled_footprint(footprints[members.back().prototype], members.back().scale));
  }
  rules.spacing = params.spacing;
  rules.heading = params.heading.value * to_radians;
  rules.heading_variation = params.heading.variation * to_radians;
  rules.seed = seed;
  rules.obstacles = obstacles;
  const GroundArea area(params.area);
  std::vector<CrowdPlace> places;
  try {
    places = place_crowd(area, rules, job);
  } catch (const Error& error) {
    throw Error(error.kind(), named_at, "crowd '" + name + "': " + error.what());
  }
  for (size_t i = 0; i < members.size(); ++i) {
    members[i].position = V3f(places[i].position.x, area.height(), places[i].position.y);
    members[i].heading = places[i].heading;
  }
  return members;
}

PlacedFootprint placed_footprint(const CrowdMember& member, const Footprint& footprint) {
  return {scaled_footprint(footprint, member.scale),
          {V2f(member.position.x, member.position.z), member.heading}};
}

M44f scale_of(const CrowdMember& member) {
  M44f matrix;
  matrix.setScale(member.scale);
  return matrix;
}

M44f placement_of(const CrowdMember& member) {
  const float s = std::sin(member.heading), c = std::cos(member.heading);
  const V3f &p = member.position, &up = member.up;
  const M44f level(c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, p.x, p.y, p.z, 1);
  if (up == V3f(0, 1, 0)) return level;
  // Rotates y to `up`, which is above the ground: 1 + up.y > 0.
  const float k = 1 / (1 + up.y);
  const M44f tilt(1 - k * up.x * up.x, -up.x, -k * up.x * up.z, 0,  //
                  up.x, up.y, up.z, 0,                              //
                  -k * up.x * up.z, -up.z, 1 - k * up.z * up.z, 0,  //
                  0, 0, 0, 1);
  M44f turned = level * tilt;
  std::copy_n(&p.x, 3, turned[3]);
  return turned;
}

}  // namespace pelage
