// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/lod_pictures.h"

#include <algorithm>
#include <map>
#include <string>

#include "base/error.h"
#include "image/exr.h"
#include "lab/pictures/picture_difference.h"

namespace pelage {

PictureChange change_between(const std::filesystem::path& from, const std::filesystem::path& to) {
  try {
    const ExrImage a = read_exr(from), b = read_exr(to);
    double sum = 0, squares = 0, largest = 0, count = 0;
    const int columns = (a.width + kChangeBlock - 1) / kChangeBlock;
    std::map<int, double> blocks;  // sums of changes
    const std::vector<float>& alpha = a.find("A")->pixels;
    for (size_t p = 0; p < alpha.size(); ++p) {
      if (!(alpha[p] > 0)) continue;
      double before = 0, after = 0;
      for (const auto& [name, weight] : {std::pair{"R", 0.2126}, {"G", 0.7152}, {"B", 0.0722}}) {
        before += weight * a.find(name)->pixels[p];
        after += weight * b.find(name)->pixels[p];
      }
      sum += before;
      squares += (after - before) * (after - before);
      largest = std::max(largest, std::abs(after - before));
      const int x = static_cast<int>(p) % a.width / kChangeBlock,
                y = static_cast<int>(p) / a.width / kChangeBlock;
      blocks[y * columns + x] += after - before;
      ++count;
    }
    if (!(sum > 0)) return {};
    double largest_block = 0;
    for (const auto& [block, change] : blocks) largest_block = std::max(largest_block, std::abs(change));
    largest_block /= kChangeBlock * kChangeBlock;
    return {largest * count / sum, std::sqrt(squares / count) * count / sum, largest_block * count / sum};
  } catch (const Error&) {
    return {};
  }
}

std::optional<Picture> picture_sheet(const std::vector<std::filesystem::path>& files, size_t columns,
                                     int max_width, const std::string& caption) {
  Picture sheet;
  sheet.caption = caption;
  size_t width = 0, height = 0;  // of a tile; width in bytes
  for (size_t i = 0; i < files.size(); ++i) {
    const auto tile = screen_picture_of(files[i], max_width, "");
    if (!tile) return {};
    if (i == 0) {
      width = static_cast<size_t>(tile->width * tile->channels);
      height = static_cast<size_t>(tile->height);
      sheet.width = tile->width * static_cast<int>(columns);
      sheet.height = tile->height * static_cast<int>((files.size() + columns - 1) / columns);
      sheet.channels = tile->channels;
      sheet.pixels.resize(static_cast<size_t>(sheet.height) * width * columns);
    }
    if (tile->pixels.size() != width * height) return {};
    for (size_t y = 0; y < height; ++y) {
      const size_t to = ((i / columns * height + y) * columns + i % columns) * width;
      std::copy_n(&tile->pixels[y * width], width, &sheet.pixels[to]);
    }
  }
  return sheet;
}

std::optional<Picture> detail_picture(const std::filesystem::path& file) {
  try {
    const ExrImage image = read_exr(file);
    const ExrChannel* layer = image.find("lod");
    const ExrChannel* alpha = image.find("A");
    if (!layer || !alpha) return {};
    Picture picture;
    picture.caption = "Fraction of strands removed: blue none, purple four fifths, red 99 %.";
    picture.width = image.width;
    picture.height = image.height;
    for (size_t p = 0; p < layer->pixels.size(); ++p) {
      const float left = std::clamp(1 - layer->pixels[p], 0.0f, 1.0f);
      const float x = std::min(1.4f * (1 - std::sqrt(std::sqrt(left))), 1.0f);
      const float a = std::clamp(alpha->pixels[p], 0.0f, 1.0f);
      for (const float c : {x, 0.0f, 1 - x})  // as tools/exr_to_png
        picture.pixels.push_back(static_cast<unsigned char>(std::lround(255 * a * c)));
    }
    return picture;
  } catch (const Error&) {
    return {};
  }
}

}  // namespace pelage
