// SPDX-License-Identifier: Apache-2.0
// Cost of evaluating, posing and tessellating skins, and of closest-point queries. Yardsticks: OpenSubdiv
// used directly for evaluation and posing, one evaluation per vertex for tessellation, and Embree's own query
// for closest points.
#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>
#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/primvarRefiner.h>

#include "base/hash.h"
#include "base/parallel.h"
#include "bench/yardstick.h"
#include "geom/cage_refiner.h"
#include "geom/closest_point.h"
#include "geom/tessellation.h"
#include "geom/triangle_distance.h"
#include "tests/geom/cages.h"

namespace pelage {
namespace {

namespace Far = OpenSubdiv::Far;

constexpr size_t kPlaces = 4096;

/// A torus of 960 quads, shaken, in which every tenth quad is two triangles: half of its patches are
/// irregular.
const ControlMesh& cage() {
  static const ControlMesh mesh = [] {
    const ControlMesh torus = torus_cage(40, 24);
    std::vector<V3f> positions = torus.positions;
    for (size_t i = 0; i < positions.size(); ++i) positions[i] *= 1 + 0.02f * signed_float(hash64(i));
    std::vector<std::vector<uint32_t>> faces;
    for (size_t f = 0; f < torus.face_count(); ++f) {
      const uint32_t* v = &torus.face_vertices[f * 4];
      if (hash64(f, 1) % 10 == 0) {
        faces.push_back({v[0], v[1], v[2]});
        faces.push_back({v[0], v[2], v[3]});
      } else {
        faces.push_back({v[0], v[1], v[2], v[3]});
      }
    }
    return make_cage(positions, faces);
  }();
  return mesh;
}

std::shared_ptr<const SurfaceTopology> make_topology() {
  return SurfaceTopology::create(cage(), SubdivisionScheme::kCatmullClark, BoundaryRule::kEdgeAndCorner,
                                 "bench");
}

const LimitSurface& surface() {
  static const LimitSurface s(make_topology(), cage().positions);
  return s;
}

const std::vector<RootAddress>& places() {
  static const std::vector<RootAddress> list = [] {
    std::vector<RootAddress> result(kPlaces);
    for (size_t i = 0; i < kPlaces; ++i) {
      result[i] = {static_cast<uint32_t>(hash64(i, 1) % surface().topology().face_count()),
                   unit_float(hash64(i, 2)), unit_float(hash64(i, 3))};
    }
    return result;
  }();
  return list;
}

struct FloatPoint {
  float x = 0, y = 0, z = 0;
  void Clear() { x = y = z = 0; }
  void AddWithWeight(const FloatPoint& p, float w) {
    x += w * p.x;
    y += w * p.y;
    z += w * p.z;
  }
};

/// The same surface by the library's tutorial: refiner, patch table, primvars level by level.
struct RawSurface {
  RawSurface() {
    refiner = make_refiner(cage(), SubdivisionScheme::kCatmullClark, BoundaryRule::kEdgeAndCorner, "bench");
    Far::PatchTableFactory::Options options(6);
    options.generateVaryingTables = false;
    Far::TopologyRefiner::AdaptiveOptions levels = options.GetRefineAdaptiveOptions();
    levels.SetSecondaryLevel(3);
    refiner->RefineAdaptive(levels);
    patches.reset(Far::PatchTableFactory::Create(*refiner, options));
    map = std::make_unique<Far::PatchMap>(*patches);
    refine();
  }

  void refine() {
    const auto refined = static_cast<size_t>(refiner->GetNumVerticesTotal());
    points.resize(refined + static_cast<size_t>(patches->GetNumLocalPoints()));
    for (size_t i = 0; i < cage().positions.size(); ++i) {
      const V3f& p = cage().positions[i];
      points[i] = {p.x, p.y, p.z};
    }
    FloatPoint* source = points.data();
    for (int level = 1; level < refiner->GetNumLevels(); ++level) {
      FloatPoint* next = source + refiner->GetLevel(level - 1).GetNumVertices();
      Far::PrimvarRefiner(*refiner).Interpolate(level, source, next);
      source = next;
    }
    FloatPoint* local = points.data() + refined;
    patches->GetLocalPointStencilTable<float>()->UpdateValues(points.data(), local);
  }

