// SPDX-License-Identifier: Apache-2.0
#include "render/light/ies_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"
#include "base/nearest_name.h"

namespace pelage {
namespace {

constexpr size_t kLongestIes = size_t(16) << 20;  // bytes; files of luminaires have 2 to 200 KiB

/// Min difference of two angles, in degrees: with smaller steps, the mean of the profile would be inaccurate.
constexpr float kMinStep = 0.01f;

/// Reads the lines before TILT=, and then the numbers, which may be anywhere in lines.
class IesScanner {
 public:
  IesScanner(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  /// Skips the lines up to the line TILT=, and returns the value of this line; empty if there is no such
  /// line.
  std::optional<std::string_view> skip_to_tilt() {
    while (at_ < text_.size()) {
      const size_t end = std::min(text_.find('\n', at_), text_.size());
      std::string_view line = text_.substr(at_, end - at_);
      token_line_ = line_;
      at_ = std::min(end + 1, text_.size());
      ++line_;
      line = trimmed(line);
      if (line.starts_with("TILT=")) return trimmed(line.substr(5));
    }
    return {};
  }

  /// Reads the next number as a float.
  float number(const char* what) {
    const std::string_view token = next_token(what);
    const std::string_view digits = token.starts_with('+') ? token.substr(1) : token;
    double value = 0;
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (status != std::errc() || end != digits.data() + digits.size())
      refuse(fmt::format("expected {}, got {}", what, quote(token)));
    if (!std::isfinite(static_cast<float>(value)))
      refuse(fmt::format("expected {} that a float can hold, got {}", what, quote(token)));
    return static_cast<float>(value);
  }

  /// Reads the next number as a count of numbers that follow, which the file is long enough to have.
  size_t count(const char* what, float least) {
    const float value = number(what);
    if (!(value >= least) || value != std::floor(value))
      refuse(fmt::format("expected {}, at least {}, got {}", what, least, value));
    if (value > static_cast<float>(text_.size() - at_))
      refuse(fmt::format("{} is larger than the file", what));
    return static_cast<size_t>(value);
  }

  [[noreturn]] void refuse(std::string message) const {
    throw Error(ErrorKind::kInput, {file_, token_line_, 0}, std::move(message));
  }

 private:
  static std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_between(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_between(text.back())) text.remove_suffix(1);
    return text;
  }

  static bool is_between(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',' || c == '\v' || c == '\f' ||
           c == '\x1a';
  }

  std::string_view next_token(const char* what) {
    while (at_ < text_.size() && is_between(text_[at_])) line_ += text_[at_++] == '\n';
    token_line_ = line_;
    const size_t begin = at_;
    while (at_ < text_.size() && !is_between(text_[at_])) ++at_;
    if (at_ == begin) refuse(fmt::format("expected {}, got the end of the file", what));
    return text_.substr(begin, at_ - begin);
  }

  std::string_view text_;
  std::string file_;
  size_t at_ = 0;
  int line_ = 1, token_line_ = 1;
};

void skip_tilt(IesScanner& scanner, std::string_view tilt) {
  if (tilt != "INCLUDE") return;  // NONE, or the name of a file that has the same numbers
  scanner.number("the geometry of the lamp");
  const size_t angles = scanner.count("the number of tilt angles", 1);
  for (size_t i = 0; i < 2 * angles; ++i) scanner.number("a tilt angle or factor");
}

void check_type(const IesScanner& scanner, float type) {
  if (type == 1) return;
  if (type == 2 || type == 3)
    scanner.refuse(fmt::format("photometric type {} is not supported; convert the file to type C (1)",
                               type == 2 ? "B (2)" : "A (3)"));
  scanner.refuse(fmt::format("expected the photometric type 1, 2 or 3, got {}", type));
}

std::vector<float> read_angles(IesScanner& scanner, size_t count, const char* what, float max) {
  std::vector<float> angles(count);
  for (size_t i = 0; i < count; ++i) {
    angles[i] = scanner.number(what);
    if (!(angles[i] >= 0 && angles[i] <= max))
      scanner.refuse(fmt::format("expected {} from 0 to {}, got {}", what, max, angles[i]));
    if (i > 0 && !(angles[i] >= angles[i - 1] + kMinStep))
      scanner.refuse(
          fmt::format("expected {} of at least {}, got {}", what, angles[i - 1] + kMinStep, angles[i]));
  }
  return angles;
}

/// Whether the last angle, of 360 degrees, is missing: the gap is not wider than the widest step.
bool is_open_circle(const std::vector<float>& horizontal) {
  if (horizontal.front() != 0 || horizontal.back() <= 180 || horizontal.back() >= 360) return false;
  float widest = 0;
  for (size_t i = 1; i < horizontal.size(); ++i) widest = std::max(widest, horizontal[i] - horizontal[i - 1]);
  return 360 - horizontal.back() <= widest + kMinStep;
}

void check_symmetry(const IesScanner& scanner, const std::vector<float>& horizontal) {
  if (horizontal.size() == 1 || is_open_circle(horizontal)) return;
  const float first = horizontal.front(), last = horizontal.back();
  const bool known = first == 0 ? last == 90 || last == 180 || last == 360 : first == 90 && last == 270;
  if (!known)
    scanner.refuse(fmt::format(
        "horizontal angles from {} to {}; expected 0 to 90, 0 to 180, 90 to 270 or 0 to 360", first, last));
}

}  // namespace

IesPhotometry read_ies(const std::filesystem::path& path) {
  const std::string text = read_text_file(path, kLongestIes);
  IesScanner scanner(text, path.string());
  const std::optional<std::string_view> tilt = scanner.skip_to_tilt();
  if (!tilt) throw Error(ErrorKind::kInput, {path.string(), 1, 0}, "no IES profile: there is no line TILT=");
  skip_tilt(scanner, *tilt);
  scanner.number("the number of lamps");
  scanner.number("lumens per lamp");
  float factor = scanner.number("the factor of the candela values");
  const size_t vertical = scanner.count("the number of vertical angles", 2);
  const size_t horizontal = scanner.count("the number of horizontal angles", 1);
  check_type(scanner, scanner.number("the photometric type"));
  for (const char* what : {"the type of units", "the width", "the length", "the height"})
    scanner.number(what);
  factor *= scanner.number("the ballast factor");
  factor *= scanner.number("the ballast-lamp factor");
  scanner.number("the input watts");
  if (!(factor > 0)) scanner.refuse("the factors of the candela values are not above 0");

  IesPhotometry ies;
  ies.vertical = read_angles(scanner, vertical, "a vertical angle", 180);
  ies.horizontal = read_angles(scanner, horizontal, "a horizontal angle", 360);
  check_symmetry(scanner, ies.horizontal);
  for (size_t i = 0; i < vertical * horizontal; ++i) {
    const float candela = factor * scanner.number("a candela value");
    if (!std::isfinite(candela)) scanner.refuse("a candela value and its factors are too large for a float");
    if (!(candela >= 0)) scanner.refuse(fmt::format("expected a candela value not below 0, got {}", candela));
    ies.candela.push_back(candela);
  }
  if (std::all_of(ies.candela.begin(), ies.candela.end(), [](float v) { return v < 1e-20f; }))
    scanner.refuse("all candela values are 0 or almost 0");
  if (is_open_circle(ies.horizontal)) {
    ies.horizontal.push_back(360);
    ies.candela.insert(ies.candela.end(), ies.candela.begin(),
                       ies.candela.begin() + static_cast<std::ptrdiff_t>(vertical));
  }
  return ies;
}

}  // namespace pelage
