// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/parting.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/job.h"
#include "geom/limit_surface.h"
#include "groom/operators/combing.h"
#include "groom/operators/turning.h"
#include "groom/strands/named_strands.h"
#include "groom/strands/part_lines.h"
#include "groom/strands/skin_binding.h"
#include "groom/strands/strand_fields.h"

namespace pelage {
namespace {

std::vector<std::vector<V3f>> lines_of(const AssetPath& file, const Job& job) {
  StrandReadOptions options;
  options.max_bytes = free_bytes(job.ledger);
  const Strands strands = read_named_strands(file, options).strands;
  std::vector<std::vector<V3f>> lines(strands.strand_count());
  const std::span<const float> points = strands.points(0);
  size_t at = 0;
  for (size_t s = 0; s < lines.size(); ++s) {
    for (uint32_t p = 0; p < strands.strand_points(s); ++p, at += 4)
      lines[s].emplace_back(points[at], points[at + 1], points[at + 2]);
  }
  return lines;
}

}  // namespace

const Schema<PartingParams>& PartingParams::schema() {
  static const Schema<PartingParams> table = [] {
    Schema<PartingParams> s(
        "part",
        "Parts the hair along a line on the skin, from which it falls both ways. Guides and "
        "clumps of the groom, before and after this operator, do not act across the line. "
        "Lengths are kept.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - part: {points: [[0, 0, -2], [0.2, 0, 0], [0, 0, 2]], width: 1.5})");
    s.set_picture("Left: straight strands. Right: parted along a line.");
    s.key("points", &PartingParams::points,
          {.unit = "scene units",
           .help =
               "Points that the line joins, in the rest space of the skin. The line is moved to the nearest "
               "points of the skin. It is closed if its last point is its first",
           .default_text = "none; `file` has the lines"});
    s.key(
        "file", &PartingParams::file,
        {.help =
             "Strand file (.hair, .tfx, .usda, .abc) in the rest space of the skin, instead of `points`: the "
             "control "
             "points of each strand are a line",
         .default_text = "none; `points` are the line"});
    s.key("width", &PartingParams::width,
          {.unit = "scene units",
           .help = "Distance from the line within which strands turn away from it: fully up to half of this "
                   "distance, less and less up to all of it",
           .min = 0,
           .above_min = true,
           .default_text = "an eighth of the diagonal of the skin's bounds"});
    s.key("lift", &PartingParams::lift,
          {.help = "How steeply parted strands rise: 0 lies on the skin, 1 stands upright",
           .min = 0,
           .max = 1});
    s.key("amount", &PartingParams::amount,
          {.help = "How far strands turn: 0 not at all, 1 fully. Guides and clumps stay apart in any case",
           .min = 0,
           .max = 1});
    s.key("curve", &PartingParams::curve,
          {.help = "Fraction of the strand, from the root, over which it turns; 0 turns the whole "
                   "strand at the root",
           .min = 0,
           .max = 1});
    return s;
  }();
  return table;
}

void Parting::prepare(const PrepareContext& context) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::kInput, context.position, "the operator part " + why);
  };
  if (!context.rest) refuse("needs strands that grow on a skin");
  if (params_.points.empty() && params_.file.empty()) refuse("needs `points` or `file`");
  if (!params_.points.empty() && !params_.file.empty()) refuse("takes `points` or `file`, not both");
  std::vector<std::vector<V3f>> lines{params_.points};
  if (!params_.file.empty()) lines = lines_of(params_.file, context.job);
  const SkinBinding binding(*context.rest, params_.file.empty() ? "a part" : params_.file.path, context.job);
  if (binding.empty()) refuse("needs a skin with at least one face that is not a hole");
  lines_ = std::make_shared<const PartLines>(lines, *context.rest, binding, context.job);
  if (lines_->segment_count() == 0) refuse("needs a line through at least 2 different points of the skin");
  if (lines_->segment_count() > PartLines::kMaxSegments)
    refuse(fmt::format("has lines of more than {} segments", PartLines::kMaxSegments));
  const float size = context.rest->control_bounds().size().length();
  if (lines_->off_skin() > 0.1f * size)
    context.job.progress.warn(
        fmt::format("{}: points of the operator part are up to {:.3g} units away from the "
                    "skin",
                    to_string(context.position), lines_->off_skin()));
  width_ = params_.width.value_or(0.125f * size);
  params_.lift = params_.lift.with_textures(context.textures);
  params_.amount = params_.amount.with_textures(context.textures);
  charge_ = std::make_shared<const MemoryCharge>(context.job.ledger, MemoryTag::kGrooms,
                                                 static_cast<int64_t>(lines_->bytes()));
}

void Parting::apply(StrandBatch& batch) const {
  StrandRow lift, amount;
  evaluate(params_.lift, batch, 0, lift);
  evaluate(params_.amount, batch, 0, amount);
  for (size_t s = 0; s < batch.count; ++s) {
    PartLines::Nearest line;
    if (!lines_->nearest(vector_at(batch.rest.position, s), vector_at(batch.rest.normal, s), width_, line))
      continue;
    const float near = line.beside * (1 - smooth_step(2 * line.distance / width_ - 1));
    comb_strand(batch, s, batch.from_rest(s, line.away), lift[s], std::clamp(amount[s], 0.0f, 1.0f) * near,
                params_.curve);
  }
}

StrandReach Parting::reach_after(const StrandReach& before) const {
  return reach_after_combing(before, params_.lift, params_.amount, params_.curve);
}

}  // namespace pelage
