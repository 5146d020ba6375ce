// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/clump.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/value_readers.h"
#include "groom/operators/clump_centres.h"
#include "groom/strands/part_lines.h"
#include "groom/strands/strand_batch.h"
#include "groom/strands/strand_fields.h"

namespace pelage {
namespace {

/// Max extra length that pulling may give a strand before it is scaled back, as a fraction of amount *
/// (distance to the centre + twice the strand's length). Keeps the way back shorter than that fraction of the
/// way there.
constexpr float kStretch = 0.25f;

}  // namespace

const Schema<ClumpLevelParams>& ClumpLevelParams::schema() {
  static const Schema<ClumpLevelParams> table = [] {
    Schema<ClumpLevelParams> s("clump level", "Finer clumps inside the coarser ones.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - clump:
          spacing: 0.6
          amount: 0.7
          levels: [{spacing: 0.2, amount: 0.8}])");
    s.key("spacing", &ClumpLevelParams::spacing,
          {.unit = "scene units", .help = "Mean distance between clumps", .min = 0, .above_min = true});
    s.key("amount", &ClumpLevelParams::amount,
          {.help = "How far strands move toward the centre strand of their clump: 0 not at all, 1 fully. It "
                   "may vary along the strand",
           .min = 0,
           .max = 1});
    return s;
  }();
  return table;
}

const Schema<ClumpParams>& ClumpParams::schema() {
  static const Schema<ClumpParams> table = [] {
    Schema<ClumpParams> s("clump",
                          "Pulls strands together into clumps. Each clump follows a centre strand, which the "
                          "preceding operators shape. Strands never become longer.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - clump: {spacing: 0.4, amount: 0.9})");
    s.set_picture("Left: no clumps. Right: clumps with `spacing: 0.4` and `amount: 0.9`.");
    s.key("spacing", &ClumpParams::spacing,
          {.unit = "scene units", .help = "Mean distance between clumps", .min = 0, .above_min = true});
    s.key("amount", &ClumpParams::amount,
          {.help = "How far strands move toward the centre strand of their clump: 0 not at all, 1 fully. It "
                   "may vary along the strand",
           .min = 0,
           .max = 1});
    s.key("root", &ClumpParams::root, {.help = "Factor on `amount` at the root", .min = 0, .max = 1});
    s.key("tip", &ClumpParams::tip, {.help = "Factor on `amount` at the tip", .min = 0, .max = 1});
    s.key("profile", &ClumpParams::profile,
          {.help = "Exponent of the change from `root` to `tip`. With values below 1, the strands of a clump "
                   "come together near the root; with values above 1, near the tip",
           .min = 0.1,
           .max = 10});
    s.key(
        "variation", &ClumpParams::variation,
        {.help = "Random reduction of `amount` per clump: 0.4 gives 60 to 100 % of it", .min = 0, .max = 1});
    s.key("strays", &ClumpParams::strays, {.help = "Fraction of strands left unclumped", .min = 0, .max = 1});
    s.key("levels", &ClumpParams::levels, {.help = "Finer clumps inside the clumps, from coarse to fine"});
    return s;
  }();
  return table;
}

void Clump::prepare(const PrepareContext& context) { prepare_after(context, kName, {}); }

void Clump::prepare_after(const PrepareContext& context, const char* name,
                          const std::function<void(StrandBatch&)>& shape) {
  if (!context.rest)
    throw Error(ErrorKind::kInput, context.position,
                fmt::format("the operator {} needs strands that grow on a skin", name));
  seed_ = context.seed;
  parts_ = context.parts;
  levels_.clear();
  const auto add = [&](float spacing, const Field& amount) {
    const uint64_t level_seed = hash64(seed_, levels_.size());
    const auto grow = [&](StrandBatch& batch) {
      for (const auto& op : context.preceding) {
        if (op->traits().reads_rest_only) op->apply(batch);
      }
      if (shape) shape(batch);
      pull(batch, levels_.size());
    };
    auto centres = std::make_shared<const ClumpCentres>(context, spacing, level_seed, grow);
    levels_.push_back({spacing, amount.with_textures(context.textures), std::move(centres)});
  };
  add(params_.spacing, params_.amount);
  for (const ClumpLevelParams& level : params_.levels) add(level.spacing, level.amount);
}

void Clump::apply(StrandBatch& batch) const { pull(batch, levels_.size()); }

void Clump::pull(StrandBatch& batch, size_t level_count) const {
  if (level_count == 0) return;
  const size_t points = batch.points.size();
  std::vector<StrandRow> arcs(points);  // of the incoming strands
  arcs[0].fill(0.0f);
  for (size_t p = 1; p < points; ++p) {
    for (size_t s = 0; s < batch.count; ++s) {
      const auto point = static_cast<int>(p);
      arcs[p][s] = arcs[p - 1][s] + (batch.offset(point, s) - batch.offset(point - 1, s)).length();
    }
  }
  PullTotals totals;
  totals.stays.fill(1.0f);
  totals.roots.fill(0.0f);
  for (size_t i = 0; i < level_count; ++i) pull_level(levels_[i], hash64(seed_, i), arcs, batch, totals);

  // Strands that became longer are scaled back about their roots.
  StrandRow length;
  arc_lengths(batch, length);
  for (size_t s = 0; s < batch.count; ++s) {
    const float before = arcs.back()[s];
    if (length[s] <= before || totals.stays[s] >= 1) continue;
    const float limit = kStretch * (1 - totals.stays[s]) * (totals.roots[s] + 2.0f * before);
    const float factor = before / std::min(length[s], before + limit);
    const V3f base = batch.offset(0, s);
    for (int p = 1; p < batch.point_count(); ++p) {
      batch.set_offset(p, s, base + (batch.offset(p, s) - base) * factor);
    }
  }
}

void Clump::pull_level(const Level& level, uint64_t level_seed, const std::vector<StrandRow>& arcs,
                       StrandBatch& batch, PullTotals& totals) const {
  const ClumpCentres& centres = *level.centres;
  std::array<RootGrid::Neighbour, kBlockStrands> centre;
  StrandRow strength;
  for (size_t s = 0; s < batch.count; ++s) {
    strength[s] = 0;
    if (unit_float(hash64(level_seed, batch.ids[s], random_use("stray"))) < params_.strays) continue;
    const V3f root = vector_at(batch.rest.position, s), normal = vector_at(batch.rest.normal, s);
    const auto on_this_side = [&](uint32_t i) {
      return !divides(parts_, root, normal, centres.roots().position(i));
    };
    if (!centres.roots().nearest_if(root, normal, centre[s], on_this_side)) continue;
    const uint64_t of_clump = hash64(level_seed, centre[s].index, random_use("clump"));
    strength[s] = 1.0f - params_.variation * unit_float(of_clump);
    batch.clump[s] = unit_float(mix64(of_clump));
    totals.roots[s] += centre[s].distance * batch.scale;
  }

  StrandField amount(level.amount, batch);
  std::array<int, kBlockStrands> segment{};
  StrandRow max{};  // largest amount along each strand
  for (int p = 1; p < batch.point_count(); ++p) {
    const float along = batch.along(p);
    const float profile = params_.root + (params_.tip - params_.root) * std::pow(along, params_.profile);
    const StrandRow& row = amount.at(along);
    const StrandRow& arc = arcs[static_cast<size_t>(p)];
    for (size_t s = 0; s < batch.count; ++s) {
      if (strength[s] <= 0) continue;
      const float k = std::clamp(row[s], 0.0f, 1.0f) * profile * strength[s];
      max[s] = std::max(max[s], k);
      // Centres are in rest space, at the scale of the rest skin.
      const V3f rest =
          centres.at(centre[s].index, arc[s] / batch.scale, segment[s]) - vector_at(batch.rest.position, s);
      const V3f here = batch.offset(p, s);
      batch.set_offset(p, s, here + (batch.from_rest(s, rest) * batch.scale - here) * k);
    }
  }
  for (size_t s = 0; s < batch.count; ++s) totals.stays[s] *= 1.0f - max[s];
}

float Clump::strongest(const Level& level) const {
  return std::clamp(level.amount.value_range().second, 0.0f, 1.0f) * std::max(params_.root, params_.tip);
}

Clump::Pull Clump::pull() const {
  Pull result{1, 0};
  for (const Level& level : levels_) {
    result.amount *= 1 - strongest(level);
    result.roots += ClumpCentres::kReach * level.spacing;
  }
  result.amount = 1 - result.amount;
  return result;
}

StrandReach Clump::reach_after(const StrandReach& before) const {
  const auto [amount, roots] = pull();
  StrandReach after = before;
  if (amount <= 0) return after;
  after.distance += amount * (roots + before.length - before.distance);
  const float stretch = amount * (roots + 2 * before.length);
  after.length *= (before.length + stretch) / (before.length + kStretch * stretch);
  after.lean = std::numbers::pi_v<float>;
  return after;
}

}  // namespace pelage
