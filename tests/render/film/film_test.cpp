// SPDX-License-Identifier: Apache-2.0
#include "render/film/film.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "render/film/frame_header.h"
#include "render/film/pixel_filter.h"
#include "tests/render/film/film_picture.h"

namespace pelage {
namespace {

const float kInfinitelyFar = std::numeric_limits<float>::infinity();

FilmLayers two_lights() { return FilmLayers::make({{"key", false}, {"sky", true}}, 2); }

TEST(FilmLayers, NameLightsAndLobes) {
  const FilmLayers layers = two_lights();
  EXPECT_EQ(layers.names, (std::vector<std::string>{"key.diffuse", "key.primary", "sky.diffuse",
                                                    "sky.primary", "sky.emission"}));
  EXPECT_EQ(layers.scattered(1, 1), 3u);
  EXPECT_EQ(layers.emitted(1), 4u);
  EXPECT_TRUE(FilmLayers{}.empty());
}

TEST(FilmLayers, NameTheDirectPartOfEachLobe) {
  const std::vector<FilmLayers::LightInfo> lights = {{"key", false}, {"sky", true}};
  const FilmLayers layers = FilmLayers::make(lights, 2, true), plain = two_lights();
  ASSERT_EQ(layers.size(), plain.size() + 4);
  EXPECT_TRUE(std::equal(plain.names.begin(), plain.names.end(), layers.names.begin()));
  EXPECT_EQ(layers.names[layers.direct(0, 0)], "key.diffuse.direct");
  EXPECT_EQ(layers.names[layers.direct(1, 1)], "sky.primary.direct");
  for (const int side : {10, 64}) {
    const int64_t pixels = int64_t{(side + 15) / 16 * 16} * ((side + 15) / 16 * 16);  // of whole tiles
    EXPECT_EQ(Film::bytes_needed(side, side, layers) - Film::bytes_needed(side, side, plain),
              pixels * 4 * 3 * static_cast<int64_t>(sizeof(float)));
  }
}

TEST(Film, TheRestOfALayerIsIndirect) {
  MemoryLedger ledger;
  const FilmLayers layers = FilmLayers::make({{"key", false}}, 1, true);
  Film film(2, 1, layers, ledger);
  FilmSample sample;
  film.add(0, 0, sample, std::vector{Rgb(3, 2, 0.5f), Rgb(1, 2, 0.75f)});
  film.add(1, 0, sample, std::vector{Rgb(1, 0, 8), Rgb(1.00001f, 0, 8)});
  EXPECT_EQ(film.indirect(0, 0, 0, 0), Rgb(2, 0, -0.25f)) << "estimates may be negative";
  EXPECT_EQ(film.indirect(1, 0, 0, 0), Rgb(0)) << "rounding";
  const ExrImage image = picture_of(film);
  EXPECT_EQ(image.find("key.diffuse.R")->pixels[0], 3);
  EXPECT_EQ(image.find("key.diffuse.direct.R")->pixels[0], 1);
  EXPECT_EQ(image.find("key.diffuse.indirect.R")->pixels[0], 2);
  EXPECT_EQ(image.find("key.diffuse.indirect.B")->pixels[0], 0) << "pictures are not";
}

TEST(Film, AveragesSamplesAndDropsWhatIsNotFinite) {
  MemoryLedger ledger;
  Film film(3, 2, two_lights(), ledger);
  EXPECT_GT(ledger.current(MemoryTag::kFilm), 0);
  std::vector<Rgb> parts(5, Rgb(0));
  FilmSample sample;
  sample.radiance = Rgb(1, 2, 3);
  sample.alpha = 1;
  parts[3] = Rgb(1, 2, 3);
  EXPECT_TRUE(film.add(2, 1, sample, parts));
  sample.radiance = Rgb(3, 0, 0);
  sample.alpha = 0;
  parts[3] = Rgb(3, 0, 0);
  EXPECT_TRUE(film.add(2, 1, sample, parts));
  sample.radiance.y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(film.add(2, 1, sample, parts));
  sample.radiance.y = 0;
  parts[0].z = kInfinitelyFar;
  EXPECT_FALSE(film.add(2, 1, sample, parts));

  EXPECT_EQ(film.samples(2, 1), 4u) << "those that were dropped count";
  EXPECT_EQ(film.min_samples({2, 1, 3, 2}), 4u);
  EXPECT_EQ(film.min_samples({0, 0, 3, 2}), 0u);
  EXPECT_EQ(film.sample_sum({0, 0, 3, 2}), 4);
  EXPECT_EQ(film.radiance(2, 1), Rgb(2, 1, 1.5f));
  EXPECT_EQ(film.alpha(2, 1), 0.5f);
  EXPECT_EQ(film.layer(2, 1, 3), Rgb(2, 1, 1.5f));
  EXPECT_EQ(film.samples(0, 0), 0u);
  EXPECT_EQ(film.radiance(0, 0), Rgb(0));
}

TEST(Film, KeepsTheDataOfTheFrontMostSampleWithinThePixel) {
  MemoryLedger ledger;
  Film film(1, 1, {}, ledger);
  const auto add = [&](float depth, uint32_t id, bool inside) {
    FilmSample sample;
    sample.surface.depth = depth;
    sample.surface.id = id;
    sample.offset = V2f(inside ? 0.0f : 0.9f);
    film.add(0, 0, sample, {});
  };
  EXPECT_EQ(film.surface(0, 0).depth, kInfinitelyFar);
  add(2, 1, false);
  EXPECT_EQ(film.surface(0, 0).id, 1u);
  add(5, 2, true);  // farther, but within the pixel
  EXPECT_EQ(film.surface(0, 0).id, 2u);
  add(3, 3, false);
  EXPECT_EQ(film.surface(0, 0).id, 2u);
  add(4, 4, true);
  EXPECT_EQ(film.surface(0, 0).id, 4u);
  add(4, 5, true);  // equally near: the earlier sample stays
  EXPECT_EQ(film.surface(0, 0).id, 4u);
}

TEST(Film, WritesEveryChannelByItsName) {
  MemoryLedger ledger;
  Film film(2, 1, two_lights(), ledger);
  FilmSample sample;
  sample.radiance = Rgb(0.5f);
  sample.alpha = 1;
  sample.surface = {3, V3f(0, 1, 0), V3f(1, 0, 0), V2f(2, -1), V2f(0.25f, 0.75f), 77};
  film.add(1, 0, sample, std::vector<Rgb>(5, Rgb(0.1f)));
  const ExrImage image = picture_of(film);
  for (const char* name : {"R", "G", "B", "A", "key.diffuse.R", "sky.emission.B"}) {
    ASSERT_TRUE(image.find(name)) << name;
    EXPECT_EQ(image.find(name)->type, ChannelType::kHalf) << name;
  }
  const auto value = [&](const char* name, size_t pixel) {
    const ExrChannel* channel = image.find(name);
    EXPECT_TRUE(channel && channel->type == ChannelType::kFloat) << name;
    return channel ? channel->pixels[pixel] : 0.0f;
  };
  EXPECT_EQ(value("Z", 0), kInfinitelyFar);
  EXPECT_EQ(value("Z", 1), 3);
  EXPECT_EQ(value("N.Y", 1), 1);
  EXPECT_EQ(value("tangent.X", 1), 1);
  EXPECT_EQ(value("forward.u", 1), 2);
  EXPECT_EQ(value("forward.v", 1), -1);
  EXPECT_EQ(value("root.u", 1), 0.25f);
  EXPECT_EQ(value("root.v", 1), 0.75f);
  ASSERT_TRUE(image.find("id"));
  EXPECT_EQ(image.find("id")->ids, (std::vector<uint32_t>{kNoStrand, 77}));
  EXPECT_EQ(value("id.X", 0), 0);                                        // no strand
  EXPECT_EQ(std::bit_cast<uint32_t>(value("id.X", 1)), 77u | 1u << 23);  // 77 alone would not be normal
  EXPECT_EQ(std::bit_cast<uint32_t>(id_float(0x12345678)), 0x12345678u);
  EXPECT_TRUE(std::isnormal(id_float(0x7f812345)));
  EXPECT_EQ(image.channels.size(), 4u + 15 + 1 + 3 + 3 + 2 + 2 + 2);
}

// Samples that share light may be negative; what is written is not, and its layers still add up. Direct and
// indirect parts change no layer.
TEST(Film, WritesNoNegativeLight) {
  MemoryLedger ledger;
  std::vector<std::vector<float>> undivided;
  for (const bool events : {false, true}) {
    const FilmLayers layers = FilmLayers::make({{"key", false}, {"sky", true}}, 2, events);
    Film film(2, 1, layers, ledger);
    for (int x = 0; x < 2; ++x) {
      std::vector<Rgb> by_layer(layers.size(), Rgb(0.5f));
      by_layer[layers.scattered(0, 1)] = Rgb(-0.25f);
      if (x == 1) by_layer[layers.emitted(1)] = Rgb(-2);
      FilmSample sample;
      sample.radiance = x == 1 ? Rgb(-0.75f) : Rgb(1.75f);
      for (int g = 0; events && g < 2; ++g) {
        by_layer[layers.direct(0, g)] = Rgb(0.25f);
        by_layer[layers.direct(1, g)] = Rgb(g == 0 ? 0.125f : 0.75f);  // indirect light below zero
      }
      film.add(x, 0, sample, by_layer);
    }
    const ExrImage image = picture_of(film);
    double sum = 0;
    size_t layer = 0;
    for (const ExrChannel& channel : image.channels) {
      if (channel.type != ChannelType::kHalf) continue;
      if (!events) {
        undivided.push_back(channel.pixels);
      } else if (layer < undivided.size()) {
        EXPECT_EQ(channel.pixels, undivided[layer++]) << channel.name;
      }
      EXPECT_GE(channel.pixels[0], 0) << channel.name;
      EXPECT_GE(channel.pixels[1], 0) << channel.name;
    }
    for (const char* name :
         {"key.diffuse.R", "key.primary.R", "sky.diffuse.R", "sky.primary.R", "sky.emission.R"})
      sum += image.find(name)->pixels[0];
    EXPECT_NEAR(sum, 1.75, 1e-5);
    EXPECT_EQ(image.find("R")->pixels, (std::vector<float>{1.75f, 0}));
    if (events) {
      EXPECT_EQ(image.find("key.primary.R")->pixels[0], image.find("key.primary.direct.R")->pixels[0] +
                                                            image.find("key.primary.indirect.R")->pixels[0]);
    }
  }
}

TEST(Film, RowsAreThoseOfTheWholePicture) {
  MemoryLedger ledger;
  FilmLayers layers = two_lights();
  layers.noise = layers.lod = true;
  Film film(3, 5, layers, ledger);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 3; ++x) {
      FilmSample sample;
      sample.radiance = Rgb(static_cast<float>(x + 3 * y));
      sample.surface.id = static_cast<uint32_t>(x + 3 * y);
      sample.surface.depth = static_cast<float>(1 + x + 3 * y);
      for (int i = 0; i <= x; ++i) film.add(x, y, sample, std::vector<Rgb>(5, Rgb(0.1f)));
    }
  }
  const std::vector<ExrChannel> whole = film.exr_rows(0, 5), some = film.exr_rows(1, 4);
  ASSERT_EQ(some.size(), whole.size());
  const auto part = [](const auto& all) {
    return all.empty() ? all : std::decay_t<decltype(all)>(all.begin() + 3, all.begin() + 12);
  };
  for (size_t i = 0; i < some.size(); ++i) {
    EXPECT_EQ(some[i].name, whole[i].name);
    EXPECT_EQ(some[i].type, whole[i].type);
    EXPECT_EQ(some[i].pixels, part(whole[i].pixels)) << some[i].name;
    EXPECT_EQ(some[i].ids, part(whole[i].ids)) << some[i].name;
  }
}

