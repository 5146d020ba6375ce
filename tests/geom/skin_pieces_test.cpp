// SPDX-License-Identifier: Apache-2.0
#include "geom/skin_pieces.h"

#include <algorithm>
#include <map>
#include <set>

#include "base/parallel.h"
#include "geom/io/obj_file.h"
#include "tests/geom/cages.h"
#include "tests/support/data.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

View near_view(const LimitSurface& surface) {
  View view;
  const float size = surface.control_bounds().size().length();
  view.position = surface.control_bounds().center() + V3f(0.3f, 0.2f, 1.2f) * size;
  view.focal_pixels = 300;
  return view;
}

/// First triangle of every ptex face.
std::map<uint32_t, size_t> first_triangles(const SkinMesh& mesh) {
  std::map<uint32_t, size_t> first;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) first.emplace(mesh.faces[t], t);
  return first;
}

/// Every triangle of the whole skin stands in one piece, bit by bit as in the whole, and pieces are posed on
/// the faces around them alone.
void expect_pieces_of_the_whole(const ControlMesh& cage, SubdivisionScheme scheme, size_t max) {
  const auto topology = SurfaceTopology::create(cage, scheme, BoundaryRule::kEdgeAndCorner, "test");
  std::vector<V3f> moved = cage.positions;
  for (V3f& p : moved) p += V3f(0.1f * p.y, 0.05f * p.x, 0.1f);
  const std::vector<LimitSurface> keys{{topology, cage.positions}, {topology, moved}};
  const View view = near_view(keys[0]);
  const TessellationOptions options{4, 16};
  const SkinMesh whole = tessellate(keys, view, options, Workers(2));
  const auto first = first_triangles(whole);

  const std::vector<SkinPiece> pieces = divide_skin(keys, view, options, max, QuietJob(2));
  if (whole.triangle_count() + kTrianglesPerPose * topology->face_count() > max) {
    EXPECT_GT(pieces.size(), 1u);
  }
  size_t triangles = 0;
  std::vector<int> seen(topology->face_count());
  for (const SkinPiece& piece : pieces) {
    for (const uint32_t face : piece.faces) ++seen[face];
    const std::vector<uint32_t> around = faces_around(*topology, piece.faces);
    ASSERT_TRUE(std::is_sorted(piece.faces.begin(), piece.faces.end()));
    ASSERT_TRUE(std::includes(around.begin(), around.end(), piece.faces.begin(), piece.faces.end()));
    const std::vector<LimitSurface> here{{topology, cage.positions, around}, {topology, moved, around}};
    const SkinMesh mesh = tessellate_faces(here, piece.faces, view, options);
    ASSERT_EQ(mesh.vertex_count(), piece.vertices);
    ASSERT_EQ(mesh.triangle_count(), piece.triangles);
    ASSERT_EQ(mesh.motion_keys, 2);
    triangles += mesh.triangle_count();
    std::map<uint32_t, size_t> count;
    for (size_t t = 0; t < mesh.triangle_count(); ++t) {
      const uint32_t face = mesh.faces[t];
      const size_t same = first.at(face) + count[face]++;
      ASSERT_EQ(whole.faces[same], face);
      for (size_t c = 0; c < 3; ++c) {
        const uint32_t a = mesh.triangles[3 * t + c], b = whole.triangles[3 * same + c];
        ASSERT_EQ(mesh.vertex_uv[3 * t + c], whole.vertex_uv[3 * same + c]);
        for (int key = 0; key < 2; ++key) {
          ASSERT_EQ(mesh.position(a, key), whole.position(b, key)) << "face " << face;
          ASSERT_EQ(mesh.normal(a, key), whole.normal(b, key)) << "face " << face;
        }
      }
    }
  }
  EXPECT_EQ(triangles, whole.triangle_count());
  if (pieces.size() > 1) {
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ptrdiff_t(seen.size()));
  }
}

void crease(ControlMesh& cage, size_t face) {
  for (size_t i = 0; i < 4; ++i)
    cage.creases.push_back(
        {cage.face_vertices[face * 4 + i], cage.face_vertices[face * 4 + (i + 1) % 4], 10});
}

TEST(SkinPieces, TogetherAreTheWholeBitByBit) {
  for (const size_t max : {1, 300, 1500}) {
    SCOPED_TRACE(max);
    expect_pieces_of_the_whole(torus_cage(12, 8), SubdivisionScheme::kCatmullClark, max);
    expect_pieces_of_the_whole(cube_cage(), SubdivisionScheme::kCatmullClark, max);
    expect_pieces_of_the_whole(cube_cage(), SubdivisionScheme::kBilinear, max);
    expect_pieces_of_the_whole(prism_cage(5), SubdivisionScheme::kCatmullClark, max);
    expect_pieces_of_the_whole(prism_cage(3), SubdivisionScheme::kCatmullClark, max);
  }
}

TEST(SkinPieces, ShareNormalsAcrossSharpEdgesAndBesideHoles) {
  ControlMesh cube = cube_cage();
  for (size_t f = 0; f < 6; ++f) crease(cube, f);
  expect_pieces_of_the_whole(cube, SubdivisionScheme::kCatmullClark, 1);
  ControlMesh grid = grid_cage(5, 4);
  grid.holes = {4, 9, 10};
  crease(grid, 7);
  expect_pieces_of_the_whole(grid, SubdivisionScheme::kCatmullClark, 1);
  expect_pieces_of_the_whole(grid, SubdivisionScheme::kBilinear, 60);
  ControlMesh prism = prism_cage(6);
  prism.holes = {0};
  expect_pieces_of_the_whole(prism, SubdivisionScheme::kCatmullClark, 1);
}

