// SPDX-License-Identifier: Apache-2.0
#include "render/frame/strand_fields.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/nearest_name.h"
#include "geom/rest_position.h"
#include "image/field_node.h"

namespace pelage {
namespace {

/// A FieldPoint together with the attribute values that it refers to.
class StrandFieldPoint {
 public:
  StrandFieldPoint(const Field& field, const Strands& strands,
                   std::span<const StrandAttribute* const> attributes, const LimitSurface* rest,
                   const StrandPlace& place) {
    const FieldDependence needs = field.dependence();
    point_.along = place.v;
    if (needs.surface) {
      const V2f uv = strands.root_uv(place.strand);
      point_.u = uv.x;
      point_.v = uv.y;
      if (rest && strands.has_roots()) {
        const RootAddress& root = strands.root(place.strand);
        const SurfacePoint at = rest->evaluate(root.face, root.u, root.v);
        point_.rest = at.position;
        point_.face = root.face;
        point_.face_uv = {root.u, root.v};
        if (needs.normal) point_.normal = rest->frame(at, root.face, root.u, root.v).normal;
      } else {
        point_.rest =
            rest_position(strands, place.strand).value_or(strands.point(strands.first_point(place.strand)));
      }
    }
    for (size_t i = 0; i < attributes.size(); ++i) {
      std::array<float, 4> value{};
      interpolate_attribute(strands, *attributes[i], place.strand, place.segment, place.u, value.data());
      const Rgb color = attributes[i]->components >= 3 ? Rgb(value[0], value[1], value[2]) : Rgb(value[0]);
      values_[i] = {attributes[i]->name, color};
    }
    point_.attributes = std::span(values_).first(attributes.size());
  }
  StrandFieldPoint(const StrandFieldPoint&) = delete;
  StrandFieldPoint& operator=(const StrandFieldPoint&) = delete;

  const FieldPoint& get() const { return point_; }

 private:
  std::array<FieldAttribute, kMaxFieldAttributes> values_;
  FieldPoint point_;
};

/// The position of control point `i` of a strand with `points` points: where the curve is nearest to it.
StrandPlace place_of_point(const Strands& strands, size_t strand, uint32_t i) {
  const uint32_t segments = segment_count(strands.basis(), strands.strand_points(strand));
  const uint32_t before = strands.basis() == CurveBasis::kBSpline ? 1 : 0;
  const uint32_t joint = std::min(i > before ? i - before : 0, segments);
  const uint32_t segment = std::min(joint, segments - 1);
  return {strand, segment, static_cast<float>(joint - segment),
          static_cast<float>(joint) / static_cast<float>(segments)};
}

SourcePosition place_of(const Field& field, const std::string& attribute) {
  const SourcePosition* place = field.node().place_of_attribute(attribute);
  return place ? *place : SourcePosition{};
}

}  // namespace

std::vector<const StrandAttribute*> find_attributes(const Field& field, const Strands& strands,
                                                    const std::string& part) {
  std::vector<const StrandAttribute*> found;
  for (const std::string& name : field.attribute_names()) {
    const StrandAttribute* attribute = strands.find_attribute(name);
    if (!attribute) {
      std::vector<std::string> known;
      for (const StrandAttribute& other : strands.attributes()) known.push_back(other.name);
      throw Error(ErrorKind::kInput, place_of(field, name),
                  "the strands of " + part + " have no attribute " + quote(name) +
                      (known.empty() ? "; they have none" : suggest(name, known)));
    }
    if (attribute->components > 4 || found.size() == kMaxFieldAttributes) {
      throw Error(ErrorKind::kInput, place_of(field, name),
                  part + ": its material reads too many attributes, or one with more than 4 components");
    }
    found.push_back(attribute);
  }
  return found;
}

Rgb strand_color(const Field& field, const Strands& strands,
                 std::span<const StrandAttribute* const> attributes, const LimitSurface* rest,
                 const StrandPlace& place) {
  return field.color(StrandFieldPoint(field, strands, attributes, rest, place).get());
}

std::vector<float> point_opacities(const Field& opacity, const Strands& strands, const FurPart& part) {
  if (is_opaque(opacity)) return {};
  const std::vector<const StrandAttribute*> attributes = find_attributes(opacity, strands, part.name);
  std::vector<float> result(strands.point_count(), 1.0f);
  bool opaque = true;
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    if (segment_count(strands.basis(), strands.strand_points(s)) == 0) continue;
    for (uint32_t i = 0; i < strands.strand_points(s); ++i) {
      const StrandFieldPoint point(opacity, strands, attributes, part.rest.get(),
                                   place_of_point(strands, s, i));
      float& value = result[strands.first_point(s) + i];
      value = std::clamp(opacity.value(point.get()), 0.0f, 1.0f);
      opaque &= value == 1;
    }
  }
  if (opaque) result.clear();
  return result;
}

}  // namespace pelage
