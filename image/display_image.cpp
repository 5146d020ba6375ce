// SPDX-License-Identifier: Apache-2.0
#include "image/display_image.h"

#include "base/error.h"
#include "image/image_reader.h"

namespace pelage {

bool is_display_image(const std::filesystem::path& path) {
  const std::string ending = lower_extension(path);
  return ending == ".png" || ending == ".jpg" || ending == ".jpeg";
}

void write_display_image(const std::filesystem::path& path, const DisplayImage& image, Links links) {
  const ImageReader module;
  AtomicFile file(path, links);
  if (const std::string problem = module.write(file.temporary_path(), image); !problem.empty())
    throw Error(ErrorKind::kFailed, path.string() + ": cannot write: " + problem);
  file.commit();
}

}  // namespace pelage
