// SPDX-License-Identifier: Apache-2.0
#include "post/blur_file.h"

#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/temporary_folder.h"
#include "tests/post/exr_pictures.h"
#include "tests/post/picture.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

class BlurFile : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  PostReport blur(const std::string& input, const std::string& output, int threads = 2) {
    NoProgress progress;
    MemoryLedger ledger;
    const PostReport report =
        blur_file(path(input), path(output), params_, {Workers(threads), ledger, progress});
    charged_ = ledger.peak(MemoryTag::kFilm);
    return report;
  }
  std::string refusal(const std::string& input, ErrorKind kind = ErrorKind::kInput) {
    try {
      blur(input, "refused.exr");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind);
      const std::string text = error.what();
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      EXPECT_FALSE(std::filesystem::exists(path("refused.exr")));
      return text.substr(std::min(text.size(), path(input).string().size()));
    }
    ADD_FAILURE() << "accepted";
    return {};
  }

  TemporaryFolder folder_;
  BlurFileParams params_;
  int64_t charged_ = 0;
};

TEST_F(BlurFile, NoMotionGivesTheSamePixelsOfEveryType) {
  ExrImage image = still_image(61, 47);
  pixels_of(image, "key.diffuse.R")[5] = std::numeric_limits<float>::quiet_NaN();
  pixels_of(image, "Z")[6] = std::numeric_limits<float>::infinity();
  image.attributes["comments"] = std::string("kept");
  write_exr(path("in.exr"), image);
  blur("in.exr", "out.exr");
  const ExrImage in = read_exr(path("in.exr")), out = read_exr(path("out.exr"));
  ASSERT_EQ(out.channels.size(), in.channels.size());
  for (size_t c = 0; c < in.channels.size(); ++c) {
    EXPECT_EQ(out.channels[c].name, in.channels[c].name);
    EXPECT_EQ(out.channels[c].type, in.channels[c].type);
    EXPECT_EQ(bits(out.channels[c].pixels), bits(in.channels[c].pixels)) << in.channels[c].name;
    EXPECT_EQ(out.channels[c].ids, in.channels[c].ids);
  }
  EXPECT_EQ(std::get<std::string>(out.attributes.at("comments")), "kept");
  EXPECT_TRUE(out.attributes.contains("pelage:motionBlur"));
}

TEST_F(BlurFile, SamePixelsForAnyBudgetAndNumberOfThreads) {
  const int width = kSanitized ? 160 : 400, height = kSanitized ? 180 : 300;
  ExrImage image = still_image(width, height);
  for (size_t i = 0; i < pixels_of(image, "Z").size(); ++i) {
    pixels_of(image, "forward.u")[i] = 20 * signed_float(hash64(i / 777, 1));
    pixels_of(image, "forward.v")[i] = 14 * signed_float(hash64(i / 555, 2));
    pixels_of(image, "Z")[i] = 1 + unit_float(hash64(i / 333, 3));
  }
  write_exr(path("in.exr"), image);
  EXPECT_EQ(blur("in.exr", "whole.exr", 3).bands, 1);
  const int64_t whole_bytes = charged_;
  params_.tiling = {32, 8};
  params_.file.memory = whole_bytes * 6 / 10;
  EXPECT_GT(blur("in.exr", "bands.exr", 3).bands, 1);
  EXPECT_LE(charged_, params_.file.memory);
  blur("in.exr", "alone.exr", 1);
  const ExrImage a = read_exr(path("whole.exr"));
  for (const char* other : {"bands.exr", "alone.exr"}) {
    const ExrImage b = read_exr(path(other));
    for (size_t c = 0; c < a.channels.size(); ++c) {
      EXPECT_EQ(bits(a.channels[c].pixels), bits(b.channels[c].pixels)) << other << " " << a.channels[c].name;
      EXPECT_EQ(a.channels[c].ids, b.channels[c].ids);
    }
  }
  params_.file.memory = 1 << 20;
  EXPECT_NE(refusal("in.exr", ErrorKind::kMemory).find("the budget is"), std::string::npos);
}

