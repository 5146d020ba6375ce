// SPDX-License-Identifier: Apache-2.0
#include "world/checkpoint_file.h"

#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"

namespace pelage {
namespace {

constexpr const char* kKind = "checkpoint";
constexpr size_t kFirstBlock = 2;  // sections: inputs, progress, blocks of the state
constexpr const char *kSeconds = "seconds", *kPicture = "picture";

[[noreturn]] void refuse(const std::filesystem::path& path) {
  throw Error(ErrorKind::kInput, {path.string(), 0, 0}, "damaged checkpoint: its record is malformed");
}

std::string to_lines(const FrameInputs& values) {
  std::string text;
  for (const auto& [name, value] : values) text += name + "\t" + value + "\n";
  return text;
}

/// The opposite of to_lines(). Empty for other texts.
std::optional<FrameInputs> from_lines(std::span<const std::byte> bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  FrameInputs values;
  while (!text.empty()) {
    const size_t end = text.find('\n'), tab = text.find('\t');
    if (end == std::string_view::npos || tab >= end) return {};
    values.emplace(text.substr(0, tab), text.substr(tab + 1, end - tab - 1));
    text.remove_prefix(end + 1);
  }
  return values;
}

std::span<const std::byte> text_bytes(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

std::optional<double> parse_seconds(const std::string& text) {
  double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(seconds) && seconds >= 0 ? std::optional(seconds) : std::nullopt;
}

std::string difference(const std::string& name, const std::string* before, const std::string* now) {
  const size_t space = name.find(' ');
  const std::string category = name.substr(0, space);
  if (category == "scene") return "`" + name.substr(space + 1) + "`";
  if (category == "file") return name.substr(name.find(' ', space + 1) + 1);
  if (!before || !now || category == "build" || category == "poses") return category;
  return fmt::format("{} ({} before, {} now)", category, *before, *now);
}

}  // namespace

CheckpointFile::CheckpointFile(const std::filesystem::path& path) : stored_(path) {
  if (stored_.kind() != kKind || stored_.section_count() < kFirstBlock) refuse(path);
  const std::optional<FrameInputs> inputs = from_lines(stored_.section(0));
  const std::optional<FrameInputs> progress = from_lines(stored_.section(1));
  if (!inputs || !progress) refuse(path);
  record_.inputs = *inputs;
  for (const auto& [name, value] : *progress) {
    if (name == kSeconds) {
      const std::optional<double> seconds = parse_seconds(value);
      if (!seconds) refuse(path);
      record_.seconds = *seconds;
    } else if (name == kPicture) {
      record_.picture = parse_hash(value);
      if (!record_.picture) refuse(path);
    } else {
      refuse(path);
    }
  }
}

bool CheckpointFile::copy_to(const FrameState& state) const {
  if (stored_.section_count() != kFirstBlock + state.size()) return false;
  for (size_t i = 0; i < state.size(); ++i) {
    if (stored_.section(kFirstBlock + i).size() != state[i].size()) return false;
  }
  for (size_t i = 0; i < state.size(); ++i) {
    if (!state[i].empty())
      std::memcpy(state[i].data(), stored_.section(kFirstBlock + i).data(), state[i].size());
  }
  return true;
}

bool CheckpointFile::write(const std::filesystem::path& path, const CheckpointRecord& record,
                           const FrameState& state, const WarningSink& warn) {
  const std::string inputs = to_lines(record.inputs);
  FrameInputs progress{{kSeconds, fmt::format("{}", record.seconds)}};
  if (record.picture) progress[kPicture] = to_string(*record.picture);
  ContentStore::Writer writer(path, kKind, content_hash(text_bytes(inputs)));
  writer.add(text_bytes(inputs));
  writer.add(text_bytes(to_lines(progress)));
  for (const std::span<std::byte>& block : state) writer.add(std::span<const std::byte>(block));
  return writer.commit(warn);
}

std::string one_line(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f || c == '\\') {
      result += fmt::format("\\x{:02x}", byte);
    } else {
      result += c;
    }
  }
  return result;
}

std::string input_differences(const FrameInputs& before, const FrameInputs& now) {
  std::vector<std::string> found;
  const auto value = [](const FrameInputs& inputs, const std::string& name) {
    const auto place = inputs.find(name);
    return place == inputs.end() ? nullptr : &place->second;
  };
  FrameInputs all = before;
  all.insert(now.begin(), now.end());
  for (const auto& [name, ignored] : all) {
    const std::string *old = value(before, name), *present = value(now, name);
    if (!old || !present || *old != *present) found.push_back(difference(name, old, present));
  }
  constexpr size_t kShown = 6;
  std::string text;
  for (size_t i = 0; i < found.size() && i < kShown; ++i) text += (i > 0 ? ", " : "") + found[i];
  if (found.size() > kShown) text += fmt::format(" and {} more", found.size() - kShown);
  return text;
}

}  // namespace pelage
