// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_sink.h"

#include <array>

#include <zlib.h>

#include "base/error.h"

namespace pelage {
namespace {

constexpr int kLevel = 6;                  // zlib's own default
constexpr int kGzip = 15 + 16;             // the largest window, and a gzip header
constexpr size_t kMost = size_t(1) << 30;  // zlib counts the bytes of a call in 32 bits

}  // namespace

struct GzipSink::Stream {
  z_stream z{};
  std::array<char, size_t(64) << 10> out;
};

GzipSink::GzipSink(RibSink& to) : to_(to), stream_(std::make_unique<Stream>()) {
  if (deflateInit2(&stream_->z, kLevel, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw Error(ErrorKind::kFailed, "cannot start the compression of a RIB file");
}

GzipSink::~GzipSink() { deflateEnd(&stream_->z); }

void GzipSink::write(std::string_view bytes) {
  for (; bytes.size() > kMost; bytes.remove_prefix(kMost)) deflate(bytes.substr(0, kMost), false);
  deflate(bytes, false);
}

void GzipSink::finish() { deflate({}, true); }

void GzipSink::deflate(std::string_view bytes, bool last) {
  z_stream& z = stream_->z;
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // zlib does not write to it
  z.avail_in = static_cast<uInt>(bytes.size());
  do {
    z.next_out = reinterpret_cast<Bytef*>(stream_->out.data());
    z.avail_out = static_cast<uInt>(stream_->out.size());
    ::deflate(&z, last ? Z_FINISH : Z_NO_FLUSH);
    to_.write({stream_->out.data(), stream_->out.size() - z.avail_out});
  } while (z.avail_out == 0);
}

}  // namespace pelage