TEST_F(BlurFile, TakesPartsWithBareNamesAndWindowsOfTheirOwn) {
  write_exr(path("like.exr"), still_image(4, 4));
  const auto plane = [](const PixelBox& box, float value) {
    return std::vector<float>(static_cast<size_t>(box.width()) * static_cast<size_t>(box.height()), value);
  };
  const PixelBox display{0, 0, 100, 60}, box{30, 20, 50, 40}, small{34, 24, 40, 30};
  write_parts(path("in.exr"), path("like.exr"), display,
              {{"beauty",
                box,
                {{"A", ChannelType::kHalf}, {"R", ChannelType::kHalf}},
                {plane(box, 1), plane(box, 0.5f)},
                ""},
               {"depth", box, {{"Z", ChannelType::kFloat}}, {plane(box, 3)}, ""},
               {"motion",
                box,
                {{"X", ChannelType::kHalf}, {"Y", ChannelType::kHalf}},
                {plane(box, 8), plane(box, -4)},
                ""},
               {"mask", small, {{"mask.a", ChannelType::kHalf}}, {plane(small, 1)}, ""}});
  params_.shutter = {0, 1, 1};  // all of the motion, and no blur
  const PostReport report = blur("in.exr", "out.exr");
  EXPECT_EQ(report.notes, std::vector<std::string>{});
  const ExrReader out(path("out.exr"));
  ASSERT_EQ(out.parts().size(), 4u);
  EXPECT_EQ(out.parts()[0].name, "beauty");
  EXPECT_EQ(out.parts()[0].data, (PixelBox{30, 16, 58, 40}));
  EXPECT_EQ(out.parts()[0].display, display);
  EXPECT_EQ(out.parts()[3].data, (PixelBox{34, 20, 48, 30}));
  const auto beauty = read_part(path("out.exr"), 0), mask = read_part(path("out.exr"), 3);
  for (int y = 16; y < 40; ++y) {
    for (int x = 30; x < 58; ++x) {
      const bool inside = x >= 38 && y < 36;
      ASSERT_EQ(beauty[1][static_cast<size_t>((y - 16) * 28 + x - 30)], inside ? 0.5f : 0.0f)
          << x << " " << y;
    }
  }
  for (int y = 20; y < 30; ++y) {
    for (int x = 34; x < 48; ++x) {
      const bool inside = x >= 42 && y < 26;
      ASSERT_EQ(mask[0][static_cast<size_t>((y - 20) * 14 + x - 34)], inside ? 1.0f : 0.0f) << x << " " << y;
    }
  }
}

TEST_F(BlurFile, UnderstandsUnitsDirectionAndScale) {
  ExrImage image = still_image(40, 20);
  const std::vector<float> before = pixels_of(image, "R");
  for (float& u : pixels_of(image, "forward.u")) u = 0.1f;   // 0.1 * 40 = 4 pixels
  for (float& v : pixels_of(image, "forward.v")) v = 0.15f;  // up by 0.15 * 20 = 3
  write_exr(path("in.exr"), image);
  params_.file.vectors = {true, true, 2};
  params_.shutter = {0, 0.5f, 1};
  blur("in.exr", "out.exr");
  ExrImage out = read_exr(path("out.exr"));
  for (int y = 0; y < 17; ++y) {
    for (int x = 4; x < 40; ++x) {
      ASSERT_EQ(pixels_of(out, "R")[static_cast<size_t>(y * 40 + x)],
                before[static_cast<size_t>((y + 3) * 40 + x - 4)]);
    }
  }
}

TEST_F(BlurFile, ClearPixelsHideNothing) {
  ExrImage image = still_image(40, 10);
  for (size_t i = 0; i < 400; ++i) {
    const bool clear = i % 40 >= 20;
    pixels_of(image, "A")[i] = clear ? 0.0f : 1.0f;
    pixels_of(image, "R")[i] = clear ? 0.0f : 1.0f;
    pixels_of(image, "Z")[i] = clear ? 0.5f : 4.0f;  // nearer, but nothing
    pixels_of(image, "forward.u")[i] = clear ? 0.0f : 6.0f;
  }
  write_exr(path("in.exr"), image);
  params_.shutter = {0, 1, 1};
  blur("in.exr", "out.exr");
  ExrImage out = read_exr(path("out.exr"));
  for (size_t x = 0; x < 40; ++x)
    EXPECT_EQ(pixels_of(out, "R")[5 * 40 + x], x >= 6 && x < 26 ? 1.0f : 0.0f) << x;
}

