// SPDX-License-Identifier: Apache-2.0
#include "geom/mesh.h"

#include <gtest/gtest.h>

#include "tests/geom/cages.h"

namespace pelage {
namespace {

TEST(MergeEqualFaces, KeepsTheFirstOfEachAndWhatBelongsToIt) {
  ControlMesh mesh = make_cage({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}},
                               {{0, 1, 2, 3}, {2, 1, 0, 3}, {1, 4, 2}, {0, 1, 2}, {4, 2, 1}, {0, 1, 3, 2}});
  mesh.uv.resize(9);
  mesh.face_uv = {0, 1, 2, 3, 8, 8, 8, 8, 4, 5, 6, 1, 1, 1, 8, 8, 8, 8, 8, 8, 8};
  mesh.face_groups = {1, 2, 3, 4, 5, 6};
  mesh.holes = {0, 2, 4, 3};
  EXPECT_EQ(merge_equal_faces(mesh), 3u);
  EXPECT_EQ(mesh.face_sizes, (std::vector<uint32_t>{4, 3, 3}));
  EXPECT_EQ(mesh.face_vertices, (std::vector<uint32_t>{0, 1, 2, 3, 1, 4, 2, 0, 1, 2}));
  EXPECT_EQ(mesh.face_uv, (std::vector<uint32_t>{0, 1, 2, 3, 4, 5, 6, 1, 1, 1}));
  EXPECT_EQ(mesh.face_groups, (std::vector<uint16_t>{1, 3, 4}));
  EXPECT_EQ(mesh.holes, (std::vector<uint32_t>{1, 2})) << "the square is a hole only once";
  EXPECT_EQ(mesh.positions.size(), 5u);
  EXPECT_EQ(merge_equal_faces(mesh), 0u);
}

TEST(MergeEqualFaces, LeavesOtherMeshesAsTheyAre) {
  for (ControlMesh mesh : {torus_cage(5, 4), octahedron_cage(), grid_cage(3, 2), ControlMesh()}) {
    const ControlMesh before = mesh;
    EXPECT_EQ(merge_equal_faces(mesh), 0u);
    EXPECT_EQ(mesh.face_vertices, before.face_vertices);
    EXPECT_EQ(mesh.face_uv, before.face_uv);
  }
  ControlMesh damaged = cube_cage();
  damaged.face_sizes.push_back(4);
  EXPECT_EQ(merge_equal_faces(damaged), 0u);
}

}  // namespace
}  // namespace pelage
