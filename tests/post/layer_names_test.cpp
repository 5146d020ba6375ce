// SPDX-License-Identifier: Apache-2.0
#include "post/layer_names.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

ExrPart part(const std::string& name, const std::vector<std::string>& channels,
             const std::string& view = "") {
  ExrPart result;
  result.name = name;
  result.view = view;
  result.data = result.display = {0, 0, 8, 8};
  for (const std::string& channel : channels) result.channels.push_back({channel, ChannelType::kFloat});
  return result;
}

struct Names {
  explicit Names(std::vector<ExrPart> p, LayerChoice c = {}, const std::string& view = "")
      : parts(std::move(p)),
        choice(std::move(c)),
        channels(name_channels(parts)),
        finder(channels, parts, view, choice) {}
  std::string name(std::optional<size_t> i) const {
    return i ? parts[channels[*i].part].name + ":" + channels[*i].name() : "none";
  }
  std::string motion() const {
    const auto m = finder.motion();
    return m ? name(m->first) + " " + name(m->second) : "none";
  }
  LayerRole role(const std::string& wanted) const {
    for (size_t i = 0; i < channels.size(); ++i) {
      if (channels[i].name() == wanted) return finder.role(i);
    }
    ADD_FAILURE() << wanted;
    return LayerRole::kColor;
  }

  std::vector<ExrPart> parts;
  LayerChoice choice;
  std::vector<NamedChannel> channels;
  LayerFinder finder;
};

TEST(LayerNames, FindsTheVectorsOfManyPrograms) {
  EXPECT_EQ(Names({part("", {"R", "Z", "forward.u", "forward.v"})}).motion(), ":forward.u :forward.v");
  EXPECT_EQ(Names({part("", {"R", "motion.X", "motion.Y", "motion.Z"})}).motion(), ":motion.X :motion.Y");
  EXPECT_EQ(Names({part("", {"ViewLayer.Vector.X", "ViewLayer.Vector.Y"})}).motion(),
            ":ViewLayer.Vector.X :ViewLayer.Vector.Y");
  EXPECT_EQ(Names({part("", {"Motion_Vectors.red", "Motion_Vectors.green"})}).motion(),
            ":Motion_Vectors.red :Motion_Vectors.green");
  EXPECT_EQ(Names({part("rgba", {"R", "G"}), part("forward", {"u", "v"})}).motion(), "forward:u forward:v");
  EXPECT_EQ(Names({part("rgba", {"R"}), part("motion", {"R", "G"})}).motion(), "motion:R motion:G");
  EXPECT_EQ(Names({part("", {"R", "G", "B"})}).motion(), "none");
}

TEST(LayerNames, TakesWhatItIsTold) {
  const std::vector<ExrPart> parts = {
      part("", {"forward.u", "forward.v", "mv.x", "mv.y", "odd.first", "odd.second"})};
  EXPECT_EQ(Names(parts, {"mv", "", {}, {}}).motion(), ":mv.x :mv.y");
  EXPECT_EQ(Names(parts, {"odd.first,odd.second", "", {}, {}}).motion(), ":odd.first :odd.second");
  EXPECT_EQ(Names(parts, {"missing", "", {}, {}}).motion(), "none");
  const std::vector<ExrPart> bare = {part("rgba_left", {"R", "G"}, "left"),
                                     part("far_left", {"R", "G"}, "left"),
                                     part("mv_left", {"R", "G"}, "left")};
  EXPECT_EQ(Names(bare, {"mv.R,mv.G", "", {}, {}}, "left").motion(), "mv_left:R mv_left:G");
  EXPECT_EQ(Names(bare, {"mv_left.R,far_left.G", "", {}, {}}, "left").motion(), "mv_left:R far_left:G");
  const Names depth(bare, {"", "far.G", {}, {}}, "left");
  EXPECT_EQ(depth.name(depth.finder.depth()), "far_left:G");
}

TEST(LayerNames, ListsWhatThereIsToChooseFrom) {
  const std::vector<ExrPart> parts = {part("rgba_left", {"R", "key.R"}, "left"),
                                      part("z_right", {"Z"}, "right"), part("disparity", {"x", "y"})};
  EXPECT_EQ(Names(parts, {}, "left").finder.listing(), "rgba_left.R, key.R, disparity.x, disparity.y");
  EXPECT_EQ(Names({part("rgba", {"R", "Z"})}).finder.listing(), "R, Z");
}