TEST_F(BlurFile, SoftEdgesGoWithTheirSurface) {
  // A bar whose filter reached two pixels beyond it, where nothing was met.
  ExrImage image = still_image(60, 10);
  for (size_t i = 0; i < 600; ++i) {
    const size_t x = i % 60;
    const bool bar = x >= 20 && x < 30, soft = x == 18 || x == 19 || x == 30 || x == 31;
    pixels_of(image, "A")[i] = pixels_of(image, "R")[i] = bar ? 1.0f : soft ? 0.25f : 0.0f;
    pixels_of(image, "Z")[i] = bar ? 3.0f : std::numeric_limits<float>::infinity();
    pixels_of(image, "forward.u")[i] = bar ? 12.0f : 0.0f;
  }
  write_exr(path("in.exr"), image);
  params_.shutter = {0, 1, 1};
  blur("in.exr", "out.exr");
  ExrImage out = read_exr(path("out.exr"));
  for (size_t x = 0; x < 60; ++x) {
    const float expected = x >= 32 && x < 42 ? 1.0f : x == 30 || x == 31 || x == 42 || x == 43 ? 0.25f : 0.0f;
    EXPECT_EQ(pixels_of(out, "A")[300 + x], expected) << x;
  }
}

TEST_F(BlurFile, RefusesInOneLineWhatItCannotUse) {
  ExrImage image = still_image(16, 16);
  const auto without = [&](const char* name) {
    ExrImage less = image;
    std::erase_if(less.channels, [&](const ExrChannel& c) { return c.name == name; });
    write_exr(path("less.exr"), less);
    return refusal("less.exr");
  };
  EXPECT_EQ(
      without("forward.v"),
      ": has no motion vectors; name their layer with --motion-layer; it has A, B, N.X, R, Z, forward.u, id, "
      "key.diffuse.R");
  EXPECT_EQ(without("Z"),
            ": has no depth; name a layer with --depth-layer, or 'none' to blur without depth; it has A, B, "
            "N.X, R, forward.u, forward.v, id, key.diffuse.R");
  ExrImage data = image;
  std::erase_if(data.channels,
                [](const ExrChannel& c) { return c.name != "Z" && !c.name.starts_with("forward"); });
  write_exr(path("data.exr"), data);
  EXPECT_EQ(refusal("data.exr"),
            ": has no colours to blur; name their layer with --color-layer; it has Z, forward.u, forward.v");
  EXPECT_EQ(refusal("missing.exr"), ": there is no such file");
  std::ofstream(path("text.exr")) << "no picture";
  EXPECT_EQ(refusal("text.exr"), ": is not an EXR file");
  write_exr(path("in.exr"), image);
  params_.file.layers.motion = "mv";
  EXPECT_EQ(refusal("in.exr").find(": has no motion vectors 'mv'; name"), 0u);
  params_.file.layers = {"", "far", {}, {}};
  EXPECT_EQ(refusal("in.exr").find(": has no depth 'far'; name"), 0u);
  params_.file.layers = {"", "", {"N", "mask"}, {}};
  EXPECT_EQ(refusal("in.exr").find(": has no layer 'mask'; check --data-layer; it has A,"), 0u);
  params_.file.layers = {"", "", {"N"}, {"key.diffuse", "sky"}};
  EXPECT_EQ(refusal("in.exr").find(": has no layer 'sky'; check --color-layer; it has A,"), 0u);
}

TEST_F(BlurFile, RefusesChannelsWithFewerPixels) {
  write_exr(path("in.exr"), still_image(16, 16));
  std::string bytes = read_file(path("in.exr"));
  const std::string name("forward.u\0", 10);
  // Behind the name: type, linearity, sampling across.
  bytes.at(bytes.find(name) + name.size() + 8) = 2;
  std::ofstream(path("sub.exr"), std::ios::binary) << bytes;
  EXPECT_EQ(refusal("sub.exr"), ": channel 'forward.u' is subsampled, which is not supported");
}

