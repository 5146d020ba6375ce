// SPDX-License-Identifier: Apache-2.0
#include "groom/groom.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/job.h"
#include "base/memory_budget.h"
#include "base/nearest_name.h"
#include "groom/cache/growth_cache.h"
#include "groom/groom_impl.h"
#include "groom/operators/width.h"

namespace pelage {

Groom::Groom(std::shared_ptr<const Impl> impl, const ContentHash& hash)
    : impl_(std::move(impl)), hash_(hash) {}
Groom::~Groom() = default;

const FollicleTree& Groom::follicles() const { return impl_->source.follicles(); }
StrandRole Groom::role() const { return impl_->role; }
bool Groom::needs_closest_point() const { return impl_->stack->traits().needs_closest_point; }
bool Groom::guides_need_closest_point() const {
  return impl_->guides && impl_->stack->traits(0, impl_->follow).needs_closest_point;
}
StrandRepairs Groom::repairs() const {
  return impl_->source.imported ? impl_->source.imported->repairs() : StrandRepairs();
}
bool Groom::grows_on_skin() const { return impl_->source.rest != nullptr; }
const ContentHash& Groom::content_hash() const { return hash_; }
const ContentHash& Groom::identity() const { return impl_->whole; }
int Groom::points() const { return impl_->source.points; }
const MovingGuides* Groom::guides() const { return impl_->guides.get(); }
const ContentStore* Groom::store() const { return impl_->store ? &*impl_->store : nullptr; }
const GroomCacheReport* Groom::cache_report() const { return impl_->report ? &*impl_->report : nullptr; }

std::shared_ptr<const Groom> Groom::moved(std::shared_ptr<const CoatMotion> motion) const {
  const ContentHash hash = ContentHasher().add(hash_).add(motion->hash).digest();
  std::shared_ptr<Groom> coat(new Groom(impl_, hash));
  coat->motion_ = std::move(motion);
  return coat;
}

SurfacePoint Groom::root(size_t follicle, const PosedSkin& pose, size_t key) const {
  const CoatSource& source = impl_->source;
  if (source.rest) {
    const RootAddress& root = source.follicles().root(follicle);
    return pose.keys[key].evaluate(root.face, root.u, root.v);
  }
  V3f at = source.imported->first_point(follicle);
  if (!pose.free_transforms.empty()) pose.free_transforms[key].multVecMatrix(V3f(at), at);
  SurfacePoint point;
  point.position = at;
  return point;
}

bool Groom::has_priority_order() const { return !impl_->source.imported; }

float Groom::priority(size_t follicle) const {
  const FollicleTree& follicles = impl_->source.follicles();
  const uint64_t id = follicles.id(follicle);
  // Ids of grown strands are ranks in their progressive order; ids of imported strands may be sorted along
  // the skin.
  if (!has_priority_order()) return unit_float(hash64(id, random_use("priority")));
  return static_cast<float>((static_cast<double>(id) + 0.5) / static_cast<double>(follicles.size()));
}

namespace {

void check_combination(const std::string& name, const GroomParams& params, bool has_skin) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::kInput, params.strands_file.position, "groom '" + name + "' " + why);
  };
  if (params.strands_file.empty()) {
    if (!has_skin) refuse("needs a skin to grow on, or a strands_file");
    if (!params.strands && !params.density)
      refuse("needs `strands` (how many) or `density` (how many per square unit)");
  } else if (params.attach == Attachment::kSkin && !has_skin) {
    refuse("has no skin: `attach: skin` needs a skin beside the strands_file");
  } else if (params.strands || params.density) {
    refuse("takes its strands from a file; `strands` and `density` must not be given");
  }
  if (const std::optional<Problem> problem = check_freeze(params))
    throw Error(ErrorKind::kInput, problem->position, problem->message);
}

/// A script may do whatever the user may do, and a scene may come from a stranger.
void refuse_scripts(const OperatorList& list) {
  Problems problems;
  for (const OperatorList::Item& item : list.items) {
    if (!item.prototype->traits().runs_script) continue;
    problems.add(item.position, quote(item.name) +
                                    " runs a script of the scene, which may do whatever you may do; the flag "
                                    "--allow-scripts (in Python, allow_scripts=True) allows it");
  }
  problems.throw_if_any();
}

/// Grown strands have a width even if no operator sets one everywhere.
OperatorList with_width(const GroomParams& params) {
  OperatorList list = params.operators;
  std::vector<OperatorList::Item>& items = list.items;
  const auto sets_width = [](const OperatorList::Item& item) { return item.name == Width::kName; };
  const bool everywhere = std::any_of(items.begin(), items.end(),
                                      [&](const auto& item) { return sets_width(item) && !item.masked; });
  if (!everywhere && params.strands_file.empty())
    items.insert(std::find_if(items.begin(), items.end(), sets_width), default_operator(Width::kName));
  return list;
}

}  // namespace

namespace {

/// Refuses strands of so many points that not even one block of them fits. The error states the memory that
/// suffices for a picture: two blocks with colours, and the smallest part of the coat.
void require_growing(const MemoryLedger& ledger, int points, bool colored, const std::string& owner) {
  constexpr int64_t kBytesOfPoint = 256;  // of a strand that is alone in its part, with its tree
  const int64_t block = StrandBatch::bytes(points, colored);
  if (has_room(ledger, block)) return;
  require_memory(ledger, 2 * StrandBatch::bytes(points, true) + kBytesOfPoint * points,
                 fmt::format("growing strands with {} points for {}", points, owner));
}

}  // namespace

