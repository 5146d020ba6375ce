// SPDX-License-Identifier: Apache-2.0
#include "geom/skin_memory.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "geom/closest_point.h"
#include "geom/io/obj_file.h"
#include "geom/tessellation.h"
#include "tests/geom/cages.h"
#include "tests/support/allocation_meter.h"
#include "tests/support/data.h"

namespace pelage::skin_memory_test {
namespace {

struct Case {
  const char* name;
  ControlMesh mesh;
  SubdivisionScheme scheme = SubdivisionScheme::kCatmullClark;
  double over = 2;  // how many times more than is measured an estimate may be
};

void expect_bounded(const Case& c) {
  SCOPED_TRACE(c.name);
  const SkinMemory estimate = skin_memory(c.mesh, c.scheme);
  const auto peak = [&](size_t measured) {
    return static_cast<size_t>(c.over * static_cast<double>(measured)) + (1 << 17);
  };
  reset_peak();
  const size_t before = live_bytes();
  const auto topology = SurfaceTopology::create(c.mesh, c.scheme, BoundaryRule::kEdgeAndCorner, "test");
  EXPECT_LE(peak_bytes() - before, estimate.making);
  EXPECT_GE(peak(peak_bytes() - before), estimate.making);
  const LimitSurface surface(topology, c.mesh.positions);
  const size_t held = live_bytes() - before;
  EXPECT_LE(held, estimate.held);
  EXPECT_GE(peak(held), estimate.held);
  reset_peak();
  const SkinMesh skin = tessellate(std::span(&surface, 1), View(), {}, Workers(1));
  const ClosestPointTree tree(skin, 0);
  EXPECT_LE(peak_bytes() - before - held, estimate.triangles);
  EXPECT_GE(peak(peak_bytes() - before - held), estimate.triangles);
  EXPECT_GE(estimate.peak(), std::max(estimate.making, held));
}

TEST(SkinMemory, IsBoundedBeforeAnythingIsMade) {
  ControlMesh creased = torus_cage(40, 30), semi_sharp = torus_cage(40, 30), sharp = torus_cage(40, 30);
  for (uint32_t i = 0; i < 100; ++i) {
    const uint32_t a = creased.face_vertices[4 * i], b = creased.face_vertices[4 * i + 1];
    creased.creases.push_back({a, b, 2.5f});
    semi_sharp.creases.push_back({a, b, 5.5f});
    sharp.creases.push_back({a, b, 10.0f});
  }
  ControlMesh mapped = bumpy_sphere(60);
  mapped.uv.resize(mapped.positions.size());
  mapped.face_uv = mapped.face_vertices;
  using S = SubdivisionScheme;
  for (const Case& c : {Case{"triangles", bumpy_sphere(30)},
                        {"dense triangles", bumpy_sphere(56)},
                        {"very dense triangles", bumpy_sphere(102)},
                        {"quads", torus_cage(40, 30), S::kCatmullClark, 3},
                        {"dense quads", torus_cage(90, 80), S::kCatmullClark, 3},
                        {"quads with a border", grid_cage(40, 40), S::kCatmullClark, 3},
                        {"poles", poles_cage(300)},
                        {"polygons", prism_cage(300)},
                        {"creases", creased, S::kCatmullClark, 3},
                        {"semi-sharp creases", semi_sharp, S::kCatmullClark, 3},
                        {"sharp creases", sharp, S::kCatmullClark, 3},
                        {"loop", bumpy_sphere(30), S::kLoop},
                        {"dense loop", bumpy_sphere(56), S::kLoop},
                        {"very dense loop", bumpy_sphere(102), S::kLoop},
                        {"bilinear triangles", bumpy_sphere(40), S::kBilinear},
                        {"bilinear quads", torus_cage(40, 30), S::kBilinear},
                        {"flat", bumpy_sphere(102), S::kNone},
                        {"flat, mapped", mapped, S::kNone},
                        {"flat quads", torus_cage(60, 50), S::kNone}}) {
    expect_bounded(c);
  }
}

TEST(SkinMemory, OfRealCages) {
  PELAGE_REQUIRE_DATA();
  for (const char* name :
       {"penguin_control_mesh.obj", "sintel_bust.obj", "spot_control_mesh.obj", "spot_quadrangulated.obj"}) {
    const ControlMesh mesh = read_obj(data_folder() / "mesh" / name);
    for (const auto scheme : {SubdivisionScheme::kCatmullClark, SubdivisionScheme::kNone})
      expect_bounded({name, mesh, scheme, 3});
  }
}

}  // namespace
}  // namespace pelage::skin_memory_test
