// SPDX-License-Identifier: Apache-2.0
#include "image/image_file_check.h"

#include <filesystem>
#include <fstream>
#include <system_error>

#include "image/exr_check.h"
#include "image/truncation.h"

namespace pelage {

void fail_image(const AssetPath& asset, const std::string& reason) {
  throw Error(ErrorKind::kInput, asset.position, asset.path.string() + ": " + reason);
}

void check_image_file(const AssetPath& asset) {
  std::error_code error;
  const auto status = std::filesystem::status(asset.path, error);
  if (!std::filesystem::exists(status)) fail_image(asset, "there is no such file");
  if (!std::filesystem::is_regular_file(status)) fail_image(asset, "is not a regular file");
  std::ifstream stream(asset.path, std::ios::binary);
  std::string beginning(64, '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  if (stream.gcount() == 0) fail_image(asset, stream.bad() || !stream.eof() ? "cannot be read" : "is empty");
  if (beginning.starts_with("version https://git-lfs"))
    fail_image(asset, "is a git-lfs pointer, not the image itself");
  if (is_cut_short(stream)) fail_image(asset, "is truncated");
  if (beginning.starts_with("v/1\x01")) {
    try {
      check_exr_headers(asset.path);
    } catch (const Error& damage) {
      fail_image(asset, damage.problems().front().message);
    }
  }
}

}  // namespace pelage
