// SPDX-License-Identifier: Apache-2.0
#include "groom/sim/guide_simulation.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/job.h"
#include "geom/closest_point.h"
#include "tests/geom/cages.h"
#include "tests/support/effort.h"

namespace pelage {
namespace guide_simulation_test {

double random(uint64_t i, uint64_t use) { return signed_float(hash64(i, use)); }

/// The x coordinate of the tip of the first guide, relative to its root.
double state_tip(const GuideSimulation& guides) { return guides.state()[3 * guides.segment_count()]; }

/// Guides on a ball of radius 1 cm, as triangles that move and turn with it.
class GuideSimulationTest : public testing::Test {
 protected:
  static constexpr double kUnit = 0.01;
  static constexpr size_t kGuides = 24, kPoints = 10;

  GuideSimulationTest() { params_.diameter = 1e-4f; }

  static std::vector<GuideShape> shapes() {
    std::vector<GuideShape> shapes(kGuides);
    for (size_t g = 0; g < kGuides; ++g) {
      shapes[g].radius = 5e-5;
      for (size_t i = 0; i < kPoints; ++i) {  // combed, not below 0.1 mm
        const double s = static_cast<double>(i) / (kPoints - 1);
        shapes[g].points.push_back(
            V3d(0.008 * s, 0.001 * random(g, 7) * s, 0.006 * s * (1.2 - s) + 1e-4 * s));
      }
    }
    return shapes;
  }

  /// The ball with its middle at `middle` (metres), turned by `angle` about an axis.
  SkinMoment moment(const V3d& middle, const V3d& axis, double angle) {
    const Imath::Quatd turn(std::cos(angle / 2), axis.normalized() * std::sin(angle / 2));
    const ControlMesh ball = bumpy_sphere(12);
    mesh_ = {};
    for (const V3f& p : ball.positions) {
      const V3f at(turned(turn, V3d(p.normalized())) + middle / kUnit);
      const V3f out(turned(turn, V3d(p.normalized())));
      mesh_.positions.insert(mesh_.positions.end(), {at.x, at.y, at.z});
      mesh_.normals.insert(mesh_.normals.end(), {out.x, out.y, out.z});
    }
    size_t corner = 0;
    for (const auto size : ball.face_sizes) {
      for (size_t k = 2; k < static_cast<size_t>(size); ++k) {
        for (const size_t v : {size_t(0), k - 1, k})
          mesh_.triangles.push_back(static_cast<uint32_t>(ball.face_vertices[corner + v]));
      }
      corner += static_cast<size_t>(size);
    }
    mesh_.faces.resize(mesh_.triangle_count());
    mesh_.vertex_uv.resize(mesh_.triangles.size());
    tree_.emplace(mesh_, 0);
    SkinMoment at{{}, &*tree_, kUnit};
    for (size_t g = 0; g < kGuides; ++g) {
      const V3d out = V3d(random(g, 1), random(g, 2), random(g, 3)).normalized();
      ClosestPoint root;
      EXPECT_TRUE(tree_->closest_position(V3f(turned(turn, out * 1.2) + middle / kUnit), 9, root));
      at.roots.push_back({V3d(root.position) * kUnit, turn * smallest_turn(V3d(0, 0, 1), out)});
    }
    return at;
  }

  /// The shaking of the ball up to step i.
  SkinMoment shaken(uint64_t i) {
    return moment(V3d(random(i, 11), random(i, 12), random(i, 13)) * 0.01,
                  V3d(random(i, 14), random(i, 15), random(i, 16)), random(i, 17));
  }

