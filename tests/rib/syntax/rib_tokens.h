// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace pelage {

/// An argument of a request: a text, or a list of texts or numbers. A single number is a list of one.
struct RibArgument {
  bool is_list = false;
  std::vector<std::string> texts;
  std::vector<double> numbers;
};

struct RibRequest {
  std::string name;
  std::vector<RibArgument> arguments;

  /// The values of the argument that follows the text `declaration`.
  const RibArgument& parameter(const std::string& declaration) const {
    for (size_t i = 0; i + 1 < arguments.size(); ++i) {
      if (arguments[i].texts == std::vector<std::string>{declaration} && !arguments[i].is_list)
        return arguments[i + 1];
    }
    throw std::runtime_error(name + " has no " + declaration);
  }
  bool has(const std::string& declaration) const {
    for (const RibArgument& a : arguments) {
      if (!a.is_list && a.texts == std::vector<std::string>{declaration}) return true;
    }
    return false;
  }
};

/// A reader of RIB for tests, written from the table of encodings alone: slow, and without any care for
/// damaged input.
class RibTokens {
 public:
  explicit RibTokens(const std::string& bytes) : bytes_(bytes) {}

  std::vector<RibRequest> all() {
    while (at_ < bytes_.size()) token();
    return std::move(requests_);
  }

 private:
  unsigned take() {
    if (at_ >= bytes_.size()) throw std::runtime_error("the stream ends too early");
    return static_cast<unsigned char>(bytes_[at_++]);
  }
  uint32_t big_endian(unsigned count) {
    uint32_t value = 0;
    for (unsigned i = 0; i < count; ++i) value = value << 8 | take();
    return value;
  }
  std::string characters(size_t count) {
    if (at_ + count > bytes_.size()) throw std::runtime_error("a string ends too early");
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  void add_number(double value) {
    if (!in_list_) requests_.back().arguments.push_back({});
    requests_.back().arguments.back().numbers.push_back(value);
  }
  void add_text(std::string value) {
    if (!in_list_) requests_.back().arguments.push_back({});
    requests_.back().arguments.back().texts.push_back(std::move(value));
  }
  std::string encoded_string() {
    const unsigned first = take();
    if (first >= 0220 && first < 0240) return characters(first - 0220);
    if (first >= 0240 && first < 0244) return characters(big_endian(first - 0240 + 1));
    throw std::runtime_error("expected an encoded string");
  }

  void token() {
    const auto first = static_cast<unsigned char>(bytes_[at_]);
    if (first >= 0200) return encoded(first);
    const char c = bytes_[at_];
    if (c == '#') {
      while (at_ < bytes_.size() && bytes_[at_] != '\n') ++at_;
    } else if (c == ' ' || c == '\n') {
      ++at_;
    } else if (c == '[') {
      ++at_;
      requests_.back().arguments.push_back({});
      requests_.back().arguments.back().is_list = in_list_ = true;
    } else if (c == ']') {
      ++at_;
      in_list_ = false;
    } else if (c == '"') {
      quoted();
    } else if ((c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.') {
      char* end = nullptr;
      add_number(std::strtod(&bytes_[at_], &end));
      at_ = static_cast<size_t>(end - bytes_.data());
    } else {
      const size_t end = bytes_.find_first_of(" \n\"[", at_);
      requests_.push_back({bytes_.substr(at_, end - at_), {}});
      at_ = end == std::string::npos ? bytes_.size() : end;
    }
  }
  void quoted() {
    std::string value;
    for (++at_; bytes_[at_] != '"'; ++at_) {
      if (bytes_[at_] != '\\') {
        value += bytes_[at_];
      } else {
        ++at_;
        value += bytes_[at_] == 'n' ? '\n' : bytes_[at_];
      }
    }
    ++at_;
    add_text(value);
  }
  void encoded(unsigned first) {
    if (first >= 0220 && first < 0244) return add_text(encoded_string());
    ++at_;
    if (first < 0204) {
      const unsigned bytes = first - 0200 + 1;
      const uint32_t value = big_endian(bytes) << (32 - 8 * bytes);
      add_number(static_cast<int32_t>(value) >> (32 - 8 * bytes));
    } else if (first == 0244) {
      add_number(static_cast<double>(std::bit_cast<float>(big_endian(4))));
    } else if (first == 0246) {
      requests_.push_back({request_names_.at(take()), {}});
    } else if (first >= 0310 && first < 0314) {
      const uint32_t count = big_endian(first - 0310 + 1);
      requests_.back().arguments.push_back({});
      requests_.back().arguments.back().is_list = true;
      for (uint32_t i = 0; i < count; ++i)
        requests_.back().arguments.back().numbers.push_back(
            static_cast<double>(std::bit_cast<float>(big_endian(4))));
    } else if (first == 0314) {
      const unsigned code = take();
      request_names_[code] = encoded_string();
    } else if (first == 0315) {
      const unsigned code = take();
      strings_[code] = encoded_string();
    } else if (first == 0317) {
      add_text(strings_.at(take()));
    } else {
      throw std::runtime_error("unexpected byte " + std::to_string(first));
    }
  }

  const std::string& bytes_;
  size_t at_ = 0;
  bool in_list_ = false;
  std::map<unsigned, std::string> request_names_, strings_;
  std::vector<RibRequest> requests_;
};

inline std::vector<RibRequest> rib_requests(const std::string& bytes) { return RibTokens(bytes).all(); }

}  // namespace pelage
