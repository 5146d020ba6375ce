// SPDX-License-Identifier: Apache-2.0
#include "world/checkpoint.h"

#include <atomic>

#include <gtest/gtest.h>

#include "base/file.h"
#include "tests/world/small_scene.h"
#include "world/world.h"

namespace pelage {
namespace {

/// Cancels after a number of questions whether it is cancelled; remembers warnings.
class Impatient final : public Progress {
 public:
  explicit Impatient(int questions) : questions_(questions) {}
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  void warn(std::string_view line) override { warnings += std::string(line) + "\n"; }
  bool cancelled() const override { return questions_-- <= 0; }

  std::string warnings;

 private:
  mutable std::atomic<int> questions_;
};

constexpr int kNever = 1 << 30;

class CheckpointTest : public testing::Test {
 protected:
  using Bytes = std::vector<std::vector<std::byte>>;

  /// With the integrator `path`, unless overridden: it asks often whether its state is due.
  SceneDescription scene(const std::vector<Override>& overrides = {}) const {
    std::vector<Override> all{{"render.integrator", "path"}};
    all.insert(all.end(), overrides.begin(), overrides.end());
    return load_scene(scene_.path("scene.yaml"), all);
  }
  std::filesystem::path file() const { return folder_.path() / "a.checkpoint"; }
  std::filesystem::path picture() const { return folder_.path() / "a.exr"; }

  /// `calls`: the state is due after every so many questions whether it is; 0: never.
  Checkpoint checkpoint(const std::vector<Override>& overrides, Progress& progress, uint32_t calls = 0) {
    Checkpoint::Schedule schedule{1e6};
    if (calls > 0) schedule.requests = [this, calls] { return calls_++ / calls; };
    return {file(), frame_inputs(frame_inputs(scene(overrides)), 1, {}), schedule, progress};
  }
  /// Renders frame 1 from the checkpoint, if there is one. Returns the film, and whether it is complete.
  std::pair<Bytes, bool> render_some(const std::vector<Override>& overrides, Checkpoint* saver, int questions,
                                     int threads) const {
    NoProgress none;
    Impatient impatient(questions);
    MemoryLedger ledger;
    const Workers workers(threads);
    const SceneDescription description = scene(overrides);
    const auto assets = load_assets(description, {workers, ledger, none});
    const World world = compose(description, *assets, 1, {workers, ledger, none});
    if (saver) saver->begin(world.poses);
    FrameOptions options;
    options.saver = saver;
    FrameResult result = render(world, {workers, ledger, impatient}, options);
    Bytes bytes;
    for (const auto& block : result.film.state()) bytes.emplace_back(block.begin(), block.end());
    return {bytes, !result.partial};
  }
  /// What find() throws for a scene with these overrides.
  std::string refusal(const std::vector<Override>& overrides) {
    NoProgress none;
    Checkpoint other = checkpoint(overrides, none);
    try {
      other.find(picture());
      return "";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      return error.what();
    }
  }
  void save_blank(const std::vector<Override>& overrides = {}) {
    NoProgress none;
    checkpoint(overrides, none).save({});
  }