  DynamicsParams params_;
  SkinMesh mesh_;
  std::optional<ClosestPointTree> tree_;
  Workers workers_{2};
  MemoryLedger ledger_;
  NoProgress progress_;
  Job job_{workers_, ledger_, progress_};
  WindParams still_air_;
};

TEST_F(GuideSimulationTest, GuidesStayAsGroomedUnderGravity) {
  GuideSimulation guides(params_, shapes(), moment(V3d(0), V3d(0, 0, 1), 0));
  for (int i = 0; i < 24; ++i)
    guides.advance(moment(V3d(0), V3d(0, 0, 1), 0), Wind(still_air_, i, i / 48.0), 1 / 48.0, 2, job_);
  EXPECT_EQ(guides.rigid_count(), 0u);
  const GuideTurns turns = guides.turns();
  // Half a radius at the tip of 1 cm: 2.5 mrad.
  for (size_t i = 3; i < turns.size(); i += 4) EXPECT_GT(turns[i], std::cos(0.0025 / 2)) << i;
}

TEST_F(GuideSimulationTest, ShakenGuidesStayOutsideTheirSkin) {
  GuideSimulation guides(params_, shapes(), shaken(0));
  const int shakes = repetitions(1000);
  for (int i = 1; i <= shakes; ++i) {
    const SkinMoment at = shaken(static_cast<uint64_t>(i));
    guides.advance(at, Wind(still_air_, i, i / 48.0), 1 / 48.0, 2, job_);
    const std::vector<float> state = guides.state();
    for (size_t g = 0; g < kGuides; ++g) {
      const float* numbers = &state[g * (10 * (kPoints - 1) + 6)];
      for (size_t p = 1; p < kPoints; ++p) {
        const V3d point = at.roots[g].position + V3d(numbers[3 * p], numbers[3 * p + 1], numbers[3 * p + 2]);
        ASSERT_TRUE(std::isfinite(point.length()));
        ClosestPoint near;
        const bool is_inside = tree_->closest(V3f(point / kUnit), 9, near) && near.inside;
        ASSERT_FALSE(is_inside && near.distance * kUnit > 2.5e-5) << "step " << i << ", guide " << g;
      }
    }
  }
}

// Long steps of soft guides on a wild skin stretch segments; shorter steps do not.
TEST_F(GuideSimulationTest, GuidesThatFailAreMovedInMoreSteps) {
  params_.youngs_modulus = 1e7f;
  GuideSimulation guides(params_, shapes(), shaken(0));
  size_t rigid = 0;
  for (int i = 1; i <= 40; ++i) {
    guides.advance(shaken(static_cast<uint64_t>(i)), Wind(still_air_, i, i / 48.0), 1 / 48.0, 1, job_);
    rigid += guides.rigid_count();
  }
  EXPECT_EQ(rigid, 0u);
}

TEST_F(GuideSimulationTest, ResumedRunsAreEqual) {
  WindParams air;
  air.velocity = V3f(3, 0, 1);
  air.turbulence = 2.0f;
  const auto step = [&](GuideSimulation& guides, int i, int threads) {
    const Workers workers(threads);
    const SkinMoment at = shaken(static_cast<uint64_t>(i));
    guides.advance(at, Wind(air, i, i / 48.0), 1 / 48.0, 2, {workers, ledger_, progress_});
    const std::vector<float> state = guides.state();
    guides.set_state(state, at);
    return state;
  };
  GuideSimulation whole(params_, shapes(), shaken(0));
  step(whole, 1, 1);
  const std::vector<float> middle = step(whole, 2, 1);
  const std::vector<float> end = step(whole, 3, 1);
  GuideSimulation resumed(params_, shapes(), shaken(0));
  resumed.set_state(middle, shaken(2));
  EXPECT_EQ(step(resumed, 3, 4), end);
}

/// Mean height of the tips on the upper side of the ball after half a second of wind from above.
double blown_height(GuideSimulation& guides, const SkinMoment& at, const ClosestPointTree& skin, double unit,
                    const Job& job) {
  WindParams down;
  down.velocity = V3f(0, -8, 0);
  for (int i = 1; i <= 24; ++i) guides.advance(at, Wind(down, i, i / 48.0), 1 / 48.0, 2, job);
  const std::vector<float> state = guides.state();
  const size_t size = state.size() / guides.guide_count();
  double sum = 0;
  int count = 0;
  for (size_t g = 0; g < guides.guide_count(); ++g) {
    if (turned(at.roots[g].frame, V3d(0, 0, 1)).y < 0.5) continue;
    ++count;
    const float* tip = &state[g * size + 3 * guides.segment_count()];
    ClosestPoint near;
    EXPECT_TRUE(skin.closest(V3f((at.roots[g].position + V3d(tip[0], tip[1], tip[2])) / unit), 9, near));
    sum += near.distance * unit;
  }
  return sum / count;
}

TEST_F(GuideSimulationTest, VolumeKeepsACoatFromCollapsing) {
  params_.youngs_modulus = 1e8f;
  params_.drag = 1e-3f;
  const SkinMoment at = moment(V3d(0), V3d(0, 0, 1), 0);
  GuideSimulation flat(params_, shapes(), at);
  params_.volume = 20;
  GuideSimulation full(params_, shapes(), at);
  for (int i = 0; i < 24; ++i) full.advance(at, Wind(still_air_, i, i / 48.0), 1 / 48.0, 2, job_);
  const GuideTurns turns = full.turns();  // as groomed, as without `volume`
  for (size_t i = 3; i < turns.size(); i += 4) EXPECT_GT(turns[i], std::cos(0.0025 / 2)) << i;
  const double collapsed = blown_height(flat, at, *tree_, kUnit, job_);
  EXPECT_GT(blown_height(full, at, *tree_, kUnit, job_), 1.2 * collapsed);
}

/// A thin plate across x, from z = 5 mm on, as a skin of its own; sizes in units of 1 cm.
struct Plate {
  static constexpr double kThickness = 0.02;
  SkinMesh mesh;
  std::optional<ClosestPointTree> tree;
  Box3f box;