std::shared_ptr<const Groom> Groom::create(const std::string& name, const GroomParams& params,
                                           std::shared_ptr<const LimitSurface> rest,
                                           const FieldSources& sources, const Job& job, const Groom* previous,
                                           const GrowthCache* growth_cache, const OperatorScripts* scripts) {
  check_combination(name, params, rest != nullptr);
  if (!scripts) refuse_scripts(params.operators);
  const std::string owner = "groom '" + name + "'";
  auto impl = std::make_unique<Impl>();
  impl->role = params.role;
  impl->source.rest = std::move(rest);
  impl->source.points = params.points;
  if (!params.strands_file.empty()) {
    // Strands that do not follow the skin grow as without a skin.
    impl->source.imported.emplace(params, impl->source.rest.get(), owner, job);
    if (impl->source.imported->is_free()) impl->source.rest = nullptr;
  }
  OperatorList operators = with_width(params);
  if (params.dynamics) {
    impl->guides = std::make_shared<MovingGuides>();
    impl->follow = follow_place(*params.dynamics, operators);
    operators.items.insert(operators.items.begin() + static_cast<std::ptrdiff_t>(impl->follow),
                           follow_item(*params.dynamics, impl->guides));
  }
  impl->stack.emplace(operators);
  OperatorStack& stack = *impl->stack;
  if (stack.traits().needs_closest_point && !impl->source.rest) {
    throw Error(ErrorKind::kInput, "groom '" + name + "' uses push_out, but its strands follow no skin");
  }

  // Two coats of one skin without explicit seeds must not grow from the same places.
  const uint64_t name_hash = pelage::content_hash(std::as_bytes(std::span(name.data(), name.size()))).low;
  const uint64_t seed = hash64(static_cast<uint64_t>(params.seed), name_hash);
  PrepareContext context{impl->source.rest.get(),           sources,       job, {},
                         hash64(seed, random_use("groom")), params.points, {}};
  context.owner = owner;
  context.scripts = scripts;
  impl->operator_seed = context.seed;
  if (!impl->source.rest) context.textures.skin = nullptr;
  const GroomIdentity identity(params, seed, stack, impl->source.rest.get(), context.textures.skin);
  ContentHasher hasher;
  hasher.add(identity.whole()).add(params.leaf_size()).add(growth_version::kPose);
  if (params.cache) hasher.add(params.cache->freeze.name).add(growth_version::kFrozen);
  impl->whole = identity.whole();

  impl->follicle_identity =
      ContentHasher().add(identity.stages()[GroomIdentity::kStrands].hash).add(params.leaf_size()).digest();

  const int max_points = impl->source.imported ? impl->source.imported->max_points() : params.points;
  require_growing(job.ledger, max_points, stack.traits().colors.has_value(), context.owner);
  if (params.cache) {
    impl->open_cache(name, params, identity, context, seed);
  } else {
    stack.prepare_all(context);
    const bool same = previous && previous->impl_->follicle_identity == impl->follicle_identity;
    if (same && params.strands_file.empty()) {
      impl->source.grown = previous->impl_->source.grown;
    } else if (params.strands_file.empty()) {
      const auto place = [&] { return impl->place_follicles(params, context, seed); };
      const WarningSink warn = [&job](const std::string& line) { job.progress.warn(line); };
      impl->source.grown = std::make_shared<const FollicleTree>(
          growth_cache
              ? growth_cache->follicles(impl->follicle_identity, impl->source.rest->topology(), place, warn)
              : place());
    }
  }
  if (params.dynamics) {
    const FollicleTree& coat = impl->source.follicles();
    impl->guides->place(params.dynamics->guide_count(coat.size()), coat, *impl->source.rest);
  }
  if (impl->source.rest) stack.warn_of_missed(*impl->source.rest, impl->source.follicles(), context);
  const size_t guide_bytes = impl->guides ? impl->guides->roots.bytes() : 0;
  const size_t bytes = guide_bytes + impl->source.bytes() + impl->rest_positions.capacity() * sizeof(V3f);
  impl->charge = MemoryCharge(job.ledger, MemoryTag::kGrooms, static_cast<int64_t>(bytes));
  std::shared_ptr<const Groom> groom(new Groom(std::move(impl), hasher.digest()));
  if (params.dynamics && params.dynamics->mode == DynamicsMode::kKinematic) groom->find_tips();
  return groom;
}

FollicleTree Groom::Impl::place_follicles(const GroomParams& params, const PrepareContext& context,
                                          uint64_t seed) const {
  FollicleOptions options;
  options.count = params.strands.value_or(0);
  options.per_area = params.strands ? 0.0 : 1.0;
  if (params.density) options.density = params.density->with_textures(context.textures);
  if (stack->traits().restricts_coverage) {
    options.coverage = [this](const FieldPoint& root) { return stack->coverage(root); };
  }
  options.seed = hash64(seed, random_use("follicles"));
  options.leaf_strands = params.leaf_size();
  options.owner = context.owner;
  return FollicleTree::build(*source.rest, options, context.job);
}

}  // namespace pelage
