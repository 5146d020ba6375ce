// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/braid.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/value_readers.h"
#include "groom/operators/clump_centres.h"
#include "groom/operators/turning.h"
#include "groom/strands/part_lines.h"
#include "groom/strands/rotation.h"
#include "groom/strands/strand_fields.h"

namespace pelage {
namespace {

constexpr float kTurn = 2 * std::numbers::pi_v<float>;

}  // namespace

/// The frames of a centre strand, and the place of one strand in its braid.
struct Braid::Centre {
  size_t index = 0;
  std::vector<V3f> along, first;  // of each point: direction and perpendicular, transported from the root
  float phase = 0;                // of the ply, in turns
  float stretch = 1;              // length of a ply over that of the centre strand
  float a = 0, b = 0;             // place in the ply, in radii of the braid

  /// Rotation-minimising frames along centre strand `i`.
  Centre(const ClumpCentres& centres, size_t i) : index(i) {
    const int points = centres.points();
    for (int p = 0; p < points; ++p) {
      const int from = std::min(p, points - 2);
      const V3f before = p > 0 ? along.back() : V3f(0, 0, 1);
      along.push_back(normalised_or(centres.point(i, from + 1) - centres.point(i, from), before));
      first.push_back(p == 0 ? any_perpendicular(along[0])
                             : rotation_between(along[static_cast<size_t>(p) - 1], along.back(), first.back())
                                   .apply(first.back()));
    }
  }
};

const Schema<BraidParams>& BraidParams::schema() {
  static const Schema<BraidParams> table = [] {
    Schema<BraidParams> s(
        "braid",
        "Gathers strands into clumps whose plies are braided or twisted around a centre strand, "
        "which the preceding operators shape. Strands never become longer. Use at least 8 "
        "points per turn.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - braid: {spacing: 0.6, radius: 0.08, pitch: 0.5})");
    s.set_picture("Left: straight strands. Right: braids of three plies.");
    s.key("style", &BraidParams::style,
          {.help = "`braid`: plies cross each other; `twist`: plies run side by side, as in a rope"});
    s.key("spacing", &BraidParams::spacing,
          {.unit = "scene units", .help = "Mean distance between braids", .min = 0, .above_min = true});
    s.key("plies", &BraidParams::plies, {.help = "Number of plies", .min = 1, .max = 12});
    s.key("radius", &BraidParams::radius,
          {.unit = "scene units", .help = "Distance from the centre strand to the plies", .min = 0});
    s.key("pitch", &BraidParams::pitch,
          {.unit = "scene units",
           .help = "Length along the centre strand of one turn",
           .min = 0,
           .above_min = true});
    s.key("start", &BraidParams::start,
          {.help = "Fraction of the strand, from the root, over which it joins its ply", .min = 0, .max = 1});
    s.key("thickness", &BraidParams::thickness,
          {.help = "Radius of a ply, as a fraction of `radius`", .min = 0, .max = 2});
    s.key("amount", &BraidParams::amount,
          {.help = "How far strands move into their ply: 0 not at all, 1 fully. It may vary along the strand",
           .min = 0,
           .max = 1});
    return s;
  }();
  return table;
}

void Braid::prepare(const PrepareContext& context) {
  if (!context.rest)
    throw Error(ErrorKind::kInput, context.position, "the operator braid needs strands that grow on a skin");
  seed_ = context.seed;
  parts_ = context.parts;
  params_.radius = params_.radius.with_textures(context.textures);
  params_.amount = params_.amount.with_textures(context.textures);
  centres_ = std::make_shared<const ClumpCentres>(context, params_.spacing, seed_, [&](StrandBatch& batch) {
    for (const auto& op : context.preceding) {
      if (op->traits().reads_rest_only) op->apply(batch);
    }
  });
}

/// Point of the strand's ply in rest space, at this arc length of the centre strand.
V3f Braid::target(const Centre& centre, float arc, float radius, int& segment) const {
  const V3f at = centres_->at(centre.index, arc, segment);
  const auto p = static_cast<size_t>(segment);
  const float from = centres_->arc(centre.index, segment), to = centres_->arc(centre.index, segment + 1);
  const float t = to > from ? std::clamp((arc - from) / (to - from), 0.0f, 1.0f) : 0.0f;
  const V3f along =
      normalised_or(centre.along[p] + (centre.along[p + 1] - centre.along[p]) * t, centre.along[p]);
  const V3f mixed = centre.first[p] + (centre.first[p + 1] - centre.first[p]) * t;
  const V3f first = normalised_or(mixed - along * along.dot(mixed), any_perpendicular(along));
  float sine, cosine;
  const float turns = centre.phase + arc / params_.pitch;
  sincos_turns(turns, sine, cosine);
  if (params_.style == BraidStyle::kBraid) sine = sine * cosine;  // sin(2 t) / 2
  return at + (first * (cosine + centre.a) + along.cross(first) * (sine + centre.b)) * radius;
}

void Braid::apply(StrandBatch& batch) const {
  StrandRow radius, length;
  evaluate(params_.radius, batch, 0, radius);
  arc_lengths(batch, length);
  std::vector<StrandRow> amounts(batch.points.size());
  StrandField amount(params_.amount, batch);
  for (int p = 1; p < batch.point_count(); ++p) amounts[static_cast<size_t>(p)] = amount.at(batch.along(p));
  const auto plies = static_cast<float>(params_.plies);
  for (size_t s = 0; s < batch.count; ++s) {
    const V3f root = vector_at(batch.rest.position, s), normal = vector_at(batch.rest.normal, s);
    RootGrid::Neighbour found;
    const RootGrid& roots = centres_->roots();
    if (!(length[s] > 0) || !roots.nearest_if(root, normal, found, [&](uint32_t i) {
          return !divides(parts_, root, normal, roots.position(i));
        })) {
      continue;
    }
    Centre centre(*centres_, found.index);
    batch.clump[s] = unit_float(mix64(hash64(seed_, found.index, random_use("clump"))));
    const float size = std::max(radius[s], 0.0f);
    const V3f side = root - roots.position(found.index);
    const float turn =
        std::atan2(side.dot(centre.along[0].cross(centre.first[0])), side.dot(centre.first[0])) / kTurn;
    centre.phase = (std::floor(std::clamp(turn + 0.5f, 0.0f, 0.9999f) * plies) + 0.5f) / plies - 0.5f;
    centre.stretch = std::sqrt(1 + (kTurn * size / params_.pitch) * (kTurn * size / params_.pitch));
    // Uniformly distributed over the disc.
    const float r = params_.thickness * std::sqrt(unit_float(hash64(seed_, batch.ids[s], random_use("ply"))));
    sincos_turns(unit_float(hash64(seed_, batch.ids[s], random_use("place in ply"))), centre.b, centre.a);
    centre.a *= r;
    centre.b *= r;

    float arc = 0, wound = 0;
    int segment = 0;
    V3f before = batch.offset(0, s), last = before;
    const V3f base = before;
    for (int p = 1; p < batch.point_count(); ++p) {
      const V3f here = batch.offset(p, s);
      arc += (here - before).length();
      const float joined = params_.start > 0 ? smooth_step(arc / (params_.start * length[s])) : 1.0f;
      const float k = joined * std::clamp(amounts[static_cast<size_t>(p)][s], 0.0f, 1.0f);
      const V3f rest = target(centre, arc / batch.scale / centre.stretch, size, segment) - root;
      const V3f there = here + (batch.from_rest(s, rest) * batch.scale - here) * k;
      wound += (there - last).length();
      batch.set_offset(p, s, there);
      before = here;
      last = there;
    }
    if (wound <= length[s]) continue;
    for (int p = 1; p < batch.point_count(); ++p)
      batch.set_offset(p, s, base + (batch.offset(p, s) - base) * (length[s] / wound));
  }
}

StrandReach Braid::reach_after(const StrandReach& before) const {
  StrandReach after = before;
  after.distance = std::max(before.distance, before.length);
  after.lean = std::numbers::pi_v<float>;
  return after;
}

}  // namespace pelage