  explicit Plate(double x) {
    for (int i = 0; i < 8; ++i) {
      const V3f p(static_cast<float>(x + (i & 1 ? kThickness : 0)), i & 2 ? 2 : -2, i & 4 ? 3 : 0.5f);
      const V3f out = (p - V3f(static_cast<float>(x), 0, 1.75f)).normalized();
      mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
      mesh.normals.insert(mesh.normals.end(), {out.x, out.y, out.z});
      box.extendBy(p);
    }
    mesh.triangles = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                      2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    mesh.faces.resize(mesh.triangle_count());
    mesh.vertex_uv.resize(mesh.triangles.size());
    tree.emplace(mesh, 0);
  }
};

// Half a frame moves the plate by 25 times its thickness.
TEST_F(GuideSimulationTest, PlatesDoNotPassThroughWhiskers) {
  GuideShape whisker;
  whisker.radius = 5e-5;
  for (int i = 0; i <= 15; ++i) whisker.points.push_back(V3d(0, 0, 0.001 * i));
  SkinMoment at;
  at.roots.push_back({});
  at.meters_per_unit = kUnit;
  GuideSimulation guides(params_, {whisker}, at);
  double x = -2;
  for (int i = 1; i <= 5; ++i) {
    const Plate before(x), now(x += 0.5);
    at.others = {{&before.mesh, &now.mesh, &*before.tree, &*now.tree, before.box, now.box, 0.5}};
    guides.advance(at, Wind(still_air_, i, i / 48.0), 1 / 48.0, 2, job_);
    EXPECT_EQ(guides.rigid_count(), 0u);
    const std::vector<float> state = guides.state();
    for (int p = 1; p <= 15; ++p) {
      const double node_x = state[3 * static_cast<size_t>(p)] / kUnit;
      const double node_z = state[3 * static_cast<size_t>(p) + 2] / kUnit;
      // Nodes below the edge of the plate, and those that slip under it, may be anywhere.
      if (node_z < 0.55) continue;
      EXPECT_GT(node_x, x + Plate::kThickness - 1e-3) << "step " << i << ", point " << p;
    }
  }
  EXPECT_GT(state_tip(guides), 0.3 * kUnit);  // it bends
}

TEST_F(GuideSimulationTest, HostileGuidesFollowRigidly) {
  std::vector<GuideShape> hostile = shapes();
  for (V3d& point : hostile[0].points) point = V3d(0);  // no length
  hostile[1].points[4] = hostile[1].points[3];          // coinciding points
  hostile[2].radius = 0;
  for (const float stiffness : {0.0f, 1e12f}) {
    params_.youngs_modulus = stiffness;
    GuideSimulation guides(params_, hostile, moment(V3d(0), V3d(0, 0, 1), 0));
    for (int i = 0; i < 6; ++i) {
      // In one frame the skin is 100 units away.
      guides.advance(moment(V3d(i > 2 ? 1 : 0, 0, 0), V3d(0, 0, 1), i), Wind(still_air_, i, i / 48.0),
                     1 / 48.0, 2, job_);
      EXPECT_GE(guides.rigid_count(), 3u);
      const GuideTurns turns = guides.turns();
      for (const float x : turns) ASSERT_TRUE(std::isfinite(x));
      for (size_t k = 3; k < 3 * 4 * (kPoints - 1); k += 4) EXPECT_EQ(turns[k], 1);
    }
  }
}

// Divergence and root mean square of the turbulence, by differences and sums over random places.
TEST(Wind, TurbulenceHasNoDivergenceAndItsStrength) {
  WindParams air;
  air.turbulence = 2.0f;
  air.eddy_size = 0.05f;
  const Wind wind(air, 1, 0.3);
  double square = 0;
  const int count = repetitions(4000);
  for (int i = 0; i < count; ++i) {
    const auto n = static_cast<uint64_t>(i);
    const V3d x = V3d(random(n, 21), random(n, 22), random(n, 23)) * 3.0;
    square += wind.at(x).length2() / count;
    constexpr double kStep = 1e-6;
    double divergence = 0;
    for (unsigned k = 0; k < 3; ++k) {
      V3d d(0);
      d[k] = kStep;
      divergence += (wind.at(x + d)[k] - wind.at(x - d)[k]) / (2 * kStep);
    }
    // Differences of second order: the third derivative is below 1e5 per second and cell.
    ASSERT_LT(std::fabs(divergence), 1e-3 * 2 / 0.05);
  }
  EXPECT_NEAR(std::sqrt(square), 2, 0.1);
}

}  // namespace guide_simulation_test
}  // namespace pelage
