// SPDX-License-Identifier: Apache-2.0
#include "exchange/scene_export.h"

#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "base/file.h"
#include "geom/alembic/alembic_archive.h"
#include "geom/alembic/alembic_validation.h"
#include "geom/curve_bounds.h"
#include "geom/io/mesh_file.h"
#include "geom/io/strand_file.h"
#include "geom/usd/usd_stage.h"
#include "geom/usd/usd_validation.h"
#include "geom/usd/usd_values.h"
#include "tests/world/furry_scene.h"
#include "world/grow_coat.h"

namespace pelage::scene_export_test {
namespace {

class SceneExport : public testing::Test {
 protected:
  std::filesystem::path write(ExportFormat format, std::vector<Override> overrides = {},
                              const std::string& name = "out") {
    QuietJob job;
    overrides.insert(overrides.begin(), kColor);
    const SceneDescription scene = load_scene(files_.scene(), overrides);
    const auto assets = load_assets(scene, job);
    const std::filesystem::path folder = files_.path(name);
    files_of_export_ = export_scene(folder, format, {files_.scene(), scene, *assets}, job);
    return folder;
  }
  Strands grown(const std::string& coat, const std::vector<Override>& overrides) {
    QuietJob job;
    const SceneDescription scene = load_scene(files_.scene(), overrides);
    const auto assets = load_assets(scene, job);
    return grow_coat(compose(scene, *assets, 1, job, CoordinateOrigin::kWorld), coat, job);
  }
  const FurryScene files_;
  std::vector<std::filesystem::path> files_of_export_;
};

const Override kStill{"camera.shutter", "[0, 0]"};

TEST_F(SceneExport, UsdRoundTripKeepsTheStrands) {
  const std::filesystem::path folder = write(ExportFormat::kUsd, {kStill});
  EXPECT_EQ(files_of_export_, std::vector<std::filesystem::path>{folder / "fur.usda"});
  for (const char* coat : {"walker.coat", "post.whiskers"}) {
    const Strands expected = grown(coat, {kStill});
    std::string file = coat;
    std::replace(file.begin(), file.end(), '.', '_');
    const Strands read = read_strands(folder / "coats" / (file + ".usda")).strands;
    ASSERT_EQ(read.strand_count(), expected.strand_count());
    EXPECT_EQ(read.basis(), expected.basis());
    EXPECT_EQ(read.arrays().ids, expected.arrays().ids) << "law 2";
    EXPECT_EQ(read.arrays().root_uv, expected.arrays().root_uv);
    EXPECT_EQ(read.arrays().first_point, expected.arrays().first_point);
    // The skin without motion has no rounding at all; floats are written exactly.
    EXPECT_EQ(read.arrays().points, expected.arrays().points);
    if (const StrandAttribute* color = expected.find_attribute("color")) {
      ASSERT_NE(read.find_attribute("color"), nullptr);
      EXPECT_EQ(read.find_attribute("color")->frequency, color->frequency);
      EXPECT_EQ(read.find_attribute("color")->values, color->values);
    }
  }
}

TEST_F(SceneExport, LightsKeepTheirPowerWithoutSpreadAndDoors) {
  const std::string panel = "{type: rectangle, position: [0, 5, 0], look_at: [0, 0, 0], power: 100";
  const auto intensity = [&](const std::string& shaping, const std::string& name) {
    const std::filesystem::path folder =
        write(ExportFormat::kUsd, {{"lights.panel", panel + shaping + "}"}, {"render.samples", "1"}}, name);
    const std::string text = read_file(folder / "fur.usda");
    const size_t at = text.find("inputs:intensity = ", text.find("\"panel\""));
    EXPECT_NE(at, std::string::npos) << text;
    return std::stod(text.substr(at + std::string("inputs:intensity = ").size()));
  };
  const double plain = intensity("", "plain");
  EXPECT_NEAR(plain, 100 / M_PI, 0.01);
  EXPECT_NEAR(intensity(", spread: 14, barn_doors: {length: 1}", "shaped"), plain, 1e-4 * plain);
  EXPECT_NE(read_file(files_.path("shaped/README.md"))
                .find("its barn doors and the limits of its spread are lost: it shines in more directions"),
            std::string::npos);
}

TEST_F(SceneExport, UsdStageIsValidAndOpensWithoutStrands) {
  const std::filesystem::path folder = write(ExportFormat::kUsd);
  const ValidationReport findings = validate_usd(folder / "fur.usda");
  EXPECT_EQ(findings.problems, std::vector<std::string>());
  EXPECT_EQ(findings.strands, 930u);
  EXPECT_EQ(findings.meshes, 2u);
  // Whoever opens the stage reads this file alone.
  EXPECT_LT(std::filesystem::file_size(folder / "fur.usda"), 20'000u);
}

TEST_F(SceneExport, UsdLeavesMoveWithinTheShutter) {
  const std::filesystem::path folder = write(ExportFormat::kUsd);
  const std::string text = read_file(folder / "coats" / "walker_coat" / "leaf_0.usda");
  for (const char* time : {"\n        0.75: [", "\n        1: [", "\n        1.25: ["})
    EXPECT_NE(text.find(time), std::string::npos) << time;
  EXPECT_NE(text.find("extent.timeSamples"), std::string::npos);
  EXPECT_NE(text.find("token primvars:groom:role = \"under\""), std::string::npos);
  EXPECT_NE(text.find("string primvars:groom:coat = \"walker.coat\""), std::string::npos);
}

TEST_F(SceneExport, UsdFramesBecomeTimeSamples) {
  const std::filesystem::path folder = write(ExportFormat::kUsd, {kStill, {"frames", "1-3"}});
  const std::string text = read_file(folder / "coats" / "walker_coat" / "leaf_0.usda");
  for (const char* time : {"\n        1: [", "\n        2: [", "\n        3: ["})
    EXPECT_NE(text.find(time), std::string::npos) << time;
  const std::string still = read_file(folder / "coats" / "post_whiskers" / "leaf_0.usda");
  EXPECT_EQ(still.find("timeSamples"), std::string::npos) << "the post does not move";
}

TEST_F(SceneExport, UsdMeshIsTheCage) {
  const std::filesystem::path folder = write(ExportFormat::kUsd, {kStill});
  const ControlMesh mesh = read_mesh_file(folder / "skins" / "post_still.usda");
  const ControlMesh cage = read_mesh_file(files_.path("cube.obj"));
  EXPECT_EQ(mesh.positions, cage.positions);
  EXPECT_EQ(mesh.face_vertices, cage.face_vertices);
  EXPECT_EQ(mesh.creases.size(), cage.creases.size());
}

/// A light of the stage has the place, direction, size and radiance of the scene.
TEST_F(SceneExport, UsdLightsAndCamera) {
  const std::filesystem::path folder = write(ExportFormat::kUsd, {kStill});
  ReadWarnings warnings;
  UsdStage stage(folder / "fur.usda", warnings);
  int seen = 0;
  stage.visit([&](const UsdPrim& prim) {
    const auto number = [&](const char* attribute) {
      const UsdValue value = prim.find(attribute).value();
      return usd_floats(*value.layer, value.text, usd_components(value.attribute->type));
    };
    if (prim.path == "/scene/lights/key") {
      ++seen;
      EXPECT_EQ(prim.type, "RectLight");
      EXPECT_FLOAT_EQ(number("inputs:intensity")[0], 9);  // of (1, 2, 3) times 3
      EXPECT_FLOAT_EQ(number("inputs:color")[0] * 9, 3);
      EXPECT_EQ(number("inputs:width")[0], 2);
      const V3f position = V3f(0) * prim.to_world;
      V3f shines;
      prim.to_world.multDirMatrix(V3f(0, 0, -1), shines);
      EXPECT_EQ(position, V3f(5, 8, 5));
      EXPECT_NEAR(shines.dot(-position.normalized()), 1, 1e-6);
      EXPECT_NEAR(prim.to_world.determinant(), 1, 1e-5) << "not mirrored";
    }
    if (prim.path == "/scene/camera") {
      ++seen;
      const float aperture = number("verticalAperture")[0], focal = number("focalLength")[0];
      EXPECT_NEAR(2 * std::atan(0.5f * aperture / focal) * 180 / M_PI, 40, 1e-3);
      EXPECT_NEAR(number("horizontalAperture")[0] / aperture, 1.5f, 1e-5);
      const V3f at = V3f(0, 0, -1) * prim.to_world, from = V3f(0) * prim.to_world;
      EXPECT_NEAR((from - V3f(3, 2, 8)).length(), 0, 1e-5);
      EXPECT_NEAR((at - from).dot((V3f(1, 0, 0) - from).normalized()), 1, 1e-5);
    }
    if (prim.path == "/scene/materials/fur/hair") {
      ++seen;
      EXPECT_EQ(prim.token("info:id", ""), "ND_chiang_hair_bsdf");
    }
  });
  EXPECT_EQ(seen, 3);
}

/// Curves of a pbrt file: P of each.
TEST_F(SceneExport, PbrtHasTheStrandsAsCurves) {
  const std::filesystem::path folder =
      write(ExportFormat::kPbrt, {kStill, {"materials.fur", "{model: chiang, color: 0.3}"}});
  const std::string scene = read_file(folder / "fur.pbrt");
  for (const char* part :
       {"Camera \"perspective\"", "WorldBegin", "AreaLightSource \"diffuse\" \"rgb L\" [ 3 6 9 ]",
        "LightSource \"infinite\"", "MakeNamedMaterial \"fur\" \"string type\" \"hair\"",
        "\"float alpha\" [ -2 ]", "Include \"coats/walker_coat.0.pbrt\"",
        "Shape \"plymesh\" \"string filename\" \"skins/walker_cube.ply\""})
    EXPECT_NE(scene.find(part), std::string::npos) << part;
  const std::string leaf = read_file(folder / "coats" / "walker_coat.0.pbrt");
  EXPECT_TRUE(leaf.starts_with("Shape \"curve\""));
}

TEST_F(SceneExport, MitsubaHasTheStrandsAsBSplines) {
  const std::filesystem::path folder = write(ExportFormat::kMitsuba, {kStill});
  const std::string scene = read_file(folder / "fur.xml");
  for (const char* part :
       {"<shape type=\"bsplinecurve\"><string name=\"filename\" value=\"coats/walker_coat.0.txt\"/>",
        "<bsdf type=\"hair\" id=\"fur\">", "<float name=\"scale_tilt\" value=\"-2\"/>",
        "<float name=\"fov\" value=\"40\"/>", "<emitter type=\"constant\">"})
    EXPECT_NE(scene.find(part), std::string::npos) << part;
  // 5 points and two phantom points of the first strand: the B-spline begins at its root.
  std::ifstream leaf(folder / "coats" / "walker_coat.0.txt");
  std::string line;
  std::vector<V3f> points;
  while (std::getline(leaf, line) && !line.empty()) {
    std::istringstream numbers(line);
    V3f p;
    numbers >> p.x >> p.y >> p.z;
    points.push_back(p);
  }
  ASSERT_EQ(points.size(), 7u);
  const V3f root = (points[0] + 4.0f * points[1] + points[2]) / 6.0f;
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(root[axis], points[1][axis], 1e-5);
}

TEST_F(SceneExport, AlembicHasTheStrandsOfEachCoat) {
  const std::filesystem::path folder = write(ExportFormat::kAlembic, {kStill});
  EXPECT_EQ(files_of_export_, std::vector<std::filesystem::path>{folder / "fur.abc"});
  const AlembicArchive archive(folder / "fur.abc");
  std::vector<std::string> names;
  for (const AlembicObject& character : archive.children(archive.top())) {
    for (const AlembicObject& coat : archive.children(character))
      names.push_back(std::string(character.name) + "." + std::string(coat.name));
  }
  EXPECT_EQ(names, (std::vector<std::string>{"walker.coat", "post.whiskers"}));
  // Two coats have the same ids, so their strands stay in the order of the file.
  const Strands read = read_strands(folder / "fur.abc").strands;
  std::vector<float> points;
  for (const std::string& name : names) {
    const Strands expected = grown(name, {kStill});
    points.insert(points.end(), expected.points().begin(), expected.points().end());
  }
  EXPECT_EQ(std::vector<float>(read.points().begin(), read.points().end()), points);
  ASSERT_NE(read.find_attribute("color"), nullptr);
  EXPECT_EQ(validate_alembic(folder / "fur.abc").problems, std::vector<std::string>());
  EXPECT_NE(read_file(folder / "README.md").find("the files hold only strands"), std::string::npos);
}

TEST_F(SceneExport, AlembicHasAFilePerFrame) {
  const std::filesystem::path folder = write(ExportFormat::kAlembic, {kStill, {"frames", "1-2"}});
  EXPECT_EQ(files_of_export_,
            (std::vector<std::filesystem::path>{folder / "fur.0001.abc", folder / "fur.0002.abc"}));
  const Strands first = read_strands(files_of_export_[0]).strands,
                second = read_strands(files_of_export_[1]).strands;
  ASSERT_EQ(first.point_count(), second.point_count());
  EXPECT_NE(first.point(0), second.point(0)) << "the walker moves";
  EXPECT_EQ(first.point(first.point_count() - 1), second.point(second.point_count() - 1))
      << "the post does not";
}

TEST_F(SceneExport, ReadmeStatesWhatIsLost) {
  const std::filesystem::path folder = write(ExportFormat::kPbrt);
  const std::string text = read_file(folder / "README.md");
  EXPECT_NE(text.find("Open `fur.pbrt`"), std::string::npos);
  EXPECT_NE(text.find("material 'fur': the model `cone-shell` became hair"), std::string::npos);
  EXPECT_NE(text.find("there is no motion blur"), std::string::npos);
}

}  // namespace
}  // namespace pelage::scene_export_test
