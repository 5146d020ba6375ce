// SPDX-License-Identifier: Apache-2.0
#include "geom/io/obj_file.h"

#include <fstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/temporary_folder.h"
#include "tests/support/data.h"

namespace pelage {
namespace {

/// The mesh of a file with these contents.
ControlMesh read_text(const std::string& contents, const TemporaryFolder& folder = {}) {
  std::filesystem::remove(folder.path() / "cage.obj");  // some file systems flush what overwrites a file
  std::ofstream(folder.path() / "cage.obj", std::ios::binary) << contents;
  return read_obj(folder.path() / "cage.obj");
}

/// "line:column: message" of each problem.
std::vector<std::string> problems_of(const std::string& contents) {
  try {
    read_text(contents);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    std::vector<std::string> result;
    for (const Problem& p : error.problems()) {
      EXPECT_TRUE(p.position.file.ends_with(".obj"));
      result.push_back(to_string({"", p.position.line, p.position.column}) + " " + p.message);
      if (result.back().starts_with(':')) result.back().erase(0, 1);
    }
    return result;
  }
  return {};
}

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(ObjFile, ReadsColorsObjectsAndMaterials) {
  const ControlMesh mesh = read_text(
      "v 0 0 0\nv 1 0 0 0.1 0.2 0.3\nv 1 1 0 0.9\nv 0 1 0 1 0 0.5\n"
      "f 1 2 3\no body\nf 1 2 4\nusemtl skin\ng ears\nf 2 3 4\no tail\nf 1 3 4\n");
  EXPECT_EQ(mesh.colors, (std::vector<Rgb>{Rgb(1), Rgb(0.1f, 0.2f, 0.3f), Rgb(1), Rgb(1, 0, 0.5f)}));
  EXPECT_EQ(mesh.objects.names, (std::vector<std::string>{"", "body", "tail"}));
  EXPECT_EQ(mesh.objects.faces, (std::vector<uint16_t>{0, 1, 1, 2}));
  EXPECT_EQ(mesh.materials.names, (std::vector<std::string>{"", "skin"}));
  EXPECT_EQ(mesh.materials.faces, (std::vector<uint16_t>{0, 0, 1, 1}));
  EXPECT_TRUE(read_text(kTriangle + "f 1 2 3\n").colors.empty());
  EXPECT_EQ(problems_of("v 0 0 0 1 x 0\n" + kTriangle + "f 1 2 3\n").size(), 1u);
}

TEST(ObjFile, ReadsWhatItIsFor) {
  const ControlMesh mesh = read_text(
      "# a comment\r\n"
      "mtllib nothing.mtl\n"
      "v 0 0 0 1\n"
      "v +1.5e0 -.5 2.\n"
      "\tv 1 1 0 0.2 0.3 0.4\n"
      "v 0 1 0\n"
      "vt 0 0\nvt 1 0\nvt 1 1 0\nvt 0.25\n"
      "vn 0 0 1\n"
      "o body part\n"
      "f 1/1/1 2/2/1 3/3/1 \\\n  4/4/1  # goes on\n"
      "g ear\n"
      "f -4/-4 -3/-3 -2/-2\n"
      "f 5//1 1 2\n"
      "g body part\n"
      "f 1/1 2/2 3/3\n"
      "v 9 9 9");
  ASSERT_EQ(mesh.positions.size(), 5u);
  EXPECT_EQ(mesh.positions[1], V3f(1.5f, -0.5f, 2));
  EXPECT_EQ(mesh.positions[2], V3f(1, 1, 0));
  EXPECT_EQ(mesh.positions[4], V3f(9, 9, 9));
  EXPECT_EQ(mesh.face_sizes, (std::vector<uint32_t>{4, 3, 3, 3}));
  EXPECT_EQ(mesh.face_vertices, (std::vector<uint32_t>{0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 0, 1, 2}));
  // The third face has no texture coordinates: it gets an extra one, (0, 0).
  EXPECT_EQ(mesh.face_uv, (std::vector<uint32_t>{0, 1, 2, 3, 0, 1, 2, 4, 4, 4, 0, 1, 2}));
  ASSERT_EQ(mesh.uv.size(), 5u);
  EXPECT_EQ(mesh.uv[3], V2f(0.25f, 0));
  EXPECT_EQ(mesh.uv[4], V2f(0, 0));
  EXPECT_EQ(mesh.groups, (std::vector<std::string>{"body part", "ear"}));
  EXPECT_EQ(mesh.face_groups, (std::vector<uint16_t>{0, 1, 1, 0}));
  EXPECT_GT(mesh.bytes(), 5 * sizeof(V3f));
}

TEST(ObjFile, AByteOrderMarkHidesNoVertex) {
  EXPECT_EQ(read_text("\xef\xbb\xbf" + kTriangle + "f 1 2 3\n").positions.size(), 3u);
  EXPECT_EQ(problems_of("version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n"),
            (std::vector<std::string>{" is a git-lfs pointer, not the file itself"}));
}

TEST(ObjFile, ReadsTagsByIndicesOfTheWholeFile) {
  const ControlMesh mesh = read_text(
      "t crease 2/1/0 0 1 3.5\n"  // before what they refer to
      "g a\n" +
      kTriangle + "v 1 1 0\nf 1 2 3\ng b\nf 2 4 3\n" +
      "t crease 3/2/0 1 3 2 1 12\n"
      "t crease 3/1/0 0 1 2 4\n"
      "t corner 2/1/0 0 3 2.5\n"
      "t hole 1/0/0 1\n"
      "t interpolateboundary 1/0/0 2\n"
      "t creasemethod 0/0/1 chaikin\n"
      "t smoothtriangles 0/0/1 smooth\n"
      "t facevaryinginterpolateboundary 1/0/0 1\n");
  ASSERT_EQ(mesh.creases.size(), 5u);
  EXPECT_EQ(mesh.creases[0].a, 0u);
  EXPECT_EQ(mesh.creases[0].b, 1u);
  EXPECT_EQ(mesh.creases[0].sharpness, 3.5f);
  EXPECT_EQ(mesh.creases[2].a, 3u);
  EXPECT_EQ(mesh.creases[2].b, 2u);
  EXPECT_EQ(mesh.creases[2].sharpness, 12);
  EXPECT_EQ(mesh.creases[4].sharpness, 4);
  ASSERT_EQ(mesh.corners.size(), 2u);
  EXPECT_EQ(mesh.corners[1].vertex, 3u);
  EXPECT_EQ(mesh.corners[1].sharpness, 2.5f);
  EXPECT_EQ(mesh.holes, (std::vector<uint32_t>{1}));
  EXPECT_EQ(mesh.boundary_tag, 2);
  EXPECT_TRUE(mesh.chaikin_creases);
  EXPECT_TRUE(mesh.smooth_triangles);
  EXPECT_TRUE(mesh.face_uv.empty());
}

TEST(ObjFile, NamesEveryMistakeWithItsLine) {
  const std::vector<std::string> problems = problems_of(
      "v 0 0 nan\n"
      "v 0 0\n"
      "v 1 2x 3\n"
      "v 1e39 0 0\n"
      "v inf 0 0\n" +
      kTriangle +  // vertices 6 to 8
      "f 6 7\n"
      "f 6 7 0\n"
      "f 6 7 -9\n"
      "f 6 7 8.5\n"
      "f 6 7 9\n"
      "f 6 7 99999999999999999999\n"
      "f 6 7 6\n"
      "f 6/1 7 8\n"
      "f 6 7 8/-1\n"
      "t crease 2/1/0 0\n"
      "t corner 1/1/0 77 1\n");
  const std::vector<std::string> expected = {
      "1:7 expected z, a number that a float can hold, got 'nan'",
      "2:6 expected z, a number, got the end of the line",
      "3:5 expected y, a number, got '2x'",
      "4:3 expected x, a number that a float can hold, got '1e39'",
      "5:3 expected x, a number that a float can hold, got 'inf'",
      "9:6 a face needs 3 corners, this one has 2",
      "10:7 vertex 0: indices count from 1",
      "11:7 vertex -9 does not exist: only 8 precede it",
      "12:7 expected the number of a vertex, got '8.5'",
      "13 vertex 9 does not exist: the file has 8",
      "14:7 expected the number of a vertex, got '99999999999999999999'",
      "15:8 a face needs 3 different vertices",
      "16:10 either all corners of a face have texture coordinates or none of them",
      "16 texture coordinate 1 does not exist: the file has 0",
      "17:7 texture coordinate -1 does not exist: only 0 precede it",
      "18:17 expected a whole number of the tag, got the end of the line",
      "18:17 a crease needs 2 vertices or more",
      "19 tag vertices are numbered from 0 to 7",
  };
  EXPECT_EQ(problems, expected);
}

TEST(ObjFile, RefusesWhatItCannotHonour) {
  EXPECT_EQ(problems_of(""), (std::vector<std::string>{" has no faces"}));
  EXPECT_EQ(problems_of(kTriangle), (std::vector<std::string>{" has no faces"}));
  EXPECT_EQ(problems_of(std::string("\0\x89PNG\r\n\x1a\n f v t \xff", 17)).size(), 1u);
  const std::string face = kTriangle + "f 1 2 3\n";
  EXPECT_EQ(problems_of(face + "t vertexedit 1/1/1 0 0 x\n"),
            (std::vector<std::string>{"5:14 hierarchical edits ('vertexedit') are not supported"}));
  EXPECT_EQ(problems_of(face + "t crease 2/1/0 0 1 -1\n"),
            (std::vector<std::string>{"5:20 a sharpness may not be negative, got -1"}));
  EXPECT_EQ(problems_of(face + "t crease 4000000000000/1/0 0 1 1\n").size(), 2u);
  EXPECT_EQ(problems_of(face + "t crease -2/1/0 0 1 1\n").size(), 1u);
  EXPECT_EQ(problems_of(face + "t hole 1/0/0 1\n"),
            (std::vector<std::string>{"5 tag faces are numbered from 0 to 0"}));
  EXPECT_EQ(problems_of(face + "t hole 1/0/0 -1\n").size(), 1u);
  EXPECT_EQ(problems_of(face + "t crease\n").size(), 1u);
  EXPECT_EQ(problems_of(face + "t interpolateboundary 1/0/0 7\n").size(), 1u);
  EXPECT_THROW(read_obj("/no/such/file.obj"), Error);
}

TEST(ObjFile, ReportsAPageOfProblemsAndCountsTheRest) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "v bad\n";
  const std::vector<std::string> problems = problems_of(text);
  ASSERT_EQ(problems.size(), 21u);
  EXPECT_EQ(problems.back(), " 981 more problems");
}

TEST(ObjFile, ReadsPolygonsOfAnySize) {
  std::string text;
  for (int i = 0; i < 300; ++i) {
    text += "v " + std::to_string(std::cos(i * 2 * M_PI / 300)) + " " +
            std::to_string(std::sin(i * 2 * M_PI / 300)) + " 0\n";
  }
  text += "f";
  for (int i = 1; i <= 300; ++i) text += " " + std::to_string(i);
  EXPECT_EQ(read_text(text).face_sizes, (std::vector<uint32_t>{300}));
}

TEST(ObjFile, CountsGroupsWithinSixteenBits) {
  std::string text = kTriangle;
  for (int i = 0; i < 65537; ++i) text += "g " + std::to_string(i) + "\n";
  EXPECT_EQ(problems_of(text + "f 1 2 3\n"), (std::vector<std::string>{"65540:1 more than 65536 groups"}));
}

/// Whatever the damage: a mesh whose indices fit, or an Error.
TEST(ObjFile, SurvivesDamage) {
  std::string good = "o thing\n";
  for (int i = 0; i < 16; ++i)
    good += "v " + std::to_string(i % 4) + ".5 " + std::to_string(i / 4) + " 0e0\n";
  for (int i = 0; i < 16; ++i) good += "vt 0.25 " + std::to_string(i) + "\n";
  for (int i = 0; i < 11; ++i)
    good += "f " + std::to_string(i + 1) + "/1 " + std::to_string(i + 2) + "/2 -3/3 \\\n -1/4\n";
  good += "t crease 2/1/0 0 1 2.5\nt hole 2/0/0 1 2\nt corner 1/1/0 3 1\n";
  const std::string alphabet = "0123456789-+./\\ \n\teEnfvtgo#\xff";
  const TemporaryFolder folder;
  int accepted = 0;
  for (uint64_t trial = 0; trial < 1500; ++trial) {
    std::string text = good;
    const uint64_t edits = 1 + hash64(trial, 1) % 4;
    for (uint64_t e = 0; e < edits; ++e) {
      const size_t at = hash64(trial, 2, e) % text.size();
      const char c = alphabet[hash64(trial, 3, e) % alphabet.size()];
      switch (hash64(trial, 4, e) % 4) {
        case 0:
          text[at] = c;
          break;
        case 1:
          text.insert(at, 1, c);
          break;
        case 2:
          text.erase(at, hash64(trial, 5, e) % 20);
          break;
        default:
          text.resize(at + 1);
          break;
      }
    }
    try {
      const ControlMesh mesh = read_text(text, folder);
      ++accepted;
      for (uint32_t v : mesh.face_vertices) ASSERT_LT(v, mesh.positions.size());
      for (uint32_t v : mesh.face_uv) ASSERT_LT(v, mesh.uv.size());
      for (const ControlMesh::Crease& c : mesh.creases) ASSERT_LT(std::max(c.a, c.b), mesh.positions.size());
      for (uint32_t face : mesh.holes) ASSERT_LT(face, mesh.face_count());
    } catch (const Error& error) {
      EXPECT_FALSE(error.problems().empty());
    }
  }
  EXPECT_GT(accepted, 100);
  EXPECT_LT(accepted, 1400);
}

TEST(ObjFile, ReadsPositionsOfAPose) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "pose.obj";
  const auto refusal = [&](const std::string& text, const MeshOrder& order) -> std::string {
    std::ofstream(path) << text;
    try {
      EXPECT_EQ(read_obj_positions(path, order).at(1), V3f(1, 0, 0));
      return "";
    } catch (const Error& error) {
      return std::string(error.what()).substr(path.string().size());
    }
  };
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const MeshOrder order = mesh_order(read_text(square + "vt 0 0\nf 1 2 3\nf 1/1 3/1 4/1\n"));
  EXPECT_EQ(refusal(square, order), "") << "no faces";
  EXPECT_EQ(refusal(square + "f 1 2 3\nf -4//7 3 -1\n", order), "") << "other texture coordinates";
  EXPECT_EQ(refusal(kTriangle + "f 1 2 3\n", order), ": has 3 vertices, but its cage has 4");
  // Turned by half a turn: as a set, the faces are the same.
  for (const char* faces :
       {"f 3 4 1\nf 3 1 2\n", "f 1 3 4\nf 1 2 3\n", "f 1 2 3\n", "f 1 2 3 4\n", "f 1 2 77\n"})
    EXPECT_NE(refusal(square + faces, order).find("vertices may be in another order"), std::string::npos)
        << faces;
  EXPECT_NE(refusal(square + "f 1 x 3\n", order).find(":5:5: expected the number of a vertex"),
            std::string::npos);
}

TEST(ObjFile, ReadsRealCages) {
  PELAGE_REQUIRE_DATA();
  const ControlMesh spot = read_obj(data_folder() / "mesh" / "spot_control_mesh.obj");
  EXPECT_EQ(std::count(spot.face_sizes.begin(), spot.face_sizes.end(), 4u), 160);
  EXPECT_EQ(std::count(spot.face_sizes.begin(), spot.face_sizes.end(), 5u), 16);
  EXPECT_EQ(std::count(spot.face_sizes.begin(), spot.face_sizes.end(), 3u), 4);
  EXPECT_EQ(spot.face_uv.size(), spot.face_vertices.size());
  EXPECT_EQ(read_obj(data_folder() / "mesh" / "penguin_control_mesh.obj").positions.size(), 201u);
  EXPECT_EQ(read_obj(data_folder() / "mesh" / "sintel_bust.obj").face_count(), 5952u);
}

}  // namespace
}  // namespace pelage