  FloatPoint evaluate(const RootAddress& at, FloatPoint& du, FloatPoint& dv) const {
    const auto* handle = map->FindPatch(static_cast<int>(at.face), at.u, at.v);
    float w[20], wu[20], wv[20];
    patches->EvaluateBasis(*handle, at.u, at.v, w, wu, wv);
    const Far::ConstIndexArray vertices = patches->GetPatchVertices(*handle);
    FloatPoint p;
    du.Clear();
    dv.Clear();
    for (int i = 0; i < vertices.size(); ++i) {
      const FloatPoint& q = points[static_cast<size_t>(vertices[i])];
      p.AddWithWeight(q, w[i]);
      du.AddWithWeight(q, wu[i]);
      dv.AddWithWeight(q, wv[i]);
    }
    return p;
  }

  std::unique_ptr<Far::TopologyRefiner> refiner;
  std::unique_ptr<Far::PatchTable> patches;
  std::unique_ptr<Far::PatchMap> map;
  std::vector<FloatPoint> points;
};

RawSurface& raw() {
  static RawSurface r;
  return r;
}

float evaluate_raw(int i) {
  FloatPoint du, dv;
  const FloatPoint p = raw().evaluate(places()[static_cast<size_t>(i) % kPlaces], du, dv);
  return p.x + du.x + dv.x;
}

/// Runs `ours` under the benchmark, and adds a column with how many times as long as `theirs` it takes, both
/// as the best of several runs: on a busy machine the mean of one and the best of the other would differ.
template <class Ours, class Theirs>
void compare(benchmark::State& state, const char* column, int calls, const Ours& ours, const Theirs& theirs) {
  int i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(ours(i++));
  state.counters[column] = seconds_per_call(ours, calls) / seconds_per_call(theirs, calls);
}

void evaluate(benchmark::State& state) {
  const auto ours = [](int i) {
    const RootAddress& at = places()[static_cast<size_t>(i) % kPlaces];
    return surface().evaluate(at.face, at.u, at.v);
  };
  compare(state, "x_opensubdiv", 100000, ours, evaluate_raw);
}
BENCHMARK(evaluate)->Name("surface: position, du, dv");

void frames(benchmark::State& state) {
  const auto ours = [](int i) {
    const RootAddress& at = places()[static_cast<size_t>(i) % kPlaces];
    return surface().frame(at.face, at.u, at.v);
  };
  compare(state, "x_opensubdiv", 100000, ours, evaluate_raw);
}
BENCHMARK(frames)->Name("surface: frame");

void pose(benchmark::State& state) {
  const auto topology = surface().shared_topology();
  compare(
      state, "x_opensubdiv", 20, [&](int) { return LimitSurface(topology, cage().positions).bytes(); },
      [](int) { return raw().refine(), 0; });
  state.counters["pose_bytes"] = static_cast<double>(surface().bytes());
  state.counters["topology_bytes"] = static_cast<double>(topology->bytes());
}
BENCHMARK(pose)->Name("surface: a new pose")->Unit(benchmark::kMicrosecond);

void topology(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(make_topology());
}
BENCHMARK(topology)->Name("surface: a new topology")->Unit(benchmark::kMillisecond);

SkinMesh skin(float edge_pixels) {
  View view;
  view.position = {0, 0, 10};
  view.focal_pixels = 1000;
  static const Workers workers(1);
  return tessellate(std::span(&surface(), 1), view, {edge_pixels, 64}, workers);
}

void tessellation(benchmark::State& state) {
  const auto pixels = static_cast<float>(state.range(0));
  const auto vertices = static_cast<int>(skin(pixels).vertex_count());
  const auto evaluations = [&](int) {
    float sum = 0;
    for (int i = 0; i < vertices; ++i) sum += evaluate_raw(i);
    return sum;
  };
  compare(
      state, "x_evaluations", 1, [&](int) { return skin(pixels).vertex_count(); }, evaluations);
  state.counters["vertices"] = vertices;
}
BENCHMARK(tessellation)->Name("tessellate: pixels per edge")->Arg(8)->Arg(2)->Unit(benchmark::kMillisecond);

/// Points off the skin by up to `reach` of its size.
std::vector<V3f> queries(float reach) {
  std::vector<V3f> result(kPlaces);
  const float size = surface().control_bounds().size().length();
  for (size_t i = 0; i < kPlaces; ++i) {
    const RootAddress& at = places()[i];
    const V3f normal = surface().frame(at.face, at.u, at.v).normal;
    result[i] =
        surface().evaluate(at.face, at.u, at.v).position + normal * (reach * size * unit_float(hash64(i, 9)));
  }
  return result;
}

/// The same query through Embree's tree of triangles.
class EmbreeQueries {
 public:
  explicit EmbreeQueries(const SkinMesh& mesh) : mesh_(mesh) {
    device_ = rtcNewDevice("threads=1");
    scene_ = rtcNewScene(device_);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    float* p = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                           RTC_FORMAT_FLOAT3, 12, mesh.vertex_count()));
    std::copy_n(mesh.positions.data(), mesh.vertex_count() * 3, p);
    auto* t = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                             RTC_FORMAT_UINT3, 12, mesh.triangle_count()));
    std::copy_n(mesh.triangles.data(), mesh.triangles.size(), t);
    rtcSetGeometryPointQueryFunction(geometry, visit);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeQueries() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeQueries(const EmbreeQueries&) = delete;
  EmbreeQueries& operator=(const EmbreeQueries&) = delete;

  float distance(const V3f& point) const {
    RTCPointQuery query{point.x, point.y, point.z, 0, std::numeric_limits<float>::infinity()};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &query, &context, nullptr, const_cast<SkinMesh*>(&mesh_));
    return query.radius;
  }

 private:
  static bool visit(RTCPointQueryFunctionArguments* args) {
    const auto& mesh = *static_cast<const SkinMesh*>(args->userPtr);
    TrianglePacket packet;
    for (size_t i = 0; i < 3; ++i) {
      const V3f p = mesh.position(mesh.triangles[args->primID * 3 + i]);
      packet.corner[i] = {four(p.x), four(p.y), four(p.z)};
    }
    const V3f point(args->query->x, args->query->y, args->query->z);
    const float distance = std::sqrt(packet_distances(packet, point)[0]);
    if (distance >= args->query->radius) return false;
    args->query->radius = distance;
    return true;
  }

  const SkinMesh& mesh_;
  RTCDevice device_;
  RTCScene scene_;
};

