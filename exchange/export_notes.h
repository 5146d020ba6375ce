// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

namespace pelage {

/// Collects what an export cannot express, for the README beside the exported files. Equal notes are kept
/// once.
class ExportNotes {
 public:
  /// `subject`: the part of the scene, such as "light 'key'". `text`: what is lost or approximated.
  void add(const std::string& subject, const std::string& text);
  bool empty() const { return lines_.empty(); }
  /// Returns one line of Markdown per note, in the order in which the notes were added.
  std::string list() const;

 private:
  std::vector<std::string> lines_;
  std::set<std::string> known_;
};

}  // namespace pelage
