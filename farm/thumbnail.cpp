// SPDX-License-Identifier: Apache-2.0
#include "farm/thumbnail.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/error.h"
#include "image/display_image.h"
#include "image/exr_file.h"
#include "image/view_transform.h"

namespace pelage {

void write_thumbnail(const std::filesystem::path& picture, const std::filesystem::path& png, int width) {
  ExrReader reader(picture);
  const ExrPart& part = reader.parts().front();
  const int columns = part.data.width(), rows = part.data.height();
  const int small = std::min(width, columns);
  const int high = std::max(1, static_cast<int>(int64_t{rows} * small / columns));
  std::array<size_t, 3> channels{};
  for (size_t c = 0; c < 3; ++c) {
    const std::string name(1, "RGB"[c]);
    const auto found = std::find_if(part.channels.begin(), part.channels.end(),
                                    [&](const ExrChannelInfo& info) { return info.name == name; });
    if (found == part.channels.end())
      throw Error(ErrorKind::kInput, {picture.string(), 0, 0}, "has no channel " + name);
    channels[c] = static_cast<size_t>(found - part.channels.begin());
  }
  DisplayImage image{small, high, {}};
  for (int y = 0; y < high; ++y) {
    const int top = static_cast<int>(int64_t{rows} * y / high);
    const int bottom = std::max(top + 1, static_cast<int>(int64_t{rows} * (y + 1) / high));
    const auto stride = static_cast<size_t>(columns), strip = stride * static_cast<size_t>(bottom - top);
    std::vector<float> words(3 * strip);
    std::vector<ExrRows> to;
    for (size_t c = 0; c < 3; ++c) to.push_back({channels[c], &words[c * strip], stride});
    reader.read(0, part.data.y0 + top, part.data.y0 + bottom, to);
    for (int x = 0; x < small; ++x) {
      const int left = static_cast<int>(int64_t{columns} * x / small);
      const int right = std::max(left + 1, static_cast<int>(int64_t{columns} * (x + 1) / small));
      for (size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (int j = 0; j < bottom - top; ++j) {
          for (int i = left; i < right; ++i)
            sum += words[c * strip + static_cast<size_t>(j) * stride + static_cast<size_t>(i)];
        }
        image.pixels.push_back(view_byte(static_cast<float>(sum / ((bottom - top) * (right - left)))));
      }
    }
  }
  write_display_image(png, image);
}

}  // namespace pelage
