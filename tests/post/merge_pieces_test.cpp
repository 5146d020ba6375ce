// SPDX-License-Identifier: Apache-2.0
#include "post/merge_pieces.h"

#include <bit>
#include <chrono>
#include <cstring>
#include <limits>
#include <tuple>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/progress.h"
#include "base/temporary_folder.h"
#include "post/piece_headers.h"
#include "tests/post/exr_pictures.h"

namespace pelage {
namespace {

namespace fs = std::filesystem;

/// Cuts a picture into files and merges them again.
class MergePieces : public testing::Test {
 protected:
  MergePieces() {
    image_ = still_image(kWidth, kHeight);
    // Values that must survive as they are.
    pixels_of(image_, "Z")[40] = std::numeric_limits<float>::infinity();
    pixels_of(image_, "N.X")[7] = -0.0f;
    write_exr(path("whole"), image_);
  }
  fs::path path(const std::string& name) const { return folder_.path() / (name + ".exr"); }

  /// Writes the pixels of a box, with these attributes.
  fs::path piece(const std::string& name, const PixelBox& box, const ExrAttributes& attributes = {}) const {
    ExrPart part{name, "", box, {0, 0, kWidth, kHeight}, {}, attributes, {}};
    std::vector<std::vector<float>> planes;
    for (size_t c = 0; c < image_.channels.size(); ++c) {
      const ExrChannel& channel = image_.channels[c];
      part.channels.push_back({channel.name, channel.type});
      std::vector<float> plane;
      for (int y = box.y0; y < box.y1; ++y) {
        for (int x = box.x0; x < box.x1; ++x) {
          const auto i = static_cast<size_t>(y * kWidth + x);
          plane.push_back(channel.type == ChannelType::kUint ? std::bit_cast<float>(channel.ids[i])
                                                             : channel.pixels[i]);
        }
      }
      planes.push_back(std::move(plane));
    }
    ExrWriter writer(path(name), part);
    std::vector<ExrRows> rows;
    for (size_t c = 0; c < planes.size(); ++c)
      rows.push_back({c, planes[c].data(), static_cast<size_t>(box.width())});
    writer.write(0, box.height(), rows, Workers::alone());
    writer.commit();
    return path(name);
  }

  std::string problem(const std::vector<fs::path>& pieces) const {
    try {
      merge(pieces);
    } catch (const Error& error) {
      EXPECT_FALSE(fs::exists(path("merged")));
      return error.what();
    }
    return "none";
  }
  PixelBox merge(const std::vector<fs::path>& pieces, const MergeParams& params = {}) const {
    MemoryLedger ledger;
    NoProgress progress;
    const Workers workers(2);
    return merge_pieces(pieces, path("merged"), params, Job{workers, ledger, progress});
  }

