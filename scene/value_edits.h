// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/document.h"

namespace pelage {

/// A new value of a key that holds a number or a list of numbers, or a block that is added or removed.
struct ValueEdit {
  std::vector<std::string>
      path;  ///< names of the key and of the blocks around it: {"lights", "key", "intensity"}
  std::vector<double> numbers;  ///< finite, not empty; a single number is written without brackets
  std::string block = {};       ///< a new block, instead of numbers: "{type: sphere, radius: 0.5}"
  bool removed = false;         ///< the key is removed, with its value
};

/// Returns the text of a scene file with new values. Changes only the bytes of these values, and keeps all
/// others: comments, formatting and line ends. Adds a missing key after another key of its block, and a block
/// behind all others, or before all others in brackets; if the document has no block around the new block,
/// adds both at the end. Removes a key together with the comments behind its value, and also the block around
/// it if this becomes empty.
///
/// Throws Error (kInput) with one line if a value cannot be changed in this way: its block is not in the
/// text, the value is neither a number nor a list of as many numbers as the new value has, a new block exists
/// already, or a removed key is missing or the last one of the document. `file`: file
/// name for messages.
std::string with_values(const std::string& text, const std::string& file,
                        const std::vector<ValueEdit>& edits);

/// Does the same to a scene file. The file is replaced as a whole or not at all. Also throws Error (kInput)
/// if a value comes from an included file or from an override, which the file would not change, and Error
/// (kFailed) if the file cannot be written or changes at the same time.
void write_values(const std::filesystem::path& path, const std::vector<Override>& overrides,
                  const std::vector<ValueEdit>& edits);

/// Returns the new values as YAML, one line for each, under the names of their blocks. Comments name what is
/// removed.
std::string values_text(const std::vector<ValueEdit>& edits);

/// Returns numbers as they are written into a scene: "0.5", "[1, 0.5, 2]".
std::string numbers_text(const std::vector<double>& numbers);

}  // namespace pelage