TEST_F(BlurFile, GoesWithoutDepthWhenTold) {
  ExrImage image = still_image(16, 16);
  std::erase_if(image.channels, [](const ExrChannel& c) { return c.name == "Z"; });
  write_exr(path("in.exr"), image);
  params_.file.layers.depth = "none";
  blur("in.exr", "out.exr");
  EXPECT_EQ(read_exr(path("out.exr")).find("R")->pixels, image.find("R")->pixels);
}

TEST_F(BlurFile, RefusesEveryTruncation) {
  write_exr(path("in.exr"), still_image(64, 40));
  const std::string whole = read_file(path("in.exr"));
  for (size_t length = 0; length < whole.size(); length += length < 1200 ? 97 : 1501) {
    std::ofstream(path("cut.exr"), std::ios::binary)
        .write(whole.data(), static_cast<std::streamsize>(length));
    EXPECT_NE(refusal("cut.exr"), "");
  }
}

TEST_F(BlurFile, CountsVectorsThatAreNotFinite) {
  ExrImage image = still_image(16, 16);
  pixels_of(image, "forward.u")[3] = std::numeric_limits<float>::quiet_NaN();
  pixels_of(image, "forward.v")[9] = std::numeric_limits<float>::infinity();
  write_exr(path("in.exr"), image);
  EXPECT_EQ(blur("in.exr", "out.exr").notes,
            std::vector<std::string>{"2 vectors are not finite and are treated as zero"});
}

TEST_F(BlurFile, AFewPixelsInAHugeFrameStayFew) {
  write_exr(path("like.exr"), still_image(4, 4));
  const PixelBox display{0, 0, 65000, 65000}, box{30000, 20000, 30064, 20036};
  const auto plane = [](float value) { return std::vector<float>(64 * 36, value); };
  const auto write = [&](float u) {
    write_parts(path("in.exr"), path("like.exr"), display,
                {{"",
                  box,
                  {{"A", ChannelType::kHalf},
                   {"Z", ChannelType::kFloat},
                   {"forward.u", ChannelType::kFloat},
                   {"forward.v", ChannelType::kFloat}},
                  {plane(1), plane(3), plane(u), plane(0)},
                  ""}});
  };
  for (const float u : {30000.0f, 1e30f, 3e38f}) {
    write(u);
    const PostReport report = blur("in.exr", "out.exr");
    EXPECT_EQ(report.window, (PixelBox{30000 - 1024, 20000, 30064 + 1024, 20036})) << u;
    EXPECT_EQ(report.warnings.size(), 1u);
  }
  params_.file.vectors.is_ndc = true;
  write(3e38f);  // becomes infinite, not zero
  EXPECT_EQ(blur("in.exr", "out.exr").window.width(), 64 + 2 * 1024);
  // Vectors that stay in the neighbourhood are never cut.
  params_.file.vectors.is_ndc = false;
  write(4000);  // 1000 on each side
  const PostReport report = blur("in.exr", "out.exr");
  EXPECT_GT(report.window.width(), 64 + 1900);
  EXPECT_LT(report.window.width(), 64 + 2000);
}

