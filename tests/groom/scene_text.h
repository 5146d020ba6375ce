// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "base/schema.h"
#include "scene/document.h"

namespace pelage::scene_text {

/// Reads a T from YAML as a scene does; the problems of the text, if any, into `problems`. The text stands
/// indented by two from line 2 of "scene.yaml" on.
template <class T>
T read(const std::string& yaml, Problems& problems, const KeyOptions& options = {}) {
  std::string text = "it:\n  ";
  for (char c : yaml) text += c == '\n' ? "\n  " : std::string(1, c);
  T result{};
  ValueReader<T>::read(*parse_document(text, "scene.yaml").find("it"), options, result, problems);
  return result;
}

/// The same for text that must be right.
template <class T>
T read(const std::string& yaml) {
  Problems problems;
  T result = read<T>(yaml, problems);
  EXPECT_TRUE(problems.empty()) << (problems.empty() ? "" : problems.list().front().message);
  return result;
}

}  // namespace pelage::scene_text
