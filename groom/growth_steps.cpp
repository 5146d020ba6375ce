// SPDX-License-Identifier: Apache-2.0
#include "groom/growth_steps.h"

#include <memory>

#include "base/check.h"
#include "groom/groom_impl.h"

namespace pelage {
namespace {

/// Returns the one strand of a posed batch.
Strands strand_of(const CoatSource& source, const OperatorStack& stack, size_t follicle, float length,
                  const StrandBatch& batch) {
  StrandWriter writer(1, 1, stack.traits().colors, source.rest != nullptr);
  writer.expect(source.strand_points(follicle));
  writer.write(batch, 0, 0, length);
  writer.write_roots(batch, 0, source.follicles(), follicle);
  StrandArrays arrays = writer.take();
  if (source.imported) arrays.basis = source.imported->basis();
  return Strands(std::move(arrays));
}

}  // namespace

std::vector<GrowthStep> Groom::grow_steps(size_t follicle, const PosedSkin& pose) const {
  const Impl& g = *impl_;
  const OperatorStack& stack = *g.stack;
  PELAGE_CHECK(!g.frozen);
  PELAGE_CHECK(!stack.traits().needs_closest_point || !pose.trees.empty());
  const auto batch = std::make_unique<StrandBatch>();
  batch->count = 1;
  if (const std::optional<AttributeClass> colors = stack.traits().colors) {
    const auto points = static_cast<size_t>(g.source.strand_points(follicle));
    batch->colors.resize(*colors == AttributeClass::kPerPoint ? points : 1);
  }
  const auto posed = [&] {
    auto copy = std::make_unique<StrandBatch>(*batch);
    g.stand(*copy, follicle, pose, 0);
    carry_to_pose(*copy, pose.scale);
    return copy;
  };
  std::vector<GrowthStep> steps;
  const auto add = [&](std::string name, const StrandBatch& now) {
    steps.push_back({std::move(name), strand_of(g.source, stack, follicle, pose.length, now)});
  };
  const auto name_of = [&](size_t i) { return std::string(stack.operators()[i]->traits().name); };
  g.source.start(*batch, follicle);
  add("follicle", *posed());
  for (size_t i = 0; i < stack.first_live(); ++i) {
    stack.apply(i, i + 1, *batch);
    add(name_of(i), *posed());
  }
  const auto live = posed();
  for (size_t i = stack.first_live(); i < stack.size(); ++i) {
    stack.apply(i, i + 1, *live);
    add(name_of(i), *live);
  }
  return steps;
}

}  // namespace pelage
