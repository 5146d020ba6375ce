// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_curves_writer.h"

#include <algorithm>
#include <set>

#include "base/version.h"
#include "geom/alembic/alembic_curve_vertices.h"
#include "geom/alembic/alembic_curves_file.h"

namespace pelage {
namespace {

enum class Scope { kConstant, kUniform, kVertex };

/// Metadata of a parameter. `extent`: numbers per element.
AlembicMetadata param_metadata(Scope scope, const char* pod, size_t extent, size_t array_extent = 1) {
  constexpr const char* kScopes[] = {"con", "uni", "vtx"};
  return {{"isGeomParam", "true"},
          {"geoScope", kScopes[static_cast<size_t>(scope)]},
          {"podName", pod},
          {"podExtent", std::to_string(extent)},
          {"arrayExtent", std::to_string(array_extent)},
          {"interpretation", extent > 1 ? "vector" : ""}};
}

Scope scope_of(AttributeClass frequency) {
  if (frequency == AttributeClass::kConstant) return Scope::kConstant;
  return frequency == AttributeClass::kPerStrand ? Scope::kUniform : Scope::kVertex;
}

bool has_small_ids(const Strands& strands) {
  const std::vector<uint64_t>& ids = strands.arrays().ids;
  return std::all_of(ids.begin(), ids.end(), [](uint64_t id) { return id <= INT32_MAX; });
}

/// The name of an attribute that the groom schema has under another one; empty for others.
std::string schema_name(const StrandAttribute& attribute) {
  if (attribute.name == "color" && attribute.components == 3) return "groom_color";
  const bool per_strand = attribute.frequency != AttributeClass::kPerPoint;
  return attribute.name == "guide" && attribute.components == 1 && per_strand ? "groom_guide" : "";
}

/// The names of the parameters of all attributes; empty for those that are not written.
std::vector<std::string> param_names(const Strands& strands, const AlembicCurvesFacts& facts) {
  std::set<std::string> taken{"", "groom_version_major", "groom_version_minor"};
  taken.insert(has_small_ids(strands) ? "groom_id" : "ids");
  if (!facts.group.empty()) taken.insert("groom_group_name");
  if (!strands.arrays().root_uv.empty()) taken.insert("groom_root_uv");
  if (facts.host == AlembicHost::kUnreal && facts.widths) taken.insert("groom_width");
  for (const StrandAttribute& attribute : strands.attributes()) taken.insert(schema_name(attribute));
  std::vector<std::string> names;
  for (const StrandAttribute& attribute : strands.attributes()) {
    names.push_back(schema_name(attribute));
    if (!names.back().empty()) continue;
    std::string name = attribute.name;
    std::replace(name.begin(), name.end(), '/', '_');
    if (taken.insert(name).second) names.back() = std::move(name);
  }
  return names;
}

constexpr size_t kVerticesAtOnce = 4096;

class AlembicCurvesObject {
 public:
  AlembicCurvesObject(AlembicWriter& writer, const Strands& strands, const AlembicCurvesFacts& facts)
      : writer_(writer),
        strands_(strands),
        facts_(facts),
        unreal_(facts.host == AlembicHost::kUnreal),
        vertices_(strands, facts.host) {}

  AlembicObjectWriter write(const std::string& name) {
    constexpr const char* kSchema = "AbcGeom_Curve_v2";
    const AlembicMetadata base{{"schema", kSchema}, {"schemaBaseType", "AbcGeom_GeomBase_v1"}};
    AlembicMetadata title = base;
    title["schemaObjTitle"] = std::string(kSchema) + ":.geom";
    AlembicObjectWriter object(writer_, name, title);
    AlembicCompoundWriter geometry(writer_);
    write_geometry(geometry);
    AlembicCompoundWriter params(writer_);
    write_params(params);
    geometry.add(".arbGeomParams", {}, std::move(params));
    if (vertices_.phantom_ends()) {
      AlembicCompoundWriter user(writer_);
      const int16_t one = 1;
      user.scalar(kAlembicPhantomEnds, std::span<const int16_t>(&one, 1));
      geometry.add(".userProperties", {}, std::move(user));
    }
    object.properties.add(".geom", base, std::move(geometry));
    return object;
  }

