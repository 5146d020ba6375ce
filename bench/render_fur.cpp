// SPDX-License-Identifier: Apache-2.0
// The fur tree over Embree's flat curves on the same B-splines, on one thread: runs alternate, and of each
// the best counts.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include "base/process_usage.h"
#include "bench/furball.h"
#include "render/accel/flush_denormals.h"
#include "render/accel/fur/fur_tree.h"

namespace pelage {
namespace {

constexpr int kRuns = 7;
constexpr float kRootWidth = 8e-4f;

/// Embree's curves over the strands with phantom ends, as it wants them.
class EmbreeCurvesOf {
 public:
  EmbreeCurvesOf(const Strands& strands, bool compact, float tessellation_rate) {
    std::vector<float> vertices;
    std::vector<uint32_t> segments;
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      const float* p = &strands.points()[size_t(strands.first_point(s)) * 4];
      const size_t n = strands.strand_points(s);
      const auto first = static_cast<uint32_t>(vertices.size() / 4);
      for (size_t i = 0; i < 4; ++i) vertices.push_back(2 * p[i] - p[4 + i]);
      vertices.insert(vertices.end(), p, p + n * 4);
      for (size_t i = 0; i < 4; ++i) vertices.push_back(2 * p[(n - 1) * 4 + i] - p[(n - 2) * 4 + i]);
      for (uint32_t k = 0; k + 1 < n; ++k) segments.push_back(first + k);
    }
    device_ = rtcNewDevice("threads=1,set_affinity=0");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, compact ? RTC_SCENE_FLAG_COMPACT : RTC_SCENE_FLAG_NONE);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_FLAT_BSPLINE_CURVE);
    void* v = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16,
                                      vertices.size() / 4);
    void* i =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, 4, segments.size());
    std::copy(vertices.begin(), vertices.end(), static_cast<float*>(v));
    std::copy(segments.begin(), segments.end(), static_cast<uint32_t*>(i));
    rtcSetGeometryTessellationRate(geometry, tessellation_rate);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetDeviceMemoryMonitorFunction(
        device_,
        [](void* bytes, ssize_t change, bool) {
          *static_cast<int64_t*>(bytes) += change;
          return true;
        },
        &bytes_);
    const double start = cpu_seconds();
    rtcCommitScene(scene_);
    build_s_ = cpu_seconds() - start;
    bytes_ += static_cast<int64_t>(vertices.size() * 4 + segments.size() * 4);
  }
  ~EmbreeCurvesOf() {
    rtcReleaseScene(scene_);
    rtcSetDeviceMemoryMonitorFunction(device_, nullptr, nullptr);
    rtcReleaseDevice(device_);
  }
  EmbreeCurvesOf(const EmbreeCurvesOf&) = delete;
  EmbreeCurvesOf& operator=(const EmbreeCurvesOf&) = delete;

  bool occluded(const Ray& ray) const {
    RTCRay r = embree_ray(ray);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_, &context, &r);
    return r.tfar < 0;
  }
  float closest(const Ray& ray) const {
    RTCRayHit r;
    r.ray = embree_ray(ray);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_, &context, &r);
    return r.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity() : r.ray.tfar;
  }
  double build_s() const { return build_s_; }
  double bytes() const { return static_cast<double>(bytes_); }

 private:
  static RTCRay embree_ray(const Ray& ray) {
    return {ray.origin.x,
            ray.origin.y,
            ray.origin.z,
            ray.near,
            ray.direction.x,
            ray.direction.y,
            ray.direction.z,
            ray.time,
            ray.far,
            ~0u,
            0,
            0};
  }
  RTCDevice device_;
  RTCScene scene_;
  int64_t bytes_ = 0;
  double build_s_ = 0;
};

struct FurOf {
  FurOf(const Strands& strands, float width) : snapped(strands, FurGrid(width)) {
    const double start = cpu_seconds();
    tree = std::make_unique<FurTree>(snapped, FurTreeOptions());
    build_s = cpu_seconds() - start;
  }
  bool occluded(const Ray& ray) const { return tree->occluded(ray, {}); }
  float closest(const Ray& ray) const { return tree->closest(ray, {}).distance; }
  SnappedStrands snapped;
  std::unique_ptr<FurTree> tree;
  double build_s = 0;
};

template <class Tree>
double seconds(const Tree& tree, const std::vector<Ray>& rays, bool shadow, size_t& hits) {
  hits = 0;
  const double start = cpu_seconds();
  for (const Ray& ray : rays) hits += shadow ? tree.occluded(ray) : std::isfinite(tree.closest(ray));
  return cpu_seconds() - start;
}

void fur_over_embree(benchmark::State& state) {
  const FlushDenormals flush;
  const auto count = static_cast<size_t>(state.range(0));
  const Strands strands = make_furball(count);
  const float width = kRootWidth * std::sqrt(1e5f / static_cast<float>(count));
  const EmbreeCurvesOf compact(strands, true, 4), fast(strands, false, 4);
  const FurOf fur(strands, width);
  const auto n = static_cast<double>(fur.snapped.segment_count());
  const std::vector<Ray> deep = rays_deep_in_furball(100000), camera = camera_rays_at_furball(316);
  for (auto _ : state) {
    const auto compare = [&](const std::string& name, const std::vector<Ray>& rays, bool shadow) {
      double best[3] = {1e30, 1e30, 1e30};
      size_t hits[3];
      for (int run = 0; run < kRuns; ++run) {
        best[0] = std::min(best[0], seconds(compact, rays, shadow, hits[0]));
        best[1] = std::min(best[1], seconds(fur, rays, shadow, hits[1]));
        best[2] = std::min(best[2], seconds(fast, rays, shadow, hits[2]));
      }
      const auto r = static_cast<double>(rays.size());
      state.counters[name + " Mray/s compact"] = r / best[0] * 1e-6;
      state.counters[name + " fur/compact"] = best[0] / best[1];
      state.counters[name + " fur/fast"] = best[2] / best[1];
      state.counters[name + " hits embree"] = static_cast<double>(hits[0]) / r;
      state.counters[name + " hits fur"] = static_cast<double>(hits[1]) / r;
    };
    compare("1 occlusion", deep, true);
    compare("2 closest", deep, false);
    compare("3 camera", camera, false);
  }
  state.counters["bytes/segment compact"] = compact.bytes() / n;
  state.counters["bytes/segment fast"] = fast.bytes() / n;
  state.counters["bytes/segment fur"] = static_cast<double>(fur.tree->bytes()) / n;
  state.counters["leaf bytes/segment"] = static_cast<double>(fur.tree->leaf_bytes()) / n;
  state.counters["build fur/compact"] = fur.build_s / compact.build_s();
  state.counters["build s compact"] = compact.build_s();
}
BENCHMARK(fur_over_embree)
    ->Name("fur over Embree flat")
    ->ArgName("strands")
    ->Arg(100000)
    ->Arg(1000000)
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace pelage

BENCHMARK_MAIN();
