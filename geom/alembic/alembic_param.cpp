// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_param.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "base/visible_text.h"
#include "geom/alembic/alembic_values.h"

namespace pelage {
namespace {

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

void expand(const AlembicNode& node, const ParamParts& parts, Primvar& param) {
  const std::vector<int64_t> indices = alembic_integers(node.archive, *parts.indices);
  param.select(indices.size(), [&](size_t i) {
    if (indices[i] < 0 || static_cast<size_t>(indices[i]) >= param.count())
      node.fail(fmt::format("the index {} is not one of {} elements", indices[i], param.count()));
    return static_cast<size_t>(indices[i]);
  });
}

}  // namespace

std::optional<Primvar> alembic_param(const AlembicNode& node, const AlembicProperty& property,
                                     const PrimvarCounts& counts, ReadWarnings& warnings, bool needed) {
  const std::optional<ParamParts> parts = param_parts(node.archive, property);
  if (!parts) return {};
  const SourcePosition place{node.archive.file().path().string(), 0, 0};
  if (parts->components > kMaxPrimvarComponents) {
    warnings.add("parameters with more than 16 numbers per element are skipped", place);
    return {};
  }
  Primvar param;
  param.components = parts->components;
  param.values = alembic_floats(node.archive, parts->values);
  const auto skip = [&](const std::string& why) -> std::optional<Primvar> {
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
  if (counts.of(param.interpolation) == count) return param;
  // AbcGeom counts the values of these scopes per vertex, also those of cubic curves that are not periodic.
  const bool per_vertex = count == counts.vertex && counts.varying == counts.face_varying &&
                          (param.interpolation == "varying" || param.interpolation == "faceVarying");
  if (const char* fitting = counts.interpolation_of(count)) {
    if (!scope.empty() && !per_vertex) {
      warnings.add(fmt::format("'{}' has a size that does not fit its scope, {}", visible(property.name),
                               param.interpolation),
                   place);
    }
    param.interpolation = fitting;
    return param;
  }
  return skip(fmt::format("'{}' has {} values; {} vertices, {} curves or faces need others", property.name,
                          count, counts.vertex, counts.uniform));
}

size_t alembic_param_bytes(const AlembicArchive& archive, const AlembicProperty& property) {
  const std::optional<ParamParts> parts = param_parts(archive, property);
  if (!parts || parts->components > kMaxPrimvarComponents) return 0;
  const size_t values = alembic_count(archive, parts->values) * sizeof(float);
  if (!parts->indices) return values;
  return values +
         alembic_count(archive, *parts->indices) * (sizeof(int64_t) + parts->components * sizeof(float));
}

}  // namespace pelage
