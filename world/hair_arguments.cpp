// SPDX-License-Identifier: Apache-2.0
#include "world/hair_arguments.h"

#include <charconv>

#include <fmt/format.h>

#include "base/error.h"
#include "base/nearest_name.h"
#include "base/value_readers.h"

namespace pelage {
namespace {

constexpr const char* kMemory = "render.memory";

[[noreturn]] void fail(const std::string& message) {
  throw Error(ErrorKind::kArguments, "procedural: " + message);
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  bool quoted = false, in_word = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && text.substr(i, 2) == "''") {
      words.back() += c;
      ++i;
    } else if (c == '\'') {
      quoted = !quoted;
      if (!in_word) words.emplace_back();
      in_word = true;
    } else if (!quoted && (c == ' ' || c == '\t' || c == '\n' || c == '\r')) {
      in_word = false;
    } else {
      if (!in_word) words.emplace_back();
      in_word = true;
      words.back() += c;
    }
  }
  if (quoted) fail("the arguments " + quote(std::string(text)) + " have an unpaired quote");
  return words;
}

template <class Number>
Number parse_number_of(const std::string& name, std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    fail(fmt::format("{}={}: expected a number", name, text));
  return value;
}

LeafRange parse_leaves(const std::string& text) {
  const size_t dash = text.find('-');
  const auto first = parse_number_of<uint32_t>("leaf", std::string_view(text).substr(0, dash));
  const auto last = dash == std::string::npos
                        ? first
                        : parse_number_of<uint32_t>("leaf", std::string_view(text).substr(dash + 1));
  if (last < first) fail("leaf=" + text + ": the last leaf comes before the first");
  return {first, size_t(last) + 1};
}

void set(HairArguments& arguments, const std::string& name, const std::string& value) {
  static const std::vector<std::string> names{"camera", "character", "coat",  "detail", "frame",
                                              "leaf",   "memory",    "scale", "set",    "threads"};
  if (name == "camera") {
    if (value != "scene") fail("camera=" + value + ": expected camera=scene");
    arguments.scene_camera = true;
  } else if (name == "character") {
    arguments.character = value;
  } else if (name == "coat") {
    arguments.coat = value;
  } else if (name == "detail") {
    if (value != "full") fail("detail=" + value + ": expected detail=full");
    arguments.full_detail = true;
  } else if (name == "frame") {
    arguments.frame = parse_number_of<int>(name, value);
  } else if (name == "leaf") {
    arguments.leaves = parse_leaves(value);
  } else if (name == "memory") {
    if (!parse_bytes(value)) fail("memory=" + value + ": expected bytes such as 512M or 4G");
    arguments.overrides.push_back({kMemory, value});
  } else if (name == "scale") {
    arguments.pixels_per_unit = parse_number_of<float>(name, value);
    if (!(*arguments.pixels_per_unit > 0)) fail("scale=" + value + ": expected a positive number");
  } else if (name == "set") {
    arguments.overrides.push_back(parse_override(value));
  } else if (name == "threads") {
    arguments.threads = parse_number_of<int>(name, value);
    if (arguments.threads < 0 || arguments.threads > 4096) fail("threads=" + value + ": expected 0 to 4096");
  } else {
    fail("unknown argument " + quote(name) + suggest(name, names));
  }
}

}  // namespace

HairArguments parse_hair_arguments(std::string_view text) {
  HairArguments arguments;
  for (const std::string& word : words_of(text)) {
    const size_t equals = word.find('=');
    // The path of a scene may contain '='; a name does not contain '/' or '.'.
    if (equals == std::string::npos || word.find_first_of("/.") < equals) {
      if (!arguments.scene.empty())
        fail("expected name=value, got " + quote(word) + " after the scene " + quote(arguments.scene));
      arguments.scene = word;
    } else {
      set(arguments, word.substr(0, equals), word.substr(equals + 1));
    }
  }
  if (arguments.scene.empty()) fail("the arguments name no scene file");
  if (arguments.leaves && arguments.coat.empty()) fail("leaf= needs coat=");
  return arguments;
}

std::string print_hair_arguments(const HairArguments& arguments) {
  std::string text;
  const auto add = [&](const std::string& word) {
    const bool plain = !word.empty() && word.find_first_of("' \t\n\r") == std::string::npos;
    if (!text.empty()) text += ' ';
    if (!plain) text += '\'';
    for (const char c : word) text += c == '\'' ? std::string("''") : std::string(1, c);
    if (!plain) text += '\'';
  };
  add(arguments.scene);
  if (arguments.frame) add(fmt::format("frame={}", *arguments.frame));
  if (!arguments.character.empty()) add("character=" + arguments.character);
  if (!arguments.coat.empty()) add("coat=" + arguments.coat);
  if (arguments.leaves) {
    const LeafRange leaves = *arguments.leaves;
    add(leaves.count() == 1 ? fmt::format("leaf={}", leaves.first)
                            : fmt::format("leaf={}-{}", leaves.first, leaves.end - 1));
  }
  if (arguments.scene_camera) add("camera=scene");
  if (arguments.pixels_per_unit) add(fmt::format("scale={}", *arguments.pixels_per_unit));
  if (arguments.full_detail) add("detail=full");
  if (arguments.threads > 0) add(fmt::format("threads={}", arguments.threads));
  for (const Override& one : arguments.overrides) {
    add(one.key == kMemory ? "memory=" + one.value : "set=" + one.key + "=" + one.value);
  }
  return text;
}

}  // namespace pelage
