// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_param.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "base/visible_text.h"
#include "geom/alembic/alembic_values.h"

namespace pelage {
namespace {

constexpr size_t kMaxParamComponents = 16;

/// The values of a parameter, and the indices of an indexed one.
struct ParamParts {
  AlembicProperty values;
  std::optional<AlembicProperty> indices;
  size_t components = 1;
};

std::optional<ParamParts> param_parts(const AlembicArchive& archive, const AlembicProperty& property) {
  ParamParts parts{property, {}, 1};
  if (property.kind == AlembicProperty::Kind::kCompound) {
    const AlembicCompound compound = archive.compound(property);
    const AlembicProperty *values = compound.find(".vals"), *indices = compound.find(".indices");
    if (!values || !indices) return {};
    parts.values = *values;
    if (alembic_count(archive, *indices) > 0) parts.indices = *indices;
  }
  if (alembic_pod_bytes(parts.values.pod) == 0 || parts.values.kind == AlembicProperty::Kind::kCompound)
    return {};
  const std::string_view stated = alembic_metadata(parts.values.metadata, "arrayExtent");
  size_t array_extent = 1;
  std::from_chars(stated.data(), stated.data() + stated.size(), array_extent);
  parts.components = parts.values.extent * std::clamp<size_t>(array_extent, 1, 1 << 20);
  return parts;
}

std::string interpolation_of_scope(std::string_view scope) {
  if (scope == "uni") return "uniform";
  if (scope == "var") return "varying";
  if (scope == "vtx") return "vertex";
  if (scope == "fvr") return "faceVarying";
  return "constant";
}

size_t param_count(const std::string& interpolation, const UsdPrimvarCounts& counts) {
  if (interpolation == "uniform") return counts.uniform;
  if (interpolation == "varying") return counts.varying;
  if (interpolation == "vertex") return counts.vertex;
  if (interpolation == "faceVarying") return counts.face_varying;
  return 1;
}

void expand(const AlembicNode& node, const ParamParts& parts, UsdPrimvar& param) {
  std::vector<float> expanded;
  const std::vector<int64_t> indices = alembic_integers(node.archive, *parts.indices);
  expanded.reserve(indices.size() * param.components);
  for (const int64_t index : indices) {
    if (index < 0 || static_cast<size_t>(index) >= param.count())
      node.fail(fmt::format("the index {} is not one of {} elements", index, param.count()));
    const auto first = param.values.begin() + index * static_cast<ptrdiff_t>(param.components);
    expanded.insert(expanded.end(), first, first + static_cast<ptrdiff_t>(param.components));
  }
  param.values = std::move(expanded);
}

}  // namespace

std::optional<UsdPrimvar> alembic_param(const AlembicNode& node, const AlembicProperty& property,
                                        const UsdPrimvarCounts& counts, UsdWarnings& warnings, bool needed) {
  const std::optional<ParamParts> parts = param_parts(node.archive, property);
  if (!parts) return {};
  const SourcePosition place{node.archive.file().path().string(), 0, 0};
  if (parts->components > kMaxParamComponents) {
    warnings.add("parameters with more than 16 numbers per element are skipped", place);
    return {};
  }
  UsdPrimvar param;
  param.components = parts->components;
  param.values = alembic_floats(node.archive, parts->values);
  const auto skip = [&](const std::string& why) -> std::optional<UsdPrimvar> {
    if (needed) node.fail(why);
    warnings.add(visible(why) + "; it is skipped", place);
    return {};
  };
  if (param.values.size() % param.components != 0)
    return skip(fmt::format("the number of values of '{}' is no multiple of its arrayExtent", property.name));
  if (parts->indices) expand(node, *parts, param);
  const size_t count = param.count();
  if (count == 0) return {};
  const std::string_view scope = alembic_metadata(property.metadata, "geoScope");
  param.interpolation = interpolation_of_scope(scope);
  if (param_count(param.interpolation, counts) == count) return param;
  // AbcGeom counts the values of these scopes per vertex, also those of cubic curves that are not periodic.
  const bool per_vertex = count == counts.vertex && counts.varying == counts.face_varying &&
                          (param.interpolation == "varying" || param.interpolation == "faceVarying");
  for (const char* other : {"vertex", "varying", "uniform", "constant", "faceVarying"}) {
    if (param_count(other, counts) != count) continue;
    if (!scope.empty() && !per_vertex) {
      warnings.add(fmt::format("'{}' has a size that does not fit its scope, {}", visible(property.name),
                               param.interpolation),
                   place);
    }
    param.interpolation = other;
    return param;
  }
  return skip(fmt::format("'{}' has {} values; {} vertices, {} curves or faces need others", property.name,
                          count, counts.vertex, counts.uniform));
}

size_t alembic_param_bytes(const AlembicArchive& archive, const AlembicProperty& property) {
  const std::optional<ParamParts> parts = param_parts(archive, property);
  if (!parts || parts->components > kMaxParamComponents) return 0;
  const size_t values = alembic_count(archive, parts->values) * sizeof(float);
  if (!parts->indices) return values;
  return values +
         alembic_count(archive, *parts->indices) * (sizeof(int64_t) + parts->components * sizeof(float));
}

}  // namespace pelage
