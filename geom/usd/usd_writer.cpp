// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_writer.h"

#include <iterator>
#include <vector>

#include <fmt/compile.h>

namespace pelage {
namespace {

constexpr size_t kUsdBlock = size_t(1) << 20;

/// Max length of the text of a float, with the characters around it.
constexpr size_t kNumberLength = 32;

void append_text(fmt::memory_buffer& buffer, std::string_view text) {
  buffer.append(text.data(), text.data() + text.size());
}

}  // namespace

UsdWriter::UsdWriter(const std::filesystem::path& path, std::string_view metadata, Links links)
    : file_(path, links) {
  append_text(text_, "#usda 1.0\n(\n");
  for (size_t begin = 0; begin < metadata.size();) {
    const size_t end = std::min(metadata.find('\n', begin), metadata.size());
    append_text(text_, "    ");
    append_text(text_, metadata.substr(begin, end - begin));
    text_.push_back('\n');
    begin = end + 1;
  }
  append_text(text_, ")\n\n");
}

void UsdWriter::begin(std::string_view text) {
  for (size_t i = 0; i < depth_; ++i) append_text(text_, "    ");
  append_text(text_, text);
}

void UsdWriter::end(std::string_view text) {
  append_text(text_, text);
  text_.push_back('\n');
  flush_if_long();
}

void UsdWriter::flush_if_long() {
  if (text_.size() < kUsdBlock) return;
  file_.write(std::string_view(text_.data(), text_.size()));
  text_.clear();
}

void UsdWriter::line(std::string_view text) {
  begin(text);
  end({});
}

void UsdWriter::open(std::string_view text) {
  line(text);
  line("{");
  ++depth_;
}

void UsdWriter::open_samples(std::string_view attribute) {
  begin(attribute);
  end(".timeSamples = {");
  ++depth_;
}

void UsdWriter::close() {
  --depth_;
  line("}");
}

void UsdWriter::array(std::string_view text, std::span<const float> values, Layout layout,
                      std::string_view metadata) {
  begin(text);
  append_text(text_, "[");
  std::vector<char> element(kNumberLength * layout.components + 4);
  for (size_t i = 0; i + layout.components <= values.size(); i += layout.stride) {
    char* end = element.data();
    if (i > 0) *end++ = ',', *end++ = ' ';
    if (layout.components > 1) *end++ = '(';
    for (size_t c = 0; c < layout.components; ++c) {
      if (c > 0) *end++ = ',', *end++ = ' ';
      end = fmt::format_to(end, FMT_COMPILE("{}"), values[i + c]);
    }
    if (layout.components > 1) *end++ = ')';
    text_.append(element.data(), end);
    flush_if_long();
  }
  append_text(text_, "]");
  end(metadata);
}

template <class T>
void UsdWriter::integers(std::string_view text, std::span<const T> values, std::string_view metadata) {
  begin(text);
  append_text(text_, "[");
  for (size_t i = 0; i < values.size(); ++i) {
    if (i > 0) append_text(text_, ", ");
    fmt::format_to(std::back_inserter(text_), FMT_COMPILE("{}"), values[i]);
    flush_if_long();
  }
  append_text(text_, "]");
  end(metadata);
}

void UsdWriter::array(std::string_view text, std::span<const uint32_t> values, std::string_view metadata) {
  integers(text, values, metadata);
}
void UsdWriter::array(std::string_view text, std::span<const uint64_t> values, std::string_view metadata) {
  integers(text, values, metadata);
}

void UsdWriter::box(std::string_view text, const Box3f& box, std::string_view metadata) {
  const float corners[] = {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
  array(text, corners, {3, 3}, metadata);
}

void UsdWriter::commit() {
  file_.write(std::string_view(text_.data(), text_.size()));
  text_.clear();
  file_.commit();
}

std::string usd_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n') {
      out += "\\n";
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string usd_asset(std::string_view path) {
  const char* quotes = path.find('@') == std::string_view::npos ? "@" : "@@@";
  return fmt::format("{}{}{}", quotes, path, quotes);
}

std::string usd_number(double value) { return fmt::format("{}", static_cast<float>(value)); }

}  // namespace pelage