TEST(LayerNames, FindsTheAlphaOfThePicture) {
  const auto alpha = [](std::vector<ExrPart> parts) {
    const Names names(std::move(parts));
    return names.name(names.finder.alpha());
  };
  EXPECT_EQ(alpha({part("", {"A", "View.Combined.A", "mask.A"})}), ":A");
  EXPECT_EQ(alpha({part("", {"View.Shadow.A", "View.Combined.A", "View.Combined.R"})}), ":View.Combined.A");
  EXPECT_EQ(alpha({part("", {"mask.A", "R"})}), "none");
}

TEST(LayerNames, FindsDepthButNotTheThirdNumberOfAVector) {
  const auto depth = [](std::vector<ExrPart> parts, const std::string& choice = "") {
    const Names names(std::move(parts), {"", choice, {}, {}});
    return names.name(names.finder.depth());
  };
  EXPECT_EQ(depth({part("", {"R", "Z"})}), ":Z");
  EXPECT_EQ(depth({part("N", {"X", "Y", "Z"}), part("depth", {"Z"})}), "depth:Z");
  EXPECT_EQ(depth({part("", {"R", "depth.V"})}), ":depth.V");
  EXPECT_EQ(depth({part("", {"N.X", "N.Y", "N.Z"})}), "none");
  EXPECT_EQ(depth({part("", {"R", "Z", "far.z"})}, "far"), ":far.z");
  EXPECT_EQ(depth({part("", {"R", "Z", "far.z"})}, "far.z"), ":far.z");
}

TEST(LayerNames, KnowsDataFromColour) {
  const Names names({part("", {"R", "A", "Z", "N.X", "forward.u", "forward.v", "key.diffuse.R", "tangent.X",
                               "root.u", "sky.emission.G", "disparityL.x", "mask.a", "key.diffuse.direct.R",
                               "key.diffuse.indirect.R"})},
                    {"", "", {"mask"}, {"disparityL"}});
  for (const char* name : {"R", "A", "key.diffuse.R", "sky.emission.G", "disparityL.x",
                           "key.diffuse.direct.R", "key.diffuse.indirect.R"}) {
    EXPECT_EQ(names.role(name), LayerRole::kColor) << name;
  }
  for (const char* name : {"N.X", "forward.u", "forward.v", "tangent.X", "root.u", "mask.a"}) {
    EXPECT_EQ(names.role(name), LayerRole::kData) << name;
  }
  EXPECT_EQ(names.role("Z"), LayerRole::kDepth);
}

TEST(LayerNames, KeepsViewsApart) {
  const std::vector<ExrPart> parts = {part("rgba_right", {"R", "A"}, "right"), part("z_left", {"Z"}, "left"),
                                      part("rgba_left", {"R", "A"}, "left"), part("z_right", {"Z"}, "right"),
                                      part("forward", {"u", "v"})};
  const std::vector<NamedChannel> channels = name_channels(parts);
  EXPECT_EQ(views_of(channels, parts), (std::vector<std::string>{"right", "left", ""}));
  const Names left(parts, {}, "left");
  EXPECT_EQ(left.name(left.finder.depth()), "z_left:Z");
  EXPECT_EQ(left.name(left.finder.alpha()), "rgba_left:A");
  EXPECT_EQ(left.motion(), "forward:u forward:v");  // of no view
}

TEST(LayerNames, FindsViewsInTheNamesOfOnePart) {
  ExrPart both =
      part("", {"R", "left.R", "forward.left.u", "forward.left.v", "forward.right.u", "key.diffuse.R"});
  both.multi_view = {"right", "left"};
  const Names left({both}, {}, "left");
  EXPECT_EQ(left.channels[0].view, "right");
  EXPECT_EQ(left.channels[1].view, "left");
  EXPECT_EQ(left.channels[1].name(), "R");
  EXPECT_EQ(left.motion(), ":forward.u :forward.v");
  EXPECT_EQ(left.channels[5].view, "");
}

TEST(LayerNames, FindsTheRanksOfACryptomatte) {
  ExrPart p = part("", {"R", "crypto00.r", "crypto00.g", "crypto00.b", "crypto00.a", "crypto01.r",
                        "crypto01.g", "crypto.r"});
  p.attributes["cryptomatte/abcdef0/name"] = std::string("crypto");
  const Names names({p});
  ASSERT_EQ(names.finder.mattes().size(), 1u);
  EXPECT_EQ(names.finder.mattes()[0].ranks.size(), 3u);
  EXPECT_EQ(names.role("crypto01.g"), LayerRole::kMatte);
  EXPECT_NE(names.role("crypto.r"), LayerRole::kMatte);
}

}  // namespace
}  // namespace pelage
