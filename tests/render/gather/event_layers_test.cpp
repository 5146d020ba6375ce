// SPDX-License-Identifier: Apache-2.0
// image.event_layers with both integrators: direct and indirect light of each light layer.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "render/sampling/pixel_moments.h"
#include "tests/render/film/film_picture.h"
#include "tests/render/gather/gather_scene.h"

namespace pelage::event_layers_test {
namespace {

constexpr size_t kLights = 2;

struct EventScene : GatherScene {
  EventScene() {
    for (MaterialParams& material : materials) {
      auto* fibre = std::get_if<ConeShellParams>(&material);
      if (fibre) fibre->diffuse = 0.7f;  // given, so that no colour must be matched before every render
    }
    image.event_layers = true;
  }
};

class EventLayers : public testing::TestWithParam<Integrator> {
 protected:
  EventLayers() { scene_.render.integrator = GetParam(); }
  FrameResult with_bounces(int bounces) {
    scene_.render.bounces = bounces;
    return scene_.run();
  }

  EventScene scene_;
};

INSTANTIATE_TEST_SUITE_P(Integrators, EventLayers, testing::Values(Integrator::kPath, Integrator::kGather),
                         [](const auto& name) {
                           return name.param == Integrator::kPath ? "path" : "gather";
                         });

void expect_same(const ExrChannel& a, const ExrChannel& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.pixels, b.pixels) << a.name;
  EXPECT_EQ(a.ids, b.ids) << a.name;
}

/// Calls `check(x, y, light, group)` for each pixel and light layer.
template <class Check>
void for_each_part(const Film& film, const Check& check) {
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      for (size_t light = 0; light < kLights; ++light) {
        for (int g = 0; g < kLobeGroups; ++g) check(x, y, light, g);
      }
    }
  }
}

TEST_P(EventLayers, AddChannelsAndChangeNoOther) {
  const ExrImage with = picture_of(scene_.run().film);
  scene_.image.event_layers = false;
  const ExrImage without = picture_of(scene_.run().film);
  for (const ExrChannel& channel : without.channels) {
    ASSERT_TRUE(with.find(channel.name)) << channel.name;
    expect_same(*with.find(channel.name), channel);
  }
  size_t added = 0;
  for (const ExrChannel& channel : with.channels) {
    if (without.find(channel.name)) continue;
    ++added;
    EXPECT_NE(channel.name.find("direct."), std::string::npos) << channel.name;
    const float brightest = *std::max_element(channel.pixels.begin(), channel.pixels.end());
    EXPECT_GT(brightest, 0) << channel.name;
  }
  EXPECT_EQ(added, kLights * kLobeGroups * 2 * 3);
  EXPECT_TRUE(with.find("sky.secondary.indirect.B"));
}

TEST_P(EventLayers, AddUpToTheirLayerAndToThePicture) {
  const FrameResult result = scene_.run();
  const Film& film = result.film;
  const FilmLayers& layers = film.layers();
  for_each_part(film, [&](int x, int y, size_t light, int g) {
    const Rgb whole = film.layer(x, y, layers.scattered(light, g));
    const Rgb direct = film.layer(x, y, layers.direct(light, g)), indirect = film.indirect(x, y, light, g);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(direct[c] + indirect[c], whole[c], 1e-4f * std::abs(whole[c])) << x << ", " << y;
      if (GetParam() == Integrator::kGather) continue;  // whose estimates may be negative
      EXPECT_GE(direct[c], 0);
      EXPECT_GE(indirect[c], 0);
    }
  });
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      Rgb sum = film.layer(x, y, layers.emitted(1));
      for (size_t light = 0; light < kLights; ++light) {
        for (int g = 0; g < kLobeGroups; ++g)
          sum += film.layer(x, y, layers.direct(light, g)) + film.indirect(x, y, light, g);
      }
      const Rgb whole = film.radiance(x, y);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], whole[c], 2e-4f * (1 + whole[c]));
    }
  }
}

TEST_P(EventLayers, NothingIsIndirectWithoutBounces) {
  const FrameResult result = with_bounces(0);
  const Film& film = result.film;
  for_each_part(film, [&](int x, int y, size_t light, int g) {
    EXPECT_EQ(film.indirect(x, y, light, g), Rgb(0));
    EXPECT_EQ(film.layer(x, y, film.layers().direct(light, g)),
              film.layer(x, y, film.layers().scattered(light, g)));
  });
}

