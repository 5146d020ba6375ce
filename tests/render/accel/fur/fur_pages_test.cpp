// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_pages.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "base/parallel.h"
#include "render/accel/fur/fur_leaf.h"
#include "tests/render/accel/fur/fur_paging.h"

namespace pelage {
namespace {

struct Cut {
  FurPageTable table;
  std::vector<std::vector<std::byte>> pages;
};

Cut cut(std::span<const FurTree* const> trees, size_t page_bytes) {
  Cut result;
  FurCutter cutter(
      [&](std::span<const std::byte> page) { result.pages.emplace_back(page.begin(), page.end()); },
      page_bytes);
  for (const FurTree* tree : trees) cutter.add(*tree);
  result.table = cutter.finish();
  return result;
}

/// Numbers of all segments in the leaves of a tree, sorted.
std::vector<uint32_t> numbers(const FurTreeView& view, size_t node_bytes) {
  std::vector<uint32_t> result;
  const size_t size = node_size(view.layout, view.motion_keys);
  for (size_t n = 0; n < node_bytes / size; ++n) {
    for (size_t i = 0; i < 4; ++i) {
      const FurReference r = child_reference(view.layout, view.motion_keys, view.nodes + n * size, i);
      if (!r.is_leaf()) continue;
      for (uint32_t b = 0; b < r.blocks(); ++b) {
        FurBlockHeader header;
        const size_t block = (r.is_wide() ? kWideBlock : kNarrowBlock).block(view.motion_keys);
        std::memcpy(&header, view.leaves + r.leaf_offset() + b * block, sizeof(header));
        std::copy_if(std::begin(header.number), std::end(header.number), std::back_inserter(result),
                     [](uint32_t number) { return number != FurBlockHeader::kNone; });
      }
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

class FurPagesOf : public testing::TestWithParam<GroomShape> {};

INSTANTIATE_TEST_SUITE_P(Grooms, FurPagesOf, testing::ValuesIn(groom_shapes()), [](const auto& test) {
  std::string name = test.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

/// Calls look(curve) for all curves of a treelet at one key, in grid units.
template <class Look>
void for_each_curve(const FurTreeView& view, size_t node_bytes, int key, const Look& look) {
  const size_t size = node_size(view.layout, view.motion_keys);
  for (size_t n = 0; n < node_bytes / size; ++n) {
    for (size_t i = 0; i < 4; ++i) {
      const FurReference r = child_reference(view.layout, view.motion_keys, view.nodes + n * size, i);
      if (!r.is_leaf()) continue;
      const size_t block = (r.is_wide() ? kWideBlock : kNarrowBlock).block(view.motion_keys);
      for (uint32_t b = 0; b < r.blocks(); ++b) {
        const std::byte* at = view.leaves + r.leaf_offset() + b * block;
        FurBlockHeader header;
        std::memcpy(&header, at, sizeof(header));
        for (size_t lane = 0; lane < FurBlockHeader::kLanes; ++lane) {
          if (header.number[lane] != FurBlockHeader::kNone) look(read_block(at, r.is_wide(), lane, key));
        }
      }
    }
  }
}

/// A page in memory with the alignment of pages.
PageBlock placed(const std::vector<std::byte>& page) {
  PageBlock block(page.size());
  std::memcpy(block.data(), page.data(), page.size());
  return block;
}

TEST_P(FurPagesOf, keep_boxes_around_all_that_is_in_their_treelets) {
  const Strands strands = random_groom(GetParam(), 200, 3);
  const SnappedStrands snapped(strands, FurGrid(GetParam().width, V3f(0.3f, -1, 2)));
  for (const FurRotation rotation : {FurRotation::kNever, FurRotation::kAlways}) {
    const FurTree tree(snapped, fur_options(FurNodeLayout::kQuantised, rotation));
    EXPECT_EQ(tree.view().frame.turned, rotation == FurRotation::kAlways && GetParam().motion_keys == 1);
    const FurTree* trees[] = {&tree};
    const Cut pages = cut(trees, kSmallPages);
    const FurPagedTree& of = pages.table.trees[0];
    EXPECT_TRUE(of.frame == tree.view().frame);
    const auto keys = static_cast<size_t>(pages.table.box_keys);
    for (size_t t = 0; t < pages.table.treelets.size(); ++t) {
      const FurTreelet& treelet = pages.table.treelets[t];
      const PageBlock page = placed(pages.pages[treelet.page]);
      const FurTreeView view = treelet_view(of, treelet, page.data());
      for (size_t key = 0; key < keys; ++key) {
        const int last = key == 0 ? 0 : view.motion_keys - 1;
        const Box3f& box = pages.table.boxes[t * keys + key];
        for_each_curve(view, treelet.leaves - treelet.nodes, last, [&](const SnappedSegment& curve) {
          for (const auto& p : curve) {
            for (int axis = 0; axis < 3; ++axis) {
              const V3d along(of.frame.axes[static_cast<size_t>(axis)]);
              const double at = along.dot(V3d(of.anchor)) + of.step * along.dot(V3d(p[0], p[1], p[2]));
              const double radius = double(of.step) * p[3];
              ASSERT_GE(at - radius, box.min[axis]);
              ASSERT_LE(at + radius, box.max[axis]);
            }
          }
        });
      }
    }
  }
}

TEST_P(FurPagesOf, hold_every_segment_once_in_possible_treelets) {
  const Strands strands = random_groom(GetParam(), 400, 3);
  const SnappedStrands snapped(strands, FurGrid(GetParam().width));
  for (const FurNodeLayout layout : {FurNodeLayout::kFloat, FurNodeLayout::kQuantised}) {
    const FurRotation rotation = layout == FurNodeLayout::kFloat ? FurRotation::kNever : FurRotation::kAlways;
    const FurTree tree(snapped, fur_options(layout, rotation));
    const FurTree* trees[] = {&tree};
    for (const size_t page_bytes : {size_t(4) << 10, size_t(16) << 10, FurCutter::kPageBytes}) {
      const Cut pages = cut(trees, page_bytes);
      EXPECT_TRUE(pages.table.is_possible());
      EXPECT_EQ(pages.pages.size(), pages.table.page_bytes.size());
      std::vector<uint32_t> found;
      for (const FurTreelet& t : pages.table.treelets) {
        const PageBlock page = placed(pages.pages[t.page]);
        const FurTreeView view = treelet_view(pages.table.trees[0], t, page.data());
        ASSERT_TRUE(is_possible_treelet(view, t));
        const auto own = numbers(view, t.leaves - t.nodes);
        found.insert(found.end(), own.begin(), own.end());
      }
      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, numbers(tree.view(), tree.node_bytes()));
    }
  }
}

TEST(FurPages, are_full) {
  const GroomShape plain = groom_shapes()[0];
  const Strands strands = random_groom(plain, 3000, 3);
  const SnappedStrands snapped(strands, FurGrid(plain.width));
  const FurTree tree(snapped, fur_options(FurNodeLayout::kQuantised));
  const FurTree* trees[] = {&tree};
  const size_t page_bytes = size_t(32) << 10;
  const Cut pages = cut(trees, page_bytes);
  ASSERT_GT(pages.pages.size(), 8u);
  for (size_t i = 0; i + 1 < pages.pages.size(); ++i) {
    EXPECT_LE(pages.pages[i].size(), page_bytes);
    EXPECT_GE(pages.pages[i].size(), page_bytes * 3 / 4) << i;
  }
  // What is left to the tree above: a box for some 100 segments at least.
  EXPECT_LT(pages.table.treelets.size(), snapped.segment_count() / 100);
}

TEST(FurPages, of_several_trees_follow_each_other) {
  const GroomShape plain = groom_shapes()[0], moving = groom_shapes()[9];
  const Strands one = random_groom(plain, 50, 3), two = random_groom(moving, 50, 4);
  const SnappedStrands first(one, FurGrid(plain.width)), second(two, FurGrid(moving.width));
  StrandArrays nothing;
  nothing.first_point.push_back(0);
  const Strands none(nothing);
  const SnappedStrands empty(none, FurGrid(1));
  const FurTree a(first, {}), b(empty, {}), c(second, {});
  const FurTree* trees[] = {&a, &b, &c};
  const Cut pages = cut(trees, size_t(8) << 10);
  EXPECT_TRUE(pages.table.is_possible());
  ASSERT_EQ(pages.table.trees.size(), 3u);
  EXPECT_EQ(pages.table.box_keys, 2);
  EXPECT_EQ(pages.table.treelets.front().tree, 0u);
  EXPECT_EQ(pages.table.treelets.back().tree, 2u);
  EXPECT_TRUE(std::none_of(pages.table.treelets.begin(), pages.table.treelets.end(),
                           [](const FurTreelet& t) { return t.tree == 1; }));
}

TEST(FurPages, of_axes_that_are_none_are_not_possible) {
  const GroomShape combed = groom_shapes()[11];
  const Strands strands = random_groom(combed, 50, 3);
  const FurTree tree(SnappedStrands(strands, FurGrid(combed.width)),
                     fur_options(FurNodeLayout::kQuantised, FurRotation::kWhenUseful));
  ASSERT_TRUE(tree.view().frame.turned);
  const FurTree* trees[] = {&tree};
  const FurPageTable table = cut(trees, kSmallPages).table;
  EXPECT_TRUE(table.is_possible());
  const auto with_axes = [&](const V3f& x, const V3f& y, const V3f& z) {
    FurPageTable other = table;
    other.trees[0].frame.axes = {x, y, z};
    return other.is_possible();
  };
  const V3f x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_TRUE(with_axes(x, y, z));
  EXPECT_FALSE(with_axes(x, y, x));
  EXPECT_FALSE(with_axes(x, 1.1f * y, z));
  EXPECT_FALSE(with_axes(x, y, V3f(0)));
  EXPECT_FALSE(with_axes(x, V3f(NAN, 1, 0), z));
  EXPECT_FALSE(with_axes(x, y, V3f(0, 0, INFINITY)));
}

class FurPageFileOf : public testing::TestWithParam<FurRotation> {};

INSTANTIATE_TEST_SUITE_P(Frames, FurPageFileOf, testing::Values(FurRotation::kNever, FurRotation::kAlways),
                         [](const auto& test) {
                           return test.param == FurRotation::kNever ? "along_the_grid" : "turned";
                         });

TEST_P(FurPageFileOf, gives_back_what_was_cut) {
  StoredGroom groom(groom_shapes()[0], 300, FurNodeLayout::kQuantised, GetParam());
  const FurPageFile file = groom.open();
  EXPECT_EQ(file.table().trees.at(0).frame.turned, GetParam() == FurRotation::kAlways);
  EXPECT_TRUE(file.table().trees.at(0).frame == groom.tree.view().frame);
  EXPECT_TRUE(groom.warnings.lines.empty());
  const FurTree* trees[] = {&groom.tree};
  const Cut pages = cut(trees, kSmallPages);
  ASSERT_EQ(file.table().page_bytes, pages.table.page_bytes);
  EXPECT_EQ(file.table().boxes, pages.table.boxes);
  for (uint32_t page = 0; page < pages.pages.size(); ++page) {
    PageBlock frame(file.table().page_bytes[page]);
    const std::span<std::byte> out(frame.data(), file.table().page_bytes[page]);
    file.read(page, out);
    EXPECT_TRUE(std::equal(out.begin(), out.end(), pages.pages[page].begin(), pages.pages[page].end()));
  }
  EXPECT_TRUE(file.check_all(Workers(2), groom.warnings.sink()));
  // What is only expected may never be read.
  file.prefetch(0);
  EXPECT_FALSE(FurPageFile::open(groom.store, {5, 6}, groom.warnings.sink()));
  EXPECT_TRUE(groom.warnings.lines.empty());
}

TEST_P(FurPageFileOf, notices_damage) {
  StoredGroom groom(groom_shapes()[0], 300, FurNodeLayout::kQuantised, GetParam());
  const std::string whole = read_file(groom.path());
  const auto rewrite = [&](const std::string& bytes) {
    AtomicFile file(groom.path());
    file.write(bytes);
    file.commit();
    groom.warnings.lines.clear();
  };
  // Any bit of a page is seen when it is read, any bit of the table at once: one warning each.
  uint64_t next = 0;
  for (int i = 0; i < 60; ++i) {
    std::string damaged = whole;
    const size_t at = hash64(next++, 1) % damaged.size();
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << hash64(next, 2) % 8));
    rewrite(damaged);
    const auto file = FurPageFile::open(groom.store, kFurKey, groom.warnings.sink());
    const bool good = file && file->check_all(Workers::alone(), groom.warnings.sink());
    // What lies between sections is no part of anything.
    if (good) continue;
    EXPECT_EQ(groom.warnings.lines.size(), 1u) << at;
  }
  for (const size_t bytes : {size_t(0), size_t(10), size_t(100), whole.size() / 2, whole.size() - 1}) {
    rewrite(whole.substr(0, bytes));
    EXPECT_FALSE(FurPageFile::open(groom.store, kFurKey, groom.warnings.sink()));
    EXPECT_EQ(groom.warnings.lines.size(), 1u);
  }
  rewrite(whole);
  EXPECT_TRUE(FurPageFile::open(groom.store, kFurKey, groom.warnings.sink()));
  EXPECT_TRUE(groom.warnings.lines.empty());
}

TEST(FurTreelets, that_lead_nowhere_are_refused) {
  const GroomShape plain = groom_shapes()[0];
  const Strands strands = random_groom(plain, 20, 3);
  const SnappedStrands snapped(strands, FurGrid(plain.width));
  for (const FurNodeLayout layout : {FurNodeLayout::kFloat, FurNodeLayout::kQuantised}) {
    const FurTree tree(snapped, fur_options(layout));
    const FurTree* trees[] = {&tree};
    const Cut pages = cut(trees, FurCutter::kPageBytes);
    const FurTreelet& t = pages.table.treelets.at(0);
    PageBlock page(pages.pages[0].size());
    const auto with_child = [&](size_t i, uint32_t bits) {
      std::memcpy(page.data(), pages.pages[0].data(), pages.pages[0].size());
      set_child_reference(layout, 1, page.data() + t.nodes, i, FurReference::from_bits(bits));
      return is_possible_treelet(treelet_view(pages.table.trees[0], t, page.data()), t);
    };
    EXPECT_FALSE(with_child(0, 0xdddddddd));
    EXPECT_FALSE(with_child(0, 0x7fffffff));
    EXPECT_FALSE(with_child(0, 1));  // into the middle of the root
    // A node that is the child of two.
    const uint32_t first = child_reference(layout, 1, tree.view().nodes, 0).bits();
    EXPECT_TRUE(with_child(0, first));
    EXPECT_FALSE(with_child(1, first));
  }
}

}  // namespace
}  // namespace pelage