  SmallScene scene_;
  TemporaryFolder folder_;
  std::atomic<uint32_t> calls_{0};
};

TEST_F(CheckpointTest, ARenderInPiecesGivesTheFilmOfOneRun) {
  const std::vector<std::vector<Override>> settings = {
      {{"render.samples", "40"}, {"image.noise_layers", "true"}},
      {{"render.samples", "40"}, {"image.filter_samples", "splatted"}},
      {{"render.samples", "40"}, {"render.integrator", "gather"}},
      {{"render.samples", "40"}, {"render.integrator", "gather"}, {"image.noise_layers", "true"}},
      {{"render.samples", "40"}, {"render.integrator", "gather"}, {"render.gather.reuse", "false"}}};
  for (size_t i = 0; i < settings.size(); ++i) {
    const auto [whole, ended] = render_some(settings[i], nullptr, kNever, 1);
    ASSERT_TRUE(ended);
    std::filesystem::remove(file());
    bool complete = false;
    int runs = 0, continued = 0;
    for (; !complete; ++runs) {
      Impatient progress(kNever);
      Checkpoint saver = checkpoint(settings[i], progress, 90);
      if (saver.find(picture()) == Checkpoint::Found::kState) ++continued;
      const auto [film, done] = render_some(settings[i], &saver, 300 + 170 * runs, 1 + runs % 3);
      complete = done;
      EXPECT_EQ(progress.warnings, "");
      if (!done) continue;
      ASSERT_TRUE(film == whole) << "settings " << i << " after " << runs << " runs";
    }
    EXPECT_GT(continued, 0) << "settings " << i << " after " << runs << " runs";
  }
}

TEST_F(CheckpointTest, NamesWhatDiffers) {
  save_blank();
  EXPECT_EQ(refusal({}), "");
  EXPECT_EQ(refusal({{"render.memory", "900M"}, {"frames", "1-7"}}), "");
  EXPECT_EQ(refusal({{"render.samples", "9"}, {"lights.sky.radiance", "0.2"}}),
            file().string() +
                ": cannot continue this render, because these differ: `lights.sky`, "
                "`render.samples`; remove the file to start anew");
  const std::string mesh = read_file(scene_.path("cube.obj"));
  scene_.write("cube.obj", mesh + "# new\n");
  EXPECT_NE(refusal({}).find("differ: cube.obj, cube.obj;"), std::string::npos) << refusal({});
  scene_.write("cube.obj", mesh);
  EXPECT_EQ(refusal({}), "");
}

TEST_F(CheckpointTest, PosesCount) {
  NoProgress none;
  Checkpoint first = checkpoint({}, none);
  render_some({}, &first, kNever, 1);
  first.save({});
  const std::string pose = read_file(scene_.path("cube.0001.obj"));
  for (const bool changed : {false, true}) {
    if (changed) scene_.write("cube.0001.obj", "v 0 0 0" + pose.substr(pose.find('\n')));
    Checkpoint next = checkpoint({}, none);
    EXPECT_EQ(next.find(picture()), Checkpoint::Found::kState);
    if (changed) {
      EXPECT_THROW(render_some({}, &next, kNever, 1), Error);
    } else {
      EXPECT_NO_THROW(render_some({}, &next, kNever, 1));
    }
  }
}

TEST_F(CheckpointTest, ProgramFrameAndRegionCount) {
  const FrameInputs one = frame_inputs(frame_inputs(scene()), 1, {});
  FrameInputs other = frame_inputs(frame_inputs(scene()), 2, PixelBox{0, 0, 8, 4});
  for (const char* name : {"version", "instructions"}) other.at(name) = "other";
  other.at("build") = "other";
  const std::string text = input_differences(one, other);
  EXPECT_EQ(text.substr(0, text.find("instr")), "build, frame (1 before, 2 now), ");
  EXPECT_NE(text.find(" before, other now), region, version ("), std::string::npos) << text;
  EXPECT_EQ(checkpoint_name(7, {}), "frame-0007.checkpoint");
  EXPECT_EQ(checkpoint_name(-3, PixelBox{0, 1, 16, 9}), "frame--003-0-1-16-9.checkpoint");
}

TEST_F(CheckpointTest, ControlCharactersCannotForgeAnInput) {
  EXPECT_EQ(one_line("a\n\tb\\"), "a\\x0a\\x09b\\x5c");
  NoProgress none;
  const FrameInputs inputs{{"scene " + one_line("lights.a\tb\nframe"), "1"}};
  Checkpoint(file(), inputs, {}, none).save({});
  EXPECT_EQ(CheckpointFile(file()).record().inputs, inputs);
}

TEST_F(CheckpointTest, ADamagedFileIsNamedAndTheFrameStartsAnew) {
  NoProgress none;
  Checkpoint first = checkpoint({}, none, 90);
  render_some({}, &first, kNever, 1);
  const std::string good = read_file(file());
  for (size_t i = 0; i < 60; ++i) {
    std::string bad = good;
    if (i % 2 == 0) {
      bad.resize(bad.size() * i / 60);
    } else {
      bad[hash64(i) % bad.size()] ^= static_cast<char>(1 << i % 8);
    }
    write_file(file(), bad);
    Impatient progress(kNever);
    EXPECT_EQ(checkpoint({}, progress).find(picture()), Checkpoint::Found::kNothing) << i;
    EXPECT_TRUE(progress.warnings.starts_with(file().string())) << progress.warnings;
    EXPECT_NE(progress.warnings.find("rendered from the beginning"), std::string::npos);
  }
  // A file that is in order but belongs to a film of another size.
  std::vector<std::byte> block(24);
  checkpoint({}, none).save({block});
  Impatient progress(kNever);
  Checkpoint next = checkpoint({}, progress);
  EXPECT_EQ(next.find(picture()), Checkpoint::Found::kState);
  std::vector<std::byte> larger(25, std::byte{7});
  EXPECT_FALSE(next.restore({larger}));
  EXPECT_EQ(larger, std::vector<std::byte>(25, std::byte{7}));
  EXPECT_NE(progress.warnings.find("other sizes"), std::string::npos);
}

TEST_F(CheckpointTest, AFolderThatCannotBeReadIsNoFolderWithoutCheckpoints) {
  std::filesystem::create_symlink("circle", folder_.path() / "circle");
  NoProgress none;
  Checkpoint unreadable(folder_.path() / "circle" / "a.checkpoint", {}, {}, none);
  try {
    unreadable.find(picture());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_NE(std::string(error.what()).find("a.checkpoint: cannot read: "), std::string::npos)
        << error.what();
  }
}

TEST_F(CheckpointTest, AFinishedFrameIsFinishedWhileItsPictureIsThere) {
  Impatient progress(kNever);
  Checkpoint first = checkpoint({}, progress);
  first.begin({3, 4});
  write_file(picture(), "a picture");
  first.finish(picture());
  EXPECT_EQ(checkpoint({}, progress).find(picture()), Checkpoint::Found::kPicture);
  EXPECT_NE(refusal({{"render.samples", "9"}}), "");
  EXPECT_EQ(progress.warnings, "");
  write_file(picture(), "another one");
  EXPECT_EQ(checkpoint({}, progress).find(picture()), Checkpoint::Found::kNothing);
  EXPECT_TRUE(progress.warnings.starts_with(picture().string() + ": missing or changed"))
      << progress.warnings;
}

TEST_F(CheckpointTest, IsDueAfterATimeAndOnRequest) {
  NoProgress none;
  std::atomic<uint32_t> requests{0};
  Checkpoint saver(file(), {}, {1e6, [&] { return requests.load(); }}, none);
  EXPECT_FALSE(saver.due());
  ++requests;
  EXPECT_TRUE(saver.due());
  saver.save({});
  EXPECT_FALSE(saver.due());
  Checkpoint often(file(), {}, {0}, none);
  EXPECT_TRUE(often.due());
}

TEST_F(CheckpointTest, AFileThatCannotBeWrittenIsAWarning) {
  save_blank();
  const std::string before = read_file(file());
  Impatient progress(kNever);
  Checkpoint nowhere(folder_.path() / "a.checkpoint" / "b", {}, {}, progress);
  nowhere.save({});
  EXPECT_NE(progress.warnings.find("cannot write"), std::string::npos);
  EXPECT_EQ(read_file(file()), before);
}

TEST_F(CheckpointTest, AdaptiveSamplingAndATimeLimitAreRefused) {
  for (const auto& [key, value] :
       {std::pair{"render.adaptive", "{noise: 0.05}"}, {"render.time_limit", "5"}}) {
    NoProgress none;
    Checkpoint saver = checkpoint({{key, value}}, none);
    EXPECT_THROW(render_some({{key, value}}, &saver, kNever, 1), Error);
  }
}

}  // namespace
}  // namespace pelage
