// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "base/file.h"
#include "base/vector.h"

namespace pelage {

/// Writes a USD layer as text (.usda). Numbers are the shortest text that a reader converts back to the same
/// float. The file appears completely or not at all (law 6). Every member throws Error (kFailed) when the
/// file cannot be written.
class UsdWriter {
 public:
  /// Writes the first line and the metadata of the layer. `metadata`: lines between the parentheses.
  UsdWriter(const std::filesystem::path& path, std::string_view metadata, Links links = Links::kReplace);

  /// Writes a line with the indentation of the open blocks.
  void line(std::string_view text);
  /// Writes a line and an opening brace. close() writes the closing brace.
  void open(std::string_view text);
  /// Writes the beginning of the time samples of an attribute, such as "float[] widths". The grammar wants
  /// the brace in the same line. close() ends them.
  void open_samples(std::string_view attribute);
  void close();

  /// The layout of the values of an array: `components` numbers, which start at each multiple of `stride`.
  struct Layout {
    size_t components = 1, stride = 1;
  };
  /// Writes `text` = an array. `layout.components` > 1: an array of tuples. `metadata`: text after the array.
  void array(std::string_view text, std::span<const float> values, Layout layout = {1, 1},
             std::string_view metadata = {});
  void array(std::string_view text, std::span<const uint32_t> values, std::string_view metadata = {});
  void array(std::string_view text, std::span<const uint64_t> values, std::string_view metadata = {});
  /// Writes `text` = an array with two points.
  void box(std::string_view text, const Box3f& box, std::string_view metadata = {});

  /// Ends the file and moves it to its path.
  void commit();

 private:
  template <class T>
  void integers(std::string_view text, std::span<const T> values, std::string_view metadata);
  void begin(std::string_view text);
  void end(std::string_view text);
  void flush_if_long();

  AtomicFile file_;
  fmt::memory_buffer text_;
  size_t depth_ = 0;
};

/// Returns a text as a string of USD, in quotes.
std::string usd_string(std::string_view text);
/// Returns a path of a file as an asset of USD, between @.
std::string usd_asset(std::string_view path);
/// Returns the shortest text of a number.
std::string usd_number(double value);

}  // namespace pelage