void closest(benchmark::State& state) {
  const SkinMesh mesh = skin(1.5f);
  const ClosestPointTree tree(mesh, 0);
  const EmbreeQueries embree(mesh);
  const std::vector<V3f> points = queries(static_cast<float>(state.range(0)) / 1000);
  const auto ours = [&](int i) {
    ClosestPoint result;
    tree.closest(points[static_cast<size_t>(i) % kPlaces], std::numeric_limits<float>::infinity(), result);
    return result.distance;
  };
  const auto theirs = [&](int i) { return embree.distance(points[static_cast<size_t>(i) % kPlaces]); };
  compare(state, "x_embree", static_cast<int>(kPlaces), ours, theirs);
  state.SetItemsProcessed(state.iterations());
  state.counters["triangles"] = static_cast<double>(mesh.triangle_count());
  state.counters["bytes_per_triangle"] =
      static_cast<double>(tree.bytes()) / static_cast<double>(mesh.triangle_count());
}
BENCHMARK(closest)
    ->Name("closest point: thousandths of size off the skin")
    ->Arg(0)
    ->Arg(5)
    ->Arg(50)
    ->Arg(500);

void closest_build(benchmark::State& state) {
  const SkinMesh mesh = skin(1.5f);
  for (auto _ : state) benchmark::DoNotOptimize(ClosestPointTree(mesh, 0));
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(mesh.triangle_count()));
}
BENCHMARK(closest_build)->Name("closest point: build, triangles/s")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pelage
