// SPDX-License-Identifier: Apache-2.0
#include "groom/groom.h"

#include <algorithm>
#include <cmath>

#include <Imath/ImathBoxAlgo.h>

#include "base/check.h"
#include "base/hash.h"
#include "groom/imported.h"
#include "groom/operator_stack.h"
#include "groom/strand_writer.h"
#include "groom/width.h"

namespace pelage {

struct Groom::Impl {
  std::shared_ptr<const LimitSurface> rest;  // null: strands stand free
  StrandRole role = StrandRole::kUnder;
  int points = 8;
  std::optional<OperatorStack> stack;
  FollicleTree grown;  // of strands that are not imported
  std::optional<ImportedStrands> imported;
  MemoryCharge charge;

  const FollicleTree& follicles() const { return imported ? imported->follicles() : grown; }
  void start(StrandBatch& batch, size_t begin) const;
  void pose(StrandBatch& batch, size_t begin, const PosedSkin& skin, size_t key) const;
  StrandReach reach(size_t leaf) const;
};

Groom::Groom(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Groom::~Groom() = default;

const FollicleTree& Groom::follicles() const { return impl_->follicles(); }
StrandRole Groom::role() const { return impl_->role; }
bool Groom::needs_closest_point() const { return impl_->stack->needs_closest_point(); }
int64_t Groom::strands_dropped() const { return impl_->imported ? impl_->imported->repairs().dropped : 0; }
int64_t Groom::strands_repaired() const { return impl_->imported ? impl_->imported->repairs().repaired : 0; }

namespace {

void check_combination(const std::string& name, const GroomParams& params, bool has_skin) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::kInput, params.strands_file.position, "groom '" + name + "' " + why);
  };
  if (params.strands_file.empty()) {
    if (!has_skin) refuse("needs a skin to grow on, or a strands_file");
    if (!params.strands && !params.density)
      refuse("needs strands (how many) or density (how many per square unit)");
  } else if (params.strands || params.density) {
    refuse("has its strands from a file: neither strands nor density may be given");
  }
}

/// Grown strands have a width even when nothing gives them one.
OperatorList with_width(const GroomParams& params) {
  OperatorList list = params.operators;
  const bool has_width =
      std::any_of(list.items.begin(), list.items.end(),
                  [](const OperatorList::Item& item) { return item.name == Width::kName; });
  if (!has_width && params.strands_file.empty()) list.items.push_back(default_operator(Width::kName));
  return list;
}

}  // namespace

std::shared_ptr<const Groom> Groom::create(const std::string& name, const GroomParams& params,
                                           std::shared_ptr<const LimitSurface> rest, TextureLibrary& textures,
                                           const Workers& workers, MemoryLedger& ledger) {
  check_combination(name, params, rest != nullptr);
  auto impl = std::make_unique<Impl>();
  impl->rest = std::move(rest);
  impl->role = params.role;
  impl->points = params.points;

  // Two coats of one skin must not grow from the same places because neither was given a seed.
  const uint64_t name_hash = content_hash(std::as_bytes(std::span(name.data(), name.size()))).low;
  const uint64_t seed = hash64(static_cast<uint64_t>(params.seed), name_hash);
  PrepareContext context{impl->rest.get(), textures, workers, {}, hash64(seed, random_use("groom")),
                         params.points,    {}};
  impl->stack.emplace(with_width(params), context);
  const OperatorStack& stack = *impl->stack;
  if (stack.needs_closest_point() && !impl->rest) {
    throw Error(ErrorKind::kInput, "groom '" + name + "' keeps clear of a skin but grows on none");
  }

  if (!params.strands_file.empty()) {
    impl->imported.emplace(params, impl->rest.get(), workers);
  } else {
    FollicleOptions options;
    options.count = params.strands.value_or(0);
    options.per_area = params.strands ? 0.0 : 1.0;
    if (params.density) options.density = params.density->with_textures(textures);
    if (stack.restricts_coverage()) {
      options.coverage = [&stack](const V3f& at, const V3f& normal) { return stack.coverage(at, normal); };
    }
    options.seed = hash64(seed, random_use("follicles"));
    options.leaf_strands = params.leaf_strands;
    impl->grown = FollicleTree::build(*impl->rest, options, workers);
  }
  const size_t bytes = stack.bytes() + (impl->imported ? impl->imported->bytes() : impl->grown.bytes());
  impl->charge = MemoryCharge(ledger, MemoryTag::kGrooms, static_cast<int64_t>(bytes));
  return std::shared_ptr<const Groom>(new Groom(std::move(impl)));
}

/// Places a batch on the rest skin and makes what the first operator sees.
void Groom::Impl::start(StrandBatch& batch, size_t begin) const {
  if (rest) {
    place_on_rest(batch, *rest, follicles(), begin);
  } else {
    imported->place_free(batch, begin);
  }
  if (imported) {
    imported->start(batch, begin);
  } else {
    start_strands(batch, points);
  }
}