TEST_P(EventLayers, TheClampLeavesDirectLightAlone) {
  const FrameResult free = scene_.run();
  scene_.render.clamp_indirect = 1e-6f;
  const FrameResult dark = scene_.run();
  double removed = 0;
  for_each_part(free.film, [&](int x, int y, size_t light, int g) {
    const size_t direct = free.film.layers().direct(light, g);
    EXPECT_EQ(free.film.layer(x, y, direct), dark.film.layer(x, y, direct));
    EXPECT_LT(std::abs(luminance(dark.film.indirect(x, y, light, g))), 1e-4f);
    removed += luminance(free.film.indirect(x, y, light, g));
  });
  EXPECT_GT(removed, 1);
}

TEST_P(EventLayers, OneAndManyThreadsGiveTheSameFilm) {
  const ExrImage one = picture_of(scene_.run({}, 1).film), many = picture_of(scene_.run({}, 3).film);
  ASSERT_EQ(one.channels.size(), many.channels.size());
  for (size_t i = 0; i < one.channels.size(); ++i) expect_same(one.channels[i], many.channels[i]);
}

TEST_P(EventLayers, CountAsMemoryOfTheFrameBuffer) {
  const FrameResult result = scene_.run();
  const int64_t needed = Film::bytes_needed(scene_.image.width, scene_.image.height, result.film.layers());
  EXPECT_EQ(scene_.ledger.current(MemoryTag::kFilm), needed);
  scene_.render.memory.bytes = static_cast<uint64_t>(2 * needed - 1);
  try {
    scene_.run();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
    EXPECT_NE(std::string(error.what()).find("the frame buffer"), std::string::npos) << error.what();
  }
}

constexpr int kSeeds = 16;
/// Means of two times kSeeds pictures differ by more standard errors than this once in 100,000 (Student).
constexpr double kFarOff = 5.3;

/// Mean luminance over the picture of direct and indirect light, by light and lobe group: moments over
/// pictures of several seeds.
struct Means {
  PixelMoments direct[kLights][kLobeGroups], indirect[kLights][kLobeGroups];
};

Means means_of(EventScene& scene, uint64_t first_seed) {
  Means result;
  for (int seed = 0; seed < kSeeds; ++seed) {
    scene.render.seed = static_cast<int64_t>(first_seed) + seed;
    const FrameResult picture = scene.run();
    const Film& film = picture.film;
    double direct[kLights][kLobeGroups] = {}, indirect[kLights][kLobeGroups] = {};
    const double pixels = film.width() * film.height();
    for_each_part(film, [&](int x, int y, size_t light, int g) {
      direct[light][g] += luminance(film.layer(x, y, film.layers().direct(light, g))) / pixels;
      indirect[light][g] += luminance(film.indirect(x, y, light, g)) / pixels;
    });
    for (size_t light = 0; light < kLights; ++light) {
      for (int g = 0; g < kLobeGroups; ++g) {
        result.direct[light][g].add(direct[light][g]);
        result.indirect[light][g].add(indirect[light][g]);
      }
    }
  }
  return result;
}

void expect_same_mean(const PixelMoments& a, const PixelMoments& b) {
  EXPECT_GT(a.mean, 0);
  EXPECT_LT(std::abs(a.mean - b.mean), kFarOff * std::hypot(a.error(), b.error()) + 1e-6)
      << a.mean << " " << b.mean;
}

TEST_P(EventLayers, DirectLightIsAllLightWithoutBounces) {
  const Means some = means_of(scene_, 0);
  scene_.render.bounces = 0;
  const Means none = means_of(scene_, 100);
  for (size_t light = 0; light < kLights; ++light) {
    for (int g = 0; g < kLobeGroups; ++g) {
      SCOPED_TRACE(std::to_string(light) + " " + kLobeGroupNames[g]);
      expect_same_mean(some.direct[light][g], none.direct[light][g]);
      EXPECT_GT(some.indirect[light][g].mean, 10 * some.indirect[light][g].error());
    }
  }
}

TEST(EventLayersOfGather, HaveTheMeansOfPaths) {
  EventScene scene;
  scene.image.filter_samples = FilterSamples::kSplatted;
  scene.render.integrator = Integrator::kPath;
  const Means paths = means_of(scene, 1000);
  scene.render.integrator = Integrator::kGather;
  for (const bool reuse : {false, true}) {
    scene.render.gather.reuse = reuse;
    const Means gathered = means_of(scene, 0);
    for (size_t light = 0; light < kLights; ++light) {
      for (int g = 0; g < kLobeGroups; ++g) {
        SCOPED_TRACE(std::to_string(reuse) + " " + std::to_string(light) + " " + kLobeGroupNames[g]);
        expect_same_mean(gathered.direct[light][g], paths.direct[light][g]);
        expect_same_mean(gathered.indirect[light][g], paths.indirect[light][g]);
      }
    }
  }
}

}  // namespace
}  // namespace pelage::event_layers_test
