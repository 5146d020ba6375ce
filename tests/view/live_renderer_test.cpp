// SPDX-License-Identifier: Apache-2.0
#include "view/live_renderer.h"

#include <functional>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "tests/world/small_scene.h"
#include "view/picture_bytes.h"
#include "view/scene_follower.h"
#include "world/world.h"

namespace pelage {
namespace {

/// A view of the small scene without a server.
class LiveRendererTest : public testing::Test {
 protected:
  std::string path() const { return scene_.path("scene.yaml"); }
  std::string text() const { return read_file(path()); }

  void replace(const std::string& from, const std::string& to) const {
    std::string edited = text();
    const size_t at = edited.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    scene_.write("scene.yaml", edited.replace(at, from.size(), to));
  }

  bool wait_until(const std::function<bool(const ViewStatus&)>& holds) const {
    for (int i = 0; i < 60'000; ++i) {  // ten minutes: a sanitizer on a busy machine is slow
      if (holds(state_.status())) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  /// Waits until the picture after `edits` edits is finished.
  bool rests(int edits) const {
    return wait_until([=](const ViewStatus& status) { return status.done() && status.edits == edits; });
  }

  /// Renders the files as they are now.
  FrameResult rendered(const std::vector<Override>& overrides, MemoryLedger& ledger) const {
    const Workers workers(1);
    NoProgress progress;
    const Job job{workers, ledger, progress};
    const SceneDescription scene = load_scene(path(), overrides);
    const auto assets = load_assets(scene, job);
    const World world = compose(scene, *assets, scene.frames.frames.front(), job);
    return render(world, job);
  }

  /// Compares all channels at rest with those of a render of the files as they are now.
  void expect_rendered(const std::vector<Override>& overrides = {}) const {
    MemoryLedger ledger;
    const FrameResult truth = rendered(overrides, ledger);
    const std::vector<ExrChannel> wanted = truth.film.exr_rows(0, truth.film.height());
    std::vector<ExrChannel> shown;
    ASSERT_TRUE(state_.with_frame([&](const FinishedFrame& frame) {
      shown = frame.result.film.exr_rows(0, frame.result.film.height());
    }));
    ASSERT_EQ(shown.size(), wanted.size());
    for (size_t i = 0; i < wanted.size(); ++i) {
      EXPECT_EQ(shown[i].name, wanted[i].name);
      EXPECT_EQ(shown[i].pixels, wanted[i].pixels) << wanted[i].name;
      EXPECT_EQ(shown[i].ids, wanted[i].ids) << wanted[i].name;
    }
  }

  /// Writes an image of one grey pixel.
  void write_map(int value) const {
    const std::string grey = std::to_string(value) + "\n";
    scene_.write("map.ppm", "P3\n1 1\n255\n" + grey + grey + grey);
  }

  SmallScene scene_{true};
  ViewState state_;
};

TEST_F(LiveRendererTest, EveryEditIsThatOfARender) {
  LiveRenderer renderer(state_, 2);
  const SceneFollower follower(path(), {}, renderer, state_);
  ASSERT_TRUE(rests(0));
  expect_rendered();
  EXPECT_EQ(state_.status().strands_regrown, 0);
  EXPECT_GT(state_.status().first_pixels_s, 0);

  struct Edit {
    const char *from, *to;
    bool regrows;
  };
  const Edit edits[] = {{"intensity: 30", "intensity: 60", false},
                        {"color: [0.6, 0.4, 0.2]", "color: [0.2, 0.4, 0.6]", false},
                        {"sky: {type", "moon: {type: environment, radiance: 0.1}\n  sky: {type", false},
                        {"samples: 4", "samples: 7, integrator: gather", false},
                        {"samples: 7, integrator: gather", "samples: 7", false},
                        {"position: [3, 2, 8]", "position: [3, 3, 8]", true},
                        {"length: {value: 0.4}", "length: {value: 0.5}", true},
                        {"diffuse: 0.7", "diffuse: 0.7, opacity: 0.5", true},
                        {"width: 24", "width: 30", false}};
  int count = 0;
  for (const Edit& edit : edits) {
    replace(edit.from, edit.to);
    ASSERT_TRUE(rests(++count)) << edit.to << state_.status().error();
    expect_rendered();
    EXPECT_EQ(state_.status().strands_regrown > 0, edit.regrows) << edit.to;
  }
}

TEST_F(LiveRendererTest, OnlyTheCoatThatChangesGrowsAgain) {
  replace(", {push_out: {}}", "");
  replace("materials:",
          "  fuzz: {skin: still, strands: 300, operators: [{length: {value: 0.2}}]}\nmaterials:");
  replace("{skin: still, material: hide}", "{skin: still, material: hide, grooms: {fuzz: fur}}");
  LiveRenderer renderer(state_, 2);
  const SceneFollower follower(path(), {}, renderer, state_);
  ASSERT_TRUE(rests(0));
  expect_rendered();
  const int64_t memory = state_.status().memory_bytes;

  struct Edit {
    const char *from, *to;
    int64_t regrown;  // strands of whole coats
  };
  const Edit edits[] = {{"position: [3, 2, 8]", "position: [3, 3, 7]", 0},
                        {"fov: 40", "fov: 38, lens: {f_stop: 8, focal_length: 5, focus_distance: 8}", 0},
                        {"length: {value: 0.4}", "length: {value: 0.5}", 400},
                        {"length: {value: 0.2}", "length: {value: 0.3}", 300},
                        {"points: 5", "points: 6", 400},
                        {"strands: 300", "strands: 200", 200},
                        {"[0.6, 0.4, 0.2]", "[0.2, 0.4, 0.6]", 0},
                        {"diffuse: 0.7", "diffuse: 0.7, opacity: 0.5", 600},
                        {"fov: 38", "fov: 37", 0},
                        {"samples: 4", "samples: 4, integrator: gather", 0},
                        {"fov: 37", "fov: 36", 0},
                        {"translate: [0, 1, 0]", "translate: [0, 0.5, 0]", 400},
                        {"shutter: [-0.25, 0.25]", "shutter: [-0.1, 0.1]", 400},
                        {"integrator: gather", "accel: embree", 600},
                        {"accel: embree", "bounds: none", 600},
                        {"fov: 36", "fov: 35", 0},
                        {"bounds: none", "memory: 1G", 0},
                        {"fov: 35", "fov: 34", 0}};
  int count = 0;
  for (const Edit& edit : edits) {
    replace(edit.from, edit.to);
    ASSERT_TRUE(rests(++count)) << edit.to << state_.status().error();
    expect_rendered();
    EXPECT_EQ(state_.status().strands_regrown, edit.regrown) << edit.to;
  }
  EXPECT_LT(state_.status().memory_bytes, memory + (memory >> 1)) << "old chunks are freed";
}

TEST_F(LiveRendererTest, AMapIsReadAgain) {
  write_map(50);
  replace("length: {value: 0.4}", "length: {value: {map: map.ppm, channel: r}}");
  replace("{model: lambert, color: 0.4}", "{model: lambert, color: {map: map.ppm}}");
  LiveRenderer renderer(state_, 2);
  const SceneFollower follower(path(), {}, renderer, state_);
  ASSERT_TRUE(rests(0)) << state_.status().error();
  expect_rendered();
  write_map(120);
  ASSERT_TRUE(rests(1));
  expect_rendered();
  EXPECT_EQ(state_.status().strands_regrown, 400);
}

TEST_F(LiveRendererTest, AnAssetIsReadAgain) {
  LiveRenderer renderer(state_, 2);
  const SceneFollower follower(path(), {}, renderer, state_);
  ASSERT_TRUE(rests(0));
  for (const char* pose : {"cube.0001.obj", "cube.obj"}) {
    std::string cage = read_file(scene_.path(pose));
    cage.replace(cage.find("0.5"), 3, "0.9");
    scene_.write(pose, cage);
    ASSERT_TRUE(rests(pose == std::string("cube.obj") ? 2 : 1));
    expect_rendered();
  }
}

TEST_F(LiveRendererTest, AWrongEditKeepsThePictureAndSaysWhy) {
  LiveRenderer renderer(state_, 2);
  const SceneFollower follower(path(), {}, renderer, state_);
  ASSERT_TRUE(rests(0));
  const std::string good = text();
  const uint64_t version = state_.picture()->version;
  const auto shows = [&](const std::string& what) {
    return wait_until([&](const ViewStatus& s) { return s.error().find(what) != std::string::npos; });
  };
  scene_.write("scene.yaml", good + "nonsense: [\n");
  ASSERT_TRUE(shows("scene.yaml:"));
  EXPECT_FALSE(state_.status().done());
  EXPECT_EQ(state_.picture()->version, version);

  scene_.write("scene.yaml", good + "# a comment\n");  // nothing to render
  ASSERT_TRUE(rests(0));
  EXPECT_EQ(state_.picture()->version, version);
  expect_rendered();

  replace("mesh: cube.obj, poses", "mesh: none.obj, poses");
  ASSERT_TRUE(shows("no such file"));
  EXPECT_EQ(state_.picture()->version, version) << "the last good picture stays";
  EXPECT_TRUE(state_.with_frame([](const FinishedFrame&) {})) << "with all layers";
  EXPECT_FALSE(state_.status().done());
  scene_.write("none.obj", read_file(scene_.path("cube.obj")));  // the missing file arrives
  ASSERT_TRUE(wait_until([](const ViewStatus& s) { return s.done(); })) << state_.status().error();
  expect_rendered();

  replace("render: {", "include: more.yaml\nrender: {");
  ASSERT_TRUE(shows("more.yaml"));
  scene_.write("more.yaml", "lights: {more: {type: environment, radiance: 0.2}}\n");
  ASSERT_TRUE(wait_until([](const ViewStatus& s) { return s.done(); })) << state_.status().error();
  expect_rendered();
}

TEST_F(LiveRendererTest, ManyEditsAndReadersAtOnce) {
  LiveRenderer renderer(state_, 2);
  const SceneFollower follower(path(), {}, renderer, state_);
  std::atomic<bool> ends{false};
  std::thread reader([&] {
    while (!ends) {
      const ViewStatus status = state_.status();
      for (const std::string& layer : status.layers) {
        const auto picture = state_.with_layers({layer});
        if (!picture || !picture->layers.contains(layer)) continue;
        EXPECT_FALSE(layer_bytes(*picture, {layer}).empty());
      }
      state_.with_frame([](const FinishedFrame& frame) { EXPECT_EQ(frame.result.film.height(), 16); });
    }
  });
  replace("samples: 4", "samples: 40");
  for (int i = 0; i < 8; ++i) {
    replace("intensity: 3", "intensity: 33");
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    replace("value: 0.4", "value: 0.44");
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
  }
  replace("samples: 40", "samples: 3");
  EXPECT_TRUE(wait_until([](const ViewStatus& s) { return s.done() && s.wanted_samples == 3; }));
  ends = true;
  reader.join();
  expect_rendered();
}

TEST_F(LiveRendererTest, ExplainsPixelsOfThePicture) {
  LiveRenderer renderer(state_, 2);
  const SceneFollower follower(path(), {}, renderer, state_);
  const auto ask = [this](int x, int y) {
    const CommandAnswer answer = state_.why().ask(x, y, [] { return false; });
    return std::pair(answer.status, nlohmann::json::parse(answer.json));
  };
  ASSERT_TRUE(rests(0));
  int strands = 0;
  const auto check = [&] {
    for (int x = 0; x < 24; x += 3) {
      const auto [status, why] = ask(x, 8);
      ASSERT_EQ(status, 200) << why;
      state_.with_frame([&](const FinishedFrame& frame) {
        const Rgb shown = frame.result.film.radiance(x, 8);
        EXPECT_EQ(why["radiance"], nlohmann::json({shown.x, shown.y, shown.z}));
        const uint32_t id = frame.result.film.surface(x, 8).id;
        EXPECT_EQ(why["strand"].is_null(), id == kNoStrand);
        if (id == kNoStrand) return;
        EXPECT_EQ(why["strand"]["id"], id);
        ++strands;
      });
    }
  };
  check();
  EXPECT_GT(strands, 0);
  EXPECT_EQ(ask(24, 8).first, 400);
  EXPECT_EQ(ask(-1, 8).second["error"], "pixel -1 8: the picture has 24 x 16 pixels");
  expect_rendered();
  replace("intensity: 30", "intensity: 60");
  ASSERT_TRUE(rests(1));
  check();
  replace("samples: 4", "samples: 7, integrator: gather");
  ASSERT_TRUE(rests(2));
  check();
  replace("mesh: cube.obj, poses", "mesh: none.obj, poses");
  ASSERT_TRUE(wait_until([](const ViewStatus& s) { return !s.error().empty(); }));
  EXPECT_EQ(ask(12, 8).first, 409);
}

TEST_F(LiveRendererTest, ExplainsThePictureThatIsRefined) {
  LiveRenderer renderer(state_, 2);
  const SceneFollower follower(path(), {{"render.samples", "1000000"}}, renderer, state_);
  ASSERT_TRUE(wait_until([](const ViewStatus& status) { return status.mean_samples >= 1; }));
  const CommandAnswer answer = state_.why().ask(11, 8, [] { return false; });
  ASSERT_EQ(answer.status, 200) << answer.json;
  const nlohmann::json why = nlohmann::json::parse(answer.json);
  EXPECT_LT(why["samples"], 1000000);
  MemoryLedger ledger;
  const FrameResult truth = rendered({{"render.samples", why["samples"].dump()}}, ledger);
  const Rgb wanted = truth.film.radiance(11, 8);
  EXPECT_EQ(why["radiance"], nlohmann::json({wanted.x, wanted.y, wanted.z}));
  EXPECT_FALSE(state_.status().done());
}

TEST_F(LiveRendererTest, ShowsTheChosenFrame) {
  replace("pelage: 1", "pelage: 1\nframes: 1-3");
  LiveRenderer renderer(state_, 2);
  const SceneFollower follower(path(), {}, renderer, state_);
  ASSERT_TRUE(rests(0));
  expect_rendered();
  EXPECT_EQ(state_.status().frames, (std::vector<int>{1, 2, 3}));
  state_.control().set_frame(3);
  ASSERT_TRUE(rests(1));
  EXPECT_EQ(state_.status().frame, 3);
  expect_rendered({{"frames", "3"}});
  replace("intensity: 30", "intensity: 60");
  ASSERT_TRUE(rests(2));
  expect_rendered({{"frames", "3"}});
  // The chosen frame is gone.
  replace("frames: 1-3", "frames: 2");
  ASSERT_TRUE(rests(3));
  EXPECT_EQ(state_.status().frame, 2);
  EXPECT_FALSE(state_.control().frame());
  expect_rendered();
}

TEST_F(LiveRendererTest, AnswersWhileItRendersAndWhileTheSceneChanges) {
  LiveRenderer renderer(state_, 2);
  const SceneFollower follower(path(), {{"render.samples", "100000"}, {"render.bounces", "0"}}, renderer,
                               state_);
  ASSERT_TRUE(wait_until([](const ViewStatus& status) { return status.first_pixels_s > 0; }));
  std::atomic<bool> ends{false};
  std::atomic<int> answers{0};
  std::vector<std::thread> clients;
  for (int i = 0; i < 2; ++i) {
    clients.emplace_back([&, i] {
      while (!ends) {
        const CommandAnswer answer = state_.why().ask(10 + i, 8, [&] { return ends.load(); });
        if (answer.status == 200) ++answers;
      }
    });
  }
  for (int i = 0; i < 4; ++i) {
    const int before = answers;
    replace("intensity: 3", "intensity: 33");
    EXPECT_TRUE(wait_until([&](const ViewStatus&) { return answers > before; }));
    replace("value: 0.4", "value: 0.44");
  }
  EXPECT_FALSE(state_.status().done()) << "it still renders";
  ends = true;
  for (std::thread& client : clients) client.join();
}

TEST_F(LiveRendererTest, GatherShowsItsOwnPasses) {
  replace("samples: 4", "samples: 100000, integrator: gather");
  LiveRenderer renderer(state_, 2);
  const SceneFollower follower(path(), {}, renderer, state_);
  // The pass with `path` has one sample.
  ASSERT_TRUE(wait_until([](const ViewStatus& status) { return status.mean_samples > 1; }));
  EXPECT_FALSE(state_.status().done());
  EXPECT_GT(state_.picture()->samples, 1u);
}

TEST_F(LiveRendererTest, EndsInTheMiddleOfARender) {
  LiveRenderer renderer(state_, 2);
  const SceneFollower follower(path(), {{"render.samples", "1000000"}}, renderer, state_);
  ASSERT_TRUE(wait_until([](const ViewStatus& status) { return status.first_pixels_s > 0; }));
  EXPECT_FALSE(state_.status().done());
  EXPECT_FALSE(partial_exr(*state_.picture()).empty());
}

}  // namespace
}  // namespace pelage
