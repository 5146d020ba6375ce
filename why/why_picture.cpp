// SPDX-License-Identifier: Apache-2.0
#include "why/why_picture.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "image/view_transform.h"
#include "world/kept_render.h"

namespace pelage {
namespace {

constexpr int kMinSide = 48, kMaxSide = 192;  // of the part, in pixels of the picture
constexpr int kMargin = 8;
constexpr int kShownSide = 640;          // of the enlarged part, at least; in pixels
constexpr int64_t kMaxSamples = 12'000;  // of all pixels together

struct Range {
  int begin = 0, end = 0;
};

/// Returns up to kMaxSide pixels that contain `pixel` and as much of [low, high] as possible.
Range range_around(int pixel, float low, float high, int picture) {
  const int side = std::clamp(static_cast<int>(high - low) + 2 * kMargin, kMinSide, kMaxSide);
  int begin = static_cast<int>(0.5f * (low + high)) - side / 2;
  begin = std::clamp(begin, pixel + kMargin - side, pixel - kMargin);
  begin = std::clamp(begin, 0, std::max(0, picture - side));
  return {begin, std::min(picture, begin + side)};
}

PixelBox part_around(const PixelWhy& why, int width, int height) {
  Imath::Box2f box(V2f(static_cast<float>(why.x), static_cast<float>(why.y)));
  if (why.strand) {
    const V2f far(static_cast<float>(2 * kMaxSide));  // parts of the strand that cannot be shown do not count
    for (const V2f& point : why.strand->outline) {
      const V2f from = point - V2f(static_cast<float>(why.x), static_cast<float>(why.y));
      if (std::abs(from.x) < far.x && std::abs(from.y) < far.y) box.extendBy(point);
    }
  }
  const Range x = range_around(why.x, box.min.x, box.max.x, width);
  const Range y = range_around(why.y, box.min.y, box.max.y, height);
  return {x.begin, y.begin, x.end, y.end};
}

/// A picture in which each pixel is a square of `scale` pixels.
class Enlarged {
 public:
  Enlarged(const FrameResult& result, const PixelBox& part, int scale)
      : part_(part), scale_(scale), image_{part.width() * scale, part.height() * scale, {}} {
    for (int y = 0; y < image_.height; ++y) {
      for (int x = 0; x < image_.width; ++x) {
        const Rgb color = result.film.radiance(part.x0 + x / scale - result.window.film.x0,
                                               part.y0 + y / scale - result.window.film.y0);
        for (int c = 0; c < 3; ++c) image_.pixels.push_back(view_byte(color[c]));
      }
    }
  }

  /// Draws lines through points of the picture. `width`: in pixels of the enlarged picture.
  void draw(std::span<const V2f> points, float width, const V3f& color) {
    std::vector<float> cover(static_cast<size_t>(image_.width) * static_cast<size_t>(image_.height));
    for (size_t i = 0; i + 1 < points.size(); ++i)
      cover_line(shown(points[i]), shown(points[i + 1]), width, cover);
    for (size_t pixel = 0; pixel < cover.size(); ++pixel) {
      for (int c = 0; c < 3 && cover[pixel] > 0; ++c) {
        uint8_t& value = image_.pixels[3 * pixel + static_cast<size_t>(c)];
        value = static_cast<uint8_t>(std::lround(value + cover[pixel] * (color[c] - value)));
      }
    }
  }

  DisplayImage take() { return std::move(image_); }

 private:
  V2f shown(const V2f& point) const {
    return V2f(point.x - static_cast<float>(part_.x0), point.y - static_cast<float>(part_.y0)) *
           static_cast<float>(scale_);
  }

  /// Sets how much of each pixel a line covers, unless more of the pixel is covered already.
  void cover_line(const V2f& a, const V2f& b, float width, std::vector<float>& cover) const {
    const float reach = 0.5f * width + 1;
    const auto limit = [](float v, int end) {
      return static_cast<int>(std::clamp(v, 0.0f, static_cast<float>(end)));
    };
    const int x0 = limit(std::min(a.x, b.x) - reach, image_.width),
              x1 = limit(std::max(a.x, b.x) + reach + 1, image_.width);
    const int y0 = limit(std::min(a.y, b.y) - reach, image_.height),
              y1 = limit(std::max(a.y, b.y) + reach + 1, image_.height);
    const V2f along = b - a;
    const float length2 = std::max(along.length2(), 1e-12f);
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        const V2f at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        const float t = std::clamp((at - a).dot(along) / length2, 0.0f, 1.0f);
        const float distance = (at - a - t * along).length();
        float& most =
            cover[static_cast<size_t>(y) * static_cast<size_t>(image_.width) + static_cast<size_t>(x)];
        most = std::max(most, std::clamp(0.5f * width + 0.5f - distance, 0.0f, 1.0f));
      }
    }
  }

  PixelBox part_;
  int scale_;
  DisplayImage image_;
};

}  // namespace

DisplayImage why_picture(const ExplainedFrame& frame, const PixelWhy& why, const Job& job) {
  const RenderScene& scene = frame.world.scene;
  const PixelBox part = part_around(why, scene.image.width, scene.image.height);
  const int64_t pixels = static_cast<int64_t>(part.width()) * part.height();
  FrameOptions options;
  options.region = part;
  FrameSettings settings{scene.image, scene.render};
  settings.render.adaptive.reset();
  settings.render.samples =
      static_cast<int>(std::clamp<int64_t>(kMaxSamples / pixels, 1, scene.render.samples));
  options.settings = settings;
  const FrameResult result = render(frame.world, job, options, frame.geometry, frame.kept);
  job.check_stop();

  const int scale = std::max(1, (kShownSide + part.width() - 1) / part.width());
  Enlarged picture(result, part, scale);
  const V3f dark(0), bright(255, 180, 84), white(255);
  const float x = static_cast<float>(why.x), y = static_cast<float>(why.y);
  const V2f square[] = {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}, {x, y}};
  const auto outlined = [&](std::span<const V2f> points, float width, const V3f& color) {
    picture.draw(points, width + 2.5f, dark);
    picture.draw(points, width, color);
  };
  if (why.strand && !why.strand->outline.empty()) {
    const V2f root[] = {why.strand->outline.front(), why.strand->outline.front()};
    outlined(why.strand->outline, 2, bright);
    outlined(root, 8, bright);
  }
  outlined(square, 1.5f, white);
  return picture.take();
}

}  // namespace pelage
