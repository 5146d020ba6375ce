// SPDX-License-Identifier: Apache-2.0
// Cost of dense meshes as skins, by scheme: processor time and bytes a face to make the topology, the surface
// of one pose, and the look-up of roots (tessellation and closest-point tree). The yardstick is the mesh as
// read from its file.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "base/process_usage.h"
#include "geom/closest_point.h"
#include "geom/io/obj_file.h"
#include "geom/tessellation.h"
#include "tests/geom/cages.h"
#include "tests/support/allocation_meter.h"

namespace pelage {
namespace {

/// The mesh of PELAGE_BENCH_MESH, an OBJ file, if it is set; otherwise a bumpy sphere of about this many
/// triangles.
ControlMesh mesh_of(int64_t faces) {
  if (faces == 0) return read_obj(std::getenv("PELAGE_BENCH_MESH"));
  return bumpy_sphere(static_cast<uint32_t>(std::sqrt(static_cast<double>(faces) / 2)) + 1);
}

void dense(benchmark::State& state) {
  const ControlMesh mesh = mesh_of(state.range(0));
  const auto scheme = static_cast<SubdivisionScheme>(state.range(1));
  const auto faces = static_cast<double>(mesh.face_count());
  double topology_seconds = 1e30, surface_seconds = 1e30, lookup_seconds = 1e30;
  const auto timed = [](double& best, const auto& work) {
    const double start = cpu_seconds();
    work();
    best = std::min(best, cpu_seconds() - start);
  };
  for (auto _ : state) {
    const size_t before = live_bytes();
    reset_peak();
    std::shared_ptr<const SurfaceTopology> topology;
    timed(topology_seconds,
          [&] { topology = SurfaceTopology::create(mesh, scheme, BoundaryRule::kEdgeAndCorner, "bench"); });
    state.counters["topology_B"] = static_cast<double>(live_bytes() - before) / faces;
    state.counters["making_B"] = static_cast<double>(peak_bytes() - before) / faces;
    std::optional<LimitSurface> surface;
    timed(surface_seconds, [&] { surface.emplace(topology, mesh.positions); });
    state.counters["surface_B"] = static_cast<double>(surface->bytes()) / faces;
    std::optional<SkinMesh> skin;
    std::optional<ClosestPointTree> tree;
    timed(lookup_seconds, [&] {
      skin.emplace(tessellate(std::span(&*surface, 1), View(), {}, Workers::alone()));
      tree.emplace(*skin, 0);
    });
    state.counters["lookup_B"] = static_cast<double>(skin->bytes() + tree->bytes()) / faces;
    state.counters["peak_B"] = static_cast<double>(peak_bytes() - before) / faces;
    state.counters["x_mesh"] = static_cast<double>(live_bytes() - before) / static_cast<double>(mesh.bytes());
  }
  state.counters["faces"] = faces;
  state.counters["topology_us"] = topology_seconds / faces * 1e6;
  state.counters["surface_us"] = surface_seconds / faces * 1e6;
  state.counters["lookup_us"] = lookup_seconds / faces * 1e6;
}

void add_dense() {
  for (const auto scheme : {SubdivisionScheme::kNone, SubdivisionScheme::kCatmullClark}) {
    for (const int64_t faces : {35000, 200000, 0}) {
      if (faces == 0 && !std::getenv("PELAGE_BENCH_MESH")) continue;
      const auto name = EnumNames<SubdivisionScheme>::names[static_cast<size_t>(scheme)];
      benchmark::RegisterBenchmark(
          (std::string("dense mesh, ") + name + (faces == 0 ? ", of a file" : "")).c_str(), dense)
          ->Args({faces, static_cast<int64_t>(scheme)})
          ->Iterations(scheme == SubdivisionScheme::kNone ? 5 : 1)
          ->Unit(benchmark::kMillisecond);
    }
  }
}
const bool added = (add_dense(), true);

}  // namespace
}  // namespace pelage
