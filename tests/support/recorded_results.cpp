// SPDX-License-Identifier: Apache-2.0
#include "tests/support/recorded_results.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#if __has_include(<opensubdiv/version.h>)
#include <opensubdiv/version.h>
#endif

namespace pelage {
namespace {

const std::string kFile = PELAGE_SOURCE_DIR "/tests/support/recorded_results.txt";

/// Max difference of a sum, as a fraction of the size of its numbers. With g++ and clang, with and without
/// optimisation and fused multiply-add, all bits were equal; this leaves room for other libraries of
/// functions. A random change of every number by 1e-5 changes sums by about 6e-6.
constexpr double kTolerance = 1e-6;

uint64_t mixed(uint64_t x) {  // splitmix64
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

double weight(uint64_t list, uint64_t i) {
  return static_cast<double>(static_cast<int64_t>(mixed(list ^ mixed(i)))) * 0x1p-63;
}

/// A text that is the same on machines where the functions of the C library, and subdivision, give the same
/// bits. They depend on the versions of libraries and on the processor.
std::string machine() {
  std::vector<double> values;
  for (uint64_t i = 0; i < 4096; ++i) {
    // volatile: computed by the library, not by the compiler.
    const volatile double d = 8 * weight(0, i);
    const volatile auto f = static_cast<float>(d);
    for (const double v :
         {std::sin(d), std::cos(d), std::tan(d), std::exp(d), std::log(std::fabs(d)), std::acos(d / 8),
          std::pow(std::fabs(d), 1.7), std::atan2(d, 3.0), std::cbrt(d), std::hypot(d, 1.5)})
      values.push_back(v);
    for (const float v :
         {std::sin(f), std::cos(f), std::tan(f), std::exp(f), std::log(std::fabs(f)), std::acos(f / 8),
          std::pow(std::fabs(f), 1.7f), std::atan2(f, 3.0f), std::cbrt(f), std::hypot(f, 1.5f)})
      values.push_back(static_cast<double>(v));
  }
  std::string text = "functions " + to_string(content_hash(std::as_bytes(std::span(std::as_const(values)))));
#ifdef OPENSUBDIV_VERSION_NUMBER
  text += fmt::format(" subdivision {}", OPENSUBDIV_VERSION_NUMBER);
#endif
  return text;
}

std::string text_of(const RecordedResults::Versions& versions) {
  std::string text;
  for (const auto& [stage, version] : versions)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", stage, version);
  return text;
}

/// Whether a version is smaller than the recorded one of the same stage. Caches of that version may exist.
bool is_lowered(const RecordedResults::Versions& versions, const std::string& recorded) {
  for (const auto& [stage, version] : versions) {
    const std::string text = ", " + recorded, name = ", " + stage + " ";
    const size_t at = text.find(name);
    if (at != std::string::npos && std::stoi(text.substr(at + name.size())) > version) return true;
  }
  return false;
}

}  // namespace

void StageResult::add_numbers(const std::string& name, std::span<const double> values,
                              const ContentHash& bytes) {
  exact_.add(name).add(bytes);
  if (values.empty()) return;
  List& list = lists_[name];
  ASSERT_EQ(list.count, 0u) << name << " twice";
  list.count = values.size();
  for (size_t i = 0; i < values.size(); ++i) {
    ASSERT_TRUE(std::isfinite(values[i])) << name;
    list.size += values[i] * values[i];
    for (size_t k = 0; k < list.sums.size(); ++k) list.sums[k] += weight(k + 1, i) * values[i];
  }
  list.size = std::sqrt(list.size);
}

RecordedResults::RecordedResults() { read(); }

/// An entry is a line of its name, then one with what it depends on, then one for each list of numbers.
void RecordedResults::read() {
  std::ifstream file(kFile);
  std::string line;
  Entry* entry = nullptr;
  while (std::getline(file, line)) {
    if (line.empty() || line.front() == '#') continue;
    const size_t at = line.find(": ");
    ASSERT_NE(at, std::string::npos) << kFile << ": " << line;
    const std::string key = line.substr(line.find_first_not_of(' '), at - line.find_first_not_of(' '));
    const std::string value = line.substr(at + 2);
    if (line.front() != ' ') {
      entry = &entries_[key];
      entry->versions = value;
    } else if (key == "exact") {
      entry->exact = value.substr(0, value.find(' '));
      entry->machine = value.substr(value.find(' ') + 1);
    } else {
      StageResult::List& list = entry->lists[key];
      std::istringstream numbers(value);
      numbers >> list.count >> list.size;
      for (double& sum : list.sums) numbers >> sum;
      ASSERT_TRUE(numbers) << kFile << ": " << line;
    }
  }
}

void RecordedResults::write() const {
  std::ofstream file(kFile);
  file << "# The results of stages whose results are stored in files: tests/support/recorded_results.h. "
          "Written by\n"
          "# the tests when PELAGE_RECORD_RESULTS is set, one test at a time (ctest -j1). Do not edit.\n";
  for (const auto& [stage, entry] : entries_) {
    file << "\n" << stage << ": " << entry.versions << "\n";
    file << "  exact: " << entry.exact << " " << entry.machine << "\n";
    for (const auto& [name, list] : entry.lists) {
      file << fmt::format("  {}: {} {:.9g}", name, list.count, list.size);
      for (const double sum : list.sums) file << fmt::format(" {:.9g}", sum);
      file << "\n";
    }
  }
}

/// Returns what differs, or an empty text.
std::string RecordedResults::difference(const Entry& recorded, const Entry& now) {
  if (recorded.lists.size() != now.lists.size()) return "the test looks at other numbers";
  std::string changed;
  double largest = kTolerance;
  for (const auto& [name, list] : now.lists) {
    const auto before = recorded.lists.find(name);
    if (before == recorded.lists.end()) return "'" + name + "' is new";
    const StageResult::List& old = before->second;
    if (list.count != old.count)
      return fmt::format("'{}' had {} numbers, has {}", name, old.count, list.count);
    double change = std::fabs(list.size - old.size);
    for (size_t k = 0; k < list.sums.size(); ++k)
      change = std::max(change, std::fabs(list.sums[k] - old.sums[k]));
    if (change <= largest * old.size) continue;
    largest = change / old.size;
    changed = fmt::format("'{}' changed, sums of it by {:.2g} of its size", name, largest);
  }
  if (!changed.empty()) return changed;
  if (recorded.machine == now.machine && recorded.exact != now.exact) return "last digits changed";
  return {};
}

void RecordedResults::check(const std::string& stage, const Versions& versions, const std::string& change,
                            const StageResult& result) {
  const Entry now{machine(), text_of(versions), to_string(result.exact_.digest()), result.lists_};
  const auto recorded = entries_.find(stage);
  const bool is_known = recorded != entries_.end() && recorded->second.versions == now.versions;
  const std::string changed = is_known ? difference(recorded->second, now) : "";
  if (is_known && changed.empty()) return;
  if (recorded != entries_.end() && is_lowered(versions, recorded->second.versions)) {
    ADD_FAILURE() << "Stage '" << stage << "' has the versions " << now.versions << ", but was recorded with "
                  << recorded->second.versions
                  << ": a version must not fall, because caches of it may exist.";
    return;
  }
  const char* const recording = std::getenv("PELAGE_RECORD_RESULTS");
  if (recording && (!is_known || recording == stage)) {
    entries_[stage] = now;
    write();
    return;
  }
  const std::string record =
      "run this test once with PELAGE_RECORD_RESULTS=1 and commit tests/support/recorded_results.txt";
  if (is_known) {
    ADD_FAILURE()
        << "Stage '" << stage << "' gives other results than those recorded with the same versions ("
        << now.versions << "): " << changed
        << ". Users' caches would keep the old results. If the change is wanted, raise the version of the "
           "first stage that fails here (for this one, "
        << change << "), then " << record
        << ". If only the input changed that this test gives to the stage, set PELAGE_RECORD_RESULTS to "
           "the name of the stage instead.";
  } else {
    ADD_FAILURE() << "Stage '" << stage << "' with the versions " << now.versions << " is not recorded"
                  << (recorded == entries_.end() ? "" : ", only with " + recorded->second.versions) << "; "
                  << record << ".";
  }
}

}  // namespace pelage
