// SPDX-License-Identifier: Apache-2.0
#include "geom/io/host_geometry.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "geom/io/strand_reader.h"
#include "tests/support/quiet_job.h"

namespace pelage::host_geometry_test {
namespace {

ControlMesh square() {
  ControlMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
  mesh.face_sizes = {4};
  mesh.face_vertices = {0, 3, 2, 1};
  return mesh;
}

template <class Make>
std::string message_of(const Make& make) {
  try {
    make();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(HostMesh, IsNamedByItsContents) {
  ControlMesh other = square();
  other.positions[2].y = 0.5f;
  EXPECT_EQ(share_mesh(square())->name(), share_mesh(square())->name());
  EXPECT_NE(share_mesh(square())->name(), share_mesh(other)->name());
  EXPECT_EQ(share_mesh(square())->mesh().groups, std::vector<std::string>{"default"});
}

TEST(HostMesh, RefusesWhatNoFileMayHold) {
  const auto with = [](const auto& edit) {
    return message_of([&] {
      ControlMesh mesh = square();
      edit(mesh);
      share_mesh(mesh);
    });
  };
  EXPECT_EQ(with([](ControlMesh& m) { m.face_vertices[1] = 4; }),
            "face 0: there is no vertex 4; the mesh has 4");
  EXPECT_EQ(with([](ControlMesh& m) {
              m.face_vertices = {0, 1, 0, 1};
            }),
            "face 0 needs 3 different vertices");
  EXPECT_EQ(with([](ControlMesh& m) { m.face_sizes = {3}; }), "the faces need 3 corners, got 4");
  EXPECT_EQ(with([](ControlMesh& m) { m.positions[0].x = NAN; }), "a vertex of the mesh is not finite");
  EXPECT_EQ(with([](ControlMesh& m) { m.face_sizes.clear(); }), "the mesh has no faces");
  EXPECT_EQ(with([](ControlMesh& m) { m.holes = {1}; }), "a hole is not a face of the mesh");
}

/// Three strands; the second has no extent, and no file reader keeps it.
Strands three_strands() {
  StrandArrays arrays;
  arrays.basis = CurveBasis::kCatmullRom;
  arrays.first_point = {0, 2, 4, 7};
  arrays.ids = {7, 8, 9};
  for (float y : {0.0f, 1.0f, 2.0f, 2.0f, 3.0f, 4.0f, 6.0f})
    arrays.points.insert(arrays.points.end(), {0.5f, y, 0, 0.01f});
  arrays.attributes = {{"color", AttributeClass::kPerPoint, 1, {0, 1, 2, 3, 4, 5, 6}},
                       {"weight", AttributeClass::kPerStrand, 1, {10, 11, 12}}};
  return Strands(std::move(arrays));
}

TEST(HostStrands, AreReadLikeThoseOfAFile) {
  const auto shared = share_strands(std::make_shared<const Strands>(three_strands()));
  AssetPath asset{shared->name(), {}, shared};
  StrandReader reader(asset, {});
  QuietJob quiet;
  reader.scan(quiet, [](size_t, const Strands&) {});
  EXPECT_EQ(reader.strand_count(), 2u);
  EXPECT_EQ(reader.basis(), CurveBasis::kCatmullRom);
  EXPECT_EQ(reader.repairs().dropped, 1);
  const Strands second = reader.read(std::vector<uint32_t>{1});
  EXPECT_EQ(second.id(0), 2u) << "the index in the batch, as in a file";
  EXPECT_EQ(second.strand_points(0), 3u);
  EXPECT_EQ(second.point(1).y, 4);
  EXPECT_EQ(second.find_attribute("color")->values, (std::vector<float>{4, 5, 6}));
  EXPECT_EQ(second.find_attribute("weight")->values, std::vector<float>{12});
}

TEST(HostData, OfTheWrongKindIsAnError) {
  const auto mesh = share_mesh(square());
  const AssetPath asset{mesh->name(), {"grooms.coat.strands_file", 0, 0}, mesh};
  EXPECT_EQ(message_of([&] { read_strands(asset); }),
            "grooms.coat.strands_file: expected strands, got " + mesh->name());
}

}  // namespace
}  // namespace pelage::host_geometry_test
