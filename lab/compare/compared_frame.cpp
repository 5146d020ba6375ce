// SPDX-License-Identifier: Apache-2.0
#include "lab/compare/compared_frame.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/process_usage.h"
#include "base/stopwatch.h"
#include "lab/compare/light_side.h"
#include "lab/pictures/picture_difference.h"
#include "render/render_frame.h"
#include "world/compose.h"

namespace pelage {
namespace {

bool is_fur(const Film& film, int x, int y) { return film.surface(x, y).id != kNoStrand; }

/// Stages of single frames would flood the display: shows the comparison as one.
class QuietProgress final : public Progress {
 public:
  explicit QuietProgress(Progress& outer) : outer_(outer) {}
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  void warn(std::string_view line) override { outer_.warn(line); }
  bool cancelled() const override { return outer_.cancelled(); }

 private:
  Progress& outer_;
};

Picture mean_picture(const Film& a, const Film& b) {
  ExrImage image;
  image.width = a.width();
  image.height = a.height();
  const char* names[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    ExrChannel channel;
    channel.name = names[c];
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x)
        channel.pixels.push_back(0.5f * (a.radiance(x, y)[c] + b.radiance(x, y)[c]));
    }
    image.channels.push_back(std::move(channel));
  }
  return *screen_picture(image, image.width, "");
}

/// Luminance and relMSE over fur; relMSE as docs/NOTATION.md defines it, with the mean of the halves for the
/// reference: a quarter of their squared difference is the variance of that mean.
void measure(const Film& a, const Film& b, ComparedFrame& frame) {
  double sum = 0, count = 0;
  const auto each = [&](auto&& use) {
    for (int y = 0; y < a.height(); ++y) {
      for (int x = 0; x < a.width(); ++x) {
        if (is_fur(a, x, y)) use(double(luminance(a.radiance(x, y))), double(luminance(b.radiance(x, y))));
      }
    }
  };
  each([&](double p, double q) {
    sum += 0.5 * (p + q);
    count += 1;
  });
  frame.fur_share = count / (double(a.width()) * a.height());
  if (count == 0) return;
  frame.luminance = sum / count;
  double noise = 0;
  each([&](double p, double q) {
    const double mean = 0.5 * (p + q), variance = 0.25 * (p - q) * (p - q);
    noise += variance / (mean * mean + 0.01 * frame.luminance * frame.luminance + 1e-30);
  });
  frame.noise = noise / count;
}

}  // namespace

FrameComparer::FrameComparer(const SceneDescription& scene, Assets& assets, const Job& job)
    : scene_(scene), assets_(assets), job_(job) {
  scene_.render.samples = std::max(1, (scene.render.samples + 1) / 2);
  // The same pixels as with boxes, without a pass over all fur to compute them.
  scene_.render.bounds = BoundingStrategy::kNone;
}

ComparedFrame FrameComparer::render(const std::vector<MaterialParams>& materials,
                                    const Named<LightParams>& lights, const std::string& model,
                                    const std::string& light) {
  ComparedFrame frame;
  frame.model = model;
  frame.light = light;
  scene_.lights = lights;
  assets_.materials = materials;
  const World world = compose(scene_, assets_, scene_.frames.frames.front(), job_);
  QuietProgress progress(job_.progress);
  std::vector<double> cpu_s;
  const auto half = [&](int64_t seed) {
    FrameOptions options;
    options.settings = {scene_.image, scene_.render};
    options.settings->render.seed = seed;
    const Stopwatch wall;
    const double began = cpu_seconds();
    FrameResult result = render_frame(world.scene, {job_.workers, job_.ledger, progress}, options);
    frame.wall_s += wall.seconds();
    cpu_s.push_back(cpu_seconds() - began);
    frame.rays += static_cast<double>(result.statistics.rays.total());
    return std::move(result.film);
  };
  const Film first = half(2 * scene_.render.seed), second = half(2 * scene_.render.seed + 1);
  frame.cpu_s = cpu_s[0] + cpu_s[1];
  frame.cpu_spread = std::abs(cpu_s[0] - cpu_s[1]) / std::max(cpu_s[0], cpu_s[1]);
  measure(first, second, frame);
  frame.picture = mean_picture(first, second);
  return frame;
}

double FrameComparer::furnace(const std::vector<MaterialParams>& materials) {
  constexpr int kSamples = 8, kBounces = 1000;
  SceneDescription scene = scene_;
  scene.lights = white_furnace();
  scene.image.width = std::max(16, scene.image.width / 4);
  scene.image.height = std::max(9, scene.image.height / 4);
  scene.render.samples = kSamples;
  scene.render.bounces = kBounces;
  assets_.materials = materials;
  const World world = compose(scene, assets_, scene.frames.frames.front(), job_);
  QuietProgress progress(job_.progress);
  const FrameResult result = render_frame(world.scene, {job_.workers, job_.ledger, progress});
  double sum = 0, count = 0;
  for (int y = 0; y < result.film.height(); ++y) {
    for (int x = 0; x < result.film.width(); ++x) {
      if (!is_fur(result.film, x, y)) continue;
      sum += double(luminance(result.film.radiance(x, y)));
      count += 1;
    }
  }
  return sum / count;
}

}  // namespace pelage
