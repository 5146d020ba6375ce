// SPDX-License-Identifier: Apache-2.0
// Cost of the fibre models, compared with tracing an incoherent ray through a million strands in the same
// process, on one thread. The ray starts at a visible point of the bumpy ball, in a random direction, and
// ends at its first hit.
//
//   Time    construct: from a colour, a place on a fibre and a view to a value
//           eval and pdf: of that value, for one direction; sample: samples one, with its value and pdf
//   x_ray   the same over an incoherent ray
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "bench/ball_scene.h"
#include "bench/yardstick.h"
#include "render/accel/flush_denormals.h"
#include "render/fibre/fibre_material.h"
#include "render/frame/frame_geometry.h"
#include "render/sampling/sample_stream.h"
#include "render/sampling/warp.h"

namespace pelage {
namespace {

constexpr size_t kStrands = 1000000;

/// Rays from fur that a camera sees, in random directions.
class IncoherentRays {
 public:
  IncoherentRays()
      : scene_(ball_scene(make_bumpy_ball(kStrands), ChiangParams{}, {960, 540, 1, 1, 8000}, ledger_)),
        geometry_(FrameGeometry::make(scene_, {workers_, ledger_, progress_}, statistics_)) {
    const FlushDenormals flush;
    for (uint32_t i = 0; rays_.size() < kRays; ++i) {
      SampleStream stream(5, i, 0, 0);
      const V2f at = stream.next2d();
      const CameraRay from = scene_.camera.ray(960 * at.x, 540 * at.y, V2f(0.5f), 0);
      Ray ray;
      ray.origin = from.origin;
      ray.direction = from.direction;
      const Hit hit = geometry_->accel().closest(ray, thread_);
      if (hit.kind != HitKind::kStrand) continue;
      ray.origin += (hit.distance * (1 - 1e-4f)) * ray.direction;
      ray.direction = uniform_direction(stream.next2d());
      rays_.push_back(ray);
    }
  }
  /// Best of several runs; the first run grows the chunks that rays hit.
  double seconds() {
    const FlushDenormals flush;
    return seconds_per_call(
        [this](int i) { return geometry_->accel().closest(rays_[static_cast<size_t>(i)], thread_); }, kRays,
        5);
  }

 private:
  static constexpr int kRays = 100000;
  Workers workers_;
  MemoryLedger ledger_;
  NoProgress progress_;
  FrameStatistics statistics_;
  RenderScene scene_;
  std::unique_ptr<FrameGeometry> geometry_;
  TraceThread thread_;
  std::vector<Ray> rays_;
};

double ray_seconds() {
  static const double seconds = IncoherentRays().seconds();
  return seconds;
}

void incoherent_ray(benchmark::State& state) {
  for (auto _ : state) state.SetIterationTime(ray_seconds());
}
BENCHMARK(incoherent_ray)->Name("incoherent ray, a million strands")->Iterations(1)->UseManualTime();

/// Places, views and directions made before the clock runs.
class ModelBench {
 public:
  explicit ModelBench(const MaterialParams& params) : material_(params) {
    for (uint32_t i = 0; i < kCount; ++i) {
      SampleStream stream(3, i, 0, 0);
      FibrePoint point;
      point.tangents.fill(uniform_direction(stream.next2d()));
      point.wo = uniform_direction(stream.next2d());
      point.h = 2 * stream.next1d() - 1;
      point.color = Rgb(0.5f, 0.3f, 0.2f);
      points_.push_back(point);
      directions_.push_back(uniform_direction(stream.next2d()));
      numbers_.push_back(stream.next3d());
      if (i < 64) bsdfs_.push_back(material_.at(point));
    }
  }
  auto construct(size_t i) const { return material_.at(points_[i % kCount]); }
  auto eval(size_t i) const { return bsdfs_[i % 64].eval(directions_[i % kCount]); }
  auto sample(size_t i) const { return bsdfs_[i % 64].sample(numbers_[i % kCount]); }

 private:
  static constexpr uint32_t kCount = 1024;
  FibreMaterial material_;
  std::vector<FibreBsdf> bsdfs_;
  std::vector<FibrePoint> points_;
  std::vector<V3f> directions_, numbers_;
};

template <class P>
const ModelBench& bench_of() {
  static const ModelBench bench{MaterialParams(P{})};
  return bench;
}

template <class P, class Step>
void add_step(const char* what, Step step) {
  benchmark::RegisterBenchmark((std::string(P::kTypeName) + what).c_str(), [step](benchmark::State& state) {
    const ModelBench& bench = bench_of<P>();
    const double ray = ray_seconds();
    size_t i = 0;
    const RatioTo ratio(state, "x_ray", ray);
    for (auto _ : state) benchmark::DoNotOptimize(step(bench, ++i));
  });
}

template <class... P>
int register_models() {
  const auto add = [](auto* of) {
    using Params = std::remove_pointer_t<decltype(of)>;
    add_step<Params>(": construct", [](const ModelBench& b, size_t i) { return b.construct(i); });
    add_step<Params>(": eval and pdf", [](const ModelBench& b, size_t i) { return b.eval(i); });
    add_step<Params>(": sample, eval and pdf", [](const ModelBench& b, size_t i) { return b.sample(i); });
  };
  (add(static_cast<P*>(nullptr)), ...);
  return 0;
}
const int kModels = register_models<LambertCylinderParams, KajiyaKayParams, ConeShellParams, MarschnerParams,
                                    DeonParams, ChiangParams, YanFastParams, YanParams>();

}  // namespace
}  // namespace pelage
