// SPDX-License-Identifier: Apache-2.0
#include "image/exr_errors.h"

#include <algorithm>
#include <exception>
#include <new>

namespace pelage {
namespace {

/// The library's message on one line, without the path.
std::string text_of(const std::exception& error, const std::filesystem::path& path) {
  std::string text = error.what();
  if (const size_t named = text.find(path.string() + "\". "); named != std::string::npos) {
    text.erase(0, named + path.string().size() + 3);
  }
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
  return text;
}

}  // namespace

void refuse_exr(const std::filesystem::path& path, const std::string& why) {
  throw Error(ErrorKind::kInput, {path.string(), 0, 0}, why);
}

void rethrow_exr(const std::filesystem::path& path, ErrorKind kind) {
  try {
    throw;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::kMemory, {path.string(), 0, 0}, "does not fit in memory");
  } catch (const std::exception& error) {
    throw Error(kind, {path.string(), 0, 0},
                (kind == ErrorKind::kInput ? "damaged: " : "cannot write: ") + text_of(error, path));
  }
}

}  // namespace pelage
