// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary_folder.h"
#include "geom/alembic/alembic_curves_file.h"
#include "geom/alembic/alembic_values.h"
#include "tests/geom/alembic/ogawa_bytes.h"
#include "tests/geom/attributed_strands.h"

namespace pelage::alembic_curves_test {
namespace {

using namespace ogawa_bytes;

CurvesFile read(const std::string& bytes) {
  const TemporaryFolder folder;
  write_file(folder.path() / "a.abc", bytes);
  return read_alembic_curves(folder.path() / "a.abc");
}
/// The curves of a file with one object.
CurvesFile read_curves(const std::vector<int32_t>& counts, const std::string& form,
                       const std::vector<Part>& geometry, const std::vector<Part>& params,
                       OgawaBytes& bytes) {
  return read(bytes.file({bytes.curves("c", counts, form, geometry, params)}));
}

TEST(AlembicCurves, ValuesOfAllScopesLosePhantoms) {
  // Three curves of three points each, with phantoms; the width of vertex i of a curve is its x.
  for (const int basis : {2, 3}) {
    for (const std::string scope : {"vtx", "var", "fvr"}) {
      OgawaBytes b;
      const std::vector<float> x{0, 1, 2, 3, 4, 0, 1, 2, 3, 4, 0, 1, 2, 3, 4};
      const std::vector<Part> geometry{
          b.array("width", kFloat, 1, {raw(x)}, "geoScope=" + scope),
          b.compound(".userProperties", {b.scalar(kAlembicPhantomEnds, kInt16, 1, {raw<int16_t>({1})})})};
      const CurvesFile file = read_curves({5, 5, 5}, curve_form(0, 0, basis), geometry, {}, b);
      EXPECT_EQ(file.warnings, std::vector<std::string>());
      ASSERT_EQ(file.strands.points.size(), 4u * 9);
      for (size_t i = 0; i < 9; ++i)
        EXPECT_EQ(file.strands.points[4 * i + 3], 0.5f * file.strands.points[4 * i]) << scope;
    }
  }
  // One value per point, as programs count that know two varying values per segment of a B-spline.
  OgawaBytes b;
  const std::vector<Part> geometry{
      b.array("width", kFloat, 1, {raw<float>({2, 4, 6, 2, 4, 6})}, "geoScope=var"),
      b.compound(".userProperties", {b.scalar(kAlembicPhantomEnds, kInt16, 1, {raw<int16_t>({1})})})};
  const CurvesFile file = read_curves({5, 5}, curve_form(0, 0, 2), geometry, {}, b);
  EXPECT_EQ(file.warnings, std::vector<std::string>());
  for (size_t i = 0; i < 6; ++i) EXPECT_EQ(file.strands.points[4 * i + 3], file.strands.points[4 * i]);
}

TEST(AlembicCurves, AllTypesBasesAndWrapsAreRead) {
  const auto basis_of = [](const std::string& form, const std::vector<Part>& more, OgawaBytes& bytes) {
    return read_curves({7}, form, more, {}, bytes).strands;
  };
  const auto read_form = [&](int type, int wrap, int basis) {
    OgawaBytes bytes;
    return basis_of(curve_form(type, wrap, basis), {}, bytes);
  };
  EXPECT_EQ(read_form(1, 0, 0).basis, CurveBasis::kLinear);
  EXPECT_EQ(read_form(1, 0, 0).points.size(), 4u * 7);
  EXPECT_EQ(read_form(1, 1, 0).points.size(), 4u * 8);
  EXPECT_EQ(read_form(0, 0, 2).basis, CurveBasis::kBSpline);
  EXPECT_EQ(read_form(0, 0, 2).points.size(), 4u * 7);
  EXPECT_EQ(read_form(0, 1, 2).points.size(), 4u * 10);
  // Two Bezier segments, and four segments of Catmull-Rom, with points at sixths.
  for (const auto& [basis, points, last] : {std::tuple{1, 13u, 6.0f}, std::tuple{3, 25u, 5.0f}}) {
    const StrandArrays a = read_form(0, 0, basis);
    EXPECT_EQ(a.basis, CurveBasis::kCatmullRom);
    EXPECT_EQ(a.points.size(), 4 * points);
    EXPECT_NEAR(a.points[a.points.size() - 4], last, 1e-6f);
  }
  OgawaBytes knots;
  const std::vector<Part> clamped{
      knots.array(".knots", kFloat, 1, {raw<float>({0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4})})};
  const CurvesFile pinned = read_curves({7}, curve_form(0, 0, 2), clamped, {}, knots);
  EXPECT_EQ(pinned.strands.basis, CurveBasis::kPinnedBSpline);
  ASSERT_EQ(pinned.warnings.size(), 1u);
  EXPECT_NE(pinned.warnings[0].find("approximated by uniform B-splines"), std::string::npos);
  OgawaBytes orders;
  const std::vector<Part> cubic{orders.array(".orders", kUint8, 1, {"\4"})};
  EXPECT_EQ(basis_of(curve_form(2, 0, 0), cubic, orders).basis, CurveBasis::kBSpline);
  OgawaBytes power;
  try {
    basis_of(curve_form(0, 0, 5), {}, power);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(
        std::string(error.what()).find("has no curves; curves with the bases Hermite and power are skipped"),
        std::string::npos);
  }
}

TEST(AlembicCurves, BSplinesWithThreefoldKnotsAreBezierCurves) {
  const auto read_knots = [](const std::vector<int32_t>& counts, const std::vector<float>& knots, int basis) {
    OgawaBytes b;
    return read_curves(counts, curve_form(0, 0, basis), {b.array(".knots", kFloat, 1, {raw(knots)})}, {}, b);
  };
  const std::vector<float> one{0, 0, 0, 0, 1, 1, 1, 1}, two{0, 0, 0, 0, 1, 1, 1, 5, 5, 5, 5},
      without_ends{0, 0, 0, 1, 1, 1}, uniform{0, 1, 2, 3, 4, 5, 6, 7};
  for (const auto& [counts, knots] :
       {std::pair(std::vector<int32_t>{4}, one), std::pair(std::vector<int32_t>{7}, two),
        std::pair(std::vector<int32_t>{4}, without_ends)}) {
    const CurvesFile file = read_knots(counts, knots, 2), bezier = read_knots(counts, {}, 1);
    EXPECT_EQ(file.warnings, std::vector<std::string>());
    EXPECT_EQ(file.strands.basis, bezier.strands.basis);
    EXPECT_EQ(file.strands.points, bezier.strands.points);
  }
  const CurvesFile plain = read_knots({4}, uniform, 2);
  EXPECT_EQ(plain.warnings, std::vector<std::string>());
  EXPECT_EQ(plain.strands.basis, CurveBasis::kBSpline);
  // The knots of the second curve count, too.
  std::vector<float> both = uniform;
  both.insert(both.end(), one.begin(), one.end());
  const CurvesFile mixed = read_knots({4, 4}, both, 2);
  EXPECT_EQ(mixed.strands.basis, CurveBasis::kPinnedBSpline);
  EXPECT_EQ(mixed.warnings.size(), 1u);
  const CurvesFile misfit = read_knots({4}, two, 2);
  EXPECT_EQ(misfit.strands.basis, CurveBasis::kBSpline);
  ASSERT_EQ(misfit.warnings.size(), 1u);
  EXPECT_NE(misfit.warnings[0].find("knots that do not fit"), std::string::npos);
}

TEST(AlembicCurves, ScopesIndicesAndTypesOfParameters) {
  OgawaBytes b;
  const std::vector<Part> geometry{
      b.array("width", kDouble, 1, {raw<double>({0.5, 0.25})}, "geoScope=uni"),
      b.compound("uv",
                 {b.array(".vals", kFloat, 2, {raw<float>({0, 0.5f, 1, 0.25f})}, "geoScope=vtx"),
                  b.array(".indices", kUint32, 1, {raw<uint32_t>({1, 0, 0, 0, 1})})},
                 "geoScope=vtx")};
  const std::vector<Part> params{
      b.array("groom_id", kInt32, 1, {raw<int32_t>({9, 4})}, "geoScope=uni"),
      b.array("Cd", kFloat, 3, {raw<float>({1, 0, 0})}, "geoScope=con"),
      b.array("pair", kInt16, 1, {raw<int16_t>({1, 2, 3, 4})}, "geoScope=uni;arrayExtent=2"),
      b.array("name", kText, 1, {"text\0"}, "geoScope=con")};
  const CurvesFile file = read_curves({3, 2}, linear_form(), geometry, params, b);
  EXPECT_EQ(file.warnings, std::vector<std::string>());
  const StrandArrays& a = file.strands;  // sorted by ids: the curve of two points is first
  EXPECT_EQ(a.first_point, (std::vector<uint32_t>{0, 2, 5}));
  EXPECT_EQ(a.points[3], 0.125f);
  EXPECT_EQ(a.points[4 * 4 + 3], 0.25f);
  EXPECT_EQ(a.root_uv, (std::vector<V2f>{{0, 0.5f}, {1, 0.25f}}));
  EXPECT_EQ(attribute_of(a, "color").values, (std::vector<float>{1, 0, 0}));
  EXPECT_EQ(attribute_of(a, "pair").values, (std::vector<float>{3, 4, 1, 2}));
  EXPECT_EQ(a.attributes.size(), 2u);
}

TEST(AlembicCurves, UnusedParametersOfOtherSizesAreSkipped) {
  OgawaBytes b;
  const std::vector<Part> params{
      b.array("seeds", kFloat, 1, {raw<float>({1, 2, 3, 4, 5, 6, 7})}, "geoScope=con"),
      b.array("mine", kFloat, 1, {raw<float>({1, 2})}, "geoScope=uni")};
  const CurvesFile file = read_curves({3, 3}, linear_form(), {}, params, b);
  ASSERT_EQ(file.strands.attributes.size(), 1u);
  EXPECT_EQ(file.strands.attributes[0].name, "mine");
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_NE(file.warnings[0].find("'seeds' has 7 values; 6 vertices, 2 curves"), std::string::npos);
  for (const char* needed : {"width", "uv"}) {
    OgawaBytes bad;
    const std::vector<Part> geometry{bad.array(needed, kFloat, needed[0] == 'w' ? 1 : 2,
                                               {raw(std::vector<float>(14, 1))}, "geoScope=vtx")};
    EXPECT_THROW(read_curves({3, 3}, linear_form(), geometry, {}, bad), Error) << needed;
  }
}

TEST(AlembicCurves, GuidesAreSkippedUnlessThereIsNothingElse) {
  OgawaBytes b;
  const std::vector<Part> guide{b.array("groom_guide", kInt16, 1, {raw<int16_t>({1})}, "geoScope=con")},
      strand{b.array("groom_guide", kInt16, 1, {raw<int16_t>({0})}, "geoScope=con"),
             b.array("groom_width", kFloat, 1, {raw<float>({0.5f})}, "geoScope=con")};
  const Part guides = b.curves("g", {5, 5}, linear_form(), {}, guide);
  const CurvesFile both = read(b.file({guides, b.curves("s", {3}, linear_form(), {}, strand)}));
  EXPECT_EQ(both.strands.ids.size(), 1u);
  EXPECT_TRUE(both.has_widths);
  EXPECT_EQ(both.strands.points[3], 0.25f);
  ASSERT_EQ(both.warnings.size(), 1u);
  EXPECT_NE(both.warnings[0].find("guides (groom_guide) are skipped"), std::string::npos);
  EXPECT_EQ(read(b.file({guides})).strands.ids.size(), 2u);
}

TEST(AlembicCurves, TransformsVisibilityAndSamples) {
  OgawaBytes b;
  const auto transform = [&](const std::string& name, const std::string& ops,
                             const std::vector<double>& values, std::vector<Part> children,
                             bool inherits = true, int visible = -1) {
    const std::vector<Part> xform{
        b.scalar(".ops", kUint8, static_cast<uint32_t>(ops.size()), {ops}),
        b.scalar(".vals", kDouble, static_cast<uint32_t>(values.size()), {raw(values)}),
        b.scalar(".inherits", Pod(0), 1, {std::string(1, inherits ? '\1' : '\0')})};
    return b.object(name, "AbcGeom_Xform_v3",
                    {b.compound(".xform", xform),
                     b.scalar("visible", kInt8, 1, {std::string(1, static_cast<char>(visible))})},
                    children);
  };
  // Scale by 2, then turn (0, 1, 0) to (0, 0, 1), then move: operations of the list apply in reverse.
  const std::string ops{0x10, 0x40, 0x00};
  const std::vector<double> values{10, 20, 30, 90, 2, 2, 2};
  const auto widths = [&] { return std::vector<Part>{b.array("width", kFloat, 1, {raw<float>({0.5f})})}; };
  const Part near = b.curves("near", {2}, linear_form(), widths());
  const CurvesFile file = read(b.file({transform("t", ops, values, {near})}));
  EXPECT_EQ(file.warnings, std::vector<std::string>());
  const auto last = [](const CurvesFile& one) {
    const float* p = &one.strands.points[one.strands.points.size() - 4];
    return V3f(p[0], p[1], p[2]);
  };
  // (1, 1, 0) becomes (2, 2, 0), (2, 0, 2) and (12, 20, 32).
  EXPECT_LT((last(file) - V3f(12, 20, 32)).length(), 1e-5f);
  EXPECT_FLOAT_EQ(file.strands.points[3], 0.5f);  // half of 2 * 0.5
  // Rotation about an axis and a matrix do the same; a transform within them that does not inherit.
  const std::string others{0x30, 0x20};
  const std::vector<double> same{2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 10, 20, 30, 1, 1, 0, 0, 90};
  EXPECT_LT((last(read(b.file({transform("t", others, same, {near})}))) - V3f(12, 20, 32)).length(), 1e-5f);
  const std::string move{0x10};
  const Part own = transform("own", move, {1, 0, 0}, {b.curves("c", {2}, linear_form())}, false);
  EXPECT_LT((last(read(b.file({transform("t", ops, values, {own})}))) - V3f(2, 1, 0)).length(), 1e-5f);
  // A hidden transform hides its children, except those that state that they are visible.
  const Part shown = transform("shown", move, {5, 0, 0}, {b.curves("c", {3}, linear_form())}, true, 1);
  const Part hidden = b.curves("h", {2}, linear_form());
  const CurvesFile some = read(b.file({transform("t", move, {0, 0, 0}, {hidden, shown}, true, 0)}));
  EXPECT_EQ(some.strands.ids.size(), 1u);
  ASSERT_EQ(some.warnings.size(), 1u);
  EXPECT_NE(some.warnings[0].find("hidden objects are skipped"), std::string::npos);
  // The first of two samples.
  const std::vector<Part> moving{
      b.array("P", kFloat, 3, {raw<float>({1, 2, 3, 4, 5, 6}), raw<float>({0, 0, 0, 9, 9, 9})}),
      b.array("nVertices", kInt32, 1, {raw<int32_t>({2})}),
      b.scalar("curveBasisAndType", kUint8, 4, {linear_form()})};
  const CurvesFile first = read(b.file({b.object("m", "AbcGeom_Curve_v2", {b.compound(".geom", moving)})}));
  EXPECT_EQ(last(first), V3f(4, 5, 6));
  ASSERT_EQ(first.warnings.size(), 1u);
  EXPECT_NE(first.warnings[0].find("time samples after the first are skipped"), std::string::npos);
}

TEST(AlembicCurves, AFileMayBeCutWhileItIsOpen) {
  OgawaBytes b;
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.abc";
  write_file(path, b.file({b.curves("c", {5000}, linear_form())}));
  const AlembicArchive archive(path);
  const AlembicObject curves = archive.children(archive.top()).at(0);
  const AlembicCompound properties = archive.properties(curves);
  const AlembicCompound geometry = archive.compound(*properties.find(".geom"));
  EXPECT_EQ(alembic_floats(archive, *geometry.find("P")).size(), 15'000u);
  std::filesystem::resize_file(path, 1000);
  try {
    alembic_floats(archive, *geometry.find("P"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_NE(std::string(error.what()).find("a.abc: became shorter while it was read (byte "),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace pelage::alembic_curves_test
