// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/operator_stack.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/job.h"
#include "base/nearest_name.h"

namespace pelage {
namespace {

uint64_t hash_name(std::string_view name) {
  uint64_t h = random_use("operator");
  for (char c : name) h = hash64(h, static_cast<unsigned char>(c));
  return h;
}

/// The first attribute that a parameter of an operator reads and strands do not have while they grow; empty
/// where there is none.
std::string unknown_attribute(const Operator& op, std::span<const std::string> known) {
  constexpr std::string_view kForm = "{attribute: ";
  for (const ParameterText& parameter : op.parameters()) {
    const std::string& text = parameter.text;
    for (size_t at = text.find(kForm); at != std::string::npos; at = text.find(kForm, at + 1)) {
      const size_t begin = at + kForm.size();
      std::string name = text.substr(begin, text.find('}', begin) - begin);
      if (std::find(known.begin(), known.end(), name) == known.end()) return name;
    }
  }
  return {};
}

/// Bounds need the max value of every field; attributes of strands have none.
void check_bounded(const Operator& op, const SourcePosition& position) {
  const StrandReach after = op.reach_after({});
  if (std::isfinite(after.length) && std::isfinite(after.distance) && std::isfinite(after.radius)) return;
  const std::vector<std::string> known{"random", "clump", "color"};
  const std::string name(op.traits().name);
  if (const std::string unknown = unknown_attribute(op, known); !unknown.empty()) {
    throw Error(ErrorKind::kInput, position,
                "'" + name + "' reads the unknown attribute " + quote(unknown) + suggest(unknown, known));
  }
  throw Error(ErrorKind::kInput, position,
              "a number of '" + name +
                  "' has no upper limit, because it reads an attribute or a distance without one; of "
                  "attributes, only `random` and "
                  "`clump` have limits; put it into the field `clamp`");
}

/// A root as fields see it.
FieldPoint field_point(const LimitSurface& rest, const RootAddress& root) {
  const V2f uv = rest.topology().texture_coordinates(root.face, root.u, root.v);
  FieldPoint point;
  point.rest = rest.evaluate(root.face, root.u, root.v).position;
  point.u = uv.x;
  point.v = uv.y;
  point.normal = rest.frame(root.face, root.u, root.v).normal;
  point.face = root.face;
  point.face_uv = {root.u, root.v};
  return point;
}

/// The frame at a point that is already evaluated; evaluates the surface again only where it is ill-defined.
Frame frame_at(const LimitSurface& surface, const RootAddress& root, const SurfacePoint& point) {
  const V3f cross = point.du.cross(point.dv);
  if (cross.dot(cross) > 1e-6f * point.du.dot(point.du) * point.dv.dot(point.dv))
    return LimitSurface::frame_of(point);
  return surface.frame(root.face, root.u, root.v);
}

}  // namespace

OperatorStack::OperatorStack(const OperatorList& list) {
  std::map<std::string, uint64_t> seen;
  operators_.reserve(list.items.size());
  for (const OperatorList::Item& item : list.items) {
    traits_.push_back(operators_.emplace_back(item.clone(*item.prototype))->traits());
    places_.push_back({item.position, hash_name(item.name), seen[item.name]++, false});
  }
  const auto live = std::find_if(traits_.begin(), traits_.end(),
                                 [](const OperatorTraits& traits) { return !traits.reads_rest_only; });
  live_ = static_cast<size_t>(live - traits_.begin());
}

void OperatorStack::prepare(size_t begin, size_t end, const PrepareContext& context) {
  PrepareContext own = context;
  own.parts.clear();
  for (size_t i = 0; i < size(); ++i) {
    if (!traits_[i].parts_hair) continue;
    prepare_one(i, context);
    own.parts.push_back(operators_[i]->part());
  }
  for (size_t i = begin; i < end; ++i) {
    if (places_[i].prepared) continue;
    if (traits_[i].runs_preceding) prepare(0, i, context);
    prepare_one(i, own);
  }
}

void OperatorStack::prepare_one(size_t i, const PrepareContext& context) {
  Place& place = places_[i];
  if (place.prepared) return;
  PrepareContext own = context;
  own.preceding = std::span(operators_).first(i);
  own.seed = seed_of(context.seed, i);
  own.position = place.position;
  operators_[i]->prepare(own);
  check_bounded(*operators_[i], place.position);
  place.prepared = true;
}

void OperatorStack::warn_of_missed(const LimitSurface& rest, const FollicleTree& follicles,
                                   const PrepareContext& context) const {
  constexpr size_t kSample = 20000;
  const size_t strands = follicles.size(), step = std::max<size_t>(1, strands / kSample);
  for (size_t i = 0; i < size(); ++i) {
    if (!traits_[i].may_miss || !places_[i].prepared) continue;
    size_t missed = 0, seen = 0;
    for (size_t f = 0; f < strands; f += step, ++seen) {
      if (seen % 256 == 0) context.job.check_stop();
      if (operators_[i]->misses(field_point(rest, follicles.root(f)))) ++missed;
    }
    if (missed == 0) continue;
    const size_t count = step == 1 ? missed : missed * strands / seen;
    context.job.progress.warn(fmt::format(
        "{}: {}{} of {} strands of {} have no guide within `radius` and keep "
        "their shape",
        to_string(places_[i].position), step == 1 ? "" : "about ", count, strands, context.owner));
  }
}

/// Depends on the number of preceding operators with the same name rather than on its position, so that
/// adding an operator with another name does not affect it.
uint64_t OperatorStack::seed_of(uint64_t groom, size_t i) const {
  return hash64(groom, places_[i].name, places_[i].number);
}

void OperatorStack::prepare_coverage(const PrepareContext& context) {
  for (size_t i = 0; i < size(); ++i) {
    if (traits_[i].restricts_coverage) prepare(i, i + 1, context);
  }
}

void OperatorStack::apply(size_t begin, size_t end, StrandBatch& batch) const {
  for (size_t i = begin; i < end; ++i) operators_[i]->apply(batch);
}

OperatorTraits OperatorStack::traits(size_t begin, size_t end) const {
  OperatorTraits all{.attributes_only = true, .rest_use = RestUse::kNone};
  for (const OperatorTraits& own : std::span(traits_).subspan(begin, end - begin)) {
    all.reads_rest_only &= own.reads_rest_only;
    all.needs_closest_point |= own.needs_closest_point;
    all.colors = std::max(all.colors, own.colors);
    all.replaces_colors |= own.replaces_colors;
    all.has_one_width_profile &= own.has_one_width_profile;
    all.attributes_only &= own.attributes_only;
    all.rest_use = std::max(all.rest_use, own.rest_use);
    all.restricts_coverage |= own.restricts_coverage;
    all.parts_hair |= own.parts_hair;
    all.may_miss |= own.may_miss;
  }
  return all;
}

Operator::Brightness OperatorStack::brightness(uint64_t seed, uint64_t strand_id) const {
  Operator::Brightness product;
  for (size_t i = size(); i-- > 0;) {
    const Operator& op = *operators_[i];
    if (!traits_[i].colors) continue;
    if (traits_[i].colors_partly) return {};  // how bright a strand is depends on where it is
    const Operator::Brightness own = op.brightness(seed_of(seed, i), strand_id);
    product.value *= own.value;
    product.mean *= own.mean;
    if (traits_[i].replaces_colors) break;
  }
  return product;
}

StrandReach OperatorStack::reach(StrandReach before, size_t begin, size_t end) const {
  for (size_t i = begin; i < end; ++i) before = operators_[i]->reach_after(before);
  return before;
}

float OperatorStack::coverage(const FieldPoint& root) const {
  float result = 1;
  for (const auto& op : operators_) result *= op->coverage(root);
  return result;
}

void place_on_rest(StrandBatch& batch, const LimitSurface& rest, const FollicleTree& follicles,
                   size_t begin) {
  for (size_t s = 0; s < batch.count; ++s) {
    const RootAddress& root = follicles.root(begin + s);
    const SurfacePoint point = rest.evaluate(root.face, root.u, root.v);
    batch.rest.set(s, point.position, frame_at(rest, root, point));
  }
  place_ids(batch, rest.topology(), follicles, begin);
  for (size_t s = 0; s < batch.count; ++s)
    batch.clump[s] = unit_float(hash64(batch.ids[s], random_use("no clump")));
}

void place_ids(StrandBatch& batch, const SurfaceTopology& topology, const FollicleTree& follicles,
               size_t begin) {
  for (size_t s = 0; s < batch.count; ++s) {
    const RootAddress& root = follicles.root(begin + s);
    batch.ids[s] = follicles.id(begin + s);
    const V2f uv = topology.texture_coordinates(root.face, root.u, root.v);
    batch.u[s] = uv.x;
    batch.v[s] = uv.y;
    batch.face[s] = root.face;
    batch.face_u[s] = root.u;
    batch.face_v[s] = root.v;
  }
}

void place_in_pose(StrandBatch& batch, const LimitSurface& pose, const FollicleTree& follicles,
                   size_t begin) {
  for (size_t s = 0; s < batch.count; ++s) {
    const RootAddress& root = follicles.root(begin + s);
    const SurfacePoint point = pose.evaluate(root.face, root.u, root.v);
    batch.current.set(s, point.position, frame_at(pose, root, point));
  }
}

}  // namespace pelage
