// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "image/exr.h"
#include "image/texture.h"
#include "tests/fuzz/fuzz_targets.h"

namespace pelage {
namespace {

void feed_texture(const std::filesystem::path& path) {
  MemoryLedger ledger;
  TextureLibrary library(ledger);
  try {
    const auto texture = library.load({path, {"scene.yaml", 1, 1}});
    const Image& image = texture->image();
    PELAGE_CHECK(image.width > 0 && image.height > 0 && image.channels > 0);
    PELAGE_CHECK(image.pixels.size() == static_cast<size_t>(image.width) * static_cast<size_t>(image.height) *
                                            static_cast<size_t>(image.channels));
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