 private:
  void write_geometry(AlembicCompoundWriter& geometry) {
    const std::vector<double> box = bounds();
    geometry.scalar(".selfBnds", std::span<const double>(box), 6, {{"interpretation", "box"}});
    write_vertices(geometry, "P", 3, {{"geoScope", "vtx"}, {"interpretation", "point"}},
                   [](const AlembicCurveVertex& v, float* to) { std::copy_n(&v.position.x, 3, to); });
    std::vector<int32_t> counts;
    counts.reserve(strands_.strand_count());
    for (size_t s = 0; s < strands_.strand_count(); ++s)
      counts.push_back(static_cast<int32_t>(vertices_.count(s)));
    geometry.array("nVertices", std::span<const int32_t>(counts));
    const uint8_t form[4] = {vertices_.type(), 0, vertices_.basis(), vertices_.basis()};
    geometry.scalar("curveBasisAndType", std::span<const uint8_t>(form), 4);
    if (facts_.widths) write_widths(geometry, "width");
    if (!root_uv().empty())
      geometry.array("uv", root_uv(), 2, param_metadata(Scope::kUniform, "float32_t", 2));
  }

  void write_params(AlembicCompoundWriter& params) {
    if (!facts_.group.empty())
      params.array("groom_group_name", facts_.group, param_metadata(Scope::kConstant, "string", 1));
    write_ids(params);
    if (!root_uv().empty())
      params.array("groom_root_uv", root_uv(), 2, param_metadata(Scope::kUniform, "float32_t", 2));
    if (unreal_ && facts_.widths) write_widths(params, "groom_width");
    const std::vector<std::string> names = param_names(strands_, facts_);
    for (size_t i = 0; i < names.size(); ++i) {
      if (!names[i].empty()) write_attribute(params, names[i], strands_.attributes()[i]);
    }
  }

  void write_ids(AlembicCompoundWriter& params) {
    const std::vector<uint64_t>& ids = strands_.arrays().ids;
    if (has_small_ids(strands_)) {
      const std::vector<int32_t> narrow(ids.begin(), ids.end());
      params.array("groom_id", std::span<const int32_t>(narrow), 1,
                   param_metadata(Scope::kUniform, "int32_t", 1));
    } else {
      const std::vector<int64_t> wide(ids.begin(), ids.end());
      params.array("ids", std::span<const int64_t>(wide), 1, param_metadata(Scope::kUniform, "int64_t", 1));
    }
  }

  void write_attribute(AlembicCompoundWriter& params, const std::string& name,
                       const StrandAttribute& attribute) {
    if (name == "groom_guide" && !schema_name(attribute).empty()) {
      std::vector<int16_t> guide;
      for (const float value : attribute.values) guide.push_back(value != 0);
      return params.array(name, std::span<const int16_t>(guide), 1,
                          param_metadata(scope_of(attribute.frequency), "int16_t", 1));
    }
    const bool color = name == "groom_color";
    const bool per_vertex = attribute.frequency == AttributeClass::kPerPoint || (color && unreal_);
    const auto n = static_cast<size_t>(attribute.components);
    const size_t extent = n <= 3 ? n : 1;
    const AlembicMetadata metadata = param_metadata(
        per_vertex ? Scope::kVertex : scope_of(attribute.frequency), "float32_t", extent, n / extent);
    if (!per_vertex)
      return params.array(name, std::span<const float>(attribute.values), static_cast<uint32_t>(extent),
                          metadata);
    write_vertices(
        params, name, n, metadata,
        [&, strand = size_t{0}](const AlembicCurveVertex& v, float* to) mutable {
          while (v.point >= strands_.first_point(strand) + strands_.strand_points(strand)) ++strand;
          attribute_value(attribute, strand, v.point, to);
        },
        static_cast<uint32_t>(extent));
  }

  static void attribute_value(const StrandAttribute& attribute, size_t strand, size_t point, float* to) {
    const auto n = static_cast<size_t>(attribute.components);
    const size_t at = attribute.frequency == AttributeClass::kPerPoint    ? point
                      : attribute.frequency == AttributeClass::kPerStrand ? strand
                                                                          : 0;
    std::copy_n(&attribute.values[n * at], n, to);
  }

