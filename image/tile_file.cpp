// SPDX-License-Identifier: Apache-2.0
#include "image/tile_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/error.h"

namespace pelage {
namespace {

std::filesystem::path folder() {
  std::error_code error;
  const std::filesystem::path path = std::filesystem::temp_directory_path(error);
  if (error) {
    throw Error(ErrorKind::kFailed,
                "the folder for temporary files does not exist (set TMPDIR): " + error.message());
  }
  return path;
}

[[noreturn]] void fail(const std::string& what, int reason) {
  throw Error(ErrorKind::kFailed, "cannot " + what + " a temporary file of texture tiles in " +
                                      folder().string() + " (TMPDIR): " + std::strerror(reason));
}

size_t tiles_across(const TexelLayout& layout) {
  return static_cast<size_t>((layout.width + kTileSide - 1) / kTileSide);
}

}  // namespace

size_t TileFile::buffer_bytes(const TexelLayout& layout) {
  return tiles_across(layout) * kTileSide * kTileSide * layout.texel_bytes();
}

TileFile::TileFile(const TexelLayout& layout) : layout_(layout), band_(buffer_bytes(layout)) {
  std::string pattern = (folder() / "pelage-tiles-XXXXXX").string();
  descriptor_ = ::mkostemp(pattern.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail("make", errno);
  ::unlink(pattern.c_str());
}

TileFile::~TileFile() { ::close(descriptor_); }

void TileFile::add_rows(const std::byte* rows, int count) {
  const size_t texel = layout_.texel_bytes(), segment = kTileSide * texel, tile = kTileSide * segment;
  for (int i = 0; i < count; ++i, rows += layout_.row_bytes()) {
    const auto row_in_tile = static_cast<size_t>(rows_ % kTileSide);
    for (size_t t = 0, from = 0; from < layout_.row_bytes(); ++t, from += segment) {
      const size_t bytes = std::min(segment, layout_.row_bytes() - from);
      std::memcpy(band_.data() + t * tile + row_in_tile * segment, rows + from, bytes);
    }
    ++rows_;
    if (rows_ % kTileSide == 0 || rows_ == layout_.height) write_band();
  }
  if (rows_ == layout_.height) {
    band_.clear();
    band_.shrink_to_fit();
  }
}

void TileFile::write_band() {
  const std::byte* from = band_.data();
  for (size_t left = band_.size(); left > 0;) {
    const ssize_t written = ::write(descriptor_, from, left);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("write", written < 0 ? errno : ENOSPC);
    from += written;
    left -= static_cast<size_t>(written);
  }
}

}  // namespace pelage
