// SPDX-License-Identifier: Apache-2.0
//
// Time of a frame of simulated guides of 16 points on a moving, turning ball, in wind and with collisions, on
// one core: four steps in two halves, as `pelage simulate` makes them, without reading and posing the skin.
// "rods" is the ratio to the time of these steps for each rod by itself (Rod::step), without contacts and
// wind.
#include <cmath>
#include <optional>

#include <benchmark/benchmark.h>

#include "base/hash.h"
#include "bench/yardstick.h"
#include "geom/closest_point.h"
#include "groom/sim/guide_simulation.h"
#include "tests/geom/cages.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

constexpr size_t kPoints = 16;

/// A ball of radius 3 cm with about 10,000 triangles, whose middle is at `x` metres.
struct Ball {
  SkinMesh mesh;
  std::optional<ClosestPointTree> tree;
  SkinMoment moment;

  Ball(double x, size_t guides) {
    const ControlMesh cage = bumpy_sphere(72);
    for (const V3f& p : cage.positions) {
      const V3f out = p.normalized(), at = out * 3 + V3f(static_cast<float>(x) * 100, 0, 0);
      mesh.positions.insert(mesh.positions.end(), {at.x, at.y, at.z});
      mesh.normals.insert(mesh.normals.end(), {out.x, out.y, out.z});
    }
    size_t corner = 0;
    for (const auto size : cage.face_sizes) {
      for (size_t k = 2; k < static_cast<size_t>(size); ++k) {
        for (const size_t v : {size_t(0), k - 1, k})
          mesh.triangles.push_back(static_cast<uint32_t>(cage.face_vertices[corner + v]));
      }
      corner += static_cast<size_t>(size);
    }
    mesh.faces.resize(mesh.triangle_count());
    mesh.vertex_uv.resize(mesh.triangles.size());
    tree.emplace(mesh, 0);
    moment = {{}, &*tree, 0.01};
    for (uint64_t g = 0; g < guides; ++g) {
      const V3d out = V3d(signed_float(hash64(g, 1)), signed_float(hash64(g, 2)), signed_float(hash64(g, 3)))
                          .normalized();
      moment.roots.push_back({V3d(x, 0, 0) + out * 0.03, smallest_turn(V3d(0, 0, 1), out)});
    }
  }
};

GuideShape combed_guide() {
  GuideShape shape;
  shape.radius = 3e-5;
  for (size_t i = 0; i < kPoints; ++i) {
    const double s = static_cast<double>(i) / (kPoints - 1);
    shape.points.push_back(V3d(0.015 * s, 0, 0.008 * s * (1.3 - s)));
  }
  return shape;
}

/// Time of a step of a shaken rod.
double rod_step_seconds(const DynamicsParams& params) {
  const GuideShape shape = combed_guide();
  Rod rod(shape.points, params.material(shape.radius), RodRoot{});
  rod.balance(V3d(params.gravity));
  RodState state = rod.rest();
  Rod::Workspace work;
  RodForces forces;
  forces.gravity = V3d(params.gravity);
  return seconds_per_call(
      [&](int i) {
        return rod.step({V3d(i / 2 % 2 * 0.002, 0, 0), {}}, forces, 1 / 96.0, 2, state, work);
      },
      1000);
}

void BM_SimulatedFrame(benchmark::State& state) {
  const DynamicsParams params;
  const auto count = static_cast<size_t>(state.range(0));
  std::vector<GuideShape> shapes(count, combed_guide());
  const Ball left(-0.002, count), right(0.002, count);
  WindParams air;
  air.velocity = V3f(5, 0, 0);
  air.turbulence = 2.0f;
  GuideSimulation guides(params, std::move(shapes), left.moment);
  QuietJob quiet(1);
  int half = 0;
  const double rods = 4 * static_cast<double>(count) * rod_step_seconds(params);
  const RatioTo ratio(state, "rods", rods);
  for (auto _ : state) {
    for (int k = 0; k < 2; ++k, ++half) {
      const Wind wind(air, 1, half / 48.0);
      guides.advance((half % 2 ? left : right).moment, wind, 1 / 48.0, 2, quiet);
      benchmark::DoNotOptimize(guides.turns());
    }
  }
  state.counters["rigid"] = static_cast<double>(guides.rigid_count());
}
BENCHMARK(BM_SimulatedFrame)
    ->Arg(1000)
    ->Arg(2000)
    ->Arg(4000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

}  // namespace
}  // namespace pelage
