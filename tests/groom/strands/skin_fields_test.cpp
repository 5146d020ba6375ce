// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/skin_fields.h"

#include <cstring>
#include <fstream>

#include "base/temporary_folder.h"
#include "geom/io/obj_file.h"
#include "groom/strands/strand_fields.h"
#include "tests/groom/operator_harness.h"
#include "tests/groom/scene_text.h"

namespace pelage::skin_fields_test {
namespace {

/// Two quads and a pentagon side by side in the plane z = 0, from x = 0 to x = 3.
constexpr const char* kStrip = R"(v 0 0 0 1 0 0
v 1 0 0 0 1 0
v 2 0 0
v 3 0 0 0 0 1
v 0 1 0 1 0 0
v 1 1 0 0 1 0
v 2 1 0
v 3 1 0 0 0 1
v 3 0.5 0 0 0 1
o strip
usemtl hide
g left ears
f 1 2 6 5
g middle
usemtl nose
f 2 3 7 6
f 3 4 9 8 7
)";

class SkinFieldTest : public OperatorTest {
 protected:
  SkinFieldTest() {
    std::ofstream(folder_.path() / "strip.obj") << kStrip;
    cage_ = read_obj(folder_.path() / "strip.obj");
    for (const SubdivisionScheme scheme : {SubdivisionScheme::kBilinear, SubdivisionScheme::kNone}) {
      surfaces_.push_back(std::make_unique<LimitSurface>(
          SurfaceTopology::create(cage_, scheme, BoundaryRule::kEdgeAndCorner, "strip.obj"),
          cage_.positions));
    }
  }

  /// Values of a field at (u, v) of each face, and where the surface is there.
  struct Sample {
    V3f at;
    Rgb value;
  };
  std::vector<Sample> sample(const LimitSurface& surface, const std::string& text, float u, float v) {
    const SkinFields skin("skin 'strip'", surface, cage_, job_);
    const Field field = scene_text::read<Field>(text).with_textures({textures_, &skin});
    std::vector<Sample> samples;
    for (uint32_t face = 0; face < surface.topology().face_count(); ++face) {
      FieldPoint point;
      point.rest = surface.evaluate(face, u, v).position;
      point.normal = surface.frame(face, u, v).normal;
      point.face = face;
      point.face_uv = {u, v};
      samples.push_back({point.rest, field.color(point)});
      const auto [low, high] = field.value_range();
      EXPECT_GE(field.value(point), low - 1e-5f) << text;
      EXPECT_LE(field.value(point), high + 1e-5f) << text;
    }
    return samples;
  }

  TemporaryFolder folder_;
  ControlMesh cage_;
  std::vector<std::unique_ptr<LimitSurface>> surfaces_;
};

TEST_F(SkinFieldTest, GroupsObjectsAndMaterialsAreNamesOfFaces) {
  for (const auto& surface : surfaces_) {
    for (const auto& [x, y] : {std::pair(0.3f, 0.3f), std::pair(0.1f, 0.6f)}) {
      for (const auto& [name, first, last] :
           {std::tuple("ears", 0.0f, 1.0f), std::tuple("left ears", 0.0f, 1.0f),
            std::tuple("middle", 1.0f, 3.0f), std::tuple("hide", 0.0f, 1.0f), std::tuple("nose", 1.0f, 3.0f),
            std::tuple("strip", 0.0f, 3.0f)}) {
        for (const Sample& s : sample(*surface, std::string("{group: ") + name + "}", x, y))
          EXPECT_EQ(s.value.x, s.at.x > first && s.at.x < last ? 1 : 0) << name << s.at;
      }
    }
  }
}

TEST_F(SkinFieldTest, AnUnknownGroupIsNamedWithTheNearest) {
  const SkinFields skin("skin 'strip'", *surfaces_[0], cage_, job_);
  try {
    scene_text::read<Field>("{group: midle}").with_textures({textures_, &skin});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "scene.yaml:2:11: the mesh of skin 'strip' has no group 'midle'; did you mean 'middle'?");
  }
  cage_.colors.clear();
  EXPECT_THROW(scene_text::read<Field>("{vertex_color: }").with_textures({textures_, &skin}), Error);
}

