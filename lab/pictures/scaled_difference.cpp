// SPDX-License-Identifier: Apache-2.0
#include "lab/pictures/scaled_difference.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace pelage {
namespace {

constexpr const char* kColors[] = {"R", "G", "B"};

bool fits(const ExrImage& image, const ExrImage& first) {
  return image.width == first.width && image.height == first.height &&
         std::all_of(std::begin(kColors), std::end(kColors),
                     [&](const char* name) { return image.find(name) != nullptr; });
}

void add(const std::vector<ExrImage>& images, double factor, std::vector<double>& sums) {
  for (const ExrImage& image : images) {
    for (size_t c = 0; c < std::size(kColors); ++c) {
      const std::vector<float>& pixels = image.find(kColors[c])->pixels;
      for (size_t p = 0; p < pixels.size(); ++p)
        sums[3 * p + c] += factor * pixels[p] / static_cast<double>(images.size());
    }
  }
}

std::vector<ExrImage> read_all(const std::vector<std::filesystem::path>& paths) {
  std::vector<ExrImage> images;
  for (const std::filesystem::path& path : paths) images.push_back(read_exr(path));
  return images;
}

}  // namespace

std::optional<Picture> scaled_difference(const std::vector<ExrImage>& pictures,
                                         const std::vector<ExrImage>& references, double factor,
                                         const std::string& caption) {
  if (pictures.empty() || references.empty()) return {};
  for (const auto* list : {&pictures, &references}) {
    for (const ExrImage& image : *list) {
      if (!fits(image, pictures.front())) return {};
    }
  }
  Picture result;
  result.caption = caption;
  result.width = pictures.front().width;
  result.height = pictures.front().height;
  std::vector<double> sums(3 * static_cast<size_t>(result.width) * static_cast<size_t>(result.height), 0.5);
  add(pictures, factor, sums);
  add(references, -factor, sums);
  for (const double sum : sums)
    result.pixels.push_back(
        static_cast<unsigned char>(std::lround(255 * std::clamp(std::isfinite(sum) ? sum : 0, 0.0, 1.0))));
  return result;
}

std::optional<Picture> scaled_difference_of_files(const std::vector<std::filesystem::path>& pictures,
                                                  const std::vector<std::filesystem::path>& references,
                                                  double factor, const std::string& caption) {
  try {
    return scaled_difference(read_all(pictures), read_all(references), factor, caption);
  } catch (const Error&) {
    return {};
  }
}

}  // namespace pelage
