// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/curl.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/value_readers.h"
#include "groom/strands/rotation.h"
#include "groom/strands/strand_fields.h"
#include "groom/strands/transported_frame.h"

namespace pelage {
namespace {

/// Inverse of the radius factor of a uniform cubic B-spline whose control points are on a circle, a fixed
/// fraction of a turn apart: (2 + cos) / 3. Gives the curve the requested radius; valid up to a third of a
/// turn, beyond which control points do not describe a circle.
float spline_gain(float turns_per_segment) {
  float sine, cosine;
  sincos_turns(std::min(std::fabs(turns_per_segment), 1.0f / 3), sine, cosine);
  return 3.0f / (2.0f + cosine);
}

}  // namespace

const Schema<CurlParams>& CurlParams::schema() {
  static const Schema<CurlParams> table = [] {
    Schema<CurlParams> s("curl",
                         "Winds each strand into a helix. The root stays in place and the strand becomes "
                         "longer. Use at least 3 points per turn, better 5.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - curl: {radius: 0.06, turns: 3})");
    s.set_picture("Left: straight strands. Right: helices of 3 turns.");
    s.key("radius", &CurlParams::radius, {.unit = "scene units", .help = "Radius of the helix", .min = 0});
    s.key("turns", &CurlParams::turns,
          {.help = "Turns from root to tip; negative values wind the other way", .min = -1000, .max = 1000});
    s.key("angle_variation", &CurlParams::random,
          {.help = "Random variation of the angle at which the helix starts: 0 gives all strands the same "
                   "angle, 1 any angle",
           .min = 0,
           .max = 1,
           .old_names = {"random"}});
    s.key("start", &CurlParams::start,
          {.help = "Fraction of the strand, from the root, over which the radius grows to its full size",
           .min = 0,
           .max = 1});
    return s;
  }();
  return table;
}

void Curl::prepare(const PrepareContext& context) {
  seed_ = context.seed;
  params_.radius = params_.radius.with_textures(context.textures);
  params_.turns = params_.turns.with_textures(context.textures);
}

void Curl::apply(StrandBatch& batch) const {
  StrandRow phase, turns, gain, a, b;
  evaluate(params_.turns, batch, 0, turns);
  const float segments = static_cast<float>(batch.segment_count());
  for (size_t s = 0; s < batch.count; ++s) {
    turns[s] = std::clamp(turns[s], -1000.0f, 1000.0f);
    phase[s] = params_.random * unit_float(hash64(seed_, batch.ids[s], random_use("curl")));
    gain[s] = spline_gain(turns[s] / segments) * batch.scale;
  }
  StrandField radius(params_.radius, batch);
  TransportedFrame frame(batch);
  for (int p = 1; p < batch.point_count(); ++p) {
    const float along = batch.along(p);
    const float envelope = params_.start > 0 ? std::min(along / params_.start, 1.0f) : 1.0f;
    const StrandRow& size = radius.at(along);
    for (size_t s = 0; s < batch.count; ++s) {
      float sine, cosine;
      sincos_turns(phase[s] + turns[s] * along, sine, cosine);
      const float scale = envelope * gain[s] * std::max(size[s], 0.0f);
      a[s] = scale * cosine;
      b[s] = scale * sine;
    }
    frame.advance(batch);
    frame.displace(batch, p, a, b);
  }
}

StrandReach Curl::reach_after(const StrandReach& before) const {
  const auto [low, high] = params_.turns.value_range();
  const float max = std::min(std::max(std::fabs(low), std::fabs(high)), 1000.0f);
  return before.displaced(std::max(params_.radius.value_range().second, 0.0f) *
                          spline_gain(max / static_cast<float>(before.segments)) * 1.00001f);
}

}  // namespace pelage
