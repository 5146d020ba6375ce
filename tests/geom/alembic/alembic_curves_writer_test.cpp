// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_curves_writer.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "geom/alembic/alembic_curve_vertices.h"
#include "geom/alembic/alembic_curves_file.h"
#include "geom/alembic/alembic_values.h"
#include "geom/curve.h"
#include "geom/io/alembic_strands.h"
#include "geom/io/strand_file.h"
#include "tests/geom/attributed_strands.h"

namespace pelage::alembic_curves_writer_test {
namespace {

StrandArrays with_everything(CurveBasis basis) {
  StrandArrays a = attributed_strands(basis);
  a.attributes.push_back(
      {"wide", AttributeClass::kPerStrand, 7, std::vector<float>(7 * a.ids.size(), 0.25f)});
  return a;
}

constexpr CurveBasis kBases[] = {CurveBasis::kPinnedBSpline, CurveBasis::kBSpline, CurveBasis::kLinear,
                                 CurveBasis::kCatmullRom};

TEST(AlembicCurvesWriter, RoundTripKeepsEverything) {
  const TemporaryFolder folder;
  for (const CurveBasis basis : kBases) {
    const StrandArrays written = with_everything(basis);
    const std::filesystem::path path = folder.path() / "a.abc";
    write_strands(path, Strands(written));
    const CurvesFile file = read_alembic_curves(path);
    EXPECT_TRUE(file.has_widths);
    EXPECT_EQ(file.warnings, std::vector<std::string>());
    EXPECT_EQ(file.strands.basis, basis);
    EXPECT_EQ(file.strands.first_point, written.first_point);
    EXPECT_EQ(file.strands.ids, written.ids);
    EXPECT_EQ(file.strands.root_uv, written.root_uv);
    EXPECT_EQ(file.strands.points, written.points);  // halving a width is exact
    EXPECT_EQ(file.strands.attributes.size(), written.attributes.size());
    for (const StrandAttribute& one : written.attributes) {
      EXPECT_EQ(attribute_of(file.strands, one.name).frequency, one.frequency) << one.name;
      EXPECT_EQ(attribute_of(file.strands, one.name).components, one.components) << one.name;
      EXPECT_EQ(attribute_of(file.strands, one.name).values, one.values) << one.name;
    }
    EXPECT_EQ(what_is_lost(path, Strands(written)), "");
  }
}

TEST(AlembicCurvesWriter, NamesOfTheSchemaAreLostOnlyIfTheFileHasThem) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.abc";
  StrandArrays written = with_everything(CurveBasis::kLinear);
  const std::vector<float> values(40, 0.5f);
  written.attributes.clear();
  for (const char* name : {"groom_roughness", "groom_group_id", "width", "id", "ids", "a/b"})
    written.attributes.push_back({name, AttributeClass::kPerStrand, 1, values});
  EXPECT_EQ(what_is_lost(path, Strands(written)), "");
  write_strands(path, Strands(written));
  const CurvesFile file = read_alembic_curves(path);
  EXPECT_EQ(file.warnings, std::vector<std::string>());
  EXPECT_EQ(file.strands.ids, written.ids);
  EXPECT_EQ(file.strands.points, written.points);
  ASSERT_EQ(file.strands.attributes.size(), 6u);
  written.attributes.back().name = "a_b";
  for (const StrandAttribute& one : written.attributes)
    EXPECT_EQ(attribute_of(file.strands, one.name).values, one.values) << one.name;
  for (const char* name : {"groom_id", "groom_root_uv", "groom_group_name", "a/b"})
    written.attributes.push_back({name, AttributeClass::kPerStrand, 1, values});
  EXPECT_EQ(what_is_lost(path, Strands(written)),
            "the attribute groom_id, the attribute groom_root_uv, the attribute groom_group_name, "
            "the attribute a/b");
  written.attributes = {{"groom_width", AttributeClass::kPerStrand, 1, values}};
  EXPECT_EQ(lost_alembic_attributes(Strands(written), alembic_facts(path, true, AlembicHost::kUnreal)),
            std::vector<std::string>{"groom_width"});
}

TEST(AlembicCurvesWriter, GuidesAmongStrandsStayMarked) {
  const TemporaryFolder folder;
  StrandArrays written = with_everything(CurveBasis::kLinear);
  std::vector<float> guide(40, 0);
  guide[3] = 1, guide[4] = 1e9f, guide[5] = NAN;
  written.attributes = {{"guide", AttributeClass::kPerStrand, 1, guide}};
  write_strands(folder.path() / "a.abc", Strands(written));
  const CurvesFile file = read_alembic_curves(folder.path() / "a.abc");
  guide[4] = guide[5] = 1;
  EXPECT_EQ(attribute_of(file.strands, "guide").values, guide);
  EXPECT_EQ(attribute_of(file.strands, "guide").frequency, AttributeClass::kPerStrand);
}

TEST(AlembicCurvesWriter, StrandsThatMoveAreWrittenAtTheirFirstKey) {
  const TemporaryFolder folder;
  RandomStrandOptions options;
  options.motion_keys = 2;
  const Strands moving = random_strands(3, options);
  write_strands(folder.path() / "a.abc", moving);
  const StrandArrays read = read_alembic_curves(folder.path() / "a.abc").strands;
  EXPECT_EQ(read.motion_keys, 1);
  EXPECT_EQ(read.points, std::vector<float>(moving.points(0).begin(), moving.points(0).end()));
}

/// The strands that a program sees which follows AbcGeom and knows nothing of Pelage.
Strands as_others_read(const StrandArrays& written, AlembicHost host, CurveBasis basis) {
  const Strands strands(written);
  const AlembicCurveVertices file(strands, host);
  StrandArrays a;
  a.basis = basis;
  a.first_point.push_back(0);
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    a.ids.push_back(s);
    a.first_point.push_back(a.first_point.back() + static_cast<uint32_t>(file.count(s)));
    for (size_t i = 0; i < file.count(s); ++i) {
      const AlembicCurveVertex v = file.vertex(s, i);
      a.points.insert(a.points.end(), {v.position.x, v.position.y, v.position.z, 0.5f * v.width});
    }
  }
  return Strands(std::move(a));
}