  void write_widths(AlembicCompoundWriter& to, const char* name) const {
    write_vertices(to, name, 1, param_metadata(Scope::kVertex, "float32_t", 1),
                   [](const AlembicCurveVertex& v, float* width) { *width = v.width; });
  }

  /// Writes an array of `n` numbers per vertex, a few thousand vertices at a time.
  template <class Value>
  void write_vertices(AlembicCompoundWriter& to, const std::string& name, size_t n,
                      const AlembicMetadata& metadata, Value&& value, uint32_t extent = 0) const {
    to.array(name, n * vertices_.count(), extent > 0 ? extent : static_cast<uint32_t>(n), metadata,
             [&](const AlembicCompoundWriter::FloatSink& sink) {
               std::vector<float> part(n * kVerticesAtOnce);
               size_t filled = 0;
               for (size_t s = 0; s < strands_.strand_count(); ++s) {
                 for (size_t i = 0; i < vertices_.count(s); ++i) {
                   value(vertices_.vertex(s, i), &part[n * filled]);
                   if (++filled < kVerticesAtOnce) continue;
                   sink(part);
                   filled = 0;
                 }
               }
               if (filled > 0) sink(std::span(part).first(n * filled));
             });
  }

  /// The box of all vertices, with half the largest width.
  std::vector<double> bounds() const {
    Box3f box;
    float widest = 0;
    for (size_t s = 0; s < strands_.strand_count(); ++s) {
      for (size_t i = 0; i < vertices_.count(s); ++i) {
        const AlembicCurveVertex v = vertices_.vertex(s, i);
        box.extendBy(v.position);
        widest = std::max(widest, v.width);
      }
    }
    if (box.isEmpty()) return std::vector<double>(6, 0.0);
    const V3f margin(0.5f * widest), low = box.min - margin, high = box.max + margin;
    return {low.x, low.y, low.z, high.x, high.y, high.z};
  }

  std::span<const float> root_uv() const {
    const std::vector<V2f>& uv = strands_.arrays().root_uv;
    return uv.empty() ? std::span<const float>() : std::span(&uv[0].x, 2 * uv.size());
  }

  AlembicWriter& writer_;
  const Strands& strands_;
  const AlembicCurvesFacts& facts_;
  const bool unreal_;
  const AlembicCurveVertices vertices_;
};

}  // namespace

std::vector<std::string> lost_alembic_attributes(const Strands& strands, const AlembicCurvesFacts& facts) {
  const std::vector<std::string> names = param_names(strands, facts);
  std::vector<std::string> lost;
  for (size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) lost.push_back(strands.attributes()[i].name);
  }
  return lost;
}

void add_alembic_curves(AlembicWriter& writer, AlembicObjectWriter& parent, const std::string& name,
                        const Strands& strands, const AlembicCurvesFacts& facts) {
  parent.add(AlembicCurvesObject(writer, strands, facts).write(name));
}

AlembicObjectWriter alembic_groom(AlembicWriter& writer, const std::string& name) {
  constexpr const char* kSchema = "AbcGeom_Xform_v3";
  AlembicObjectWriter object(writer, name,
                             {{"schema", kSchema}, {"schemaObjTitle", std::string(kSchema) + ":.xform"}});
  constexpr int16_t kMajor = 1, kMinor = 4;
  const std::string tool = std::string("Pelage ") + version();
  AlembicCompoundWriter transform(writer), params(writer), user(writer);
  const std::span<const int16_t> major(&kMajor, 1), minor(&kMinor, 1);
  // Releases of Unreal read either of the two.
  const AlembicMetadata constant = param_metadata(Scope::kConstant, "int16_t", 1);
  params.array("groom_version_major", major, 1, constant);
  params.array("groom_version_minor", minor, 1, constant);
  params.array("groom_tool", tool, param_metadata(Scope::kConstant, "string", 1));
  user.scalar("groom_version_major", major);
  user.scalar("groom_version_minor", minor);
  user.scalar("groom_tool", tool);
  transform.add(".arbGeomParams", {}, std::move(params));
  transform.add(".userProperties", {}, std::move(user));
  object.properties.add(".xform", {{"schema", kSchema}}, std::move(transform));
  return object;
}

}  // namespace pelage