TEST_F(SkinFieldTest, VertexColorsAreInterpolatedOverFaces) {
  for (const auto& surface : surfaces_) {
    for (const Sample& s : sample(*surface, "{vertex_color: }", 0.25f, 0.5f)) {
      if (s.at.x > 2) continue;  // in the pentagon, weights depend on how it is divided
      const float x = s.at.x;
      EXPECT_NEAR(s.value.x, x < 1 ? 1 - x : x - 1, 1e-5f) << s.at;
      EXPECT_NEAR(s.value.y, x < 1 ? x : 1, 1e-5f) << s.at;
      EXPECT_NEAR(s.value.z, x < 1 ? 0 : x - 1, 1e-5f) << s.at;
    }
    for (const Sample& s : sample(*surface, "{vertex_color: g}", 0.25f, 0.5f))
      EXPECT_EQ(s.value.x, s.value.z);
  }
}

TEST_F(SkinFieldTest, HeightCoversTheSkin) {
  for (const Sample& s : sample(*surfaces_[0], "{height: x}", 0.25f, 0.5f))
    EXPECT_NEAR(s.value.x, s.at.x / 3, 1e-5f);
}

TEST_F(SkinFieldTest, DistancesFromBoundariesAndMeshes) {
  std::ofstream(folder_.path() / "far.obj") << "v 0 0 2\nv 3 0 2\nv 3 1 2\nv 0 1 2\nf 1 2 3 4\n";
  for (const auto& surface : surfaces_) {
    const std::string edge = "{threshold: {ramp: {along: x, knots: [[0, 0], [3, 3]]}}, at: 1.4, width: 1}";
    for (const Sample& s : sample(*surface, "{distance: {boundary: " + edge + "}}", 0.25f, 0.5f))
      EXPECT_NEAR(s.value.x, std::abs(s.at.x - 1.4f), 2e-3f) << s.at;
    const std::string mesh = (folder_.path() / "far.obj").string();
    for (const Sample& s : sample(*surface, "{distance: {mesh: " + mesh + "}}", 0.25f, 0.5f))
      EXPECT_NEAR(s.value.x, 2, 1e-5f);
  }
  const SkinFields skin("skin 'strip'", *surfaces_[0], cage_, job_);
  for (const char* bad : {"{distance: {boundary: 0.2}}", "{distance: {mesh: missing.obj}}"})
    EXPECT_THROW(scene_text::read<Field>(bad).with_textures({textures_, &skin}), Error) << bad;
}

TEST_F(SkinFieldTest, CurvatureOfABallIsItsInverseRadius) {
  const ControlMesh ball = shapes::ball_cage(1.2f);
  const SkinFields skin("skin 'ball'", *rest_, ball, job_);
  const Field field = scene_text::read<Field>("{curvature: 1}").with_textures({textures_, &skin});
  FieldPoint point;
  const float radius = rest_->evaluate(0, 0, 0).position.length();
  EXPECT_NEAR(field.value(point), 1 / radius, 0.15f / radius);
}

// Evaluating a tree of fields in rows gives the bits of evaluating it at one point.
TEST_F(SkinFieldTest, RowsEqualSinglePoints) {
  const Field field = scene_text::read<Field>(
                          "{mix: [{add: [{noise: {frequency: 3}}, {ramp: {along: strand, knots: [[0, 0], [1, "
                          "[1, 2, 3]]]}}]}, "
                          "{product: [{slope: y}, {attribute: random}, [0.2, 0.4, 0.6]]}], "
                          "by: {threshold: {remap: {sphere: 1, center: [1, 0, 0], soft: 1}, knots: [[0, "
                          "0.2], [1, 0.8]]}, width: 1}}")
                          .with_textures(textures_);
  const auto batch = straight();
  StrandField rows(field, *batch);
  StrandColor colors(field, *batch);
  for (int p = 0; p < batch->point_count(); ++p) {
    const StrandRow row = rows.at(batch->along(p));
    VectorRow color;
    colors.at(p, color);
    for (size_t s = 0; s < batch->count; ++s) {
      FieldPoint point;
      point.rest = vector_at(batch->rest.position, s);
      point.normal = vector_at(batch->rest.normal, s);
      point.along = batch->along(p);
      const FieldAttribute random{"random",
                                  Rgb(unit_float(hash64(batch->ids[s], random_use("field random"))))};
      point.attributes = std::span(&random, 1);
      const Rgb right = field.color(point);
      EXPECT_EQ(row[s], right.x);
      EXPECT_EQ(color[1][s], right.y);
      EXPECT_EQ(color[2][s], right.z);
    }
  }
}

}  // namespace
}  // namespace pelage::skin_fields_test
