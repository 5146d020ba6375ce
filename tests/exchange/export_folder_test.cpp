// SPDX-License-Identifier: Apache-2.0
#include "exchange/export_folder.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "exchange/scene_export.h"
#include "tests/world/furry_scene.h"

namespace pelage::export_folder_test {
namespace {

constexpr const char* kMesh = R"(#usda 1.0
def Mesh "m"
{
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
}
)";
constexpr const char* kOurReadme = "# fur for usd\n\nPelage 0 wrote these files from `fur.yaml`. Open `a`.\n";

class ExportFolders : public testing::Test {
 protected:
  void write(const std::vector<Override>& more = {}) {
    QuietJob job;
    std::vector<Override> overrides{kColor};
    overrides.insert(overrides.end(), more.begin(), more.end());
    const SceneDescription scene = load_scene(files_.scene(), overrides);
    const auto assets = load_assets(scene, job);
    export_scene(folder(), ExportFormat::kUsd, {files_.scene(), scene, *assets}, job);
  }
  std::string refusal(const std::vector<Override>& more = {}) {
    try {
      write(more);
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::kArguments);
      return e.what();
    }
    return "";
  }
  std::filesystem::path folder() const { return files_.path("out"); }
  size_t entries() const {
    const std::filesystem::directory_iterator all(folder());
    return static_cast<size_t>(std::distance(begin(all), end(all)));
  }
  const FurryScene files_;
};

TEST_F(ExportFolders, KeepFilesOfOthers) {
  make_own_folder(folder());
  write_file(folder() / "README.md", "mine");
  EXPECT_NE(refusal().find("README.md: exists, and `pelage export` did not write it"), std::string::npos);
  EXPECT_EQ(read_file(folder() / "README.md"), "mine");
  std::filesystem::remove(folder() / "README.md");
  write_file(folder() / "fur.usda", "mine");
  EXPECT_NE(refusal().find("fur.usda: exists"), std::string::npos);
  EXPECT_EQ(read_file(folder() / "fur.usda"), "mine");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(ExportFolders, KeepFilesThatTheSceneReads) {
  for (const char* input : {"fur.usda", "skins/post_still.usda"}) {
    make_own_folder(folder());
    make_own_folder(folder() / "skins");
    write_file(folder() / "README.md", kOurReadme);
    write_file(folder() / input, kMesh);
    EXPECT_NE(refusal({{"skins.still.mesh", (folder() / input).string()}}).find("would overwrite a file"),
              std::string::npos);
    EXPECT_EQ(read_file(folder() / input), kMesh);
    EXPECT_EQ(read_file(folder() / "README.md"), kOurReadme) << "nothing is half replaced";
    std::filesystem::remove_all(folder());
  }
}

TEST_F(ExportFolders, AreWrittenAgainAndHoldNothingElse) {
  write();
  EXPECT_EQ(entries(), 4u) << "the stage, README.md, coats and skins";
  write();
  EXPECT_EQ(entries(), 4u);
}

TEST_F(ExportFolders, ThatFailLeaveNothing) {
  {
    ExportFolder out(folder(), {});
    write_file(out.working() / "a.usda", "half");
  }
  EXPECT_FALSE(std::filesystem::exists(folder()));
}

}  // namespace
}  // namespace pelage::export_folder_test
