// SPDX-License-Identifier: Apache-2.0
// Photometric files: how they are read, and the lamps that shine by them.
#include "render/light/light_profile.h"

#include <fstream>
#include <numbers>

#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include "base/error.h"
#include "base/temporary_folder.h"
#include "image/texture_library.h"
#include "render/light/light_params.h"
#include "tests/render/light/light_checks.h"

namespace pelage::light_profile_test {
namespace {

/// Writes a file with the numbers after TILT=NONE, and reads it.
IesPhotometry read_text(const std::string& text) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "lamp.ies") << text;
  return read_ies(folder.path() / "lamp.ies");
}

std::string file_of(const std::string& sizes, const std::string& angles_and_candela) {
  return "IESNA:LM-63-1995\n[TEST] 1\n[MANUFAC] none\nTILT=NONE\n1 1000 1 " + sizes + " 1 2 0 0 0\n1 1 50\n" +
         angles_and_candela;
}

LightProfile profile_of(const std::string& sizes, const std::string& rest) {
  return LightProfile(read_text(file_of(sizes, rest)));
}

/// Direction of a lamp that shines along z, for angles of the file in degrees.
V3f at_angles(double vertical, double horizontal) {
  const double v = vertical * std::numbers::pi / 180, h = horizontal * std::numbers::pi / 180;
  return V3f(V3d(-std::sin(v) * std::sin(h), -std::sin(v) * std::cos(h), std::cos(v)));
}

// One of each symmetry; intensities have a step, a peak and zeros.
const LightProfile around() { return profile_of("4 1", "0 30 90 120 0 100 60 20 0"); }
const LightProfile quadrant() { return profile_of("3 3", "0 45 90 0 30 90 90 50 10 90 70 20 90 80 40"); }
const LightProfile half() { return profile_of("3 3", "0 90 180 0 90 180 50 10 30 50 20 30 50 70 30"); }
const LightProfile crosswise() { return profile_of("3 3", "0 90 180 90 180 270 50 10 30 50 20 30 50 70 30"); }
const LightProfile whole() { return profile_of("2 5", "0 90 0 90 180 270 360 8 1 8 2 8 3 8 4 8 1"); }

TEST(IesFile, ReadsNumbersWhereverTheyAreInLines) {
  const IesPhotometry ies = read_text(
      "a lamp of 1986, without keywords\r\nTILT=INCLUDE\r\n1\r\n3\r\n0 45 90\r\n1 0.9 0.8\r\n2, -1 2.5\r\n3 "
      "1 1 1 0 0 "
      "0\r\n0.5 0.8 +50\r\n0 45\r\n90\r\n0\r\n1e2 50 25\r\n");
  EXPECT_EQ(ies.vertical, (std::vector<float>{0, 45, 90}));
  EXPECT_EQ(ies.horizontal, std::vector<float>{0});
  EXPECT_EQ(ies.candela, (std::vector<float>{100, 50, 25}));  // with the factors 2.5 * 0.5 * 0.8
}

TEST(IesFile, ClosesACircleWithoutItsLastAngle) {
  const IesPhotometry ies = read_text(file_of("2 4", "0 90 0 90 180 270 8 1 8 2 8 3 8 4"));
  EXPECT_EQ(ies.horizontal, (std::vector<float>{0, 90, 180, 270, 360}));
  EXPECT_EQ(ies.candela, (std::vector<float>{8, 1, 8, 2, 8, 3, 8, 4, 8, 1}));
}

