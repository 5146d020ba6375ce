// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/masked_operator.h"

#include <algorithm>
#include <numbers>

#include "base/value_readers.h"
#include "groom/strands/strand_batch.h"
#include "groom/strands/strand_fields.h"

namespace pelage {
namespace {

/// Does not change `after` where the mask is 1, and gives exactly `before` where it is 0.
void blend(const StrandRow& before, const StrandRow& mask, size_t count, StrandRow& after) {
  for (size_t s = 0; s < count; ++s) {
    const float m = mask[s];
    after[s] = m <= 0 ? before[s] : m >= 1 ? after[s] : before[s] + (after[s] - before[s]) * m;
  }
}

void blend(const VectorRow& before, const StrandRow& mask, size_t count, VectorRow& after) {
  for (size_t axis = 0; axis < 3; ++axis) blend(before[axis], mask, count, after[axis]);
}

bool is_zero(const std::vector<StrandRow>& rows, size_t count) {
  return std::all_of(rows.begin(), rows.end(), [count](const StrandRow& row) {
    return std::all_of(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(count),
                       [](float m) { return m <= 0; });
  });
}

}  // namespace

const Schema<MaskParams>& MaskParams::mask_only() {
  static const Schema<MaskParams> table = [] {
    Schema<MaskParams> s(
        "operator mask",
        "Every operator of a groom also has the key `mask`, which limits it to a part of the skin or of the "
        "strand, and the key `amount`, which weakens it. Operators that have an `amount` among their own "
        "keys use it as described there.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - comb: {direction: [1, 0, 0], lift: 0.1, mask: {ramp: {along: x, knots: [[0, 0], [0, 1]]}}}
      - frizz: {amplitude: 0.01, amount: 0.5})");
    s.set_picture("Left: combed everywhere. Right: combed only where the mask is 1.");
    s.key(
        "mask", &MaskParams::mask,
        {.help = "How far the operator changes a point: 0 not at all, 1 fully. In between, positions, widths "
                 "and colours are interpolated linearly between the strand before and after the operator, so "
                 "strands that turn far become shorter where the mask is about 0.5. A strand counts as part "
                 "of a clump where the mask at its root is at least 0.5",
         .min = 0,
         .max = 1});
    return s;
  }();
  return table;
}

const Schema<MaskParams>& MaskParams::schema() {
  static const Schema<MaskParams> table = [] {
    Schema<MaskParams> s = mask_only();
    s.key(
        "amount", &MaskParams::amount,
        {.help = "Factor on `mask`: 0 switches the operator off. It may vary over the skin and along strands",
         .min = 0,
         .max = 1});
    return s;
  }();
  return table;
}

MaskedOperator::MaskedOperator(std::shared_ptr<const Operator> inner, Clone clone, Field mask)
    : inner_(clone(*inner)), clone_(clone), mask_(std::move(mask)) {}

MaskedOperator::MaskedOperator(const MaskedOperator& other)
    : inner_(other.clone_(*other.inner_)), clone_(other.clone_), mask_(other.mask_) {}

OperatorTraits MaskedOperator::traits() const {
  OperatorTraits traits = inner_->traits();
  const FieldDependence needs = mask_.dependence();
  if (traits.colors) {
    const AttributeClass own = changes_along(mask_)                ? AttributeClass::kPerPoint
                               : needs.surface || needs.attributes ? AttributeClass::kPerStrand
                                                                   : AttributeClass::kConstant;
    traits.colors = std::max(*traits.colors, own);
    traits.replaces_colors = false;
    traits.colors_partly = true;
  }
  traits.has_one_width_profile = false;
  traits.rest_use = std::max(traits.rest_use, pelage::rest_use(needs));
  return traits;
}

std::vector<ParameterText> MaskedOperator::parameters() const {
  std::vector<ParameterText> all = inner_->parameters();
  for (ParameterText& parameter : MaskParams::mask_only().describe({mask_, {}}))
    all.push_back(std::move(parameter));
  return all;
}

void MaskedOperator::prepare(const PrepareContext& context) {
  mask_ = mask_.with_textures(context.textures);
  inner_->prepare(context);
}

float MaskedOperator::coverage(const FieldPoint& root) const {
  const float full = inner_->coverage(root), mask = mask_.value(root);
  return 1 + (full - 1) * mask;
}

bool MaskedOperator::misses(const FieldPoint& root) const {
  return mask_.value(root) > 0 && inner_->misses(root);
}

void MaskedOperator::apply(StrandBatch& batch) const {
  // All rows of the mask are evaluated first, because the operator may change what the mask reads.
  const bool along = changes_along(mask_);
  std::vector<StrandRow> rows(along ? batch.points.size() : 1);
  FieldRows<StrandRow> values(mask_, batch);
  for (size_t p = 0; p < rows.size(); ++p)
    rows[p] = values.at(batch.along(static_cast<int>(p)), static_cast<int>(p));
  if (is_zero(rows, batch.count)) return;
  const auto mask = [&](size_t point) -> const StrandRow& { return rows[along ? point : 0]; };

  const bool shaped = !inner_->traits().attributes_only;
  const std::vector<StrandBatch::PointRows> points = batch.points;
  const std::vector<VectorRow> colors = batch.colors;
  const StrandRow clump = batch.clump;
  inner_->apply(batch);
  for (size_t p = 0; p < points.size(); ++p) {
    // An operator of attributes may run before its strands have a shape.
    if (shaped && p > 0) blend(points[p].offset, mask(p), batch.count, batch.points[p].offset);
    blend(points[p].radius, mask(p), batch.count, batch.points[p].radius);
  }
  for (size_t p = 0; p < colors.size(); ++p) blend(colors[p], mask(p), batch.count, batch.colors[p]);
  for (size_t s = 0; s < batch.count; ++s) {
    if (mask(0)[s] < 0.5f) batch.clump[s] = clump[s];
  }
}

/// Each point of a blended strand lies between two points that the bounds enclose, and each segment is a
/// weighted mean of two segments, if the mask is the same at both ends. A mask that changes along the strand
/// may also stretch a segment by the distance between the two strands, and turn it.
StrandReach MaskedOperator::reach_after(const StrandReach& before) const {
  StrandReach after = inner_->reach_after(before);
  after.length = std::max(before.length, after.length);
  const float farthest = std::max(before.distance, after.distance);
  if (changes_along(mask_)) {
    after.length += (before.distance + after.distance) * static_cast<float>(after.segments);
    after.lean = std::numbers::pi_v<float>;
  }
  after.distance = farthest;
  after.radius = std::max(before.radius, after.radius);
  after.lean = std::max(before.lean, after.lean);
  // A cone is convex only up to a right angle.
  if (after.lean > 0.5f * std::numbers::pi_v<float>) after.lean = std::numbers::pi_v<float>;
  return after;
}

}  // namespace pelage
