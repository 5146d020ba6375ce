// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/guides.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "base/job.h"
#include "geom/limit_surface.h"
#include "groom/operators/guide_set.h"
#include "groom/strands/curve_basis_names.h"
#include "groom/strands/part_lines.h"
#include "groom/strands/rotation.h"
#include "groom/strands/strand_fields.h"

namespace pelage {
namespace {

constexpr int kMaxNeighbours = 8;

/// Turns vectors by the smallest rotation that takes the normal at a guide's root to the normal at a strand's
/// root.
class GuideRotation {
 public:
  GuideRotation() = default;
  GuideRotation(const V3f& from, const V3f& to) {
    const Rotation rotation = rotation_between(from, to, any_perpendicular(from));
    axis_ = rotation.axis;
    sine_ = std::sin(rotation.angle);
    cosine_ = std::cos(rotation.angle);
  }
  V3f operator()(const V3f& v) const {
    return v * cosine_ + axis_.cross(v) * sine_ + axis_ * (axis_.dot(v) * (1 - cosine_));
  }

 private:
  V3f axis_{0};
  float sine_ = 0, cosine_ = 1;
};

struct Weights {
  std::array<RootGrid::Neighbour, kMaxNeighbours + 1> guide;
  std::array<GuideRotation, kMaxNeighbours> rotation;
  std::array<float, kMaxNeighbours> weight;
  int count = 0;
};

/// How much a guide counts beside the nearest one, by the cosine of the angle between them: 1 up to 40
/// degrees, 0 from 60 degrees.
float agreement(float cosine) {
  constexpr float kFull = 0.76604444f, kNone = 0.5f;
  const float x = std::clamp((cosine - kNone) / (kFull - kNone), 0.0f, 1.0f);
  return x * x * (3 - 2 * x);
}

/// The guides near a position and their weights, which sum to 1; empty when no guide is near.
Weights find_weights(const RootGrid& grid, const GuideSet& guides, const V3f& position, const V3f& normal,
                     int neighbours, std::span<const std::shared_ptr<const PartLines>> parts) {
  Weights w;
  const int found = grid.nearest_if(position, normal, neighbours + 1, w.guide.data(), [&](uint32_t i) {
    return !divides(parts, position, normal, grid.position(i));
  });
  w.count = std::min(found, neighbours);
  const float radius = found > neighbours ? w.guide[static_cast<size_t>(neighbours)].distance : grid.radius();
  const auto count = static_cast<size_t>(w.count);
  float total = 0;
  for (size_t k = 0; k < count; ++k) {
    const float x = radius > 0 ? std::max(0.0f, 1.0f - w.guide[k].distance / radius) : 0.0f;
    w.weight[k] = x * x;
    total += w.weight[k];
  }
  // All equally far: equal weights.
  if (!(total > 1e-12f)) std::fill_n(w.weight.begin(), count, 1.0f);
  V3f nearest;
  total = 0;
  for (size_t k = 0; k < count; ++k) {
    const size_t guide = w.guide[k].index;
    w.rotation[k] = GuideRotation(guides.normals()[guide], normal);
    const V3f lean = w.rotation[k](guides.lean(guide));
    if (k == 0) nearest = lean;
    if (k > 0) w.weight[k] *= agreement(nearest.dot(lean));
    total += w.weight[k];
  }
  for (size_t k = 0; k < count; ++k) w.weight[k] /= total;
  return w;
}

}  // namespace

const Schema<GuidesParams>& GuidesParams::schema() {
  static const Schema<GuidesParams> table = [] {
    Schema<GuidesParams> s("guides", "Shapes strands like the nearby guide strands of a file.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - guides: {file: guides.hair, neighbours: 4})");
    s.set_picture("Left: straight strands. Right: strands shaped by the guides of a file.");
    s.key("file", &GuidesParams::file,
          {.help = "Guide file (.hair, .tfx, .usda, .abc) in the rest space of the skin", .required = true});
    s.key("basis", &GuidesParams::basis,
          {.help = "How control points of the file define curves", .default_text = "the basis in the file"});
    s.key("scale", &GuidesParams::scale,
          {.help = "Factor on the file's positions", .min = 0, .above_min = true});
    s.key("translate", &GuidesParams::translate,
          {.unit = "scene units", .help = "Offset of the file's positions, added after `scale`"});
    s.key(
        "mirror", &GuidesParams::mirror,
        {.help =
             "Normal of a plane through the origin of the rest space, such as [1, 0, 0]: the guides also act "
             "as their mirror images on the other side, so that one side needs no guides of its own",
         .default_text = "guides act where they are"});
    s.key(
        "neighbours", &GuidesParams::neighbours,
        {.help = "Number of guides that shape a strand. Of these, guides that lean more than 60 degrees away "
                 "from the nearest one do not count, so that guides combed apart part the hair; up to 40 "
                 "degrees, they count fully. Copies of guides do not count",
         .min = 1,
         .max = kMaxNeighbours});
    s.key(
        "radius", &GuidesParams::radius,
        {.unit = "scene units",
         .help = "Maximum distance from a guide to a strand that it shapes. Guides where the skin faces more "
                 "than 60 degrees away, as on the other side of an ear, do not act",
         .min = 0,
         .above_min = true,
         .default_text = "4 times the median distance between guides, copies aside"});
    s.key(
        "growth_radius", &GuidesParams::spread,
        {.unit = "scene units",
         .help =
             "Strands grow only within this distance of a guide, and more densely where more guides are near",
         .min = 0,
         .above_min = true,
         .default_text = "guides do not limit where strands grow",
         .old_names = {"spread"}});
    s.key(
        "amount", &GuidesParams::amount,
        {.help = "How far strands take the shape of the guides: 0 not at all, 1 fully", .min = 0, .max = 1});
    return s;
  }();
  return table;
}

void Guides::prepare(const PrepareContext& context) {
  if (!context.rest)
    throw Error(ErrorKind::kInput, context.position, "the operator guides needs strands that grow on a skin");
  if (params_.mirror && params_.mirror->length() == 0)
    throw Error(ErrorKind::kInput, context.position, "the key `mirror` of the operator guides must not be 0");
  params_.amount = params_.amount.with_textures(context.textures);
  parts_ = context.parts;
  guides_ = std::make_shared<const GuideSet>(
      GuideFile{params_.file, params_.basis, params_.scale, params_.translate, params_.mirror}, context);
  const float automatic =
      guides_->spacing() > 0 ? 4.0f * guides_->spacing() : context.rest->control_bounds().size().length();
  near_ = RootGrid(guides_->roots(), guides_->normals(), params_.radius.value_or(automatic));
  if (params_.spread) covered_ = RootGrid(guides_->roots(), guides_->normals(), *params_.spread);
  charge_ = std::make_shared<const MemoryCharge>(
      context.job.ledger, MemoryTag::kGrooms,
      static_cast<int64_t>(guides_->bytes() + near_.bytes() + covered_.bytes()));
}

float Guides::coverage(const FieldPoint& root) const {
  if (!params_.spread) return 1;
  float total = 0;
  covered_.for_each_near(root.rest, root.normal, [&](uint32_t, float distance2) {
    const float x = 1.0f - distance2 / (covered_.radius() * covered_.radius());
    total += x * x;
  });
  return total;
}

bool Guides::misses(const FieldPoint& root) const {
  RootGrid::Neighbour guide;
  return !near_.nearest_if(root.rest, root.normal, guide, [&](uint32_t i) {
    return !divides(parts_, root.rest, root.normal, near_.position(i));
  });
}

void Guides::apply(StrandBatch& batch) const {
  const int points = batch.point_count();
  PELAGE_CHECK(points == guides_->points());
  StrandRow amount;
  evaluate(params_.amount, batch, 0, amount);
  std::vector<V3f> shape(static_cast<size_t>(points));
  for (size_t s = 0; s < batch.count; ++s) {
    const V3f normal = vector_at(batch.rest.normal, s);
    const Weights weights =
        find_weights(near_, *guides_, vector_at(batch.rest.position, s), normal, params_.neighbours, parts_);
    if (weights.count == 0) continue;
    std::fill(shape.begin(), shape.end(), V3f(0));
    float length = 0;
    for (size_t i = 0; i < static_cast<size_t>(weights.count); ++i) {
      const size_t guide = weights.guide[i].index;
      const float weight = weights.weight[i];
      if (weight == 0) continue;
      for (int p = 1; p < points; ++p)
        shape[static_cast<size_t>(p)] += weights.rotation[i](guides_->offset(guide, p)) * weight;
      length += guides_->length(guide) * weight;
    }
    // A mean of different directions is shorter than the mean of the lengths.
    float mixed = 0;
    for (int p = 1; p < points; ++p)
      mixed += (shape[static_cast<size_t>(p)] - shape[static_cast<size_t>(p - 1)]).length();
    const float scale = mixed > 0 ? std::clamp(length / mixed, 1.0f, 2.0f) : 1.0f;
    const float k = std::clamp(amount[s], 0.0f, 1.0f);
    const V3f base = batch.offset(0, s);
    for (int p = 1; p < points; ++p) {
      const V3f here = batch.offset(p, s);
      const V3f there = base + batch.from_rest(s, shape[static_cast<size_t>(p)]) * (scale * batch.scale);
      batch.set_offset(p, s, here + (there - here) * k);
    }
  }
}

bool Guides::all_strands_have_guides() const {
  const auto [low, high] = params_.amount.value_range();
  return low >= 1 && params_.spread && *params_.spread <= near_.radius();
}

StrandReach Guides::reach_after(const StrandReach& before) const {
  StrandReach after = before;
  const float longest = guides_->longest() * 1.00001f;
  after.length = all_strands_have_guides() ? longest : std::max(before.length, longest);
  after.distance = all_strands_have_guides() ? longest : std::max(before.distance, longest);
  after.lean = std::numbers::pi_v<float>;
  return after;
}

}  // namespace pelage
