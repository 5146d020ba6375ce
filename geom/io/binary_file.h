// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace pelage {

/// A little-endian binary file that is read part by part. Call require() before each read, to check the sizes
/// that the file claims against its length. Thread safety: const members may be called from any thread.
class BinaryFile {
 public:
  /// Throws Error (kInput) when the file is missing, empty, not a regular file, or a git-lfs pointer.
  explicit BinaryFile(const std::filesystem::path& path);

  /// An empty file under a name, for data that is in memory.
  struct InMemory {
    std::string name;
  };
  explicit BinaryFile(const InMemory& data) : path_(data.name) {}

  const std::filesystem::path& path() const { return path_; }
  uint64_t size() const { return size_; }
  /// Checks that the file has `count` values of `value_size` bytes at `offset`. If not, throws Error (kInput)
  /// with `what`, the name of these values.
  void require(uint64_t offset, uint64_t count, uint64_t value_size, const std::string& what) const;
  /// Reads values whose range require() has checked.
  void read(uint64_t offset, std::span<float> values) const {
    read_bytes(offset, values.data(), values.size_bytes());
  }
  void read(uint64_t offset, std::span<uint16_t> values) const {
    read_bytes(offset, values.data(), values.size_bytes());
  }
  /// Reads `count` bytes at `offset` to `to`. require() must have checked this range.
  void read_bytes(uint64_t offset, void* to, size_t count) const;

  /// Throws Error (kInput) with the path of the file as position and `why` as message.
  [[noreturn]] void fail(const std::string& why) const;

 private:
  std::filesystem::path path_;
  struct Descriptor {
    int number = -1;
    Descriptor() = default;
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor();
  } descriptor_;
  uint64_t size_ = 0;
};

}  // namespace pelage
