// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "base/file.h"
#include "rib/syntax/rib_writer.h"

namespace pelage {

struct RibFormat {
  RibEncoding encoding = RibEncoding::kBinary;
  bool gzip = false;
};

/// A RIB file that appears completely or not at all (law 6). Every member throws Error (kFailed) on failure.
class RibFile {
 public:
  RibFile(const std::filesystem::path& path, const RibFormat& format, Links links = Links::kFollow);
  RibWriter& writer() { return writer_; }
  /// Ends the file and moves it to its path.
  void commit();

 private:
  class FileSink final : public RibSink {
   public:
    FileSink(const std::filesystem::path& path, Links links) : file(path, links) {}
    void write(std::string_view bytes) override { file.write(bytes); }
    AtomicFile file;
  };
  FileSink file_;
  std::optional<GzipSink> gzip_;
  RibWriter writer_;
};

}  // namespace pelage
