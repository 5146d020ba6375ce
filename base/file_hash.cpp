// SPDX-License-Identifier: Apache-2.0
#include "base/file_hash.h"

#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include <unistd.h>

#include "base/error.h"
#include "base/open_file.h"

namespace pelage {

ContentHash file_hash(const std::filesystem::path& path) {
  constexpr size_t kPiece = size_t(256) << 10;
  const OpenFile file(path);
  ContentHasher hasher;
  std::vector<std::byte> piece(kPiece);
  for (;;) {
    const ssize_t read = ::read(file.descriptor(), piece.data(), piece.size());
    if (read == 0) return hasher.digest();
    if (read > 0) {
      hasher.add_bytes(std::span(piece).first(static_cast<size_t>(read)));
    } else if (errno != EINTR) {
      throw Error(ErrorKind::kInput, {path.string(), 0, 0},
                  std::string("cannot read: ") + std::strerror(errno));
    }
  }
}

}  // namespace pelage
