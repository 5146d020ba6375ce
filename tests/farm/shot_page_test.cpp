// SPDX-License-Identifier: Apache-2.0
#include "farm/shot_page.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary_folder.h"
#include "image/exr.h"

namespace pelage {
namespace {

ShotState shot(const std::filesystem::path& folder) {
  FarmRequest request;
  request.scene = "rat.yaml";
  request.frames = {7};
  request.output = "shot.%04d.exr";
  request.folder = "farm";
  request.width = request.height = 64;
  request.columns = 2;
  request.memory = 1000;
  ShotState state;
  state.plan = {folder, 2, make_farm_plan(request)};
  state.plan.estimate.render_bytes = uint64_t{300} << 20;
  state.tasks.resize(state.plan.tasks.size());
  for (TaskState& task : state.tasks) {
    task.stage = TaskStage::kDone;
    task.starts = 1;
    task.busy_s = 61;
    task.host = "node1";
    task.log = "logs/x.txt";
  }
  state.tasks[0].peak_bytes = int64_t{200} << 20;
  return state;
}

void write_picture(const std::filesystem::path& path, float value) {
  ExrImage image;
  image.width = 500;
  image.height = 100;
  for (const char* name : {"B", "G", "R"})
    image.channels.push_back({name, ChannelType::kHalf, std::vector<float>(500 * 100, value), {}});
  write_exr(path, image);
}

TEST(ShotPage, ShowsFramesWithTimesAndMemory) {
  const TemporaryFolder folder;
  const ShotState state = shot(folder.path());
  write_picture(folder.path() / "shot.0007.exr", 0.5f);
  const PagePictures pictures = update_thumbnails(state, folder.path() / "farm");
  ASSERT_TRUE(pictures.contains(7));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "farm" / pictures.at(7)));
  const std::string page = shot_page(state, folder.path() / "farm", pictures, 0);
  for (const char* text : {"<b>7</b> done", "src=\"thumbs/0007.png\"", "2:02 of machine time", "200.0 MiB",
                           "reserved 300.0 MiB", "3 tasks", "1970-01-01 00:00:00 UTC"})
    EXPECT_NE(page.find(text), std::string::npos) << text << "\n" << page;
  EXPECT_EQ(page.find("Failures"), std::string::npos);
  EXPECT_EQ(page.find("http-equiv=refresh"), std::string::npos) << "nothing will change";
  EXPECT_EQ(page.find("http:"), std::string::npos) << "it needs no server";
}

TEST(ShotPage, ShowsFailuresWithTheEndOfTheLog) {
  const TemporaryFolder folder;
  ShotState state = shot(folder.path());
  state.tasks[1].stage = TaskStage::kFailed;
  state.tasks[1].exit_code = 3;
  state.tasks[2].stage = TaskStage::kCancelled;
  write_file(folder.path() / "farm" / "logs" / "x.txt",
             "first\n2\n3\n4\n5\n6\nrat.yaml:3:7: <no> such & key\n");
  const std::string page = shot_page(state, folder.path() / "farm", {}, 0);
  EXPECT_NE(page.find("rat.yaml:3:7: &lt;no&gt; such &amp; key"), std::string::npos) << page;
  EXPECT_EQ(page.find("first"), std::string::npos);
  EXPECT_NE(page.find("exit code 3"), std::string::npos);
  EXPECT_NE(page.find("<b>7</b> failed"), std::string::npos);
  EXPECT_NE(page.find("http-equiv=refresh"), std::string::npos);
}

TEST(ShotPage, ShowsATaskThatWasKilledBeforeItStartsAgain) {
  const TemporaryFolder folder;
  ShotState state = shot(folder.path());
  state.tasks[1].stage = TaskStage::kQueuedAgain;
  state.tasks[1].exit_code = 137;
  const std::string page = shot_page(state, folder.path() / "farm", {}, 0);
  EXPECT_NE(page.find("Failures and restarts"), std::string::npos);
  EXPECT_NE(page.find("exit code 137<td>"), std::string::npos) << page;
}

