// SPDX-License-Identifier: Apache-2.0
#include "geom/io/binary_file.h"

#include <bit>
#include <system_error>

#include "base/error.h"

namespace pelage {

static_assert(std::endian::native == std::endian::little, "strand files are read as they lie in memory");

BinaryFile::BinaryFile(const std::filesystem::path& path) : path_(path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) fail("there is no such file");
  if (!std::filesystem::is_regular_file(status)) fail("is not a regular file");
  stream_.open(path, std::ios::binary);
  size_ = std::filesystem::file_size(path, error);
  if (!stream_ || error) fail("cannot be opened");
  if (size_ == 0) fail("is empty");
  constexpr std::string_view kPointer = "version https://git-lfs";
  std::string beginning(kPointer.size(), '\0');
  if (size_ >= beginning.size()) read_bytes(0, beginning.data(), beginning.size());
  if (beginning == kPointer) fail("is a git-lfs pointer, not the file itself");
}

void BinaryFile::require(uint64_t offset, uint64_t count, uint64_t value_size,
                         const std::string& what) const {
  if (offset <= size_ && count <= (size_ - offset) / value_size) return;
  fail("claims " + std::to_string(count) + " " + what + " at byte " + std::to_string(offset) +
       ", but has only " + std::to_string(size_) + " bytes");
}

void BinaryFile::read_bytes(uint64_t offset, void* to, size_t count) {
  stream_.seekg(static_cast<std::streamoff>(offset));
  stream_.read(static_cast<char*>(to), static_cast<std::streamsize>(count));
  if (static_cast<size_t>(stream_.gcount()) != count)
    fail("cannot be read at byte " + std::to_string(offset));
}

void BinaryFile::fail(const std::string& why) const {
  throw Error(ErrorKind::kInput, {path_.string(), 0, 0}, why);
}

}  // namespace pelage
