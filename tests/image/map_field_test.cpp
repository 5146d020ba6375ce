// SPDX-License-Identifier: Apache-2.0
#include "image/map_field.h"

#include <fstream>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "image/udim.h"

namespace pelage::map_field_test {
namespace {

/// The unit ball as the skin of a field.
struct BallSkin final : FieldSkin {
  std::string name() const override { return "skin 'ball'"; }
  Box3f bounds() const override { return {V3f(-1), V3f(1)}; }
  ContentHash attributes_hash() const override { return {}; }
  std::vector<std::string> groups() const override { return {}; }
  std::shared_ptr<const SkinValues> group(const std::string&) const override { return nullptr; }
  std::shared_ptr<const SkinValues> vertex_colors() const override { return nullptr; }
  std::shared_ptr<const SkinValues> curvature() const override { return nullptr; }
  std::shared_ptr<const SkinValues> distance_to_boundary(const Field&) const override { return nullptr; }
  std::shared_ptr<const SkinValues> distance_to_mesh(const AssetPath&) const override { return nullptr; }
};

class MapFields : public testing::Test {
 protected:
  /// Writes a grey image whose rows from the top have these bytes.
  std::filesystem::path write(const std::string& name, int width, int height,
                              std::initializer_list<int> bytes) {
    std::ofstream out(folder_.path() / name, std::ios::binary);
    out << "P5\n" << width << " " << height << "\n255\n";
    for (const int byte : bytes) out.put(static_cast<char>(byte));
    return folder_.path() / name;
  }
  Field load(MapForm form) {
    form.channel = MapChannel::kR;
    return map_field(std::move(form)).with_textures({library_, &skin_});
  }

  TemporaryFolder folder_;
  MemoryLedger ledger_;
  TextureLibrary library_{ledger_};
  BallSkin skin_;
};

float at_uv(const Field& field, float u, float v) {
  FieldPoint point;
  point.u = u;
  point.v = v;
  return field.value(point);
}

float on_ball(const Field& field, V3f direction) {
  FieldPoint point;
  point.rest = point.normal = direction.normalized();
  return field.value(point);
}

TEST_F(MapFields, EndInBlackIfAsked) {
  MapForm form;
  form.map = {write("white.pgm", 2, 1, {255, 255}), {}};
  form.wrap = MapWrap::kBlack;
  form.range = {0.5f, 2};
  const Field black = load(form);
  EXPECT_EQ(at_uv(black, 0.9f, 0.5f), 2);
  for (const auto& [u, v] : {std::pair(1.1f, 0.5f), std::pair(-0.1f, 0.5f), std::pair(0.5f, 1.5f)})
    EXPECT_EQ(at_uv(black, u, v), 0.5f);
  EXPECT_EQ(black.value_range(), std::pair(0.5f, 2.0f));
  form.wrap = MapWrap::kClamp;
  EXPECT_EQ(at_uv(load(form), 1.1f, 0.5f), 2);
}

TEST_F(MapFields, ReadUdimTiles) {
  write("a.1001.pgm", 1, 1, {51});
  write("a.1002.pgm", 1, 1, {102});
  write("a.1011.pgm", 1, 1, {204});
  for (const char* name : {"a.<UDIM>.pgm", "a.%(UDIM)d.pgm"}) {
    MapForm form;
    form.map = {folder_.path() / name, {}};
    const Field field = load(form);
    EXPECT_NEAR(at_uv(field, 0.3f, 0.3f), 0.2f, 1e-5f);
    EXPECT_NEAR(at_uv(field, 1.3f, 0.3f), 0.4f, 1e-5f);
    EXPECT_NEAR(at_uv(field, 0.3f, 1.3f), 0.8f, 1e-5f);
    EXPECT_EQ(at_uv(field, 5, 5), 0) << "no tile";
    EXPECT_EQ(field.files().size(), 3u);
    EXPECT_NEAR(field.value_range().second, 0.8f, 1e-5f);
  }
  EXPECT_EQ(tile_at(9.5f, 0), 1010);
  EXPECT_EQ(tile_at(10, 0), 0);
  EXPECT_EQ(tile_at(-0.1f, 0), 0);
  MapForm form;
  form.map = {folder_.path() / "b.<UDIM>.pgm", {"s.yaml", 3, 5}};
  try {
    load(form);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("s.yaml:3:5: no tile of the map exists"), std::string::npos)
        << error.what();
  }
}

// A map of four quarters: dark below, bright above; odd steps to the right.
TEST_F(MapFields, LieOnTheSkinWithoutTextureCoordinates) {
  MapForm form;
  form.map = {write("quarters.pgm", 2, 2, {102, 153, 0, 51}), {}};
  form.projection = MapProjection::kPlanar;
  const Field front = load(form);
  EXPECT_NEAR(on_ball(front, V3f(-1, -1, 0.1f)), 0, 0.05f);
  EXPECT_NEAR(on_ball(front, V3f(1, -1, 0.1f)), 0.2f, 0.05f);
  EXPECT_NEAR(on_ball(front, V3f(-1, 1, 0.1f)), 0.4f, 0.05f);
  EXPECT_NEAR(on_ball(front, V3f(1, 1, -0.1f)), 0.6f, 0.05f);
  EXPECT_TRUE(front.dependence().rest);
  EXPECT_TRUE(front.maps(true).empty()) << "no texture coordinates";
  EXPECT_EQ(front.maps().size(), 1u);

  form.projection = MapProjection::kTriplanar;
  const Field three = load(form);
  EXPECT_NEAR(on_ball(three, V3f(-0.3f, -0.3f, 1)), on_ball(front, V3f(-0.3f, -0.3f, 1)), 0.02f);
  EXPECT_TRUE(three.dependence().normal);

  form.projection = MapProjection::kSphere;
  const Field sphere = load(form);
  EXPECT_NEAR(on_ball(sphere, V3f(-1, -1, 0)), 0, 0.05f);
  EXPECT_NEAR(on_ball(sphere, V3f(1, -1, 0)), 0.2f, 0.05f);
  EXPECT_NEAR(on_ball(sphere, V3f(1, 1, 0)), 0.6f, 0.05f);
  EXPECT_NEAR(on_ball(sphere, V3f(0, -1, 1)), 0.1f, 0.05f) << "the middle of the image is in front";

  form.projection = MapProjection::kCylinder;
  form.center = V3f(0, 2, 0);
  form.size = V3f(1, 10, 1);
  form.wrap = MapWrap::kClamp;
  EXPECT_LT(on_ball(load(form), V3f(-1, 0, 0)), 0.2f) << "below the middle of the image";
  form.center = form.size = {};

  form.projection = MapProjection::kFace;
  const Field faces = load(form);
  FieldPoint point;
  point.face_uv = {0.9f, 0.1f};
  EXPECT_NEAR(faces.value(point), 0.2f, 1e-3f);
  EXPECT_FALSE(faces.dependence().rest);
}

TEST_F(MapFields, NeedTheBoundsOfOneSkinOrABox) {
  MapForm form;
  form.map = {write("white.pgm", 1, 1, {255}), {"s.yaml", 2, 8}};
  form.projection = MapProjection::kPlanar;
  EXPECT_THROW(map_field(form).with_textures(library_), Error);
  form.center = V3f(0);
  form.size = V3f(2);
  EXPECT_EQ(map_field(form).with_textures(library_).value({}), 1);
}

}  // namespace
}  // namespace pelage::map_field_test
