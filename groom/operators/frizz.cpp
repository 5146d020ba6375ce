// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/frizz.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/value_readers.h"
#include "groom/strands/rotation.h"
#include "groom/strands/strand_fields.h"
#include "groom/strands/transported_frame.h"

namespace pelage {
namespace {

/// Sideways noise per strand at one position: unit vectors at integer `t`, blended smoothly in between, so
/// never longer than 1.
struct LatticeNoise {
  StrandRow before, after;  // turns of the two unit vectors
  StrandRow blend;

  void find(const StrandBatch& batch, const std::array<uint64_t, kBlockStrands>& streams, float along,
            const StrandRow& frequency) {
    for (size_t s = 0; s < batch.count; ++s) {
      const float t = along * frequency[s] + unit_float(streams[s]);
      const float cell = std::floor(t);
      const auto k = static_cast<uint64_t>(static_cast<int64_t>(cell));
      before[s] = unit_float(mix64(streams[s] + k * 0x9e3779b97f4a7c15ull));
      after[s] = unit_float(mix64(streams[s] + (k + 1) * 0x9e3779b97f4a7c15ull));
      const float x = t - cell;
      blend[s] = x * x * (3.0f - 2.0f * x);
    }
  }
};

}  // namespace

const Schema<FrizzParams>& FrizzParams::schema() {
  static const Schema<FrizzParams> table = [] {
    Schema<FrizzParams> s("frizz",
                          "Displaces each strand sideways by its own random waves. The root stays in place; "
                          "the waves reach their full amplitude at half the length. Strands become longer.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - frizz: {amplitude: 0.12, frequency: 4})");
    s.set_picture("Left: straight strands. Right: `amplitude: 0.12`.");
    s.key("amplitude", &FrizzParams::amplitude,
          {.unit = "scene units", .help = "Maximum displacement of a point", .min = 0});
    s.key("frequency", &FrizzParams::frequency,
          {.help = "Changes of direction from root to tip. Keep it below half the number of control points; "
                   "higher frequencies are lost",
           .min = 0,
           .max = 1000});
    return s;
  }();
  return table;
}

void Frizz::prepare(const PrepareContext& context) {
  seed_ = context.seed;
  params_.amplitude = params_.amplitude.with_textures(context.textures);
  params_.frequency = params_.frequency.with_textures(context.textures);
}

void Frizz::apply(StrandBatch& batch) const {
  std::array<uint64_t, kBlockStrands> streams;
  for (size_t s = 0; s < batch.count; ++s) streams[s] = hash64(seed_, batch.ids[s], random_use("frizz"));
  StrandRow frequency, a, b;
  evaluate(params_.frequency, batch, 0, frequency);
  for (float& f : frequency) f = std::clamp(f, 0.0f, 1000.0f);
  StrandField amplitude(params_.amplitude, batch);
  TransportedFrame frame(batch);
  LatticeNoise noise;
  for (int p = 1; p < batch.point_count(); ++p) {
    const float along = batch.along(p);
    const float envelope = std::min(2.0f * along, 1.0f) * batch.scale;
    const StrandRow& size = amplitude.at(along);
    noise.find(batch, streams, along, frequency);
    for (size_t s = 0; s < batch.count; ++s) {
      float s0, c0, s1, c1;
      sincos_turns(noise.before[s], s0, c0);
      sincos_turns(noise.after[s], s1, c1);
      const float scale = envelope * std::max(size[s], 0.0f);
      a[s] = scale * (c0 + (c1 - c0) * noise.blend[s]);
      b[s] = scale * (s0 + (s1 - s0) * noise.blend[s]);
    }
    frame.advance(batch);
    frame.displace(batch, p, a, b);
  }
}

StrandReach Frizz::reach_after(const StrandReach& before) const {
  return before.displaced(std::max(params_.amplitude.value_range().second, 0.0f));
}

}  // namespace pelage
