// SPDX-License-Identifier: Apache-2.0
#include "exchange/export_notes.h"

namespace pelage {

void ExportNotes::add(const std::string& subject, const std::string& text) {
  std::string line = "- " + subject + ": " + text;
  if (known_.insert(line).second) lines_.push_back(std::move(line));
}

std::string ExportNotes::list() const {
  std::string text;
  for (const std::string& line : lines_) text += line + "\n";
  return text;
}

}  // namespace pelage