  static constexpr int kWidth = 53, kHeight = 90;  // three bands
  const TemporaryFolder folder_;
  ExrImage image_;
};

TEST_F(MergePieces, GivesEveryBitOfTheWhole) {
  const std::vector<fs::path> pieces{piece("d", {20, 33, 53, 90}), piece("a", {0, 0, 53, 1}),
                                     piece("b", {0, 1, 20, 90}), piece("c", {20, 1, 53, 33})};
  EXPECT_EQ(merge(pieces), (PixelBox{0, 0, kWidth, kHeight}));
  const auto merged = read_part(path("merged"), 0), whole = read_part(path("whole"), 0);
  ASSERT_EQ(merged.size(), whole.size());
  for (size_t c = 0; c < whole.size(); ++c)
    EXPECT_EQ(std::memcmp(merged[c].data(), whole[c].data(), whole[c].size() * sizeof(float)), 0) << c;
}

TEST_F(MergePieces, TheHeaderSumsUpThePieces) {
  const ExrAttributes a{{"pelage:renderSeconds", 2.0f}, {"pelage:peakMemoryBytes", "900"}, {"comment", "x"}};
  const ExrAttributes b{{"pelage:renderSeconds", 3.5f}, {"pelage:peakMemoryBytes", "1000"}, {"comment", "x"}};
  merge({piece("a", {0, 0, 53, 40}, a), piece("b", {0, 40, 53, 90}, b)});
  const ExrAttributes merged = read_exr(path("merged")).attributes;
  EXPECT_EQ(merged.at("pelage:renderSeconds"), ExrAttribute(5.5f));
  EXPECT_EQ(merged.at("pelage:peakMemoryBytes"), ExrAttribute("1000"));
  EXPECT_EQ(merged.at("comment"), ExrAttribute("x"));
}

TEST_F(MergePieces, NamesWhatIsMissingOrDouble) {
  const fs::path top = piece("top", {0, 0, 53, 40}), left = piece("left", {0, 40, 30, 90});
  EXPECT_EQ(problem({top, left}), "no piece contains the pixels 30,40,53,90");
  EXPECT_EQ(
      problem({top, left, piece("right", {29, 40, 53, 90})}),
      path("right").string() + ": contains pixels 29,40,30,90, which " + left.string() + " contains too");
  EXPECT_NE(problem({top, path("none")}).find("none.exr"), std::string::npos);
}

TEST_F(MergePieces, NamesThePieceThatDiffers) {
  const PixelBox above{0, 0, 53, 40}, below{0, 40, 53, 90};
  for (const auto& [name, a, b] :
       std::vector<std::tuple<std::string, ExrAttribute, ExrAttribute>>{{"pelage:sceneHash", "12", "13"},
                                                                        {"pelage:version", "1", "2"},
                                                                        {"pelage:instructions", "x", "y"},
                                                                        {"pelage:samples", 4, 8},
                                                                        {"comment", "x", "y"}}) {
    const std::string text = problem({piece("a", above, {{name, a}}), piece("b", below, {{name, b}})});
    EXPECT_EQ(text.find(path("b").string() + ": `" + name + "`"), 0u) << text;
    EXPECT_NE(problem({piece("a", above), piece("b", below, {{name, b}})}).find("missing"),
              std::string::npos);
  }
  EXPECT_NE(problem({piece("a", above), piece("b", below, {{"pelage:partial", 1}})}).find("partial"),
            std::string::npos);
  image_.channels.pop_back();
  const fs::path fewer = piece("b", below);
  image_ = still_image(kWidth, kHeight);
  EXPECT_NE(problem({piece("a", above), fewer}).find("other channels"), std::string::npos);
}

TEST_F(MergePieces, AcceptsAnyInstructionsIfAsked) {
  const std::vector<fs::path> pieces{piece("a", {0, 0, 53, 40}, {{"pelage:instructions", "x"}}),
                                     piece("b", {0, 40, 53, 90}, {{"pelage:instructions", "y"}})};
  merge(pieces, {.any_instructions = true});
  EXPECT_EQ(read_exr(path("merged")).attributes.at("pelage:instructions"), ExrAttribute("mixed"));
}

TEST_F(MergePieces, KnowsThePictureOfThesePieces) {
  const ExrAttributes seconds{{"pelage:renderSeconds", 0.3f}};
  const std::vector<fs::path> pieces{piece("a", {0, 0, 53, 40}, seconds),
                                     piece("b", {0, 40, 53, 90}, seconds)};
  const auto merged = [&] { return is_merged(pieces, path("merged"), false); };
  EXPECT_FALSE(merged());
  merge(pieces);
  fs::last_write_time(path("merged"), fs::last_write_time(pieces[1]) + std::chrono::seconds(1));
  EXPECT_TRUE(merged());

  fs::last_write_time(pieces[0], fs::last_write_time(path("merged")));  // a piece that may be newer
  EXPECT_FALSE(merged());
  fs::last_write_time(pieces[0], fs::last_write_time(pieces[1]));
  EXPECT_TRUE(merged());

  fs::copy_file(path("whole"), path("merged"), fs::copy_options::overwrite_existing);  // another picture
  fs::last_write_time(path("merged"), fs::last_write_time(pieces[1]) + std::chrono::seconds(1));
  EXPECT_FALSE(merged());
  merge(pieces);
  fs::last_write_time(path("merged"), fs::last_write_time(pieces[1]) + std::chrono::seconds(1));
  fs::remove(pieces[1]);
  EXPECT_FALSE(merged());
}

}  // namespace
}  // namespace pelage