TEST(SkinPieces, OfTriangularCages) {
  expect_pieces_of_the_whole(octahedron_cage(), SubdivisionScheme::kLoop, 1);
  expect_pieces_of_the_whole(octahedron_cage(), SubdivisionScheme::kLoop, 50);
}

TEST(SkinPieces, OfFlatTriangles) {
  expect_pieces_of_the_whole(bumpy_sphere(16), SubdivisionScheme::kNone, 1000);
  expect_pieces_of_the_whole(prism_cage(9), SubdivisionScheme::kNone, 50);
}

TEST(SkinPieces, AreMuchAlikeInSize) {
  const ControlMesh cage = torus_cage(40, 24);
  const LimitSurface surface(
      SurfaceTopology::create(cage, SubdivisionScheme::kCatmullClark, BoundaryRule::kEdgeAndCorner, "test"),
      cage.positions);
  constexpr size_t kMax = 2000;
  const std::vector<SkinPiece> pieces =
      divide_skin(std::span(&surface, 1), near_view(surface), {2, 16}, kMax, QuietJob(2));
  ASSERT_GT(pieces.size(), 4u);
  size_t all = 0, largest = 0;
  for (const SkinPiece& piece : pieces) {
    const size_t cost = piece.triangles + kTrianglesPerPose * piece.faces.size();
    all += cost;
    largest = std::max(largest, cost);
  }
  EXPECT_LE(largest, kMax);
  EXPECT_GT(all, pieces.size() * kMax * 6 / 10);
}

TEST(SkinPieces, LieWithinTheHullOfTheVerticesAround) {
  const ControlMesh cage = torus_cage(12, 8);
  const auto topology =
      SurfaceTopology::create(cage, SubdivisionScheme::kCatmullClark, BoundaryRule::kEdgeAndCorner, "test");
  const LimitSurface surface(topology, cage.positions);
  for (const SkinPiece& piece :
       divide_skin(std::span(&surface, 1), near_view(surface), {4, 16}, 600, QuietJob(1))) {
    Box3f hull;
    const std::vector<uint32_t> vertices = vertices_of(*topology, faces_around(*topology, piece.faces));
    EXPECT_LT(vertices.size(), cage.positions.size());
    for (const uint32_t v : vertices) hull.extendBy(cage.positions[v]);
    const SkinMesh mesh = tessellate_faces(std::span(&surface, 1), piece.faces, near_view(surface), {4, 16});
    for (size_t i = 0; i < mesh.vertex_count(); ++i) EXPECT_TRUE(hull.intersects(mesh.position(i)));
  }
}

/// faces_around(), by a look at every face of the cage.
std::vector<uint32_t> faces_around_slowly(const ControlMesh& cage, const SurfaceTopology& topology,
                                          std::span<const uint32_t> faces) {
  std::vector<std::vector<uint32_t>> corners(cage.face_count());
  size_t first = 0;
  for (size_t face = 0; face < corners.size(); ++face) {
    corners[face].assign(cage.face_vertices.begin() + std::ptrdiff_t(first),
                         cage.face_vertices.begin() + std::ptrdiff_t(first + cage.face_sizes[face]));
    first += cage.face_sizes[face];
  }
  std::set<uint32_t> touched;
  for (const uint32_t face : faces) {
    const auto& own = corners[topology.cage_face(face)];
    touched.insert(own.begin(), own.end());
  }
  std::vector<uint32_t> around;
  for (uint32_t face = 0; face < topology.face_count(); ++face) {
    const auto& own = corners[topology.cage_face(face)];
    if (std::any_of(own.begin(), own.end(), [&](uint32_t v) { return touched.count(v) > 0; }))
      around.push_back(face);
  }
  return around;
}

TEST(SkinPieces, HaveTheFacesAroundThatALookAtEveryFaceFinds) {
  const std::pair<ControlMesh, SubdivisionScheme> cases[] = {
      {torus_cage(12, 8), SubdivisionScheme::kCatmullClark},
      {prism_cage(5), SubdivisionScheme::kBilinear},
      {octahedron_cage(), SubdivisionScheme::kLoop},
      {bumpy_sphere(8), SubdivisionScheme::kNone}};
  for (const auto& [cage, scheme] : cases) {
    const auto topology = SurfaceTopology::create(cage, scheme, BoundaryRule::kEdgeAndCorner, "test");
    for (uint32_t face = 0; face < topology->face_count(); ++face) {
      const std::vector<uint32_t> one = {face}, two = {face / 2, face};
      for (const auto& faces : {one, two})
        ASSERT_EQ(faces_around(*topology, faces), faces_around_slowly(cage, *topology, faces)) << face;
    }
  }
}

TEST(SkinPieces, AreTheSameForAnyNumberOfThreads) {
  const ControlMesh cage = bumpy_sphere(40);
  const LimitSurface surface(
      SurfaceTopology::create(cage, SubdivisionScheme::kNone, BoundaryRule::kEdgeAndCorner, "test"),
      cage.positions);
  const auto faces = [&](int threads) {
    std::vector<std::vector<uint32_t>> found;
    for (SkinPiece& piece :
         divide_skin(std::span(&surface, 1), near_view(surface), {}, 3000, QuietJob(threads)))
      found.push_back(std::move(piece.faces));
    return found;
  };
  EXPECT_GT(faces(1).size(), 4u);
  EXPECT_EQ(faces(1), faces(2));
}

TEST(SkinPieces, OfRealCages) {
  PELAGE_REQUIRE_DATA();
  for (const char* name : {"spot_control_mesh.obj", "penguin_control_mesh.obj", "sintel_bust.obj"}) {
    SCOPED_TRACE(name);
    expect_pieces_of_the_whole(read_obj(data_folder() / "mesh" / name), SubdivisionScheme::kCatmullClark,
                               2048);
  }
}

}  // namespace
}  // namespace pelage