TEST(FrameHeader, CarriesWhatAPictureWasMadeFrom) {
  FrameHeader header;
  header.samples = 16;
  header.partial = true;
  header.scene_hash = "0123";
  const auto attributes = exr_attributes(header, Camera(CameraParams{}, 1, 4, 3));
  EXPECT_EQ(std::get<int>(attributes.at("pelage:samples")), 16);
  EXPECT_EQ(std::get<int>(attributes.at("pelage:partial")), 1);
  EXPECT_EQ(std::get<std::string>(attributes.at("pelage:sceneHash")), "0123");
  EXPECT_TRUE(std::holds_alternative<M44f>(attributes.at("worldToCamera")));
  EXPECT_TRUE(std::holds_alternative<M44f>(attributes.at("worldToNDC")));
}

/// Largest distance between the empirical distribution of many offsets and the filter's own (Kolmogorov).
class FilterSamplerTest : public testing::TestWithParam<PixelFilter> {};

TEST_P(FilterSamplerTest, OffsetsAreDistributedAsTheFilter) {
  const FilterSampler sampler(GetParam());
  constexpr size_t kSamples = 100000;
  std::vector<float> x(kSamples);
  double sum = 0;
  for (size_t i = 0; i < kSamples; ++i) {
    const V2f offset = sampler.offset({unit_float(hash64(i, 1)), unit_float(hash64(i, 2))});
    ASSERT_LE(std::abs(offset.x), filter_radius(GetParam()));
    ASSERT_LE(std::abs(offset.y), filter_radius(GetParam()));
    x[i] = offset.x;
    sum += offset.y;
  }
  EXPECT_NEAR(sum / kSamples, 0, 0.006);
  std::sort(x.begin(), x.end());
  double distance = 0;
  for (size_t i = 0; i < kSamples; ++i) {
    distance = std::max(distance, std::abs(filter_integral(GetParam(), x[i]) - (double(i) + 0.5) / kSamples));
  }
  EXPECT_LT(distance, 2.2 / std::sqrt(double(kSamples)));  // 1e-4 of all seeds are farther
  EXPECT_NEAR(filter_integral(GetParam(), -filter_radius(GetParam())), 0, 1e-12);
  EXPECT_NEAR(filter_integral(GetParam(), filter_radius(GetParam())), 1, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Filters, FilterSamplerTest,
                         testing::Values(PixelFilter::kBox, PixelFilter::kBlackmanHarris));

}  // namespace
}  // namespace pelage
