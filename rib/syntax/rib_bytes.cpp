// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_bytes.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string_view>

#include <unistd.h>
#include <zlib.h>

#include "base/file.h"
#include "base/open_file.h"

namespace pelage {

namespace {

// gzip reaches a factor of 1,000 with constant data. Strands reach 3 to 25.
constexpr uint64_t kMaxFactor = 200, kUncheckedBytes = uint64_t(64) << 20;

}  // namespace

struct RibBytes::Stream {
  gzFile file = nullptr;
  uint64_t read = 0;  // bytes of RIB so far
  ~Stream() {
    if (file) gzclose(file);
  }
};

RibBytes::RibBytes(const std::filesystem::path& path)
    : stream_(std::make_unique<Stream>()), file_(std::make_shared<const std::string>(path.string())) {
  const OpenFile file(path);
  const int own = ::dup(file.descriptor());
  stream_->file = own < 0 ? nullptr : gzdopen(own, "rb");
  if (!stream_->file) {
    if (own >= 0) ::close(own);
    throw Error(ErrorKind::kInput, {*file_, 0, 0}, "cannot read: out of file handles or memory");
  }
  // Small buffers for small files, of which there may be many.
  std::error_code ignored;
  const auto size = std::clamp<uintmax_t>(std::filesystem::file_size(path, ignored), 1 << 12, 1 << 17);
  gzbuffer(stream_->file, static_cast<unsigned>(size));
  buffer_.resize(size);
  fill();
  const std::string_view beginning(reinterpret_cast<const char*>(buffer_.data()), end_);
  if (const std::string_view foreign = foreign_text(beginning); !foreign.empty())
    throw Error(ErrorKind::kInput, {*file_, 0, 0}, std::string(foreign));
  if (beginning.starts_with(kUtf8Mark)) next_ = kUtf8Mark.size();
}

RibBytes::~RibBytes() = default;

bool RibBytes::fill() {
  const int got = gzread(stream_->file, buffer_.data(), static_cast<unsigned>(buffer_.size()));
  int state = Z_OK;
  gzerror(stream_->file, &state);
  if (got < 0 || state == Z_BUF_ERROR || state == Z_DATA_ERROR)
    throw Error(ErrorKind::kInput, position(), "the gzip data is damaged or cut off");
  next_ = 0;
  end_ = static_cast<size_t>(std::max(got, 0));
  stream_->read += end_;
  const auto taken = static_cast<uint64_t>(std::max<z_off_t>(0, gzoffset(stream_->file)));
  if (!gzdirect(stream_->file) && stream_->read > std::max(kUncheckedBytes, kMaxFactor * taken))
    throw Error(
        ErrorKind::kInput, position(),
        "the gzip data expands to more than 200 times its size; unpack it with gunzip if you trust it");
  return end_ > 0;
}

void RibBytes::take_binary(void* to, size_t count, const char* what) {
  auto* out = static_cast<uint8_t*>(to);
  while (count > 0) {
    if (next_ == end_ && !fill())
      throw Error(ErrorKind::kInput, position(), std::string("the file ends within ") + what);
    const size_t some = std::min(count, end_ - next_);
    std::memcpy(out, &buffer_[next_], some);
    out += some;
    count -= some;
    next_ += some;
    column_ = static_cast<int>(
        std::min<size_t>(static_cast<size_t>(column_) + some, std::numeric_limits<int>::max() - 1));
  }
}

}  // namespace pelage
