// SPDX-License-Identifier: Apache-2.0
#include "base/check.h"
#include "tests/fuzz/fuzz_targets.h"
#include "world/scene_schema.h"

namespace pelage {
namespace {

// A message is one line, whatever the text that it quotes.
void check_lines(const std::vector<Problem>& problems) {
  PELAGE_CHECK(!problems.empty());
  for (const Problem& problem : problems) {
    PELAGE_CHECK(!problem.message.empty());
    PELAGE_CHECK(problem.message.find_first_of("\n\r\x1b") == std::string::npos);
    PELAGE_CHECK(problem.position.line >= 1 && problem.position.column >= 1);
  }
}

}  // namespace

void fuzz_scene(std::span<const uint8_t> bytes) {
  try {
    const Value document =
        parse_document(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), "scene.yaml");
    SceneDescription scene;
    Problems problems;
    const bool good = SceneDescription::schema().read(document, scene, problems);
    PELAGE_CHECK(good == problems.empty());
    if (good) check_references(scene, problems);
    if (!problems.empty()) check_lines(problems.list());
  } catch (const Error& error) {
    PELAGE_CHECK(error.kind() == ErrorKind::kInput);
    check_lines(error.problems());
  }
}

}  // namespace pelage
