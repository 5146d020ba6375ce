// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "image/exr.h"
#include "image/texture_library.h"
#include "tests/fuzz/fuzz_targets.h"

namespace pelage {
namespace {

void feed_texture(const std::filesystem::path& path) {
  MemoryLedger ledger;
  TextureLibrary library(ledger);
  try {
    const auto texture = library.load({path, {"scene.yaml", 1, 1}});
    PELAGE_CHECK(texture->width() > 0 && texture->height() > 0 && texture->channels() > 0);
    PELAGE_CHECK(std::isfinite(texture->texel(texture->width() - 1, texture->height() - 1).x));
    PELAGE_CHECK(texture->range(0).first <= texture->range(0).second);
    PELAGE_CHECK(std::isfinite(texture->color(0.3f, 0.7f).x));
  } catch (const Error& error) {
    PELAGE_CHECK(error.kind() == ErrorKind::kInput);
    PELAGE_CHECK(error.problems().at(0).position.line == 1);
  }
}

}  // namespace

void fuzz_hdr(std::span<const uint8_t> bytes) { feed_texture(fuzz_file(bytes, ".hdr")); }

void fuzz_exr(std::span<const uint8_t> bytes) {
  const std::filesystem::path path = fuzz_file(bytes, ".exr");
  try {
    const ExrImage image = read_exr(path);
    const size_t pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
    for (const ExrChannel& channel : image.channels) {
      PELAGE_CHECK((channel.type == ChannelType::kUint ? channel.ids.size() : channel.pixels.size()) ==
                   pixels);
    }
  } catch (const Error& error) {
    PELAGE_CHECK(error.kind() == ErrorKind::kInput);
  }
  feed_texture(path);
}

}  // namespace pelage
