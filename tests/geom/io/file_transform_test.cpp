// SPDX-License-Identifier: Apache-2.0
#include "geom/io/file_transform.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/temporary_folder.h"
#include "geom/io/strand_file.h"
#include "geom/io/strand_reader.h"
#include "tests/geom/cages.h"
#include "tests/support/quiet_job.h"

namespace pelage::file_transform_test {

TEST(FileTransform, UpComesFirstThenUnitsScaleRotationAndTranslation) {
  FileTransformParams params;
  params.up = UpAxis::kZ;
  EXPECT_EQ(V3f(1, 2, 3) * params.matrix(), V3f(1, 3, -2));
  params.up = UpAxis::kX;
  EXPECT_EQ(V3f(1, 2, 3) * params.matrix(), V3f(-2, 1, 3));
  params.units.meters = 1;
  params.meters_per_unit = 0.5f;
  params.scale.along = V3f(1, 10, -1);
  params.rotate = V3f(0, 90, 0);
  params.translate = V3f(0, 0, 7);
  EXPECT_LT((V3f(1, 2, 3) * params.matrix() - V3f(-6, 20, 11)).length(), 1e-5f);
  EXPECT_NEAR(length_factor(params.matrix()), 2 * std::cbrt(10.0), 1e-5);
}

TEST(FileTransform, MirroredFacesKeepTheirOuterSide) {
  ControlMesh cage = make_cage({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 3, 2}});
  cage.uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  cage.face_uv = {0, 1, 2, 3};
  FileTransformParams params;
  params.scale.along = V3f(-1, 1, 1);
  transform_cage(params.matrix(), cage);
  const auto corner = [&](size_t i) { return cage.positions[cage.face_vertices[i]]; };
  EXPECT_GT((corner(1) - corner(0)).cross(corner(2) - corner(0)).z, 0);
  for (size_t i = 0; i < 4; ++i)
    EXPECT_EQ(cage.uv[cage.face_uv[i]].x, std::abs(corner(i).x)) << "texture coordinates stay with vertices";
}

TEST(FileTransform, StrandsAndTheirWidthsAreTransformedWhenTheyAreRead) {
  const TemporaryFolder folder;
  StrandArrays a;
  a.first_point = {0, 3};
  a.ids = {0};
  a.points = {0, 0, 0, 0.5f, 0, 0, 1, 0.25f, 0, 1, 2, 0};
  write_strands(folder.path() / "a.hair", Strands(a));
  FileTransformParams params;
  params.up = UpAxis::kZ;
  params.scale.along = V3f(2);
  params.translate = V3f(5, 0, 0);
  StrandReader reader(folder.path() / "a.hair", {}, params.matrix());
  reader.scan(QuietJob(1), [](size_t, const Strands&) {});
  const uint32_t first[] = {0};
  const Strands strands = reader.read(first);
  EXPECT_EQ(strands.point(1), V3f(5, 2, 0));
  EXPECT_EQ(strands.point(2), V3f(5, 4, -2));
  EXPECT_FLOAT_EQ(strands.radius(0), 1);
}

TEST(FileTransform, MistakesAreNamed) {
  const SourcePosition at{"scene.yaml", 3, 5};
  Problems problems;
  FileUnit unit;
  ScaleFactors scale;
  EXPECT_FALSE(ValueReader<FileUnit>::read(Value::scalar(at, "inches"), {}, unit, problems));
  EXPECT_FALSE(ValueReader<FileUnit>::read(Value::scalar(at, "-1"), {}, unit, problems));
  EXPECT_FALSE(ValueReader<ScaleFactors>::read(Value::scalar(at, "0"), {}, scale, problems));
  ASSERT_EQ(problems.list().size(), 3u);
  EXPECT_NE(problems.list()[0].message.find("did you mean 'inch'?"), std::string::npos);
  EXPECT_NE(problems.list()[2].message.find("leaves nothing"), std::string::npos);
}

}  // namespace pelage::file_transform_test
