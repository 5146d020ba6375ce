// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "geom/curve_bounds.h"
#include "rib/scene/rib_interpreter.h"
#include "rib/scene/rib_reading.h"
#include "tests/rib/syntax/rib_bytes_of.h"

namespace pelage {
namespace {

using namespace rib_test;

// `count` lines from z = first on.
std::string lines(int count, int first) {
  std::string sizes, points;
  for (int i = 0; i < count; ++i) {
    sizes += "2 ";
    points += "0 0 " + std::to_string(first + i) + " 1 1 " + std::to_string(first + i) + " ";
  }
  return "Curves \"linear\" [" + sizes + "] \"nonperiodic\" \"P\" [" + points + "] \"constantwidth\" 0.25\n";
}

std::vector<const Procedural*> leaves_of(const std::unique_ptr<Procedural>& root,
                                         std::vector<std::unique_ptr<Procedural>>& keep) {
  keep = root->split();
  std::vector<const Procedural*> leaves;
  for (const auto& leaf : keep) leaves.push_back(leaf.get());
  return leaves;
}

TEST(RibDeferred, AnArchiveGivesTheStrandsThatItWouldGiveInPlace) {
  const Files files;
  files.write("AttributeBegin Scale 1 2 1 " + lines(9000, 0) +
                  "AttributeEnd Attribute \"identifier\" \"name\" \"b\" " + lines(3, 0),
              "b.rib");
  const std::string around = "Translate 3 0 0 " + lines(5, 0);
  const RibScene direct = read_rib(files.write(around + "ReadArchive \"b.rib\"", "a.rib"), {});
  const RibScene deferred = read_rib(
      files.write(around + "Procedural \"DelayedReadArchive\" [\"b.rib\"] [0 1 0 1 0 1]", "c.rib"), {});
  ASSERT_EQ(deferred.coats.size(), 2u);
  EXPECT_EQ(deferred.coats[0].batches.size(), 1u) << "strands of the file itself";
  EXPECT_EQ(deferred.coats[0].deferred.size(), 2u);
  for (size_t coat = 0; coat < 2; ++coat) {
    const auto a = rib_procedural(direct.coats[coat]), b = rib_procedural(deferred.coats[coat]);
    const Strands is = b->generate(), should = a->generate();
    EXPECT_EQ(is.arrays().points, should.arrays().points);
    EXPECT_EQ(is.arrays().ids, should.arrays().ids);
    std::vector<std::unique_ptr<Procedural>> keep;
    for (const Procedural* leaf : leaves_of(b, keep)) {
      const Strands strands = leaf->generate();
      EXPECT_EQ(leaf->counts().strands, strands.strand_count());
      EXPECT_EQ(leaf->counts().segments, strands.strand_count());
      EXPECT_EQ(leaf->bound(BoundSpan::kShutter), exact_bounds(strands))
          << "law 4, although the file's box is smaller";
      EXPECT_TRUE(leaf->exact_bounds(BoundSpan::kShutter, 1).part_count() > 0);
    }
  }
}

TEST(RibDeferred, NewerRequestsAndMeshes) {
  const Files files;
  files.write(lines(2, 0) + "PointsPolygons [3] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0]", "b.rib");
  const RibScene scene = read_rib(files.write("Procedural2 \"DelayedReadArchive2\" \"SimpleBound\" \"string "
                                              "filename\" [\"b.rib\"] \"float[6] bound\" [0 1 0 1 0 1]"),
                                  {});
  EXPECT_EQ(scene.coats[0].deferred.size(), 1u);
  EXPECT_EQ(scene.skins.size(), 1u) << "meshes are not deferred";
}

TEST(RibDeferred, AChangedFileIsAnError) {
  const Files files;
  files.write(lines(5, 0), "b.rib");
  const RibScene scene =
      read_rib(files.write("Procedural \"DelayedReadArchive\" [\"b.rib\"] [0 1 0 1 0 1]", "a.rib"), {});
  const auto coat = rib_procedural(scene.coats[0]);
  files.write(lines(6, 0), "b.rib");
  EXPECT_NE(error_of([&] { coat->generate(); }).find("the file changed while it was in use"),
            std::string::npos);
}

TEST(RibDeferred, CodeIsNotRun) {
  const Files files;
  const RibScene scene =
      read_rib(files.write("Procedural \"RunProgram\" [\"touch /tmp/x\" \"\"] [0 1 0 1 0 1] "
                           "Procedural \"RunProgram\" [\"touch /tmp/x\" \"\"] [0 1 0 1 0 1]"),
               {});
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(
      scene.warnings[0].message,
      "a procedural of kind 'RunProgram' runs code; skipped (--allow-procedurals runs the programs that "
      "the file names)");
  EXPECT_EQ(read_rib(files.write("Procedural \"DynamicLoad\" [\"x.so\" \"\"] [0 1 0 1 0 1]"), {})
                .warnings.at(0)
                .message,
            "a procedural of kind 'DynamicLoad' calls functions of its renderer, which Pelage does not have; "
            "skipped");
  EXPECT_NE(error_of([&] {
              read_rib(files.write("Procedural \"DelayedReadArchive\" [\"b.rib\"] [0 1]"), {});
            }).find("a bound is six numbers, got an array of 2 integers"),
            std::string::npos);
}

TEST(RibDeferred, SelfReadingArchivesAreErrors) {
  const Files files;
  EXPECT_NE(error_of([&] {
              read_rib(files.write("Procedural \"DelayedReadArchive\" [\"a.rib\"] [0 1 0 1 0 1]"), {});
            }).find("the file reads itself"),
            std::string::npos);
}

}  // namespace
}  // namespace pelage