/// Carries a batch from rest to a motion key.
void Groom::Impl::pose(StrandBatch& batch, size_t begin, const PosedSkin& skin, size_t key) const {
  if (rest) {
    place_in_pose(batch, skin.keys[key], follicles(), begin);
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
      batch.here.set(s, root, frame);
    }
  }
  batch.skin = key < skin.trees.size() ? &skin.trees[key] : nullptr;
  carry_to_pose(batch, skin.scale);
}

Strands Groom::grow(size_t leaf, const PosedSkin& pose, std::optional<size_t> count) const {
  const Impl& g = *impl_;
  const FollicleTree& follicles = g.follicles();
  const FollicleTree::Leaf& range = follicles.leaves()[leaf];
  const size_t end = range.begin + std::min<size_t>(count.value_or(SIZE_MAX), range.end - range.begin);
  const size_t keys = std::max<size_t>(1, g.rest ? pose.keys.size() : pose.free_transforms.size());
  PELAGE_CHECK(!g.rest || !pose.keys.empty());
  PELAGE_CHECK(!g.stack->needs_closest_point() || pose.trees.size() == keys);

  StrandWriter writer(end - range.begin, keys, g.stack->colors(), g.rest != nullptr);
  if (g.imported) {
    for (size_t f = range.begin; f < end; ++f) writer.expect(g.imported->strand_points(f));
  } else {
    writer.expect_all(g.points);
  }
  const auto batch = std::make_unique<StrandBatch>();
  // One key is made in place; more need the rest state again.
  const auto posed = keys > 1 ? std::make_unique<StrandBatch>() : nullptr;
  for (size_t begin = range.begin; begin < end; begin += batch->count) {
    batch->count = g.imported ? g.imported->run_length(begin, end) : std::min(kBlockStrands, end - begin);
    batch->colors.resize(writer.color_rows(g.imported ? g.imported->strand_points(begin) : g.points));
    g.start(*batch, begin);
    g.stack->apply_frozen(*batch);
    for (size_t key = 0; key < keys; ++key) {
      StrandBatch* target = batch.get();
      if (posed) {
        *posed = *batch;
        target = posed.get();
      }
      g.pose(*target, begin, pose, key);
      g.stack->apply_live(*target);
      writer.write(*target, begin - range.begin, key);
    }
    for (size_t s = 0; s < batch->count; ++s)
      writer.write_root(*batch, begin - range.begin, s, follicles.root(begin + s));
  }
  StrandArrays arrays = writer.take();
  if (g.imported) {
    arrays.basis = g.imported->basis();
    for (StrandAttribute& a : g.imported->attributes(range.begin, end, g.stack->colors() ? "color" : "")) {
      arrays.attributes.push_back(std::move(a));
    }
  }
  return Strands(std::move(arrays));
}

StrandCounts Groom::counts(size_t leaf) const {
  const Impl& g = *impl_;
  const FollicleTree::Leaf& range = g.follicles().leaves()[leaf];
  StrandCounts counts;
  counts.strands = range.end - range.begin;
  if (g.imported) {
    for (size_t f = range.begin; f < range.end; ++f) {
      const auto points = static_cast<uint32_t>(g.imported->strand_points(f));
      counts.points += points;
      counts.segments += segment_count(g.imported->basis(), points);
    }
    for (const StrandAttribute& a :
         g.imported->attributes(range.begin, range.end, g.stack->colors() ? "color" : "")) {
      counts.attribute_floats += a.values.size();
    }
  } else {
    counts.points = counts.strands * static_cast<size_t>(g.points);
    counts.segments = counts.strands * static_cast<size_t>(g.points - 1);
  }
  if (const auto colors = g.stack->colors()) {
    counts.attribute_floats += 3 * (*colors == AttributeClass::kConstant ? std::min<size_t>(1, counts.strands)
                                    : *colors == AttributeClass::kPerStrand ? counts.strands
                                                                            : counts.points);
  }
  return counts;
}

StrandReach Groom::Impl::reach(size_t leaf) const {
  StrandReach before;
  before.lean = 0;
  before.segments = points - 1;
  if (imported) before = imported->reach(leaf);
  return stack->reach(before);
}

bool Groom::grows_on_skin() const { return impl_->rest != nullptr; }

float Groom::reach() const {
  float most = 0;
  for (size_t leaf = 0; leaf < impl_->follicles().leaves().size(); ++leaf) {
    const StrandReach reach = impl_->reach(leaf);
    most = std::max(most, reach.distance + reach.radius);
  }
  return most;
}

Box3f Groom::conservative_bound(size_t leaf, const PosedSkin& pose) const {
  const Impl& g = *impl_;
  const FollicleTree& follicles = g.follicles();
  const FollicleTree::Leaf& range = follicles.leaves()[leaf];
  Box3f box;
  if (g.rest) {
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
  // Rounding of positions far from the origin, and of the frames that turn offsets.
  const float size = std::max({std::fabs(box.min.x), std::fabs(box.min.y), std::fabs(box.min.z),
                               std::fabs(box.max.x), std::fabs(box.max.y), std::fabs(box.max.z)});
  const V3f out((reach.distance + reach.radius) * pose.scale * 1.00002f + 1e-6f * size);
  return {box.min - out, box.max + out};
}

}  // namespace pelage