TEST_F(BlurFile, WarnsOfWrongUnits) {
  ExrImage image = still_image(64, 48);  // the diagonal is 80
  const auto warning = [&](float u, bool is_ndc = false, float scale = 1) -> std::string {
    std::fill(pixels_of(image, "forward.u").begin(), pixels_of(image, "forward.u").end(), u);
    write_exr(path("in.exr"), image);
    params_.file.vectors = {is_ndc, false, scale};
    const PostReport report = blur("in.exr", "out.exr");
    return report.warnings.empty() ? "" : report.warnings.at(0);
  };
  EXPECT_EQ(warning(0), "");
  EXPECT_EQ(warning(5), "");
  EXPECT_EQ(warning(-79), "");
  EXPECT_EQ(
      warning(0.1f),
      "no vector is longer than 1 pixel (the longest: 0.1); if they are normalised to the picture's size, "
      "use --motion-units ndc");
  EXPECT_EQ(warning(0.1f, true), "");
  EXPECT_EQ(warning(0.001f), "");  // nothing moves in either unit
  EXPECT_EQ(warning(20, true),
            "most vectors are longer than 80 pixels (the longest: 1280): they look like pixels; omit "
            "--motion-units ndc");
  EXPECT_EQ(warning(20, false, 100),
            "most vectors are longer than 80 pixels (the longest: 2000): check --motion-scale");
  EXPECT_EQ(warning(200),
            "most vectors are longer than 80 pixels (the longest: 200): they look like pixels per second; at "
            "24 frames per second use --motion-scale 0.0417");
  EXPECT_EQ(
      warning(1e9f),
      "most vectors are longer than 80 pixels (the longest: 1e+09): they look like positions or another "
      "quantity; check --motion-layer");
  pixels_of(image, "forward.v").assign(64 * 48, 0.5f);
  EXPECT_EQ(warning(0.502f), "the vectors look encoded with 0.5 for no motion; subtract 0.5 from them first");
  pixels_of(image, "forward.v").assign(64 * 48, 0);
  pixels_of(image, "forward.v")[7] = pixels_of(image, "forward.v")[70] = 1e20f;
  EXPECT_EQ(warning(5),
            "2 of 3072 vectors are longer than 80 pixels, the size of the picture; they look damaged");
}

TEST_F(BlurFile, TrustsTheUnitsOfPelagesOwnPictures) {
  ExrImage image = still_image(64, 48);
  pixels_of(image, "forward.u").assign(64 * 48, 0.1f);
  image.attributes["pelage:version"] = std::string("0.1.0");
  write_exr(path("in.exr"), image);
  EXPECT_TRUE(blur("in.exr", "out.exr").warnings.empty());
}

TEST_F(BlurFile, WarnsWhereThePictureIsBlurredAlready) {
  ExrImage image = still_image(16, 16);
  image.attributes["pelage:shutter"] = V2f(0.0f, 0.0f);
  write_exr(path("static.exr"), image);
  EXPECT_TRUE(blur("static.exr", "once.exr").warnings.empty());
  image.attributes["pelage:shutter"] = V2f(-0.25f, 0.125f);
  write_exr(path("blurred.exr"), image);
  EXPECT_EQ(blur("blurred.exr", "twice.exr").warnings,
            std::vector<std::string>{"the picture is already blurred: it was rendered with the shutter open "
                                     "from -0.25 to 0.125 frames; render it with camera.shutter: [0, 0]"});
  // The result says when its shutter was open, and who opened it.
  EXPECT_EQ(std::get<V2f>(read_exr(path("once.exr")).attributes.at("pelage:shutter")), V2f(-0.25f, 0.25f));
  const std::vector<std::string> by_us{"the picture is already blurred: pelage motionblur wrote it"};
  EXPECT_EQ(blur("once.exr", "twice.exr").warnings, by_us);
  ExrImage foreign = still_image(16, 16);
  write_exr(path("foreign.exr"), foreign);
  EXPECT_TRUE(blur("foreign.exr", "once.exr").warnings.empty());
  EXPECT_EQ(blur("once.exr", "twice.exr").warnings, by_us);
}

TEST_F(BlurFile, LeavesNothingWhenItIsStopped) {
  class Stopped final : public Progress {
   public:
    void begin(std::string_view, double) override {}
    void advance(double) override {}
    void end() override {}
    bool cancelled() const override { return true; }
  } stopped;
  write_exr(path("in.exr"), still_image(32, 32));
  MemoryLedger ledger;
  EXPECT_TRUE(blur_file(path("in.exr"), path("out.exr"), params_, {Workers(2), ledger, stopped}).cancelled);
  EXPECT_FALSE(std::filesystem::exists(path("out.exr")));
  EXPECT_EQ(ledger.current(MemoryTag::kFilm), 0);
}

}  // namespace
}  // namespace pelage
