// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/avoid.h"

#include <fstream>

#include "geom/closest_point.h"
#include "groom/strands/named_mesh.h"
#include "tests/groom/cached_coats.h"

namespace pelage::avoid_test {
namespace {

class AvoidTest : public CachedCoatTest {
 protected:
  /// A box; its faces look outwards.
  AvoidParams box(const V3f& low, const V3f& high) {
    std::ofstream out(file_);
    for (int i = 0; i < 8; ++i)
      out << "v " << (i & 1 ? high.x : low.x) << ' ' << (i & 2 ? high.y : low.y) << ' '
          << (i & 4 ? high.z : low.z) << '\n';
    out << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    return {.mesh = {file_, {}}, .offset = Field(0.02f)};
  }
  /// A plate above the ball, in the way of strands of unit length.
  AvoidParams plate() { return box({-0.6f, 1.3f, -0.6f}, {0.6f, 1.5f, 0.6f}); }

  std::filesystem::path file_ = folder_.path() / "box.obj";
};

TEST_F(AvoidTest, Bounds) { check_bounds(prepared<Avoid>(plate()), {1.2f, 1.2f, 0, 1.0f}); }

TEST_F(AvoidTest, NoPointEndsInsideAndOthersKeepTheirBits) {
  const Avoid op = prepared<Avoid>(plate());
  const SkinMesh mesh = read_named_mesh({file_, {}}, job_);
  const ClosestPointTree tree(mesh, 0);
  size_t moved = 0;
  for (size_t first = 0; first < follicles_.size(); first += kBlockStrands) {
    auto batch = straight(first), before = straight(first);
    op.apply(*batch);
    for (size_t s = 0; s < batch->count; ++s) {
      const V3f root = vector_at(batch->rest.position, s);
      if (root.y < 0) {
        EXPECT_EQ(batch->offset(7, s), before->offset(7, s));
      }
      moved += batch->offset(7, s) != before->offset(7, s);
      for (int p = 1; p < 8; ++p) {
        ClosestPoint nearest;
        ASSERT_TRUE(tree.closest(root + batch->offset(p, s), 10, nearest));
        EXPECT_FALSE(nearest.inside && nearest.distance > 0.02f) << root << p;
      }
    }
  }
  EXPECT_GT(moved, 50u);
}

TEST_F(AvoidTest, StubsAreLeftOfStrandsThatStartInside) {
  const Avoid op = prepared<Avoid>(box({-3, 0.2f, -3}, {3, 3, 3}));
  auto batch = straight();
  op.apply(*batch);
  for (size_t s = 0; s < batch->count; ++s) {
    if (vector_at(batch->rest.position, s).y > 0.4f) {
      EXPECT_LT(batch->offset(7, s).length(), 0.01f);
    }
  }
}

TEST_F(AvoidTest, ActsAtRestInEveryPose) {
  plate();
  const std::string avoid = "- avoid: {mesh: " + file_.string() + "}\n";
  const auto groom = make(Coat{"- length: {value: 0.8}\n" + avoid, ""});
  const auto live = make(Coat{"- length: {value: 0.8}\n- push_out: {}\n" + avoid, ""});
  EXPECT_FALSE(groom->needs_closest_point());
  EXPECT_TRUE(live->needs_closest_point());
  // The operator after a live one sees the same strands, in another space.
  const Avoid op = prepared<Avoid>(plate());
  auto rest = straight(), posed = straight();
  const LimitSurface pose = this->posed(0.7f, 0);
  place_in_pose(*posed, pose, follicles_, 0);
  carry_to_pose(*posed, 1.5f);
  op.apply(*rest);
  op.apply(*posed);
  size_t other = 0;  // rounding may decide where a strand slides
  for (size_t s = 0; s < rest->count; ++s)
    other += (posed->to_rest(s, posed->offset(7, s)) - rest->offset(7, s)).length() > 2e-3f;
  EXPECT_LT(other, 8u);
}

TEST_F(AvoidTest, NamesAMissingMesh) {
  AvoidParams missing;
  missing.mesh = {folder_.path() / "none.obj", {}};
  EXPECT_THROW(prepared<Avoid>(missing), Error);
}

}  // namespace
}  // namespace pelage::avoid_test