TEST(IesFile, MistakesAreOneLineWithTheLineOfTheFile) {
  const auto mistake = [](const std::string& text) -> std::string {
    try {
      read_text(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_EQ(error.problems().size(), 1u);
      const Problem& problem = error.problems().front();
      EXPECT_TRUE(problem.position.file.ends_with("lamp.ies"));
      return std::to_string(problem.position.line) + ": " + problem.message;
    }
    return "accepted";
  };
  EXPECT_EQ(mistake("v 1 2 3\n"), "1: no IES profile: there is no line TILT=");
  EXPECT_EQ(mistake("TILT=NONE\n1 1000 1 2 1 3 2 0 0 0"),
            "2: photometric type A (3) is not supported; convert the file to type C (1)");
  EXPECT_EQ(mistake("TILT=NONE\n1 1000 1 2 1\n2 2 0 0 0"),
            "3: photometric type B (2) is not supported; convert the file to type C (1)");
  EXPECT_EQ(mistake("TILT=NONE\n1 1000 1 2 1 4 2"), "2: expected the photometric type 1, 2 or 3, got 4");
  EXPECT_EQ(mistake(file_of("2 1", "0 9O 0 1 1")), "7: expected a vertical angle, got '9O'");
  EXPECT_EQ(mistake(file_of("2 1", "0 90\n0\n1")), "9: expected a candela value, got the end of the file");
  EXPECT_EQ(mistake(file_of("2 1", "90 0 0 1 1")), "7: expected a vertical angle of at least 90.01, got 0");
  EXPECT_EQ(mistake(file_of("2 1", "0 190 0 1 1")), "7: expected a vertical angle from 0 to 180, got 190");
  EXPECT_EQ(mistake(file_of("2 2", "0 90 0 120 1 1 1 1")),
            "7: horizontal angles from 0 to 120; expected 0 to 90, 0 to 180, 90 to 270 or 0 to 360");
  EXPECT_EQ(mistake(file_of("2 1", "0 90 0 1 -2")), "7: expected a candela value not below 0, got -2");
  EXPECT_EQ(mistake(file_of("2 1", "0 90 0 0 0")), "7: all candela values are 0 or almost 0");
  EXPECT_EQ(mistake(file_of("2.5 1", "0 90 0 1 1")),
            "5: expected the number of vertical angles, at least 2, got 2.5");
  EXPECT_EQ(mistake(file_of("2 99999", "0 90 0 1 1")),
            "5: the number of horizontal angles is larger than the file");
  EXPECT_EQ(mistake(file_of("2 1", "0 90 0 1 1e39")),
            "7: expected a candela value that a float can hold, got '1e39'");
}

TEST(LightProfile, ItsMeanOverAllDirectionsIsOne) {
  // The midpoint rule in steps of 1 degree has errors below 1e-3 for linear pieces of 30 degrees and more.
  for (const LightProfile& profile : {around(), quadrant(), half(), crosswise(), whole()}) {
    double mean = 0;
    for (int v = 0; v < 180; ++v) {
      const double weight = std::sin((v + 0.5) * std::numbers::pi / 180) * std::numbers::pi / 180 / 2 / 360;
      for (int h = 0; h < 360; ++h) mean += weight * profile.factor(at_angles(v + 0.5, h + 0.5));
    }
    EXPECT_NEAR(mean, 1, 2e-3);
  }
}

TEST(LightProfile, HasTheSymmetryOfItsFile) {
  TestRandom random(2);
  const LightProfile a = around(), q = quadrant(), h = half(), c = crosswise();
  for (int i = 0; i < 200; ++i) {
    const double v = random.between(0, 130), w = random.between(0, 360);
    const float tolerance = 2e-4f;  // float degrees
    EXPECT_NEAR(a.factor(at_angles(v, w)), a.factor(at_angles(v, 0)), tolerance);
    EXPECT_NEAR(q.factor(at_angles(v, w)), q.factor(at_angles(v, -w)), tolerance);
    EXPECT_NEAR(q.factor(at_angles(v, w)), q.factor(at_angles(v, 180 - w)), tolerance);
    EXPECT_NEAR(h.factor(at_angles(v, w)), h.factor(at_angles(v, -w)), tolerance);
    EXPECT_NEAR(c.factor(at_angles(v, w)), c.factor(at_angles(v, 180 - w)), tolerance);
  }
}

TEST(LightProfile, InterpolatesBetweenTheAnglesOfItsFile) {
  const LightProfile a = around(), w = whole();
  const float on_axis = a.factor(V3f(0, 0, 1));
  EXPECT_NEAR(a.factor(at_angles(15, 77)) / on_axis, 0.8f, 1e-5f);
  EXPECT_NEAR(a.factor(at_angles(60, 200)) / on_axis, 0.4f, 1e-5f);
  EXPECT_EQ(a.factor(at_angles(121, 0)), 0);
  // Seen from behind, with y up: the horizontal angle 0 is below, 90 at the left, 180 above.
  const float one = w.factor(at_angles(90, 0)) / 1;
  EXPECT_NEAR(w.factor(V3f(0, -1, 1e-6f).normalized()) / one, 1, 1e-4f);
  EXPECT_NEAR(w.factor(V3f(-1, 0, 1e-6f).normalized()) / one, 2, 1e-4f);
  EXPECT_NEAR(w.factor(V3f(0, 1, 1e-6f).normalized()) / one, 3, 1e-4f);
  EXPECT_NEAR(w.factor(V3f(1, 0, 1e-6f).normalized()) / one, 4, 1e-4f);
  EXPECT_NEAR(w.factor(at_angles(90, 315)) / one, 2.5f, 1e-4f);
}

TEST(LightProfile, StatesThePowerOfItsLumens) {
  const LightProfile even = profile_of("2 1", "0 180 0 10 10");
  EXPECT_NEAR(even.watts(), 40 * std::numbers::pi / 177.83, 1e-5);
  EXPECT_NEAR(even.factor(V3f(0.6f, 0, 0.8f)), 1, 1e-6f);
  // A half with the cosine of the angle in small steps: pi lumens per candela.
  std::string angles, candela;
  for (int i = 0; i <= 90; ++i) {
    angles += std::to_string(i) + " ";
    candela += std::to_string(7 * std::max(0.0, std::cos(i * std::numbers::pi / 180))) + " ";
  }
  EXPECT_NEAR(profile_of("91 1", angles + "0 " + candela).watts() * 177.83 / (7 * std::numbers::pi), 1, 1e-3);
}

class Lamps : public testing::Test {
 protected:
  Lamps() {
    std::ofstream(folder_.path() / "lamp.ies") << file_of("4 1", "0 30 90 120 0 100 60 20 0");
    point_.position = V3f(0, 4, 0);
    point_.profile = {folder_.path() / "lamp.ies", {"scene.yaml", 4, 9}};
  }
  std::unique_ptr<Light> made(const LightParams& params) {
    return make_light("lamp", params, 1, textures_, ledger_);
  }

  TemporaryFolder folder_;
  MemoryLedger ledger_;
  TextureLibrary textures_{ledger_};
  PointLightParams point_;
};

TEST_F(Lamps, DistributeTheirPowerByTheProfile) {
  point_.power = 800;
  const double mean = 800 / (4 * std::numbers::pi * 16);  // irradiance at a distance of 4
  const auto light = made(point_);
  const LightProfile profile = around();
  for (const double angle : {0.0, 20.0, 60.0, 110.0}) {
    const V3f away = at_angles(angle, 40), from = V3f(0, 4, 0) + 4.0f * V3f(away.x, -away.z, away.y);
    // Directions to the lamp of radius 0.05 differ by 0.5 degrees on average, and the factor by 0.055 per
    // degree at most.
    const V3f toward = (V3f(0, 4, 0) - from) / 4.0f;
    EXPECT_NEAR(irradiance(*light, from, toward, 4000) / mean, profile.factor(away), 0.03);
    expect_agreement(*light, from);
    EXPECT_NEAR(light->importance(from) * luminance(Rgb(1)), mean * profile.factor(away), 0.01 * mean);
  }
  const V3f dark(0, 8, 0);
  EXPECT_EQ(irradiance(*light, dark, V3f(0, -1, 0), 100), 0);
  EXPECT_GT(light->importance(dark), 0) << "other rows of the profile may be near";
}

TEST(LightProfile, KnowsWhereItIsDark) {
  // 0 up to 90 degrees, then a peak at 120.
  const LightProfile up = profile_of("4 2", "0 90 120 180 0 180 0 0 0 0 0 0 10 0");
  EXPECT_TRUE(up.is_dark_within(20));
  EXPECT_TRUE(up.is_dark_within(90));
  EXPECT_FALSE(up.is_dark_within(91));
  EXPECT_FALSE(around().is_dark_within(1));
  EXPECT_TRUE(profile_of("2 1", "90 180 0 5 5").is_dark_within(85));
}

TEST_F(Lamps, ReadTheirProfileOnce) {
  const auto openings = [this](const LightParams& params) {
    const int events = inotify_init1(IN_NONBLOCK);
    inotify_add_watch(events, (folder_.path() / "lamp.ies").c_str(), IN_OPEN);
    made(params);
    inotify_event all[100];
    const ssize_t size = read(events, all, sizeof all);
    close(events);
    return size / static_cast<ssize_t>(sizeof(inotify_event));  // without names
  };
  EXPECT_EQ(openings(point_), 1);
  SpotLightParams spot;
  spot.profile = point_.profile;
  EXPECT_EQ(openings(spot), 1);
}

TEST_F(Lamps, HaveThePowerOfTheFileWithoutAPower) {
  EXPECT_NEAR(
      point_.unit_radiance() /
          [this] {
            PointLightParams same = point_;
            same.power = around().watts();
            return same.unit_radiance();
          }(),
      1, 1e-6);
  EXPECT_NEAR(irradiance(*made(point_), V3f(0), V3f(0, 1, 0), 4000) * 16 * kLumensPerWatt, 100, 0.8);
}

TEST_F(Lamps, SpotsCutTheProfile) {
  SpotLightParams spot;
  spot.position = V3f(0, 4, 0);
  spot.look_at = V3f(0);
  spot.profile = point_.profile;
  spot.cone = 60;
  spot.softness = 0;
  const auto whole = made(point_), cut = made(spot);
  const V3f inside(1, 0, 0), outside(4, 0, 0), up(0, 1, 0);
  EXPECT_NEAR(irradiance(*cut, inside, up, 2000) / irradiance(*whole, inside, up, 2000), 1, 1e-5);
  EXPECT_EQ(irradiance(*cut, outside, up, 100), 0);
  EXPECT_GT(irradiance(*whole, outside, up, 100), 0);
}

TEST_F(Lamps, AreTurnedByLookAtAndUp) {
  std::ofstream(folder_.path() / "lamp.ies") << file_of("2 5", "0 90 0 90 180 270 360 8 1 8 2 8 3 8 4 8 1");
  // Straight down, the horizontal angle 180 is at -z, and 90 at -x.
  const auto down = made(point_);
  const auto seen = [](const Light& light, const V3f& away) {
    return light.intersect(V3f(0, 4, 0) + away, -away.normalized())->radiance.x;
  };
  EXPECT_NEAR(seen(*down, {0, -0.001f, -2}) / seen(*down, {0, -0.001f, 2}), 3, 0.01);
  EXPECT_NEAR(seen(*down, {-2, -0.001f, 0}) / seen(*down, {0, -0.001f, 2}), 2, 0.01);
  point_.look_at = Keyed<V3f>(V3f(0, 4, -1));
  const auto ahead = made(point_);  // seen from behind, along -z: +y is above, -x at the left
  EXPECT_NEAR(seen(*ahead, {0, 2, -0.001f}) / seen(*ahead, {0, -2, -0.001f}), 3, 0.01);
  EXPECT_NEAR(seen(*ahead, {-2, 0, -0.001f}) / seen(*ahead, {0, -2, -0.001f}), 2, 0.01);
}

TEST_F(Lamps, NameAMissingProfileWhereTheSceneDoes) {
  point_.profile.path = "missing.ies";
  try {
    made(point_);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(to_string(error.problems().front().position), "scene.yaml:4:9");
    EXPECT_NE(error.problems().front().message.find("missing.ies"), std::string::npos);
  }
}

}  // namespace
}  // namespace pelage::light_profile_test
