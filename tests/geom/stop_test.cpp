// SPDX-License-Identifier: Apache-2.0
// Making a skin is stopped at every step of it.
#include <atomic>
#include <fstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/job.h"
#include "base/temporary_folder.h"
#include "geom/closest_point.h"
#include "geom/io/obj_file.h"
#include "geom/skin_pieces.h"
#include "geom/tessellation.h"
#include "tests/geom/cages.h"

namespace pelage {
namespace {

/// The user asks to stop when somebody looks for the `after`th time.
struct StopsLater final : Progress {
  explicit StopsLater(int times) : after(times) {}
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  bool cancelled() const override { return looks++ >= after; }
  const int after;
  mutable std::atomic<int> looks{0};
};

/// How often `work(job)` looks whether it shall stop. It stops at any of these times.
template <class Work>
int looks_of(const Work& work) {
  const Workers workers(1);
  MemoryLedger ledger;
  StopsLater never(1 << 30);
  work(Job{workers, ledger, never});
  for (const int after : {0, never.looks / 2, never.looks - 1}) {
    StopsLater progress(after);
    try {
      work(Job{workers, ledger, progress});
      ADD_FAILURE() << "not stopped at " << after << " of " << never.looks;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kStopped);
    }
    EXPECT_EQ(progress.looks, after + 1);
  }
  return never.looks;
}

TEST(Stopping, IsHeardWhileSkinsAreMade) {
  const ControlMesh mesh = bumpy_sphere(80);
  const TemporaryFolder folder;
  const auto path = folder.path() / "mesh.obj";
  {
    std::ofstream file(path);
    for (const V3f& p : mesh.positions) file << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    for (size_t i = 0; i < mesh.face_vertices.size(); i += 3) {
      file << 'f';
      for (size_t k = 0; k < 3; ++k) file << ' ' << mesh.face_vertices[i + k] + 1;
      file << '\n';
    }
  }
  EXPECT_GE(looks_of([&](const Job& job) { EXPECT_EQ(read_obj(path, job).face_count(), mesh.face_count()); }),
            4);
  std::shared_ptr<const SurfaceTopology> topology;
  for (const auto scheme : {SubdivisionScheme::kCatmullClark, SubdivisionScheme::kNone}) {
    EXPECT_GE(looks_of([&](const Job& job) {
                topology = SurfaceTopology::create(mesh, scheme, BoundaryRule::kEdgeAndCorner, "test", job);
              }),
              2);
  }
  const LimitSurface surface(topology, mesh.positions);
  SkinMesh skin;
  EXPECT_GE(looks_of([&](const Job& job) { skin = tessellate(std::span(&surface, 1), View(), {}, job); }),
            100);
  EXPECT_GE(looks_of([&](const Job& job) {
              const auto pieces = divide_skin(std::span(&surface, 1), View(), {}, 1, job);
              EXPECT_GT(pieces.size(), 32u);
            }),
            150);
  EXPECT_GE(looks_of([&](const Job& job) { ClosestPointTree(skin, 0, &job); }), 1);
}

}  // namespace
}  // namespace pelage