TEST(ShotPage, AThumbnailIsMadeAnewOnlyWhenItsPictureIsNewer) {
  const TemporaryFolder folder;
  const ShotState state = shot(folder.path());
  const auto picture = folder.path() / "shot.0007.exr", png = folder.path() / "farm" / "thumbs" / "0007.png";
  write_picture(picture, 0.1f);
  update_thumbnails(state, folder.path() / "farm");
  const std::string first = read_file(png);
  const auto made = std::filesystem::last_write_time(png);
  update_thumbnails(state, folder.path() / "farm");
  EXPECT_EQ(std::filesystem::last_write_time(png), made);
  write_picture(picture, 0.9f);
  std::filesystem::last_write_time(picture, made + std::chrono::seconds(5));
  update_thumbnails(state, folder.path() / "farm");
  EXPECT_NE(read_file(png), first);
}

TEST(ShotPage, DamagedPicturesHaveNoThumbnail) {
  const TemporaryFolder folder;
  write_file(folder.path() / "shot.0007.exr", "no picture");
  EXPECT_TRUE(update_thumbnails(shot(folder.path()), folder.path() / "farm").empty());
  ExrImage grey;
  grey.width = grey.height = 4;
  grey.channels.push_back({"Y", ChannelType::kHalf, std::vector<float>(16), {}});
  write_exr(folder.path() / "grey.exr", grey);
  EXPECT_THROW(write_thumbnail(folder.path() / "grey.exr", folder.path() / "a.png", 10), Error);
}

TEST(ShotPage, ControlCharactersOfALogAreShown) {
  const TemporaryFolder folder;
  ShotState state = shot(folder.path());
  state.tasks[1].stage = TaskStage::kFailed;
  state.tasks[1].host = "n\x1b[2J";
  write_file(folder.path() / "farm" / "logs" / "x.txt", "red: \x1b[31m<b>");
  const std::string page = shot_page(state, folder.path() / "farm", {}, 0);
  EXPECT_NE(page.find("red: \\x1b[31m&lt;b&gt;"), std::string::npos) << page;
  EXPECT_NE(page.find("n\\x1b[2J"), std::string::npos) << page;
}

TEST(ShotPage, FollowsNoLinksAndShowsNoPicturesOfOthers) {
  const TemporaryFolder folder;
  ShotState state = shot(folder.path());
  const auto picture = folder.path() / "shot.0007.exr", elsewhere = folder.path() / "private.exr",
             farm = folder.path() / "farm", png = folder.path() / "precious.png", log = folder.path() / "log";
  write_picture(elsewhere, 0.5f);
  write_file(png, "precious");
  std::filesystem::create_directories(farm / "thumbs");
  std::filesystem::create_symlink(elsewhere, picture);
  EXPECT_TRUE(update_thumbnails(state, farm).empty());
  std::filesystem::remove(picture);
  write_picture(picture, 0.5f);
  std::filesystem::create_symlink(png, farm / "thumbs" / "0007.png");
  std::filesystem::last_write_time(picture, std::filesystem::last_write_time(png) + std::chrono::seconds(5));
  EXPECT_TRUE(update_thumbnails(state, farm).contains(7));
  EXPECT_EQ(read_file(png), "precious");
  EXPECT_FALSE(std::filesystem::is_symlink(farm / "thumbs" / "0007.png"));
  state.owner = 12345;
  EXPECT_TRUE(update_thumbnails(state, farm).empty());

  write_file(log, "secret");
  std::filesystem::create_symlink(log, farm / "log");
  EXPECT_EQ(end_of_log(farm / "log"), "");
}

TEST(ShotPage, TheEndOfALogIsItsLastLines) {
  const TemporaryFolder folder;
  const auto log = folder.path() / "log";
  EXPECT_EQ(end_of_log(log), "");
  write_file(log, "one\ntwo\n\n");
  EXPECT_EQ(end_of_log(log), "one\ntwo");
  write_file(log, "1\n2\n3\n4\n5\n6\n7\n8\n");
  EXPECT_EQ(end_of_log(log), "3\n4\n5\n6\n7\n8");
  write_file(log, std::string(100000, 'x'));
  EXPECT_EQ(end_of_log(log).size(), 4000u);
}

}  // namespace
}  // namespace pelage
