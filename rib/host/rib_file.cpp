// SPDX-License-Identifier: Apache-2.0
#include "rib/host/rib_file.h"

namespace pelage {

RibFile::RibFile(const std::filesystem::path& path, const RibFormat& format, Links links)
    : file_(path, links),
      gzip_(format.gzip ? std::optional<GzipSink>(std::in_place, file_) : std::nullopt),
      writer_(gzip_ ? static_cast<RibSink&>(*gzip_) : file_, format.encoding) {
  writer_.comment("#RenderMan RIB");
}

void RibFile::commit() {
  writer_.end_line();
  writer_.flush();
  if (gzip_) gzip_->finish();
  file_.file.commit();
}

}  // namespace pelage
