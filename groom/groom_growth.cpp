// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <Imath/ImathBoxAlgo.h>

#include "base/check.h"
#include "base/job.h"
#include "base/memory_budget.h"
#include "groom/coat/strand_writer.h"
#include "groom/groom_impl.h"
#include "groom/strands/work_batch.h"

namespace pelage {

void Groom::Impl::stand(StrandBatch& batch, size_t begin, const PosedSkin& skin, size_t key) const {
  if (source.rest) {
    place_in_pose(batch, skin.keys[key], source.follicles(), begin);
  } else if (!skin.free_transforms.empty()) {
    const M44f& m = skin.free_transforms[key];
    Frame frame;
    m.multDirMatrix(V3f(1, 0, 0), frame.tangent);
    m.multDirMatrix(V3f(0, 1, 0), frame.bitangent);
    frame.tangent.normalize();
    frame.bitangent.normalize();
    frame.normal = frame.tangent.cross(frame.bitangent);
    for (size_t s = 0; s < batch.count; ++s) {
      V3f root;
      m.multVecMatrix(vector_at(batch.rest.position, s), root);
      batch.current.set(s, root, frame);
    }
  }
  batch.skin = key < skin.trees.size() ? &skin.trees[key] : nullptr;
  batch.turns = key < skin.turns.size() ? &skin.turns[key] : nullptr;
}

namespace {

size_t key_count(const PosedSkin& pose, bool on_skin) {
  return std::max<size_t>(1, on_skin ? pose.keys.size() : pose.free_transforms.size());
}

}  // namespace

void Groom::Impl::grow_plain(const PosedSkin& pose, size_t begin, size_t end, StrandWriter& writer) const {
  const size_t keys = key_count(pose, source.rest != nullptr);
  const WorkBatch batch;
  // A single key is computed in place; several need the rest state again.
  std::optional<WorkBatch> posed;
  if (keys > 1) posed.emplace();
  for (size_t at = begin, run = 0; at < end; at += run) {
    run = source.run_length(at, end);
    batch->count = writer.needed(at - begin, run);
    if (batch->count == 0) continue;
    batch->colors.resize(writer.color_rows(source.strand_points(at)));
    source.start(*batch, at);
    stack->apply_frozen(*batch);
    for (size_t key = 0; key < keys; ++key) {
      StrandBatch* target = &*batch;
      if (posed) {
        **posed = *batch;
        target = &**posed;
      }
      stand(*target, at, pose, key);
      carry_to_pose(*target, pose.scale);
      stack->apply(stack->first_live(), end_of(pose), *target);
      writer.write(*target, at - begin, key, pose.length);
    }
    writer.write_roots(*batch, at - begin, source.follicles(), at);
  }
}

void Groom::Impl::prepare_rest(const std::string& name, const Job& job) {
  const RestUse use = stack->traits(frozen_end, stack->size()).rest_use;
  needs_rest_frames = !source.rest || use == RestUse::kFrames ||
                      !stack->traits(frozen_end, std::max(frozen_end, stack->first_live())).attributes_only;
  if (needs_rest_frames || use == RestUse::kNone) return;
  require_memory(job.ledger, static_cast<int64_t>(source.follicles().size() * sizeof(V3f)),
                 "placing the strands of groom '" + name + "' at rest");
  rest_positions.resize(source.follicles().size());
  job.for_each(rest_positions.size(), 4096, [&](WorkRange range) {
    for (size_t f = range.begin; f < range.end; ++f) {
      const RootAddress& root = source.follicles().root(f);
      rest_positions[f] = source.rest->evaluate(root.face, root.u, root.v).position;
    }
  });
}

void Groom::Impl::grow_cached(size_t leaf, const PosedSkin& pose, size_t begin, size_t end,
                              StrandWriter& writer) const {
  const size_t keys = key_count(pose, source.rest != nullptr);
  const size_t live = std::max(frozen_end, stack->first_live());
  const FrozenLeaf& strands = frozen->leaf(leaf);
  const WorkBatch batch;
  // Live operators need their input state at every key; without them a key only transforms the offsets again.
  const bool has_live = live < stack->size();
  std::optional<WorkBatch> posed;
  if (keys > 1 && (has_live || needs_rest_frames)) posed.emplace();
  for (const FrozenLeaf::Block& block : strands.blocks()) {
    const size_t at = begin + block.first;
    if (at >= end) break;
    batch->count = writer.needed(block.first, std::min<size_t>(block.count, end - at));
    if (batch->count == 0) continue;
    batch->points.resize(static_cast<size_t>(block.points));
    batch->colors.resize(writer.color_rows(block.points));
    batch->scale = 1;
    batch->posed = false;
    batch->skin = nullptr;
    if (needs_rest_frames) {
      source.place(*batch, at);
    } else {
      place_ids(*batch, source.rest->topology(), source.follicles(), at);
      for (size_t s = 0; s < batch->count && !rest_positions.empty(); ++s)
        set_vector(batch->rest.position, s, rest_positions[at + s]);
    }
    clear_attributes(*batch);
    strands.attributes(block, *batch);
    if (needs_rest_frames) {
      batch->current = batch->rest;
      strands.shape(block, batch->rest, 1, *batch);
    }
    stack->apply(frozen_end, live, *batch);
    for (size_t key = 0; key < keys; ++key) {
      StrandBatch* target = &*batch;
      if (posed) {
        **posed = *batch;
        target = &**posed;
      }
      stand(*target, at, pose, key);
      if (needs_rest_frames) {
        carry_to_pose(*target, pose.scale);
      } else {
        target->scale = pose.scale;
        target->posed = true;
        strands.shape(block, target->current, pose.scale, *target);
        if (posed || key == 0) scale_radii(*target, pose.scale);
      }
      stack->apply(live, end_of(pose), *target);
      writer.write(*target, at - begin, key, pose.length);
    }
    writer.write_roots(*batch, at - begin, source.follicles(), at);
  }
}

StrandWriter::Chosen Groom::Impl::chosen(const KeptStrands& kept, size_t begin) const {
  constexpr float kDarkest = 1e-3f;  // colours that are already black stay so
  StrandWriter::Chosen chosen{kept.strands, kept.width, {}};
  if (kept.contrast.empty()) return chosen;
  chosen.color.reserve(kept.strands.size());
  for (size_t i = 0; i < kept.strands.size(); ++i) {
    const auto [value, mean] =
        stack->brightness(operator_seed, source.follicles().id(begin + kept.strands[i]));
    const bool changes = kept.contrast[i] != 1 && value > kDarkest;
    chosen.color.push_back(changes ? (mean + kept.contrast[i] * (value - mean)) / value : 1.0f);
  }
  return chosen;
}

std::span<const GuideTurns> CoatMotion::at_keys(size_t count) const {
  PELAGE_CHECK(count == keys.size() || count + 2 == keys.size());
  return std::span(keys).subspan((keys.size() - count) / 2, count);
}

Strands Groom::grow(size_t leaf, const PosedSkin& groomed, const KeptStrands* kept) const {
  const Impl& g = *impl_;
  PosedSkin pose = groomed;
  if (motion_ && groomed.shown) pose.turns = motion_->at_keys(groomed.keys.size());
  const bool on_skin = g.source.rest != nullptr;
  const FollicleTree::Leaf& range = g.source.follicles().leaves()[leaf];
  PELAGE_CHECK(!on_skin || !pose.keys.empty());
  PELAGE_CHECK(!g.stack->traits(0, g.end_of(pose)).needs_closest_point ||
               pose.trees.size() == key_count(pose, on_skin));

  const size_t keys = key_count(pose, on_skin);
  const std::optional<AttributeClass> colors = g.stack->traits().colors;
  size_t end = range.end;
  if (kept) end = range.begin + (kept->strands.empty() ? 0 : kept->strands.back() + size_t(1));
  StrandWriter writer = kept ? StrandWriter(g.chosen(*kept, range.begin), keys, colors, on_skin)
                             : StrandWriter(range.end - range.begin, keys, colors, on_skin);
  if (!g.source.imported) {
    writer.expect_all(g.source.points);
  } else if (kept) {
    for (const uint32_t s : kept->strands) writer.expect(g.source.strand_points(range.begin + s));
  } else {
    for (size_t f = range.begin; f < end; ++f) writer.expect(g.source.strand_points(f));
  }
  if (g.frozen) {
    g.grow_cached(leaf, pose, range.begin, end, writer);
  } else {
    g.grow_plain(pose, range.begin, end, writer);
  }
  StrandArrays arrays = writer.take();
  if (g.source.imported) {
    arrays.basis = g.source.imported->basis();
    std::vector<uint32_t> follicles;
    for (size_t i = 0; i < arrays.ids.size(); ++i)
      follicles.push_back(range.begin + (kept ? kept->strands[i] : static_cast<uint32_t>(i)));
    for (StrandAttribute& a : g.source.imported->attributes(follicles, colors ? "color" : "")) {
      arrays.attributes.push_back(std::move(a));
    }
  }
  return Strands(std::move(arrays));
}

void Groom::visit_guides(const PosedSkin& pose, const GuideVisit& visit) const {
  const std::vector<uint32_t>& guides = impl_->guides->follicles;
  std::vector<std::pair<uint32_t, size_t>> sorted;  // follicle and guide
  for (size_t g = 0; g < guides.size(); ++g) sorted.emplace_back(guides[g], g);
  std::sort(sorted.begin(), sorted.end());
  auto next = sorted.begin();
  const auto leaves = follicles().leaves();
  for (size_t leaf = 0; leaf < leaves.size(); ++leaf) {
    std::vector<uint32_t> own;
    auto first = next;
    for (; next != sorted.end() && next->first < leaves[leaf].end; ++next)
      own.push_back(next->first - leaves[leaf].begin);
    if (own.empty()) continue;
    const std::vector<float> widths(own.size(), 1.0f);
    const KeptStrands kept{own, widths, {}};
    const Strands strands = grow(leaf, pose, &kept);
    for (size_t s = 0; s < own.size(); ++s, ++first) visit(first->second, strands, s);
  }
}

void Groom::find_tips() const {
  MovingGuides& guides = *impl_->guides;
  for (size_t i = 0; i < guides.follicles.size(); ++i) guides.tips.push_back(guides.roots.normal(i));
  // Strands that depend on the posed skin count as straight.
  if (guides_need_closest_point()) return;
  PosedSkin rest;
  rest.keys = {impl_->source.rest.get(), 1};
  rest.guides_only = true;
  visit_guides(rest, [&](size_t guide, const Strands& strands, size_t s) {
    guides.tips[guide] =
        strands.point(strands.first_point(s + 1) - 1) - strands.point(strands.first_point(s));
  });
}

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

std::vector<GrowthStep> Groom::grow_steps(size_t follicle, const PosedSkin& groomed) const {
  const Impl& g = *impl_;
  PosedSkin pose = groomed;
  if (motion_ && groomed.shown) pose.turns = motion_->at_keys(groomed.keys.size());
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

namespace {

FollicleTree::Leaf first_of(const FollicleTree::Leaf& leaf, size_t count) {
  FollicleTree::Leaf part = leaf;
  if (count < leaf.end - leaf.begin) part.end = leaf.begin + static_cast<uint32_t>(count);
  return part;
}

}  // namespace

StrandCounts Groom::counts(size_t leaf, size_t count) const {
  const CoatSource& source = impl_->source;
  const std::optional<AttributeClass> colors = impl_->stack->traits().colors;
  const FollicleTree::Leaf range = first_of(source.follicles().leaves()[leaf], count);
  StrandCounts counts;
  counts.strands = range.end - range.begin;
  if (source.imported) {
    for (size_t f = range.begin; f < range.end; ++f) {
      const auto points = static_cast<uint32_t>(source.strand_points(f));
      counts.points += points;
      counts.longest = std::max<size_t>(counts.longest, points);
      counts.segments += segment_count(source.imported->basis(), points);
    }
    counts.attribute_floats =
        source.imported->attribute_floats(range.begin, range.end, colors ? "color" : "");
  } else {
    counts.points = counts.strands * static_cast<size_t>(source.points);
    counts.longest = static_cast<size_t>(source.points);
    counts.segments = counts.strands * static_cast<size_t>(source.points - 1);
  }
  if (colors) {
    counts.attribute_floats += 3 * (*colors == AttributeClass::kConstant ? std::min<size_t>(1, counts.strands)
                                    : *colors == AttributeClass::kPerStrand ? counts.strands
                                                                            : counts.points);
  }
  return counts;
}

StrandReach Groom::Impl::reach(size_t leaf) const {
  return frozen ? stack->reach(frozen->reach(leaf), frozen_end, stack->size())
                : stack->reach(source.reach(leaf), 0, stack->size());
}

float Groom::reach() const {
  float max = 0;
  for (size_t leaf = 0; leaf < impl_->source.follicles().leaves().size(); ++leaf) {
    const StrandReach reach = impl_->reach(leaf);
    max = std::max(max, reach.distance + reach.radius);
  }
  return max;
}

float Groom::width() const {
  float max = 0;
  for (size_t leaf = 0; leaf < impl_->source.follicles().leaves().size(); ++leaf)
    max = std::max(max, 2 * impl_->reach(leaf).radius);
  return max;
}

Box3f Groom::conservative_bound(size_t leaf, const PosedSkin& pose, size_t count) const {
  const Impl& g = *impl_;
  const FollicleTree& follicles = g.source.follicles();
  const FollicleTree::Leaf range = first_of(follicles.leaves()[leaf], count);
  Box3f box;
  if (range.begin == range.end) return box;
  if (g.source.rest) {
    for (const LimitSurface& surface : pose.keys) {
      for (uint32_t f = range.begin; f < range.end; ++f) {
        const RootAddress& root = follicles.root(f);
        box.extendBy(surface.evaluate(root.face, root.u, root.v).position);
      }
    }
  } else if (pose.free_transforms.empty()) {
    box = range.rest_roots;
  } else {
    for (const M44f& m : pose.free_transforms) box.extendBy(Imath::transform(range.rest_roots, m));
  }
  const StrandReach reach = g.reach(leaf);
  // Rounding of positions far from the origin, and of the frames that rotate offsets.
  const float size = std::max({std::fabs(box.min.x), std::fabs(box.min.y), std::fabs(box.min.z),
                               std::fabs(box.max.x), std::fabs(box.max.y), std::fabs(box.max.z)});
  const V3f out((reach.distance * pose.length + reach.radius) * pose.scale * 1.00002f + 1e-6f * size);
  return {box.min - out, box.max + out};
}

}  // namespace pelage