TEST(AlembicCurvesWriter, OtherProgramsSeeTheSameCurves) {
  StrandArrays written = with_everything(CurveBasis::kPinnedBSpline);
  written.attributes.clear();
  const Strands strands(written);
  const Strands others = as_others_read(written, AlembicHost::kAny, CurveBasis::kBSpline);
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    const uint32_t segments = segment_count(CurveBasis::kPinnedBSpline, strands.strand_points(s));
    ASSERT_EQ(segment_count(CurveBasis::kBSpline, others.strand_points(s)), segments);
    for (uint32_t i = 0; i < segments; ++i) {
      const CubicSegment a = bezier_segment(strands, s, i), b = bezier_segment(others, s, i);
      for (const float t : {0.0f, 0.3f, 1.0f}) {
        // Coordinates are below 4; a sum of four products of floats is good to some 1e-6.
        EXPECT_LT((curve_position(a, t) - curve_position(b, t)).length(), 3e-6f);
        // Widths beyond the ends are not below 0.
        EXPECT_GE(curve_radius(b, t), curve_radius(a, t) - 1e-6f);
      }
    }
  }
}

TEST(AlembicCurvesWriter, StrandsForUnrealAreOnTheCurves) {
  for (const CurveBasis basis : kBases) {
    StrandArrays written = with_everything(basis);
    const Strands strands(written);
    const Strands unreal = as_others_read(written, AlembicHost::kUnreal, CurveBasis::kLinear);
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      const uint32_t segments = segment_count(basis, strands.strand_points(s));
      ASSERT_EQ(unreal.strand_points(s), segments + 1);
      for (uint32_t i = 0; i <= segments; ++i) {
        const CubicSegment segment = bezier_segment(strands, s, std::min(i, segments - 1));
        const V3f p = curve_position(segment, i < segments ? 0.0f : 1.0f);
        const V3f q = unreal.point(unreal.first_point(s) + i);
        EXPECT_LT((V3f(p.x, p.z, p.y) - q).length(), 3e-6f);
      }
    }
  }
}

std::string text_of(const AlembicArchive& archive, const AlembicProperty& property) {
  EXPECT_EQ(property.pod, AlembicPod::kText);
  const std::span<const std::byte> bytes = archive.file().keep(archive.sample(property));
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.substr(0, text.find('\0'));
}

TEST(AlembicCurvesWriter, UnrealsSchemaIsComplete) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "rat.abc";
  StrandArrays written = with_everything(CurveBasis::kPinnedBSpline);
  const std::vector<float> tint{0.5f, 0.25f, 0.125f};
  written.attributes = {{"color", AttributeClass::kConstant, 3, tint},
                        {"guide", AttributeClass::kPerStrand, 1, std::vector<float>(40, 1)}};
  write_alembic_strands(path, Strands(written), {true, "rat", AlembicHost::kUnreal});
  const AlembicArchive archive(path);
  const std::vector<AlembicObject> top = archive.children(archive.top());
  ASSERT_EQ(top.size(), 1u);
  const auto compound = [&](const AlembicObject& object, const char* schema, const char* name) {
    const AlembicCompound properties = archive.properties(object);
    const AlembicCompound inner = archive.compound(*properties.find(schema));
    return archive.compound(*inner.find(name));
  };
  for (const char* place : {".arbGeomParams", ".userProperties"}) {
    const AlembicCompound facts = compound(top[0], ".xform", place);
    EXPECT_EQ(alembic_integers(archive, *facts.find("groom_version_major")), std::vector<int64_t>{1});
    EXPECT_EQ(alembic_integers(archive, *facts.find("groom_version_minor")), std::vector<int64_t>{4});
    EXPECT_EQ(text_of(archive, *facts.find("groom_tool")).substr(0, 6), "Pelage");
  }
  const AlembicObject hair = archive.children(top[0]).at(0);
  const AlembicCompound params = compound(hair, ".geom", ".arbGeomParams");
  const auto scope = [&](const char* name) {
    const AlembicProperty* property = params.find(name);
    return property ? alembic_metadata(property->metadata, "geoScope") : "missing";
  };
  EXPECT_EQ(text_of(archive, *params.find("groom_group_name")), "rat");
  EXPECT_EQ(scope("groom_group_name"), "con");
  EXPECT_EQ(scope("groom_id"), "uni");
  EXPECT_EQ(scope("groom_root_uv"), "uni");
  EXPECT_EQ(scope("groom_guide"), "uni");
  EXPECT_EQ(scope("groom_width"), "vtx");
  EXPECT_EQ(scope("groom_color"), "vtx");
  EXPECT_EQ(params.find("groom_guide")->pod, AlembicPod::kInt16);
  EXPECT_EQ(alembic_count(archive, *params.find("groom_color")),
            3 * alembic_count(archive, *params.find("groom_width")));
  const CurvesFile file = read_alembic_curves(path);
  EXPECT_EQ(file.strands.basis, CurveBasis::kLinear);
  EXPECT_EQ(file.strands.ids, written.ids);
  EXPECT_EQ(attribute_of(file.strands, "color").values[3], tint[0]);
}

}  // namespace
}  // namespace pelage::alembic_curves_writer_test
